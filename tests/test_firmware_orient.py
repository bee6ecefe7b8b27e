"""The closed loop that turns a gripped object: it integrates the swing, keeps the grip, and knows when it is blind."""

import pytest

from protocol import codes, messages, program
from protocol.variables import UNKNOWN_CENTI as LIMP
from tests.firmware_bench import FINGERS, Rig, refusal, run_program

R, L = 0b01, 0b10
GAIN = -0.78  # of the object's angle over the swing, with the experiment's fingers


@pytest.fixture
def gripping():
    """Fingers that hold an object 2.5 degrees inward."""
    rig = Rig(FINGERS)
    rig.arm()
    rig.move(R, 250, over_ms=100, hold_ms=60000)
    rig.move(L, -250, over_ms=100, hold_ms=60000)
    rig.run(200)
    return rig


def commanded(rig) -> tuple[int, int]:
    """Return the angles that both joints are told."""
    return tuple(rig.core.control.limbs.joints.commanded_centi)


def swing(rig) -> float:
    return sum(commanded(rig)) / 2


def grip(rig) -> float:
    right, left = commanded(rig)
    return (right - left) / 2


def orient(rig, target_centideg: int, time_ms: int = 5000, hold_ms: int = 5000):
    return rig.say(messages.ORIENT, target_centideg=target_centideg, time_ms=time_ms, hold_ms=hold_ms)


def turn(rig, ms: int, gain: float = GAIN) -> None:
    """Let time pass with an object that follows the swing at once."""
    for _ in range(0, ms, 5):
        rig.board.watcher.centideg = round(gain * swing(rig))
        rig.run(5)


def test_the_object_comes_to_its_angle_and_the_grip_stays(gripping):
    orient(gripping, 500)
    turn(gripping, 3000)

    assert gripping.board.watcher.centideg == pytest.approx(500, abs=1)
    assert swing(gripping) == pytest.approx(500 / GAIN, abs=2)
    assert grip(gripping) == pytest.approx(250, abs=1)


def test_it_gets_there_as_fast_as_its_gain_says(gripping):
    """An integrator of 5 per second over a gain of 0.78 leaves 2 % after ln(50) / 3.9 s."""
    orient(gripping, 500)
    turn(gripping, 1000)

    assert gripping.board.watcher.centideg == pytest.approx(0.98 * 500, rel=0.01)


def test_the_swing_stops_at_its_clamp_and_the_grip_stays(gripping):
    orient(gripping, -3000)
    turn(gripping, 5000, gain=-0.1)

    assert swing(gripping) == 2000
    assert grip(gripping) == 250


def test_it_comes_back_from_its_clamp_without_delay(gripping):
    orient(gripping, -1000, time_ms=60000)
    turn(gripping, 5000, gain=-0.1)
    clamped = swing(gripping)
    gripping.board.watcher.centideg = -2000
    gripping.run(200)

    assert clamped == 2000
    assert swing(gripping) == pytest.approx(2000 - 5 * 1000 * 0.2, abs=100)  # a frame or two late


@pytest.mark.parametrize(("target_centideg", "ends"), [(-3000, (3000, 0)), (3000, (0, -3000))])
def test_the_joints_stay_in_their_range(gripping, target_centideg, ends):
    gripping.move(R, 1500, over_ms=500, hold_ms=60000)
    gripping.move(L, -1500, over_ms=500, hold_ms=60000)
    gripping.run(600)

    orient(gripping, target_centideg)
    turn(gripping, 5000, gain=-0.1)

    assert commanded(gripping) == ends


def test_no_joint_is_turned_faster_than_it_may(gripping):
    orient(gripping, 500)
    gripping.board.watcher.centideg = -6000
    before = commanded(gripping)[0]
    gripping.run(5)

    assert abs(commanded(gripping)[0] - before) <= 36000 * 10 // 1000


def test_when_its_time_is_over_the_joints_hold_and_then_go_limp(gripping):
    orient(gripping, 500, time_ms=500, hold_ms=1000)
    turn(gripping, 600)
    held = commanded(gripping)
    turn(gripping, 800, gain=0.0)

    assert commanded(gripping) == held
    gripping.run(200)
    assert gripping.core.control.limbs.joints.on_mask == 0


def test_the_swing_stands_still_while_no_frame_comes(gripping):
    orient(gripping, 500)
    turn(gripping, 200)
    gripping.board.watcher.frozen = True
    gripping.run(10)
    before = commanded(gripping)

    gripping.run(50)

    assert commanded(gripping) == before


@pytest.mark.parametrize("how", ["frozen", "absent", "hidden"])
def test_without_a_frame_for_too_long_the_loop_ends_and_the_joints_hold(gripping, how):
    orient(gripping, 500)
    turn(gripping, 200)
    before = commanded(gripping)
    _blind(gripping, how)
    gripping.run(150)
    gripping.board.watcher.frozen = gripping.board.watcher.absent = False
    gripping.board.watcher.seen = True

    gripping.run(300)

    (lost,) = gripping.events("lost")
    assert (lost.code, 100 < lost.value <= 110) == (codes.CAMERA, True)
    assert commanded(gripping) == pytest.approx(before, abs=60)
    assert gripping.core.state == messages.ARMED


def test_a_program_that_turns_an_object_is_aborted_without_the_camera_and_the_joints_hold():
    rig = Rig(FINGERS)
    close = program.move(R, 250, 100) + program.move(L, -250, 100) + program.delay(100)
    run_program(rig, close + program.orient(500, 5000) + program.delay(5000) + program.halt())
    turn(rig, 500)

    rig.board.watcher.absent = True
    rig.run(300)

    (aborted,) = rig.events("aborted")
    assert (aborted.code, rig.core.state) == (codes.CAMERA, messages.ARMED)
    assert grip(rig) == 250


def test_a_program_waits_for_the_objects_angle():
    rig = Rig(FINGERS)
    close = program.move(R, 250, 100) + program.move(L, -250, 100) + program.delay(100)
    there = program.Condition(program.ORIENTATION, 0, program.ABOVE, 480, 0)
    code = close + program.orient(500, 5000) + program.wait(there, 4000, program.ABORT) + program.step(7)
    run_program(rig, code + program.halt())

    turn(rig, 2000)

    (step,) = [event for event in rig.events("step") if event.step == 7]
    assert 700 < step.now_ms < 1500
    assert rig.board.watcher.centideg > 480


def test_a_program_that_asks_for_an_object_that_nobody_sees_is_not_started():
    rig = Rig(FINGERS)
    rig.board.watcher.absent = True
    rig.run(200)

    answers = run_program(rig, program.orient(0, 100) + program.halt())

    assert refusal(answers).code == codes.NO_CAMERA


def test_an_object_is_turned_only_by_joints_that_hold_it_and_a_camera_that_sees_it(gripping):
    gripping.say(messages.DISARM)
    gripping.arm()
    assert refusal(orient(gripping, 500)).code == codes.NOT_HELD

    gripping.board.watcher.seen = False
    gripping.run(200)
    assert refusal(orient(gripping, 500)).code == codes.NO_CAMERA


@pytest.mark.parametrize("side", [1, -1])
def test_a_swing_beyond_the_clamp_is_not_taken_over(gripping, side):
    gripping.move(R, side * 2900, over_ms=500, hold_ms=60000)
    gripping.move(L, side * 2400, over_ms=500, hold_ms=60000)
    gripping.run(600)

    refused = refusal(orient(gripping, 0))

    assert (refused.code, refused.value, refused.limit) == (codes.RANGE_LIMIT, side * 2650, side * 2000)


def test_a_hold_beyond_the_limit_is_refused(gripping):
    refused = refusal(orient(gripping, 500, hold_ms=60001))

    assert (refused.code, refused.value, refused.limit) == (codes.HOLD_LIMIT, 60001, 60000)


def test_the_loop_ends_with_the_arming(gripping):
    orient(gripping, 500, time_ms=60000)
    gripping.say(messages.DISARM)
    gripping.run(50)
    limp = commanded(gripping)

    gripping.arm()
    gripping.move(R | L, 0, over_ms=100, hold_ms=60000)
    gripping.run(300)

    assert (limp, commanded(gripping)) == ((LIMP, LIMP), (0, 0))


def test_a_move_takes_the_joints_out_of_the_loop(gripping):
    orient(gripping, 500)
    turn(gripping, 100)
    gripping.move(R, 0, over_ms=200)
    gripping.run(250)
    gripping.board.watcher.centideg = -500

    gripping.run(100)

    assert commanded(gripping)[0] == 0


def _blind(rig, how: str) -> None:
    if how == "hidden":
        rig.board.watcher.seen = False
    else:
        setattr(rig.board.watcher, how, True)
