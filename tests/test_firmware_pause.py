"""Programs that pause, go on, and go step by step: on the core alone."""

import pytest

from protocol import codes, messages, program
from protocol.program import Condition
from tests.firmware_bench import Rig, refusal, run_program

NEVER = Condition(program.CURRENT, program.ANY, program.ABOVE, 0x7FFF, 0)


@pytest.fixture
def rig():
    return Rig()


def three_steps():
    """Return three steps of 100 ms, each with a coil of its own."""
    parts = [program.step(1 + k) + program.fire(1 << k, 500, 100) + program.delay(100) for k in range(3)]
    return b"".join(parts) + program.halt()


def begun(rig):
    """Return the numbers of the steps that have begun."""
    return [event.step for event in rig.events("step")]


def say(rig, how):
    return rig.say(messages.PAUSE, how=how)


def test_a_pause_lets_orders_end_and_begins_nothing_new(rig):
    run_program(rig, three_steps())
    rig.run(50)
    say(rig, messages.PAUSE_NOW)
    rig.run(500)

    assert begun(rig) == [1]
    assert rig.board.chip.duty_permille[0] == 0
    assert len(rig.events("paused")) == 1


def test_what_goes_on_after_a_pause_takes_the_time_that_was_left(rig):
    run_program(rig, three_steps())
    rig.run(50)
    say(rig, messages.PAUSE_NOW)
    rig.run(500)
    say(rig, messages.RESUME)
    rig.run(400)

    began, paused, resumed = (rig.events(name)[0].now_ms for name in ("started", "paused", "resumed"))
    second = rig.events("step")[1].now_ms
    assert second - resumed == 100 - (paused - began)
    assert rig.events("finished")


def test_time_outs_and_times_do_not_see_a_pause(rig):
    by_time = program.wait(Condition(program.TIME, program.ANY, program.ABOVE, 0, 150), 5000, program.ABORT)
    run_program(rig, program.wait(NEVER, 100, program.CONTINUE) + by_time + program.halt())
    rig.run(40)
    say(rig, messages.PAUSE_NOW)
    rig.run(1000)
    assert rig.core.state == messages.RUNNING
    say(rig, messages.RESUME)
    rig.run(300)

    began, paused, resumed = (rig.events(name)[0].now_ms for name in ("started", "paused", "resumed"))
    assert rig.events("finished")[0].now_ms - resumed == 155 - (paused - began)


def test_a_guard_goes_on_guarding_in_a_pause(rig):
    run_program(rig, program.guard(Condition(program.VOLTAGE, 0, program.BELOW, 4900, 0)) + program.delay(500) + b"\0")
    rig.run(20)
    say(rig, messages.PAUSE_NOW)
    rig.board.supply.mv = 4800
    rig.run(100)

    assert rig.core.state == messages.TRIPPED


def test_a_program_can_begin_with_a_pause_and_go_step_by_step(rig):
    rig.upload(three_steps(), program.header(three_steps(), rig.profile.crc))
    rig.arm()
    rig.say(messages.START, paused=1, at_ms=0)
    seen = []
    for _ in range(4):
        rig.run(300)
        seen.append(begun(rig))
        say(rig, messages.ONE_STEP)
    rig.run(300)

    assert seen == [[], [1], [1, 2], [1, 2, 3]]
    assert rig.events("finished")


def test_a_single_step_in_the_midst_of_one_goes_to_its_end(rig):
    run_program(rig, three_steps())
    rig.run(50)
    say(rig, messages.PAUSE_NOW)
    say(rig, messages.ONE_STEP)
    rig.run(500)

    assert begun(rig) == [1]
    assert rig.core.player.paused


def test_the_status_tells_of_a_pause_and_of_its_end(rig):
    def paused():
        return next(body for name, body in rig.say(messages.STATUS_REQUEST) if name == "status").paused

    run_program(rig, three_steps())
    before = paused()
    say(rig, messages.PAUSE_NOW)
    during = paused()
    rig.say(messages.CANCEL)

    assert (before, during, paused()) == (0, 1, 0)


def test_the_next_program_does_not_begin_with_the_pause_of_the_last(rig):
    run_program(rig, three_steps())
    say(rig, messages.PAUSE_NOW)
    rig.say(messages.CANCEL)
    rig.say(messages.START, paused=0, at_ms=0)
    rig.run(400)

    assert rig.events("finished")
    assert len(rig.events("paused")) == 1
    assert rig.events("resumed") == []


def test_nothing_is_paused_where_nothing_runs(rig):
    rig.arm()

    assert refusal(say(rig, messages.PAUSE_NOW)).code == codes.NOT_RUNNING


def test_a_pause_of_an_unknown_kind_is_refused(rig):
    run_program(rig, three_steps())

    assert refusal(say(rig, 3)).code == codes.BAD_PAYLOAD


def test_every_pause_is_told_also_after_a_step_that_takes_no_time(rig):
    code = program.step(9) + program.note(9) + three_steps()
    rig.upload(code, program.header(code, rig.profile.crc))
    rig.arm()
    rig.say(messages.START, paused=1, at_ms=0)
    rig.run(20)
    say(rig, messages.ONE_STEP)
    rig.run(20)

    assert begun(rig) == [9]
    assert len(rig.events("paused")) == 2


def test_a_time_that_is_guarded_stands_still_in_a_pause(rig):
    guard = program.guard(Condition(program.TIME, program.ANY, program.ABOVE, 0, 200))
    run_program(rig, guard + program.delay(150) + program.halt())
    say(rig, messages.PAUSE_NOW)
    rig.run(1000)
    assert rig.core.state == messages.RUNNING
    say(rig, messages.RESUME)
    rig.run(200)

    assert rig.events("finished")


def test_what_runs_after_an_abort_in_a_pause_begins_as_soon_as_that_ends(rig):
    caught = program.halt() + program.label(program.ON_FAULT) + program.step(5) + program.delay(100) + program.halt()
    run_program(rig, program.delay(5000) + caught)
    say(rig, messages.PAUSE_NOW)
    rig.run(500)
    rig.core._abort(codes.CAMERA)
    rig.run(500)
    assert begun(rig) == []
    say(rig, messages.RESUME)
    rig.run(150)

    assert rig.events("step")[0].now_ms == rig.events("resumed")[0].now_ms
    assert rig.events("aborted")[0].code == codes.CAMERA


def test_a_program_that_begins_in_the_step_that_cancels_a_paused_one_goes_on_after_no_pause(rig):
    run_program(rig, program.delay(50) + program.note(1) + program.delay(50) + program.halt())
    say(rig, messages.PAUSE_NOW)
    for message, fields in ((messages.CANCEL, {}), (messages.START, {"paused": 0, "at_ms": 0})):
        rig.host.send(message.number, message.pack(**fields), rig.now_ms)
    rig.run(300)

    assert rig.events("finished")
    assert rig.events("resumed") == []
