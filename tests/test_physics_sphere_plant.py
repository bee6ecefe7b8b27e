"""The sphere as a plant: what it observes, its energies, its attitudes, and that nothing is scripted."""

import numpy as np
import pytest

from hil_sim.bodies.sphere import SpherePlant
from hil_sim.robots.file import load

BOOST_W = 1.1  # about what a coil takes from the supply at full duty
HOLD_W = 0.36


def plant(name="sphere-b", **numbers):
    """Return a plant; sections and keys of overrides are joined by two underscores."""
    return SpherePlant(load(name, {name.replace("__", "."): str(value) for name, value in numbers.items()}))


def heat(body, labels, seconds, watts):
    """Heat coils for a time and return the plant."""
    power = np.array([watts if label in labels else 0.0 for label in body.labels])
    for _ in range(round(seconds / 5e-3)):
        body.advance(5000, power)
    return body


def rolled(**numbers):
    """Return a sphere-b that has held its lowest coil and rolled onto the next one forward."""
    body = plant(**numbers)
    heat(body, ["A00m1"], 0.8, BOOST_W)
    heat(body, ["A00m1"], 1.2, HOLD_W)
    heat(body, ["A10m1"], 0.8, BOOST_W)
    return heat(body, ["A10m1"], 1.7, HOLD_W)


@pytest.fixture(scope="module")
def step():
    """One step of a crawl."""
    return rolled()


def test_one_step_rolls_by_an_eighth_of_the_circumference(step):
    seen = step.observe()

    assert seen["travel_mm"] == pytest.approx(35.3, rel=0.15)
    assert seen["rotation_deg"] == pytest.approx(45.0, abs=8.0)
    assert abs(seen["lateral_mm"]) < 0.1
    assert seen["down"] == "A10m1"


def test_the_energies_of_a_step_balance_to_one_percent_of_what_the_coils_gave(step):
    balance = step.energies()

    assert balance["coils_j"] > 5e-4
    assert abs(balance["numerical_j"]) < 0.01 * balance["coils_j"]


def test_a_step_repeats_bit_by_bit(step):
    assert rolled().snapshot() == step.snapshot()


def test_without_gravity_nothing_rolls():
    body = rolled(ground__gravity_m_per_s2=0.0)

    assert abs(body.observe()["rotation_deg"]) < 2.0


def test_without_power_nothing_moves():
    body = heat(plant(), [], 2.0, 0.0)

    assert abs(body.observe()["travel_mm"]) < 1e-3
    assert body.observe()["peak_coil_force_n"] < 0.01  # some are stretched a little where the body sags


def test_a_mirrored_start_rolls_the_mirrored_way(step):
    body = plant(start__yaw_deg=180.0)
    heat(body, ["A00m1"], 0.8, BOOST_W)
    heat(body, ["A00m1"], 1.2, HOLD_W)
    heat(body, ["A10m1"], 0.8, BOOST_W)
    heat(body, ["A10m1"], 1.7, HOLD_W)

    assert body.observe()["travel_mm"] == pytest.approx(-step.observe()["travel_mm"], rel=1e-3)


@pytest.mark.parametrize("seed", range(6))
def test_from_any_attitude_it_comes_to_rest_on_some_side(seed):
    yaw, pitch, roll = np.random.default_rng(seed).uniform(-180, 180, 3)

    body = heat(plant(start__yaw_deg=yaw, start__pitch_deg=pitch, start__roll_deg=roll), [], 3.0, 0.0)

    assert body.observe()["contacts"] > 0
    assert body.energies()["kinetic_j"] < 1e-5
    assert body.observe()["down"] in body.labels


def test_the_accelerometer_of_a_resting_core_reads_gravity_in_its_own_axes():
    body = heat(plant("sphere-a", start__pitch_deg=90.0), [], 0.5, 0.0)

    assert body.specific_force() == pytest.approx([-9.81, 0.0, 0.0], abs=0.05)
    assert body.angular_rate() == pytest.approx([0.0, 0.0, 0.0], abs=1e-3)


def test_the_snapshot_holds_three_closed_hoops_and_where_each_coil_pulls():
    seen = plant().snapshot()

    assert len(seen["hoops"]) == 3
    assert max(max(hoop) for hoop in seen["hoops"]) == len(seen["nodes"]) - 1
    assert set(seen["coils"]) == set(plant().labels)
    assert np.linalg.norm(np.subtract(seen["coils"]["B10m1"]["from"], seen["coils"]["B10m1"]["to"])) == pytest.approx(
        45.0, abs=1.0
    )
    assert seen["strip_mm"] == pytest.approx(6.0)
    assert plant("sphere-a").snapshot()["strip_mm"] == pytest.approx(10.0)


def test_a_step_in_the_ground_stops_the_sphere_that_does_not_climb_it():
    free, stopped = plant(), plant(ground__step_mm=20.0, ground__step_at_mm=40.0)
    for body in (free, stopped):
        for label in ("A00m1", "A10m1", "A100"):
            heat(body, [label], 0.8, BOOST_W)
            heat(body, [label], 1.5, HOLD_W)

    assert free.observe()["travel_mm"] > 60.0
    assert stopped.observe()["travel_mm"] < 40.0
