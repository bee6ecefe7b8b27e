"""Row L4: slow coils load the ring, its shape lets go. The drive is the prototype's, by the place from the contact."""

import pytest

from tests.ring_samples import GRID_US, new_plant, powers

BOOST_S, SECONDS = 0.94, 6.0
# Coils: on at [s], off at [s], duty after the boost.
GROUPS = {
    (0,): (0.40, 1.36, 0.27),
    (1, 7): (0.48, 4.16, 0.32),
    (2, 6): (1.64, 5.49, 0.31),
    (3, 5): (0.24, 2.52, 0.36),
    (4,): (0.61, 1.18, 0.27),
}


def duties_at(t, without=()):
    """Return the duties of all coils at a time of the jump."""
    duty = [0.0] * 8
    for coils, (on, off, hold) in GROUPS.items():
        for coil in coils:
            if on <= t < off and coil not in without:
                duty[coil] = 1.0 if t < on + BOOST_S else hold
    return duty


def jump(plant, without=()):
    """Drive the jump; return the greatest number of crossings of the rim that was seen."""
    most = 0
    for step in range(round(SECONDS * 1e6) // GRID_US):
        plant.advance(GRID_US, powers(plant, duties_at(step * GRID_US * 1e-6, without)))
        most = max(most, plant.observe()["rim_crossings"])
    return most


@pytest.mark.parametrize("nodes", [32, 40])
def test_the_ring_jumps_70_to_120_mm_and_never_through_itself(nodes):
    """With a hub of 7 mm across, on which the inverted bottom rests; the reports say 80 mm."""
    plant = new_plant(hub__radius_mm=3.5, shell__nodes_count=nodes)

    crossings = jump(plant)

    seen = plant.observe()
    assert 70 < seen["apex_mm"] < 120
    assert seen["clearance_mm"] > 60
    assert seen["peak_coil_degc"] < 120
    assert seen["peak_coil_force_n"] < 0.5
    assert crossings == 0


def test_without_the_lower_coils_that_hold_the_bottom_inverted_there_is_no_jump():
    plant = new_plant(hub__radius_mm=3.5)

    jump(plant, without=(1, 7))

    assert plant.observe()["clearance_mm"] < 10


def test_the_highest_flight_is_kept_with_the_energy_that_was_let_go_for_it():
    """A jump is ballistic but for the air; what is released comes out of what is stored and is more than what lifts."""
    plant = new_plant(hub__radius_mm=3.5)

    jump(plant)

    seen = plant.observe()["jump"]
    lifted_mj = 1.8e-3 * 9.81 * seen["apex_mm"]
    assert seen["apex_mm"] == pytest.approx(1e3 * seen["takeoff_m_per_s"] ** 2 / (2 * 9.81), abs=5)
    assert seen["stored_mj"] > seen["released_mj"] > lifted_mj
    assert 0 < seen["losses_mj"] < seen["released_mj"]
    assert 4.0 < seen["takeoff_s"] < 6.0


def test_a_robot_that_rests_has_no_flight():
    plant = new_plant()

    plant.advance(GRID_US, powers(plant, [0.0] * 8))

    assert plant.observe()["jump"] is None
