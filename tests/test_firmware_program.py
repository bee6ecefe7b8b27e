"""Programs on the core alone: upload, verification, steps, waits and guards."""

import pytest

from protocol import codes, messages, program
from protocol.program import Condition
from tests.firmware_bench import Rig, refusal, run_program


@pytest.fixture
def rig():
    return Rig()


def test_an_uploaded_program_runs_its_steps_on_time_and_says_when_it_is_done(rig):
    code = (
        program.repeat(2) + program.step(1) + program.fire(1, 1000, 100) + program.delay(100)
        + program.step(2) + program.fire(2, 500, 50) + program.delay(50) + program.next_() + program.halt()
    )  # fmt: skip

    run_program(rig, code)
    rig.run(400)

    begin = rig.events("started")[0].now_ms
    steps = [(event.step, event.now_ms - begin) for event in rig.events("step")]
    assert steps == [(1, 0), (2, 100), (1, 150), (2, 250)]
    assert rig.events("finished")[0].now_ms - begin == 300
    assert rig.core.state == messages.ARMED


def test_a_fire_that_follows_on_the_same_coil_leaves_no_gap(rig):
    code = program.fire(1, 1000, 100) + program.delay(100) + program.fire(1, 300, 100) + program.delay(100)
    duties = []

    run_program(rig, code + program.halt())
    for _ in range(45):
        rig.run(5)
        duties.append(rig.board.chip.duty_permille[0])

    on = [duty for duty in duties if duty]
    assert duties[: len(on)] == on
    assert sorted(set(on)) == [300, 1000]


def test_coils_whose_order_ends_in_this_step_do_not_count_as_on_at_once(rig):
    six = program.fire(0b00111111, 300, 50) + program.delay(50) + program.fire(0b11111000, 300, 50) + program.halt()

    run_program(rig, six)
    rig.run(200)

    assert rig.events("finished")


def test_a_ramp_rises_to_its_duty(rig):
    run_program(rig, program.ramp(1, 400, 500, 0, 200) + program.halt())
    rig.run(80)
    half = rig.board.chip.duty_permille[0]
    rig.run(150)

    assert 150 <= half <= 230
    assert rig.board.chip.duty_permille[0] == 400


def test_a_cut_off_ends_the_order_when_the_estimate_reaches_it(rig):
    run_program(rig, program.fire(1, 1000, 3000, 600) + program.halt())

    rig.run(1500)

    (event,) = rig.events("cut-off")
    assert event.channel == 0
    assert 600 <= event.value < 620
    assert rig.events("finished")


def test_a_wait_ends_when_its_condition_holds(rig):
    warm = Condition(program.TEMPERATURE, program.ANY, program.ABOVE, 400, 0b1)

    wait = program.wait(warm, 5000, program.ABORT)
    run_program(rig, program.fire(1, 500, 1000) + wait + program.off(1) + program.halt())
    rig.run(1000)

    assert rig.events("finished")[0].now_ms < 500


def test_a_wait_that_runs_out_aborts_or_continues_as_written(rig):
    hot = Condition(program.TEMPERATURE, program.ALL, program.ABOVE, 900, 0b11)

    run_program(rig, program.wait(hot, 100, program.CONTINUE) + program.wait(hot, 200, program.ABORT) + program.halt())
    rig.run(400)

    (event,) = rig.events("aborted")
    assert event.code == codes.WAIT_TIMEOUT
    assert event.now_ms - rig.events("started")[0].now_ms == pytest.approx(300, abs=10)
    assert rig.core.state == messages.ARMED


def test_a_guard_trips_in_the_step_in_which_it_holds(rig):
    guard = Condition(program.TEMPERATURE, program.ANY, program.ABOVE, 500, 0xFF)

    run_program(rig, program.guard(guard) + program.fire(2, 1000, 2000) + program.halt())
    rig.run(1000)

    assert rig.core.code == codes.GUARD
    assert rig.board.chip.duty_permille[1] == 0


def test_a_guard_within_a_loop_is_one_guard(rig):
    guard = Condition(program.TEMPERATURE, program.ANY, program.ABOVE, 500, 0xFF)
    body = program.guard(guard) + program.delay(10)

    run_program(rig, program.repeat(20) + body + program.next_() + program.fire(2, 1000, 2000) + program.halt())
    rig.run(1500)

    assert rig.core.code == codes.GUARD


def test_a_program_step_beyond_the_limits_trips_and_names_them(rig):
    run_program(rig, program.fire(1, 1000, 20_000) + program.halt())
    rig.run(20)

    (event,) = rig.events("tripped")
    assert (event.code, event.channel, event.value) == (codes.REFUSED_STEP, 0, 20_000)


def test_a_program_dies_with_its_host_unless_it_may_outlive_it(rig):
    code = program.fire(1, 300, 3000) + program.halt()
    run_program(rig, code)
    rig.run(600, silent=True)
    assert rig.core.state == messages.IDLE

    other = Rig()
    run_program(other, code, flags=program.OUTLIVES_HOST)
    other.run(600, silent=True)
    assert other.core.state == messages.RUNNING
    assert other.board.chip.duty_permille[0] == 300


def test_a_program_that_ended_does_not_keep_a_silent_host_armed(rig):
    run_program(rig, program.delay(50) + program.halt(), flags=program.OUTLIVES_HOST)

    rig.run(1000, silent=True)

    assert rig.core.state == messages.IDLE


def test_a_new_session_inherits_no_arming_from_a_program_that_outlived_its_host(rig):
    run_program(rig, program.fire(1, 300, 2000) + program.halt(), flags=program.OUTLIVES_HOST)
    rig.run(600, silent=True)

    rig.hello(session=78)
    rig.run(3000)

    assert rig.board.chip.duty_permille[0] == 0
    assert refusal(rig.fire(1)).code == codes.NOT_ARMED


BAD_PROGRAMS = [
    ("other robot", {"robot_crc": 1}, program.halt(), codes.OTHER_ROBOT),
    ("bad code", {}, program.delay(1), codes.BAD_CODE),
    ("too large", {}, program.delay(1) * 1000 + program.halt(), codes.TOO_LARGE),
]


@pytest.mark.parametrize(("what", "options", "code", "expected"), BAD_PROGRAMS, ids=[row[0] for row in BAD_PROGRAMS])
def test_a_bad_program_is_refused_whole(rig, what, options, code, expected):
    answers = run_program(rig, code, **options)

    assert refusal(answers).code == expected
    assert rig.core.state == messages.ARMED


def test_a_program_whose_bytes_changed_on_the_way_does_not_start(rig):
    code = program.fire(1, 300, 100) + program.halt()
    rig.upload(code[:5] + b"\x01" + code[6:], program.header(code, rig.profile.crc))
    rig.arm()

    assert refusal(rig.say(messages.START, paused=0, at_ms=0)).code == codes.BAD_CODE


def test_a_long_program_is_verified_in_pieces_and_then_started(rig):
    code = program.delay(1) * 400 + program.halt()
    run_program(rig, code)
    assert not rig.events("started")

    answers = rig.run(100)

    assert rig.events("started")
    assert [name for name, _ in answers].count("ok") == 1


def test_a_program_that_waits_for_its_verification_dies_with_the_arming(rig):
    code = program.delay(1) * 400 + program.halt()
    rig.upload(code, program.header(code, rig.profile.crc))
    rig.arm()
    rig.host.send(messages.START.number, messages.START.pack(paused=0, at_ms=0), rig.now_ms)
    rig.host.send(messages.DISARM.number, messages.DISARM.pack(), rig.now_ms)

    answers = rig.run(200)

    assert refusal(answers).code == codes.NOT_ARMED
    assert not rig.events("started")


def test_a_program_that_is_cancelled_while_it_is_verified_does_not_start(rig):
    code = program.fire(1, 300, 500) * 100 + program.halt()
    rig.upload(code, program.header(code, rig.profile.crc))
    rig.arm()
    rig.host.send(messages.START.number, messages.START.pack(paused=0, at_ms=0), rig.now_ms)
    rig.host.send(messages.CANCEL.number, b"", rig.now_ms)

    answers = rig.run(200)

    assert refusal(answers).code == codes.CANCELLED
    assert not rig.events("started")
    assert rig.core.state == messages.ARMED


@pytest.mark.parametrize("pause_ms", [0, 1, 2])
def test_an_off_and_an_on_of_a_program_that_one_step_serves_are_no_pause(rig, pause_ms):
    lap = program.fire(1, 50, 9896) + program.delay(9896) + program.fire(1, 0, 0) + program.delay(pause_ms)
    run_program(rig, lap * 2 + program.halt())
    rig.run(12_000)

    assert rig.core.code == codes.ON_TOO_LONG


def test_while_a_program_runs_other_orders_are_refused_and_cancel_ends_it(rig):
    run_program(rig, program.fire(1, 300, 5000) + program.halt())

    assert refusal(rig.fire(2)).code == codes.BUSY
    rig.say(messages.CANCEL)
    assert rig.core.state == messages.ARMED
    assert rig.board.chip.duty_permille[0] == 0


def test_after_the_end_of_a_program_no_step_is_told(rig):
    run_program(rig, program.step(7) + program.fire(1, 300, 50) + program.halt())
    rig.run(100)

    status = next(body for name, body in rig.say(messages.STATUS_REQUEST) if name == "status")

    assert rig.events("finished")[0].step == 7
    assert status.step == 0


def test_a_new_session_is_not_told_of_the_last_one_s_start(rig):
    code = program.delay(1) * 400 + program.halt()
    rig.upload(code, program.header(code, rig.profile.crc))
    rig.arm(lease_ms=50)
    rig.run(5, silent=True, line=start_of(rig))
    rig.core.lease_ms = 1  # so short that the next host finds it over, while the verification goes on

    rig.hello(session=78)
    rig.host.acknowledge()
    answers = rig.run(200, silent=True, line=rig.host.poll(rig.now_ms))

    assert [name for name, _ in answers if name == "refused"] == []
    assert not rig.events("started")


def start_of(rig):
    """Return the bytes of a start that the host sends now."""
    rig.host.send(messages.START.number, messages.START.pack(paused=0, at_ms=0), rig.now_ms)
    return rig.host.poll(rig.now_ms)
