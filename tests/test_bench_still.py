"""A body that does not move (`body=still`): the same coils, heat and resistances, and no motion."""

import numpy as np
import pytest

from hil_sim.address import AddressError, parse
from hil_sim.assembly import assemble, plant_of
from hil_sim.physics import coil
from hil_sim.physics.coilset import coils_of, cold
from hil_sim.robots.file import load, names
from tests.hil_rig import HilRig

ADVANCE_US = 5_000


def heated(body: str, robot: str = "circular", seconds: float = 1.0):
    """Return the body of a robot after its first coil was heated with 0.35 W, then another second."""
    plant = plant_of(load(robot), 1, body)
    power_w = np.zeros(len(plant.labels))
    for watts in (0.35, 0.0):
        power_w[0] = watts
        for _ in range(round(seconds * 1e6 / ADVANCE_US)):
            plant.advance(ADVANCE_US, power_w)
    return plant


@pytest.mark.parametrize("robot", [name for name in names() if load(name).coil])
def test_every_robot_with_coils_can_be_had_with_a_body_that_does_not_move(robot):
    plant = plant_of(load(robot), 1, "still")
    before = plant.snapshot()

    plant.advance(200 * ADVANCE_US, np.full(len(plant.labels), 0.3))

    after = plant.snapshot()
    assert after["t_s"] == pytest.approx(1.0)
    assert (after["nodes"], after["hub"]) == (before["nodes"], before["hub"])
    assert plant.observe()["travel_mm"] == 0.0
    assert plant.observe()["apex_mm"] == pytest.approx(0.0, abs=1e-9)
    assert plant.observe()["peak_coil_degc"] == plant.temperature.max() > 30


def test_its_coils_are_those_of_every_other_body_at_a_fixed_length():
    robot = load("circular")
    plant = plant_of(robot, 1, "still")
    length = np.full(8, robot.ring.R - robot.ring.attach)
    coils = coils_of(robot.coil, 8, robot.ground.T_amb)
    alone = cold(coils, length)

    for _ in range(1500):
        coil.advance(alone, 1e-3, np.full(8, 0.35), length, coils)
    plant.advance(1_500_000, np.full(8, 0.35))

    assert plant.temperature == pytest.approx(alone.T, abs=1.0)  # it rests a little below the round shape
    assert plant.resistance == pytest.approx(alone.R, rel=5e-3)


def test_it_heats_as_the_body_that_moves_until_that_one_has_moved():
    still, moving = heated("still", seconds=0.25), heated("moving", seconds=0.25)

    assert still.temperature == pytest.approx(moving.temperature, abs=0.2)
    assert still.resistance == pytest.approx(moving.resistance, rel=2e-3)


def test_its_energies_balance():
    plant = heated("still")

    assert plant.energies()["numerical_j"] == pytest.approx(0.0, abs=1e-12)
    assert plant.effort()["steps"] == 0


def test_a_still_ball_knows_where_down_is():
    rig = HilRig("sim:sphere-a?body=still")

    status = rig.robot.status()

    assert (status.down, status.pitch_deg) == ("A00m1", pytest.approx(0, abs=3))


def test_a_sloped_plane_is_tilted_under_a_still_body_too():
    bench = assemble(parse("sim:circular?body=still&slope=10"))

    bench.plant.advance(10_000_000, np.full(8, 0.1))

    assert bench.plant.snapshot()["slope_deg"] == pytest.approx(10)
    assert bench.plant.observe()["rotation_deg"] == pytest.approx(0, abs=1)


def test_an_unknown_body_is_refused_with_what_is_known():
    with pytest.raises(AddressError, match="no body 'stil': known are moving, still; did you mean still"):
        parse("sim:circular?body=stil")
