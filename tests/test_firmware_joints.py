"""Joints: along a line within range and slew, there for as long as was ordered, and limp in every other case."""

import pytest

from protocol import codes, frames, messages, program
from tests.firmware_bench import FINGERS, SESSION, Rig, refusal, run_program

R, L = 0b01, 0b10
MIDDLE_NS = 1_500_000


@pytest.fixture
def hand():
    return Rig(FINGERS)


@pytest.fixture
def armed(hand):
    hand.arm()
    return hand


def centideg(rig, label: str):
    """Return the angle that a servo's pulses mean, None: there are none."""
    width_ns = rig.board.servos[8 if label == "R" else 9].width_ns
    return None if width_ns is None else round((width_ns - MIDDLE_NS) * 9 / 1000)


def test_a_joint_is_limp_until_it_is_moved(armed):
    armed.run(500)

    assert (centideg(armed, "R"), centideg(armed, "L")) == (None, None)


def test_a_joint_goes_to_its_angle_on_a_straight_line(armed):
    armed.move(R, 800, over_ms=1000)
    seen = []
    for _ in range(4):
        armed.run(245)
        seen.append(centideg(armed, "R"))

    assert seen == pytest.approx([204, 400, 596, 792], abs=9)  # the order was taken within the first 10 ms
    armed.run(100)
    assert centideg(armed, "R") == 800


def test_a_joint_holds_and_then_goes_limp(armed):
    armed.move(R | L, 300, over_ms=100, hold_ms=400)

    armed.run(480)
    held = centideg(armed, "R"), centideg(armed, "L")
    armed.run(30)

    assert held == (300, 300)
    assert (centideg(armed, "R"), centideg(armed, "L")) == (None, None)


def test_a_limp_joint_sets_out_from_where_it_is_no_faster_than_it_may(armed):
    armed.board.converter.rest_centi[0] = -3000
    armed.run(20)

    armed.move(R, 3000, over_ms=0, hold_ms=1000)
    first = centideg(armed, "R")
    armed.run(170)

    assert first < -2500
    assert centideg(armed, "R") == 3000


@pytest.mark.parametrize(
    ("order", "code", "value", "limit"),
    [
        ({"target_centi": 3001}, codes.RANGE_LIMIT, 3001, 3000),
        ({"target_centi": -3001}, codes.RANGE_LIMIT, -3001, -3000),
        ({"over_ms": 20}, codes.SLEW_LIMIT, 40000, 36000),
        ({"over_ms": 0}, codes.SLEW_LIMIT, 800000, 36000),
        ({"target_centi": 37, "over_ms": 1}, codes.SLEW_LIMIT, 37000, 36000),
        ({"hold_ms": 60001}, codes.HOLD_LIMIT, 60001, 60000),
        ({"joints": 0b100}, codes.UNKNOWN_CHANNEL, 0b100, 0b11),
        ({"joints": 0}, codes.UNKNOWN_CHANNEL, 0, 0b11),
    ],
)
def test_what_breaks_a_limit_is_refused_with_it_and_nothing_moves(armed, order, code, value, limit):
    armed.move(R | L, 0)
    armed.run(200)

    refused = refusal(
        armed.say(messages.MOVE, **{"joints": R, "target_centi": 800, "over_ms": 1000, "hold_ms": 100, **order})
    )
    armed.run(100)

    assert (refused.code, refused.value, refused.limit) == (code, value, limit)
    assert centideg(armed, "R") == 0


def test_a_robot_that_is_not_armed_moves_nothing(hand):
    assert refusal(hand.move(R, 100)).code == codes.NOT_ARMED


def test_a_robot_of_coils_has_no_joints_and_one_of_joints_no_coils(armed):
    coils = Rig()
    coils.arm()

    assert refusal(coils.move(R, 100)).code == codes.UNKNOWN_CHANNEL
    assert refusal(armed.fire(R)).code == codes.UNKNOWN_CHANNEL
    armed.say(messages.DISARM)
    assert refusal(armed.say(messages.CALIBRATE, session=SESSION, without=0)).code == codes.UNKNOWN_CHANNEL


@pytest.mark.parametrize("how", ["stop", "disarm", "lease", "trip"])
def test_every_end_lets_the_joints_go_limp_at_once(armed, how):
    armed.move(R | L, 500, hold_ms=60000)
    armed.run(200)

    if how == "stop":
        armed.run(5, line=frames.STOP)
    elif how == "disarm":
        armed.say(messages.DISARM)
    elif how == "lease":
        armed.run(520, silent=True)
    else:
        armed.board.closed = False
        armed.run(10)

    assert (centideg(armed, "R"), centideg(armed, "L")) == (None, None)
    assert not armed.board.powered


def test_the_answer_to_a_stop_names_the_joints_that_were_driven(armed):
    armed.move(L, 500)
    answers = armed.run(10, line=frames.STOP)

    assert [body.coils for name, body in answers if name == "stopped"] == [L]


def test_a_joint_that_takes_its_stall_current_for_too_long_trips(armed):
    armed.move(R | L, 500, hold_ms=60000)
    armed.board.converter.ma[1] = 2500
    armed.run(290)
    assert not armed.events("tripped")

    armed.run(30)

    (trip,) = armed.events("tripped")
    assert (trip.code, trip.channel, centideg(armed, "R")) == (codes.STALL, 1, None)
    assert trip.value == pytest.approx(2500, abs=3)


def test_a_moment_of_stall_current_is_none(armed):
    armed.move(R, 500, hold_ms=60000)
    for _ in range(5):
        armed.board.converter.ma[0] = 2500
        armed.run(200)
        armed.board.converter.ma[0] = 500
        armed.run(10)

    assert not armed.events("tripped")


@pytest.mark.parametrize("counts", [0, 4095, 204, 3892])
def test_a_potentiometer_that_reads_no_position_refuses_the_arming_and_trips_an_armed_robot(hand, counts):
    hand.board.converter.stuck_counts[3] = counts
    hand.run(100)
    refused = refusal(hand.arm())
    hand.board.converter.stuck_counts.clear()
    hand.run(10)
    hand.arm()

    hand.board.converter.stuck_counts[3] = counts
    hand.run(120)

    assert (refused.code, refused.channel, refused.value) == (codes.JOINT, 1, counts)
    assert [(trip.code, trip.channel) for trip in hand.events("tripped")] == [(codes.JOINT, 1)]


def test_a_moment_of_a_potentiometer_that_reads_no_position_is_none(armed):
    for _ in range(5):
        armed.board.converter.stuck_counts[3] = 0
        armed.run(80)
        armed.board.converter.stuck_counts.clear()
        armed.run(20)

    assert not armed.events("tripped")


def test_the_current_of_a_limp_joint_is_no_stall(armed):
    armed.board.converter.ma[0] = 2500
    armed.run(500)
    armed.move(R, 500, hold_ms=60000)
    armed.run(200)
    early = armed.events("tripped")

    armed.run(150)

    assert (early, [trip.code for trip in armed.events("tripped")]) == ([], [codes.STALL])


def test_the_angle_and_the_current_are_read_as_they_are(hand):
    hand.board.converter.rest_centi[0] = -1234
    hand.board.converter.ma[1] = 777
    hand.run(10)

    joints = hand.core.control.limbs.joints
    assert joints.measured_centi[0] == pytest.approx(-1234, abs=6)
    assert joints.current_ma[1] == pytest.approx(777, abs=2)


def test_a_program_moves_joints_and_ends_when_they_have_arrived(hand):
    code = program.move(R, 800, 300) + program.move(L, -800, 300) + program.delay(100) + program.halt()

    run_program(hand, code)
    hand.run(250)
    early = hand.events("finished")
    hand.run(60)

    assert not early
    assert hand.events("finished")
    assert (centideg(hand, "R"), centideg(hand, "L")) == (800, -800)


def test_joints_hold_beyond_the_end_of_a_program_until_the_robot_is_disarmed(hand):
    run_program(hand, program.move(R, 500, 100) + program.halt())
    hand.run(1000)
    held = centideg(hand, "R")

    hand.say(messages.DISARM)

    assert (held, centideg(hand, "R")) == (500, None)


def test_a_program_waits_for_an_angle_and_trips_at_a_guarded_current(hand):
    above = program.Condition(program.POSITION, program.ANY, program.ABOVE, 400, R)
    guarded = program.guard(program.Condition(program.JOINT_CURRENT, program.ANY, program.ABOVE, 1000, L))
    code = guarded + program.move(R, 800, 400) + program.wait(above, 5000, program.ABORT) + program.step(2)
    run_program(hand, code + program.delay(60000) + program.halt())

    hand.run(260)
    (step,) = [event for event in hand.events("step") if event.step == 2]
    hand.board.converter.ma[1] = 1100
    hand.run(10)

    assert centideg(hand, "R") is None
    assert step.now_ms > 0
    assert [trip.code for trip in hand.events("tripped")] == [codes.GUARD]


@pytest.mark.parametrize("code", [program.move(0b100, 0, 1), program.fire(1, 1, 1), program.move(0, 0, 1)])
def test_a_program_for_channels_of_another_kind_is_refused(hand, code):
    answers = run_program(hand, code + program.halt())

    assert refusal(answers).code == codes.BAD_CODE


def test_the_pulses_are_written_only_when_they_change(armed):
    armed.move(R, 500, over_ms=100, hold_ms=60000)
    armed.run(200)
    writes = armed.board.servos[8].writes

    armed.run(200)

    assert armed.board.servos[8].writes == writes > 10


def limp_at_last(rig, ma: int, for_ms: int) -> None:
    """Have joints that hold go limp at the end of their order, and their servos take current for so long after."""
    rig.move(R | L, 500, over_ms=100, hold_ms=100)
    rig.board.supply.ma = ma
    rig.run(200 + for_ms)
    rig.board.supply.ma = 10
    rig.run(500)


def test_servos_may_hold_for_a_moment_after_their_last_pulse(armed):
    limp_at_last(armed, ma=4000, for_ms=150)

    assert not armed.events("tripped")


def test_current_that_flows_on_while_every_joint_is_limp_trips(armed):
    limp_at_last(armed, ma=4000, for_ms=400)

    assert [trip.code for trip in armed.events("tripped")] == [codes.STRAY_CURRENT]


def test_a_joint_that_stands_elsewhere_than_it_was_told_for_too_long_trips(armed):
    armed.move(L, 800, over_ms=500, hold_ms=60000)
    armed.run(600)
    armed.board.converter.stuck_counts[3] = 410 + round(9500 * 3276 / 18000)  # it fell back to 5 degrees

    armed.run(1450)
    early = armed.events("tripped")
    armed.run(100)

    (trip,) = armed.events("tripped")
    assert early == []
    assert (trip.code, trip.channel, centideg(armed, "L")) == (codes.ASTRAY, 1, None)
    assert trip.value == pytest.approx(-300, abs=6)


def test_a_joint_that_lags_behind_a_quick_move_is_not_astray(armed):
    """A servo of 60 rad/s lags by v / 30 s behind a speed v: by 1.5 deg at 45 deg/s, for the 60 deg of its range."""
    armed.board.converter.lag = 0.75
    armed.move(L, -3000, over_ms=500, hold_ms=60000)
    armed.run(600)
    armed.move(L, 3000, over_ms=1400, hold_ms=60000)
    armed.run(2000)

    assert not armed.events("tripped")
