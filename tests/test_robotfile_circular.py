"""The circular robot's files: what they say follows from what they say, and body and profile agree."""

import json
import tomllib

import numpy as np
import pytest

from hil_sim.physics.coilset import coils_of
from hil_sim.robotfile import FOLDER, PROFILES, load, names

BODY = load("circular")
COIL = coils_of(BODY.coil, 1)
PROFILE = json.loads((PROFILES / "circular.json").read_text(encoding="utf-8"))


def test_the_bench_knows_the_circular_robot():
    assert "circular" in names()
    assert BODY.labels == tuple("ABCDEFGH")


def test_its_sizes_are_in_si_units():
    found = [BODY.ring.R, BODY.ring.m, BODY.coil.G_A, BODY.coil.c_tau, BODY.coil.H, BODY.coil.rho_A]

    assert found == pytest.approx([0.020, 1.6e-3, 22e9, 6.9e6, 24.2e3, 0.88e-6])


def test_its_cold_coils_just_reach_from_hub_to_rim():
    reach = COIL.L_A[0] + COIL.dL[0] + BODY.ring.slack + BODY.ring.attach

    assert reach == pytest.approx(BODY.ring.R, rel=1e-3)


def test_the_derived_section_follows_from_the_numbers():
    derived = {key: row[0] for key, row in tomllib.loads((FOLDER / "circular.toml").read_text())["derived"].items()}
    V, R, r = BODY.wiring.supply_v, COIL.R_A[0], BODY.wiring.series_ohm

    found = {
        "closed_length_mm": COIL.L_A[0] * 1e3,
        "stretch_mm": COIL.dL[0] * 1e3,
        "spring_rate_austenite_n_per_m": COIL.k_A[0],
        "spring_rate_martensite_n_per_m": COIL.k_M[0],
        "resistance_austenite_ohm": COIL.R_A[0],
        "resistance_martensite_ohm": COIL.R_M[0],
        "wire_mass_mg": BODY.coil.m * 1e6,
        "heat_capacity_uj_per_k": COIL.C[0] * 1e6,
        "heat_loss_uw_per_k": COIL.hA[0] * 1e6,
        "latent_uj": COIL.Q[0] * 1e6,
        "full_power_mw": 1e3 * V**2 * R / (R + r) ** 2,
        "thermal_time_s": COIL.C[0] / COIL.hA[0],
    }

    assert found == pytest.approx(derived, rel=1e-3)


def test_body_and_profile_have_the_same_labels_on_the_same_outputs():
    wired = {row["label"]: (row["chip"], row["output"]) for row in PROFILE["channels"]}

    assert wired == BODY.wiring.outputs
    assert [row["label"] for row in PROFILE["channels"]] == list(BODY.labels)
    assert BODY.profile == PROFILES / "circular.json"


def test_the_firmware_estimates_with_the_numbers_of_the_body():
    coil, wiring = PROFILE["coil"], BODY.wiring
    series_ohm = wiring.series_ohm + wiring.source_ohm

    assert COIL.R_A[0] <= coil["resistance_mohm"] / 1e3 <= COIL.R_M[0]
    found = [coil[key] for key in ("wiring_mohm", "heat_capacity_uj_per_k", "loss_uw_per_k", "latent_uj")]
    body = np.array([series_ohm * 1e3, COIL.C[0] * 1e6, COIL.hA[0] * 1e6, COIL.Q[0] * 1e6])
    assert found == pytest.approx(body, rel=0.02)
    assert [coil["as_degc"], coil["af_degc"], coil["ms_degc"], coil["mf_degc"]] == [68, 78, 52, 42]
    assert PROFILE["supply"]["shunt_mohm"] == BODY.sensors.shunt_ohm * 1e3
    assert PROFILE["supply_mv"] == wiring.supply_v * 1e3
