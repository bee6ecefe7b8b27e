"""The robot on the ground, driven open loop by powers alone: rows L1 to L3, and what must not crawl."""

from math import pi

import numpy as np
import pytest

from hil_sim.bodies.ring import RingPlant
from tests.ring_samples import CRAWL_EI, crawl, drive, duties, new_plant, robot, take_hold

ARC_MM = pi * 20.0 / 4  # of one step
EI = {"shell__bending_stiffness_n_m2": CRAWL_EI}


@pytest.mark.parametrize("stiffness", [CRAWL_EI, "0.92e-5"])
def test_the_robot_rolls_an_eighth_of_its_rim_a_step_on_the_flat(stiffness):
    """L1: 15.7 mm a step, below 110 degC, 0.11 N."""
    plant = new_plant(shell__bending_stiffness_n_m2=stiffness)
    take_hold(plant)

    crawl(plant, 8)

    seen = plant.observe()
    assert seen["travel_mm"] == pytest.approx(8 * ARC_MM, rel=0.05)
    assert seen["rotation_deg"] == pytest.approx(360, abs=5)
    assert seen["peak_coil_degc"] < 110
    assert seen["peak_coil_force_n"] == pytest.approx(0.11, rel=0.1)
    assert seen["rim_crossings"] == 0


@pytest.mark.parametrize(("slope_deg", "boost_s"), [(10, 0.7), (20, 0.8)])
def test_the_robot_climbs_as_far_a_step_as_on_the_flat(slope_deg, boost_s):
    """L2. At 20 degrees the dent of a boost of 0.7 s is a little too shallow here; one of 0.8 s holds to 24."""
    plant = new_plant(ground__slope_deg=slope_deg, **EI)
    take_hold(plant, 6.0)

    crawl(plant, 8, boost=boost_s)

    seen = plant.observe()
    assert seen["travel_mm"] == pytest.approx(8 * ARC_MM, rel=0.05)
    assert seen["peak_coil_degc"] < 110


def test_on_25_degrees_one_coil_rolls_down_and_a_coil_with_its_opposite_climbs():
    """L3: the second coil flattens the body."""
    single, pair = (new_plant(ground__slope_deg=25, **EI) for _ in range(2))
    take_hold(single, 6.0)
    take_hold(pair, 6.0, pair=(4,))

    crawl(single, 1, step=1.0)
    crawl(pair, 4, offsets=(0, 4))

    assert single.observe()["travel_mm"] < -50
    assert pair.observe()["travel_mm"] == pytest.approx(4 * ARC_MM, rel=0.05)


def test_the_mirrored_drive_mirrors_the_motion():
    there, back = new_plant(), new_plant()
    take_hold(there)
    take_hold(back)

    crawl(there, 3)
    crawl(back, 3, forward=-1)

    assert back.observe()["travel_mm"] == pytest.approx(-there.observe()["travel_mm"], rel=1e-3)
    assert back.observe()["rotation_deg"] == pytest.approx(-there.observe()["rotation_deg"], rel=1e-3)
    assert there.observe()["travel_mm"] > 40


def test_without_gravity_the_robot_goes_nowhere():
    plant = new_plant(ground__gravity_m_per_s2=0)
    take_hold(plant)

    crawl(plant, 4)

    assert abs(plant.observe()["travel_mm"]) < 3.0  # the dents push it off, and it floats
    assert plant.observe()["peak_coil_degc"] > 70


def test_without_power_the_robot_stays_where_it_is():
    plant = new_plant()

    drive(plant, 10.0, duties())

    seen = plant.observe()
    assert abs(seen["travel_mm"]) < 1e-3
    assert seen["peak_coil_degc"] == pytest.approx(25.0, abs=0.01)


def test_without_friction_the_rim_slips_under_the_body():
    """The centre of mass goes almost nowhere, for there is no force along the ground, yet the body turns."""
    plant = new_plant(ground__friction_ratio=1e-6)
    take_hold(plant)

    crawl(plant, 3)

    seen = plant.observe()
    assert abs(seen["travel_mm"]) < 0.3
    assert seen["rotation_deg"] > 60


def test_a_robot_that_is_never_heated_stays_where_it_is_on_a_sloped_plane_too():
    plant = new_plant(ground__slope_deg=10)

    drive(plant, 10.0, duties())

    assert abs(plant.observe()["travel_mm"]) < 1e-3
    assert plant.energies()["tilt_j"] == 0.0


def test_a_robot_on_a_steep_slope_that_is_not_held_rolls_down():
    plant = new_plant(ground__slope_deg=15)

    drive(plant, 0.005, duties(0))  # enough to have the plane tilted, too little to take hold
    drive(plant, 5.0, duties())

    assert plant.observe()["travel_mm"] < -100


def test_the_energy_balance_of_a_crawl_closes_to_a_percent_of_the_work_of_the_coils():
    plant = new_plant(ground__slope_deg=10, **EI)
    take_hold(plant, 4.0)

    crawl(plant, 4)

    sums = plant.energies()
    assert sums["coils_j"] > 3e-4
    assert abs(sums["numerical_j"]) < 0.01 * sums["coils_j"]


def test_the_climb_is_paid_for_by_the_coils():
    """Lifted weight comes out of the work of the coils, less what bending, air and ground take."""
    plant = new_plant(ground__slope_deg=10, **EI)
    take_hold(plant, 4.0)
    before = plant.energies()

    crawl(plant, 4)

    after = plant.energies()
    lifted = 1.8e-3 * 9.81 * plant.observe()["travel_mm"] * 1e-3 * np.sin(np.radians(10))
    assert after["coils_j"] - before["coils_j"] > lifted
    assert after["gravity_j"] - before["gravity_j"] == pytest.approx(lifted, rel=0.1)


def test_finer_steps_change_the_travel_by_less_than_a_percent():
    coarse = RingPlant(robot())
    fine = RingPlant(robot(), tolerance=1e-7)
    for plant in (coarse, fine):
        take_hold(plant)
        crawl(plant, 2)

    assert fine.effort()["steps"] > 1.5 * coarse.effort()["steps"]
    assert coarse.observe()["travel_mm"] == pytest.approx(fine.observe()["travel_mm"], rel=0.01)


def test_a_finer_mesh_changes_the_travel_by_less_than_2_percent():
    default, fine = new_plant(), new_plant(shell__nodes_count=64)
    for plant in (default, fine):
        take_hold(plant)
        crawl(plant, 3)

    assert default.observe()["travel_mm"] == pytest.approx(fine.observe()["travel_mm"], rel=0.02)


def test_stiffer_ground_changes_the_travel_by_less_than_2_percent():
    soft, hard = new_plant(), new_plant(ground__contact_stiffness_n_per_m=4000, ground__contact_damping_n_s_per_m=0.5)
    for plant in (soft, hard):
        take_hold(plant)
        crawl(plant, 3)

    assert soft.observe()["travel_mm"] == pytest.approx(hard.observe()["travel_mm"], rel=0.02)
