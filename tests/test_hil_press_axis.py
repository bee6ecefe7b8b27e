"""The axis of the press: a servo with a self-locking screw, and the play between screw and tool."""

import pytest

from hil_sim.bodies.screw import Screw, ScrewNumbers
from tests.pressed_plants import drive, driven, plant_of

NUMBERS = ScrewNumbers(rate_mm_per_s=10.0, bandwidth_rad_per_s=50.0, stall_n=40.0, stall_a=1.5, idle_a=0.1)
PLAY = ("axis.backlash_mm:0.5", "indenter.tool_mass_g:100", "ground.gravity_m_per_s2:10")  # a tool of 1 N


def screw(seconds=0.0, to_mm=None, force_n=0.0, steps=1, at_mm=0.0):
    """Return a screw after it was driven for some time."""
    one = Screw(NUMBERS)
    one.at_mm = at_mm
    for _ in range(steps):
        one.advance(to_mm, force_n, seconds / steps)
    return one


def test_it_goes_at_its_rate_and_then_ever_slower():
    assert screw(0.1, to_mm=5.0).at_mm == pytest.approx(1.0)
    assert screw(0.48, to_mm=5.0).at_mm == pytest.approx(4.8)
    assert screw(0.50, to_mm=5.0).at_mm == pytest.approx(5.0 - 0.2 / 2.718281828)


@pytest.mark.parametrize("force_n", [0.0, 15.0, -15.0])
def test_it_gets_to_the_same_place_in_one_step_and_in_many(force_n):
    one, many = (screw(0.7, to_mm=5.0, force_n=force_n, steps=steps) for steps in (1, 1000))

    assert one.at_mm == pytest.approx(many.at_mm, rel=1e-12)
    assert one.current_a == pytest.approx(many.current_a)


def test_a_force_against_it_takes_its_share_of_the_speed_and_one_with_it_adds_none():
    down, up = ([screw(0.1, to_mm=to, force_n=force).at_mm for force in (10.0, -10.0)] for to in (5.0, -5.0))

    assert down == pytest.approx([0.75, 1.0])
    assert up == pytest.approx([-1.0, -0.75])


def test_it_stalls_at_its_stall_force_with_its_stall_current():
    one = screw(1.0, to_mm=5.0, force_n=41.0)

    assert (one.at_mm, one.current_a) == (0.0, 1.5)


def test_limp_it_stays_where_it_is_whatever_presses_on_it():
    one = screw(1.0, force_n=200.0, at_mm=3.0)

    assert (one.at_mm, one.current_a) == (3.0, 0.1)


def test_its_current_tells_the_force():
    assert screw(2.0, to_mm=1.0, force_n=20.0).current_a == pytest.approx(0.1 + 1.4 / 2)
    assert screw(2.0, to_mm=1.0).current_a == pytest.approx(0.1)


def test_jammed_it_stands_and_takes_its_stall_current():
    one = Screw(NUMBERS)
    one.jammed = True

    one.advance(5.0, 0.0, 1.0)

    assert (one.at_mm, one.current_a) == (0.0, 1.5)


def test_a_block_that_resists_slows_the_axis_and_stops_it_below_its_stall_force():
    plant = plant_of("axis.stall_force_n:3")

    driven(plant, 4.0, 8.0)

    assert plant.load_n == pytest.approx(3.0, rel=0.03)  # the block gives way, and the axis follows
    assert plant.screw.at_mm < 4.0
    assert plant.joint_current_a[0] == pytest.approx(1.5, rel=0.03)


def test_a_press_that_is_let_go_stays_in_the_block_and_the_force_relaxes():
    plant = driven(plant_of(), 2.0, lambda t: 2.0 * t)
    depth, force = plant.screw.at_mm, plant.load_n

    driven(plant, 2.0, None)

    assert plant.screw.at_mm == depth == pytest.approx(plant.observe()["depth_mm"])
    assert 0.5 * force < plant.load_n < 0.8 * force


def test_a_dead_servo_moves_nothing_until_it_is_alive_again():
    plant = plant_of()
    plant.kill("P")
    driven(plant, 0.5, 2.0)
    dead = plant.screw.at_mm
    plant.kill("P", dead=False)

    assert (dead, driven(plant, 1.0, 2.0).screw.at_mm) == (0.0, pytest.approx(2.0))


def test_with_play_the_tool_hangs_until_it_is_pressed_with_its_weight_and_then_stays_behind():
    plant = plant_of(*PLAY)
    behind = [(plant.load_n, plant.screw.at_mm - 1e3 * plant.state.depth) for _ in drive(plant, 2.0, lambda t: 2 * t)]

    hanging = [play for force, play in behind if 0.0 < force < 0.999]
    pushed = [play for force, play in behind if force > 1.001]

    assert hanging == pytest.approx([0.0] * len(hanging), abs=0.03)  # the axis moves between the block's steps
    assert pushed == pytest.approx([0.5] * len(pushed), abs=0.03)
    assert len(hanging) > 5 < len(pushed)


def test_with_play_the_block_carries_the_tool_while_the_axis_crosses_it():
    plant = driven(plant_of(*PLAY), 2.0, lambda t: 2.0 * t)

    forces = [plant.load_n for _ in drive(plant, 0.8, lambda t: 4.0 - 4.0 * t)]

    carried = [force for force in forces if force == pytest.approx(1.0, rel=1e-6)]
    assert 25 <= len(carried) < 50  # 0.5 mm at 4 mm/s, and what the block comes up meanwhile
    assert max(forces) > 2.0
    assert min(forces) < 0.9


def test_play_is_lost_motion_between_pushing_and_pulling_back():
    tight, loose = (driven(plant_of(*play), 2.0, lambda t: 2.0 * t) for play in ((), PLAY))

    assert tight.observe()["depth_mm"] - loose.observe()["depth_mm"] == pytest.approx(0.5)
    assert loose.load_n < tight.load_n


@pytest.mark.parametrize("modulus_kpa", [600, 60_000, 1_000_000])
def test_however_stiff_the_block_the_servo_presses_with_its_stall_force_at_most(modulus_kpa):
    rigid = (f"material.youngs_modulus_kpa:{modulus_kpa}", "material.viscosity_kpa_s:1000000000")
    plant = plant_of(*rigid, options="indenter=flat")

    forces = [plant.load_n for _ in drive(plant, 2.0, lambda t: 2.0 * t)]

    assert max(forces) == pytest.approx(40.0, rel=1e-3)
    assert max(forces) < 40.0 * (1.0 + 1e-9)


@pytest.mark.parametrize("modulus_kpa", [1e4, 1e5])
def test_however_stiff_the_block_the_servo_pulls_at_glue_with_its_stall_force_at_most(modulus_kpa):
    stiff = f"material.youngs_modulus_kpa:{modulus_kpa:g}", f"material.viscosity_kpa_s:{5 * modulus_kpa:g}"
    plant = driven(plant_of(*stiff, "indenter.pull_off_n:10000", options="indenter=bonded"), 1.0, 1.0)

    forces = [plant.load_n for _ in drive(plant, 1.0, -5.0)]

    assert min(forces) == pytest.approx(-40.0, rel=1e-3)
    assert min(forces) > -40.0 * (1.0 + 1e-9)
