"""Programs that ask where down is, on the core alone; and what becomes of them when the sensor is lost."""

import pytest

from protocol import codes, messages, program
from protocol.program import Condition
from tests.firmware_bench import BALL, PROFILE, Imu, Rig, refusal, run_program, usual

A00M1, A10M1, A100, A101, AM10M1 = 5, 12, 0, 10, 13
CIRCLE = [5, 12, 0, 10, 4, 11, 1, 13]
UPRIGHT, FORWARD_45, FORWARD_90, LEFT = (0, 0, 8197), (-5796, 0, 5796), (-8197, 0, 0), (0, -8197, 0)


@pytest.fixture
def rig():
    made = Rig(BALL)
    made.run(100)
    return made


def status(rig):
    """Return the robot's status."""
    return next(body for name, body in rig.say(messages.STATUS_REQUEST) if name == "status")


def lie(rig, force, ms=4000):
    """Have the body lie otherwise, until the estimate has followed."""
    rig.board.sensor.force = force
    rig.run(ms)


def on(rig):
    """Return the channels that are driven."""
    mask = rig.core.channels.on_mask
    return [channel for channel in range(18) if mask >> channel & 1]


def test_status_and_telemetry_tell_how_the_robot_lies(rig):
    rig.say(messages.SUBSCRIBE, slot=0, period_ms=50, on_change=0, variables=b"")
    lie(rig, FORWARD_45)

    told = status(rig)
    roll_decideg, pitch_decideg, down = usual([body for name, body in rig.got if name == "telemetry"][-1], 18)[5:8]

    assert (told.down, down) == (A10M1, A10M1)
    assert told.pitch_decideg == pytest.approx(450, abs=5)
    assert pitch_decideg == pytest.approx(450, abs=5)
    assert max(abs(told.roll_decideg), abs(roll_decideg)) <= 3


def test_a_robot_without_a_sensor_tells_that_it_does_not_know():
    assert status(Rig()).down == program.NO_COIL


@pytest.mark.parametrize(
    ("force", "ahead", "chosen"),
    [
        (UPRIGHT, 0, A00M1),
        (UPRIGHT, 1, A10M1),
        (UPRIGHT, -1, AM10M1),
        (FORWARD_45, 1, A100),
        (FORWARD_90, 1, A101),
        (FORWARD_90, 6, A00M1),
    ],
)
def test_the_coil_is_chosen_by_where_down_is_when_the_line_runs(rig, force, ahead, chosen):
    lie(rig, force)

    run_program(rig, program.aim(0, ahead, CIRCLE) + program.aimed(0, 500, 200) + program.halt())
    rig.run(20)

    assert on(rig) == [chosen]


def test_a_chosen_coil_stays_the_same_until_it_is_chosen_anew(rig):
    fire = program.aimed(2, 200, 3000) + program.delay(3000)
    run_program(rig, program.aim(2, 0, CIRCLE) + fire + fire + program.aim(2, 0, CIRCLE) + fire + program.halt())

    lie(rig, FORWARD_90, 3500)
    assert on(rig) == [A00M1]
    rig.run(3000)

    assert on(rig) == [A100]


def test_a_wait_for_a_coil_to_come_down_ends_when_it_does(rig):
    down = Condition(program.DOWN, program.ANY, program.IS, 0, 1 << A10M1 | 1 << A100)
    run_program(rig, program.wait(down, 9000, program.ABORT) + program.fire(1, 300, 500) + program.halt())
    rig.run(1000)
    assert on(rig) == []

    lie(rig, FORWARD_45, 1500)

    assert rig.events("finished") or on(rig) == [0]


def test_a_wait_for_the_chosen_coil_to_come_down_ends_when_it_does(rig):
    ahead = program.wait(Condition(program.DOWN, program.CHOSEN, program.IS, 0, 3), 9000, program.ABORT)
    run_program(rig, program.aim(3, 1, CIRCLE) + ahead + program.halt())
    rig.run(1000)
    assert rig.core.state == messages.RUNNING

    lie(rig, FORWARD_45, 1500)

    assert rig.events("finished")


def test_a_wait_for_the_chosen_coil_to_lose_its_heat_ends_when_it_has(rig):
    cool = program.wait(Condition(program.HEAT, program.CHOSEN, program.BELOW, 300, 0), 9000, program.ABORT)
    fire = program.aimed(0, 1000, 400) + program.delay(400)
    run_program(rig, program.aim(0, 0, CIRCLE) + fire + cool + program.halt())
    rig.run(500)
    assert rig.core.state == messages.RUNNING

    rig.run(8000)

    assert rig.events("finished")
    assert 290_000 < rig.core.sense.heat_uj[A00M1] + 300_000 < 600_000


@pytest.mark.parametrize(
    ("source", "compare", "value", "force"),
    [(program.PITCH, program.ABOVE, 400, FORWARD_45), (program.ROLL, program.BELOW, -700, LEFT)],
)
def test_a_guard_on_an_angle_trips_when_it_is_passed(rig, source, compare, value, force):
    guard = program.guard(Condition(source, program.ANY, compare, value, 0))
    run_program(rig, guard + program.fire(1, 100, 9000) + program.halt())
    rig.run(1000)
    assert rig.core.state == messages.RUNNING

    lie(rig, force)

    assert rig.core.code == codes.GUARD


NEEDS = {
    "aim": program.aim(0, 0, CIRCLE[:2]),
    "pitch": program.guard(Condition(program.PITCH, program.ANY, program.ABOVE, 900, 0)),
    "down": program.wait(Condition(program.DOWN, program.ANY, program.IS, 0, 1 << A00M1), 100, program.CONTINUE),
}


@pytest.mark.parametrize("name", NEEDS)
def test_a_program_that_asks_where_down_is_does_not_start_on_a_robot_that_does_not_know(rig, name):
    rig.board.sensor.silent = True
    rig.run(200)

    answers = run_program(rig, NEEDS[name] + program.halt())

    assert refusal(answers).code == codes.NO_ATTITUDE
    assert rig.core.state == messages.ARMED


def test_nor_on_a_robot_that_has_no_sensor():
    rig = Rig(PROFILE)
    answers = run_program(rig, program.aim(0, 0, [0, 1]) + program.halt())

    assert refusal(answers).code == codes.NO_ATTITUDE


LOSSES = {
    "it does not answer": {"absent": True},
    "it gives no new sample": {"silent": True},
    "it gives the same sample for ever": {"stuck": True},
}


@pytest.mark.parametrize("what", LOSSES)
def test_a_lost_sensor_is_told_once_and_a_program_that_does_not_ask_goes_on(rig, what):
    run_program(rig, program.fire(1, 100, 3000) + program.halt())
    vars(rig.board.sensor).update(LOSSES[what])

    rig.run(2500)

    assert [event.code for event in rig.events("lost")] == [codes.ATTITUDE]
    assert rig.core.state == messages.RUNNING
    assert status(rig).down == program.NO_COIL


@pytest.mark.parametrize("what", LOSSES)
def test_a_program_that_asks_trips_when_the_sensor_is_lost(rig, what):
    guard = Condition(program.PITCH, program.ANY, program.ABOVE, 900, 0)
    run_program(rig, program.guard(guard) + program.fire(1, 100, 5000) + program.halt())
    vars(rig.board.sensor).update(LOSSES[what])

    rig.run(700)

    assert rig.core.code == codes.ATTITUDE
    assert rig.core.state == messages.TRIPPED
    assert on(rig) == []
    assert not rig.board.powered


def test_another_chip_in_its_place_is_found_at_the_start(monkeypatch):
    monkeypatch.setattr(Imu, "begin", lambda self: other_chip())

    rig = Rig(BALL)
    rig.run(2500)

    (_, kept), *_ = rig.say(messages.FAULTS_REQUEST, skip=0)
    assert (kept.count, kept.records[8]) == (1, codes.ATTITUDE)  # before any host was there to be told
    assert status(rig).down == program.NO_COIL


def other_chip():
    """Do what the driver does when the identity is not the chip's."""
    raise OSError(19, "ENODEV")


def test_a_lost_sensor_is_started_again_each_second_and_known_when_it_answers(rig):
    rig.board.sensor.absent = True
    rig.run(3500)
    starts = rig.board.sensor.starts
    rig.board.sensor.absent = False

    rig.run(1200)

    assert 3 <= starts <= 5
    assert status(rig).down == A00M1


def test_a_sensor_that_lost_its_settings_is_set_again_within_the_second(rig):
    rig.board.sensor.lost = True

    rig.run(1300)

    assert rig.board.sensor.lost is False
    assert status(rig).down == A00M1


def test_a_sensor_that_was_found_again_may_be_lost_again(rig):
    for _ in range(2):
        rig.board.sensor.absent = True
        rig.run(1500)
        rig.board.sensor.absent = False
        rig.run(1500)

    assert len(rig.events("lost")) == 2
