"""The press: a force is reached on a line and kept while the block gives way, and nothing goes beyond its limits."""

import pytest

from protocol import codes, messages, program
from protocol.program import ABORT, ABOVE, ANY, Condition
from protocol.variables import UNKNOWN_CENTI as LIMP
from tests.firmware_bench import FINGERS, Rig, refusal, run_program
from tests.firmware_press import P, PressRig


@pytest.fixture
def armed():
    rig = PressRig()
    rig.arm()
    return rig


@pytest.fixture
def touching(armed):
    """A press whose shape stands on the block, just not pressing."""
    armed.move(P, 0, over_ms=1000, hold_ms=60_000)
    armed.run(1000)
    return armed


def test_the_axis_goes_to_its_depth_on_a_straight_line(touching):
    touching.move(P, 400, over_ms=2000)
    seen = []
    for _ in range(4):
        touching.run(495)
        seen.append(touching.axis.mm)

    assert seen == pytest.approx([1.0, 2.0, 3.0, 4.0], abs=0.06)  # 20 ms of lag, and the first step
    assert touching.core.limbs.load.force_mn == pytest.approx(9700, rel=0.05)


def test_a_force_is_reached_on_its_line_and_kept_while_the_block_creeps(touching):
    touching.press(5000, over_ms=1000, time_ms=10_000)
    touching.run(500)
    half = touching.axis.force_n
    touching.run(1500)
    deep_mm = touching.axis.mm
    touching.run(6000)

    assert half == pytest.approx(2.5 - 5 / (2 * 2.74), abs=0.2)  # behind its line by rate / (gain x stiffness)
    assert touching.axis.force_n == pytest.approx(5.0, abs=0.05)
    assert touching.axis.mm - deep_mm == pytest.approx(6 * 5.0 / 13.7, rel=0.05)  # the dashpot in series goes on


@pytest.mark.parametrize("scale", [0.1, 0.5, 2.0, 4.0])
def test_softer_and_harder_blocks_bear_their_force_too(scale):
    rig = PressRig(scale)
    rig.arm()
    rig.press(round(4000 * scale), over_ms=2000, time_ms=60_000)
    felt = []
    for _ in range(2600):
        rig.run(5)
        felt.append(rig.axis.force_n)

    assert max(felt) < 1.1 * 4 * scale
    assert felt[-1] == pytest.approx(4 * scale, rel=0.03)


@pytest.mark.parametrize(("scale", "off_n"), [(20.0, 0.4), (50.0, 0.8), (100.0, 1.5)])
def test_the_force_on_far_too_hard_a_block_stops_swinging(scale, off_n):
    """What is left is what a step of the pulses does: a sixteenth of a hundredth is 3 N at 100 times the dashpot."""
    rig = PressRig(scale)
    rig.arm()
    rig.press(5000, over_ms=1000, time_ms=20_000)
    rig.run(12_000)
    felt = []
    for _ in range(1000):
        rig.run(5)
        felt.append(rig.axis.force_n)

    assert 5.0 - off_n < min(felt) < max(felt) < 5.0 + off_n


def test_a_press_that_was_slow_on_a_hard_block_is_as_quick_as_ever_on_the_next_one():
    rig = PressRig(100.0)
    rig.arm()
    rig.press(5000, over_ms=1000, time_ms=10_000)
    rig.run(6000)
    rig.move(P, -100, over_ms=1000)
    rig.run(1100)
    rig.axis._scale = 1.0
    rig.press(5000, over_ms=500, time_ms=10_000)
    rig.run(5000)

    assert rig.axis.force_n == pytest.approx(5.0, abs=0.1)


def test_a_press_through_the_air_comes_to_its_force_without_a_blow(armed):
    armed.axis.surface_mm = 1.0
    armed.press(5000, over_ms=500, time_ms=20_000)
    felt = []
    for _ in range(1500):
        armed.run(5)
        felt.append(armed.axis.force_n)

    assert max(felt) < 5.5
    assert felt[-1] == pytest.approx(5.0, abs=0.1)


def test_where_there_is_nothing_to_press_the_axis_stands_at_the_end_of_its_range(armed):
    armed.axis.surface_mm = 50.0
    armed.press(18_000, over_ms=0, time_ms=20_000)
    armed.run(14_000)

    assert armed.commanded_centi == armed.profile.servo.most_centi
    assert armed.core.state == messages.ARMED


def test_after_its_time_the_axis_holds_where_it_stands_and_then_goes_limp(touching):
    touching.press(3000, over_ms=200, time_ms=1000, hold_ms=500)
    touching.run(1005)
    stands = touching.commanded_centi
    touching.run(400)
    held = touching.commanded_centi
    touching.run(100)

    assert held == stands > 50
    assert touching.commanded_centi == LIMP


def test_a_move_ends_the_regulation(touching):
    touching.press(3000, time_ms=20_000)
    touching.run(1000)
    touching.move(P, -100, over_ms=2000)
    touching.run(2500)

    assert touching.commanded_centi == -100
    assert touching.axis.force_n == 0


def test_a_force_of_zero_takes_the_load_off(touching):
    touching.move(P, 300, over_ms=1000)
    touching.run(1200)
    touching.press(0, over_ms=500, time_ms=5000)
    touching.run(4000)

    assert abs(touching.axis.force_n) < 0.05


@pytest.mark.parametrize(
    ("order", "code", "value", "limit"),
    [
        ((18_001,), codes.FORCE_LIMIT, 18_001, 18_000),
        ((1000, 0, 600_001), codes.HOLD_LIMIT, 600_001, 600_000),
        ((1000, 0, 1000, 600_001), codes.HOLD_LIMIT, 600_001, 600_000),
        ((1000, 0, 0xFFFFFFFF, 0), codes.HOLD_LIMIT, 0x7FFFFFFF, 600_000),
    ],
)
def test_a_force_or_a_time_beyond_its_limit_is_refused_and_nothing_moves(touching, order, code, value, limit):
    before = touching.commanded_centi

    refused = refusal(touching.press(*order))

    assert (refused.code, refused.value, refused.limit) == (code, value, limit)
    assert touching.commanded_centi == before


def test_a_robot_without_a_load_cell_refuses_to_press():
    rig = Rig(FINGERS)
    rig.arm()

    refused = refusal(rig.say(messages.PRESS, target_mn=1000, over_ms=0, time_ms=1000, hold_ms=0))

    assert refused.code == codes.NO_LOAD_CELL


@pytest.mark.parametrize("asks", [program.press(1000, 0, 1000), program.guard(Condition(program.FORCE, 0, 1, 0, 0))])
def test_a_program_that_needs_the_load_cell_is_refused_by_a_robot_without_one(asks):
    rig = Rig(FINGERS)
    rig.arm()

    assert refusal(run_program(rig, asks + program.halt())).code == codes.NO_LOAD_CELL


def test_a_program_presses_and_waits_for_force_and_cells(armed):
    armed.axis.cell_counts[2] = 2048
    cells = Condition(program.PRESSURE, ANY, ABOVE, 9000, 0b111)
    force = Condition(program.FORCE, ANY, ABOVE, 3000, 0)
    code = program.move(P, 0, 1000) + program.delay(1000) + program.press(4000, 500, 3000)
    code += program.wait(force, 5000, ABORT) + program.wait(cells, 5000, ABORT) + program.halt()

    run_program(armed, code)
    armed.run(3000)
    running = armed.core.state
    armed.run(1500)

    assert (running, armed.core.state) == (messages.RUNNING, messages.ARMED)
    assert armed.events("finished")
    assert armed.axis.force_n == pytest.approx(3.4, abs=0.7)  # the axis holds, the block relaxes


def test_a_guard_on_the_force_trips(touching):
    code = program.guard(Condition(program.FORCE, ANY, ABOVE, 2000, 0)) + program.move(P, 400, 1000)
    run_program(touching, code + program.delay(1000) + program.halt())
    touching.run(1500)

    assert touching.events("tripped")[-1].code == codes.GUARD
    assert touching.axis.force_n < 3.0


def test_a_program_that_would_press_for_weeks_trips_and_its_figure_fits_the_record(armed):
    code = program.press(1000, 0, 0xFFFFFFFF) + program.halt()

    run_program(armed, code)
    armed.run(50)

    trip = armed.events("tripped")[-1]
    assert (trip.code, trip.value) == (codes.REFUSED_STEP, 0x7FFFFFFF)
