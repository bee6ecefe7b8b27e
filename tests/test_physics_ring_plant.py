"""The plant as the bench sees it: what goes in, what can be seen, and that nothing else matters."""

import numpy as np
import pytest

from tests.ring_samples import GRID_US, crawl, drive, duties, new_plant, powers, take_hold


def test_the_robot_stands_at_rest_on_coil_a_at_time_zero():
    plant = new_plant()

    seen = plant.snapshot()
    heights = [y for _, y in seen["nodes"]]
    assert seen["t_s"] == 0.0
    assert min(heights) == seen["nodes"][0][1] == pytest.approx(0.0, abs=0.1)
    assert seen["coils"]["A"]["to"] == seen["nodes"][0]
    assert plant.energies()["kinetic_j"] == 0.0
    assert plant.observe()["travel_mm"] == 0.0


def test_the_next_coil_is_the_one_that_rolling_forward_brings_down():
    seen = new_plant().snapshot()

    a, b, h = (np.array(seen["coils"][label]["to"]) for label in "ABH")

    assert b[0] > a[0] > h[0]
    assert b[1] == pytest.approx(h[1], abs=1e-6)


def test_a_turned_start_puts_another_coil_down():
    plant = new_plant(start__turn_deg=45)

    heights = {label: coil["to"][1] for label, coil in plant.snapshot()["coils"].items()}

    assert min(heights, key=heights.get) == "B"
    assert plant.observe()["rotation_deg"] == pytest.approx(45, abs=0.5)


def test_a_power_heats_its_coil_and_no_other():
    plant = new_plant()

    plant.advance(GRID_US, powers(plant, duties(2)))

    assert plant.labels == list("ABCDEFGH")
    assert plant.temperature[2] > 25.5
    assert np.delete(plant.temperature, 2) == pytest.approx(25.0, abs=1e-6)


def test_resistance_falls_as_a_coil_turns_to_austenite():
    plant = new_plant()
    cold = plant.resistance.copy()

    take_hold(plant)

    assert plant.resistance[0] < 0.96 * cold[0]
    assert plant.resistance[4] == pytest.approx(cold[4], rel=0.01)


def test_a_run_repeats_to_the_last_bit():
    first, second = new_plant(), new_plant()

    for plant in (first, second):
        take_hold(plant)
        crawl(plant, 1)

    assert first.observe() == second.observe()
    assert first.snapshot() == second.snapshot()
    assert first.energies() == second.energies()


def test_looking_changes_nothing():
    seen, unseen = new_plant(), new_plant()

    for _ in range(200):
        for plant in (seen, unseen):
            plant.advance(GRID_US, powers(plant, duties(0)))
        seen.observe(), seen.snapshot(), seen.energies()

    assert seen.snapshot() == unseen.snapshot()


def test_time_may_be_cut_anywhere():
    """A gate that changes between grid points cuts a call in two; the motion then differs by no more than its error."""
    whole, cut = new_plant(), new_plant()

    for plant, cuts in ((whole, [GRID_US]), (cut, [1234, 3766])):
        for _ in range(400):
            power = powers(plant, duties(0))
            for duration_us in cuts:
                plant.advance(duration_us, power)

    assert cut.snapshot()["t_s"] == pytest.approx(2.0, abs=1e-9)
    assert cut.snapshot()["hub"] == pytest.approx(whole.snapshot()["hub"], abs=0.02)


def test_a_sloped_plane_is_level_until_a_moment_after_a_coil_is_first_heated():
    plant = new_plant(ground__slope_deg=10)
    drive(plant, 5.0, duties())

    slopes = []
    for seconds in (1.4, 0.5, 0.5, 5.0):
        slopes.append(plant.snapshot()["slope_deg"])
        drive(plant, seconds, duties(0, duty=0.5))

    assert [*slopes, plant.snapshot()["slope_deg"]] == pytest.approx([0, 0, 5, 10, 10], abs=1e-6)


def test_a_coil_that_cools_and_is_heated_again_does_not_level_the_plane():
    plant = new_plant(ground__slope_deg=10)
    drive(plant, 3.0, duties(0, duty=0.5))

    drive(plant, 1.0, duties())
    drive(plant, 0.1, duties(1, duty=0.5))

    assert plant.snapshot()["slope_deg"] == pytest.approx(10, abs=1e-6)


def test_the_robot_file_says_when_and_how_fast_the_plane_is_tilted():
    plant = new_plant(ground__slope_deg=-10, ground__tilt_after_s=0.5, ground__tilt_deg_per_s=20)

    slopes = []
    for _ in range(4):
        slopes.append(plant.snapshot()["slope_deg"])
        drive(plant, 0.375, duties(0, duty=0.5))

    assert slopes[:2] == pytest.approx([0, 0], abs=1e-6)
    assert slopes[2:] == pytest.approx([-5, -10], abs=1e-6)


def test_the_rise_is_counted_from_the_standing_height_and_a_crawl_has_none():
    plant = new_plant()

    take_hold(plant)

    assert plant.observe()["apex_mm"] == pytest.approx(0.0, abs=0.05)
    assert plant.observe()["clearance_mm"] == 0.0


def test_a_picture_is_told_the_ground_and_the_energies():
    plane, kerb = new_plant(), new_plant(ground__step_mm=2, ground__step_at_mm=60)

    assert plane.snapshot()["terrain_mm"] == []
    assert np.array(kerb.snapshot()["terrain_mm"]) == pytest.approx(
        np.array([[-200, 0], [0, 0], [60, 0], [60, 2], [200, 2]]), abs=1e-6
    )
    energy = plane.snapshot()["energy_j"]
    assert energy["kinetic"] == 0.0
    assert energy["gravity"] == pytest.approx(1.8e-3 * 9.81 * 0.019, rel=0.05)
    assert 0.0 < energy["elastic"] < 1e-4
