"""The files of each robot with coils: what they say follows from what they say, and body and profile agree."""

import json
import tomllib
from math import pi

import pytest

from hil_sim.physics.coilset import coils_of
from hil_sim.robots.file import FOLDER, PROFILES, load, names

SMALL_INT_MAX = (1 << 30) - 1  # of a board's MicroPython: beyond it a number takes memory
NOMINAL_V = {"sphere-a": 7.2}  # of a battery, as its file says in words


@pytest.fixture(params=[name for name in names() if load(name).coil])
def body(request):
    return load(request.param)


@pytest.fixture
def profile(body):
    return json.loads(body.profile.read_text(encoding="utf-8"))


def test_its_derived_section_follows_from_its_numbers(body):
    coil, reach = coils_of(body.coil, 1), body.sphere or body.ring
    V, R, r = body.wiring.supply_v or NOMINAL_V[body.name], coil.R_A[0], body.wiring.series_ohm

    follows = {
        "closed_length_mm": coil.L_A[0] * 1e3,
        "stretch_mm": coil.dL[0] * 1e3,
        "spring_rate_austenite_n_per_m": coil.k_A[0],
        "spring_rate_martensite_n_per_m": coil.k_M[0],
        "resistance_austenite_ohm": coil.R_A[0],
        "resistance_martensite_ohm": coil.R_M[0],
        "wire_mass_mg": body.coil.m * 1e6,
        "heat_capacity_uj_per_k": coil.C[0] * 1e6,
        "heat_loss_uw_per_k": coil.hA[0] * 1e6,
        "latent_uj": coil.Q[0] * 1e6,
        "full_power_mw": 1e3 * V**2 * R / (R + r) ** 2,
        "thermal_time_s": coil.C[0] / coil.hA[0],
    }
    if body.sphere:
        follows["total_mass_g"] = 1e3 * (body.sphere.m + body.sphere.m_joints + body.sphere.m_core)
        follows["step_mm"] = 1e3 * pi * reach.R / 4

    told = told_by(body)
    stretched_mm = 1e3 * (reach.R - reach.attach - coil.L_A[0] - coil.dL[0])
    assert told.pop("pre_stretch_mm") == pytest.approx(stretched_mm, abs=0.01)  # a difference of lengths
    assert follows == pytest.approx(told, rel=1e-3)


def test_body_and_profile_have_the_same_labels_on_the_same_outputs(body, profile):
    wired = {row["label"]: (row["chip"], row["output"]) for row in profile["channels"]}

    assert wired == body.wiring.outputs
    assert [row["label"] for row in profile["channels"]] == list(body.labels)
    assert body.profile == PROFILES / f"{body.name}.json"
    assert profile["robot"] == body.name


def test_the_firmware_estimates_with_the_numbers_of_the_body(body, profile):
    coil, estimate, wiring = coils_of(body.coil, 1), profile["coil"], body.wiring

    assert coil.R_A[0] <= estimate["resistance_mohm"] / 1e3 <= coil.R_M[0]
    found = [estimate[key] for key in ("wiring_mohm", "heat_capacity_uj_per_k", "loss_uw_per_k", "latent_uj")]
    series_mohm = 1e3 * (wiring.series_ohm + wiring.source_ohm)
    assert found == pytest.approx([series_mohm, coil.C[0] * 1e6, coil.hA[0] * 1e6, coil.Q[0] * 1e6], rel=0.02)
    assert [estimate[f"{end}_degc"] for end in ("as", "af", "ms", "mf")] == [68, 78, 52, 42]
    assert profile["supply"]["shunt_mohm"] == body.sensors.shunt_ohm * 1e3
    assert profile["supply_mv"] == 1e3 * (wiring.supply_v or NOMINAL_V[body.name])


def test_its_groups_name_coils_it_has_and_all_of_them_once(profile):
    labels = [row["label"] for row in profile["channels"]]
    groups = {name: members.split() for name, members in profile["groups"]}

    assert groups["all"] == labels
    assert all(set(members) <= set(labels) and len(set(members)) == len(members) for members in groups.values())


def test_its_heat_budget_is_what_a_coil_takes_that_is_held_just_below_its_trip(profile):
    """An eighth below: energy and temperature are two protections, and neither makes the other idle."""
    coil = profile["coil"]

    held_mj = coil["loss_uw_per_k"] * (coil["trip_degc"] - 25) * coil["heat_leak_ms"] / 1e6

    assert 0.85 < coil["heat_budget_mj"] / held_mj < 0.9


def test_its_supply_feeds_as_many_coils_as_may_be_on_at_once(profile):
    coil, supply = profile["coil"], profile["supply"]

    each_ma = profile["supply_mv"] * 1e3 / (coil["resistance_mohm"] + coil["wiring_mohm"])

    assert supply["at_once_max"] * each_ma < supply["current_max_ma"]


def test_the_firmware_reckons_with_its_numbers_without_taking_memory(profile):
    """The greatest products of sense.py, at the highest supply that is no fault and with coils brought up in turn."""
    coil, step_ms = profile["coil"], 5
    current_ma = profile["supply"]["high_mv"] * 1000 // (coil["resistance_mohm"] + coil["wiring_mohm"])
    full_uw = current_ma * current_ma // 100 * coil["resistance_mohm"] // 10
    turn_ms = len(profile["channels"]) * step_ms

    products = {
        "voltage": profile["supply"]["high_mv"] * 1000,
        "power": full_uw * 10,
        "duty": full_uw // 10 * 1000,
        "energy": full_uw * step_ms,
        "leak": coil["heat_budget_mj"] * 1000 * turn_ms,
        "loss": (coil["trip_degc"] + 40) * 10 * coil["loss_uw_per_k"],
        "lost": (coil["trip_degc"] + 40) * coil["loss_uw_per_k"] * turn_ms,
        "latent": coil["latent_uj"] * 10,
    }

    assert {name: value for name, value in products.items() if value > SMALL_INT_MAX} == {}


def told_by(body):
    """Return the derived section of a robot's file."""
    data = tomllib.loads((FOLDER / f"{body.name}.toml").read_text(encoding="utf-8"))
    return {key: value for key, (value, _) in data["derived"].items()}
