"""Programs that go on elsewhere, note where they are, go on after an abort, and keep a coil warm: on the core alone."""

import pytest

from protocol import codes, messages, program
from protocol.program import Condition
from tests.firmware_bench import Rig, run_program

NEVER = Condition(program.CURRENT, program.ANY, program.ABOVE, 0x7FFF, 0)
RECOVER = program.wait(NEVER, 100, program.JUMP + 2)
ABORTS = program.wait(NEVER, 100, program.ABORT)
CATCH = program.halt() + program.label(program.ON_FAULT)


@pytest.fixture
def rig():
    return Rig()


def steps(rig):
    """Return the steps that began, with their times since the program did."""
    begin = rig.events("started")[0].now_ms
    return [(event.step, event.now_ms - begin) for event in rig.events("step")]


def test_a_wait_that_runs_out_goes_on_at_its_label_out_of_all_loops(rig):
    loop = program.repeat(9) + program.step(1) + RECOVER + program.next_()
    code = loop + program.step(2) + program.delay(5000) + program.label(2) + program.step(3) + program.delay(50)

    run_program(rig, code + program.halt())
    rig.run(400)

    assert steps(rig) == [(1, 0), (3, 100)]
    assert rig.events("finished")


def test_a_wait_that_is_met_passes_its_label_by(rig):
    met = Condition(program.CURRENT, program.ANY, program.BELOW, 0x7FFF, 0)
    code = program.wait(met, 100, program.JUMP) + program.step(1) + program.delay(50) + program.label(0)

    run_program(rig, code + program.step(2) + program.delay(5) + program.halt())
    rig.run(200)

    assert steps(rig) == [(1, 0), (2, 50)]


def test_an_aborted_program_switches_off_does_what_it_says_and_has_still_failed(rig):
    code = (
        program.fire(1, 500, 5000) + ABORTS + CATCH + program.step(7) + program.fire(2, 300, 100) + program.delay(100)
    )

    run_program(rig, code + program.halt())
    rig.run(115)
    assert rig.board.chip.duty_permille[:2] == [0, 300]
    rig.run(200)

    (caught,), (aborted,) = rig.events("caught"), rig.events("aborted")
    assert (caught.code, aborted.code) == (codes.WAIT_TIMEOUT, codes.WAIT_TIMEOUT)
    assert aborted.now_ms - caught.now_ms == 100
    assert rig.core.state == messages.ARMED


def test_what_runs_after_an_abort_is_not_run_without_one(rig):
    run_program(rig, program.delay(50) + CATCH + program.step(7) + program.delay(50) + program.halt())
    rig.run(200)

    assert rig.events("finished")
    assert rig.events("step") == []


def test_an_abort_of_what_runs_after_an_abort_ends_the_program(rig):
    run_program(rig, ABORTS + CATCH + program.fire(1, 500, 5000) + ABORTS + program.delay(5000) + program.halt())
    rig.run(300)

    assert rig.events("aborted")[0].code == codes.WAIT_TIMEOUT
    assert rig.board.chip.duty_permille[0] == 0


def test_a_program_that_was_aborted_and_then_cancelled_ends_by_what_aborted_it_and_that_is_kept_once(rig):
    run_program(rig, ABORTS + CATCH + program.delay(5000) + program.halt())
    rig.run(200)
    rig.say(messages.CANCEL)

    assert rig.events("aborted")[0].code == codes.WAIT_TIMEOUT
    assert rig.core.records.faults.count() == 1


def test_a_guard_that_trips_is_not_caught(rig):
    guard = program.guard(Condition(program.TIME, program.ANY, program.ABOVE, 0, 50))
    code = guard + program.delay(500) + CATCH + program.delay(5)

    run_program(rig, code + program.halt())
    rig.run(200)

    assert rig.core.state == messages.TRIPPED
    assert rig.events("caught") == []


def test_a_wait_for_a_time_counts_from_the_beginning_of_the_program(rig):
    wait = program.wait(Condition(program.TIME, program.ANY, program.ABOVE, 0, 120), 5000, program.ABORT)

    run_program(rig, program.delay(60) + wait + program.step(1) + program.delay(5) + program.halt())
    rig.run(300)

    assert steps(rig) == [(1, 125)]


def test_every_note_that_is_passed_is_told_in_its_order(rig):
    run_program(rig, b"".join(program.note(number) for number in range(1, 30)) + program.halt())
    rig.run(200)

    assert [event.step for event in rig.events("noted")] == list(range(1, 30))


@pytest.mark.parametrize("end", [b"", program.wait(NEVER, 0, program.ABORT)])
def test_a_note_is_told_before_the_end_that_follows_it(rig, end):
    run_program(rig, program.note(7) + end + program.halt())
    rig.run(200)

    last = [messages.EVENTS[body.event] for name, body in rig.got if name == "event"][-2:]
    assert last == ["noted", "aborted" if end else "finished"]


def test_a_coil_that_is_kept_at_a_temperature_stays_there_until_its_time_is_over(rig):
    run_program(rig, program.fire(1, 600, 3000, program.KEEP | 450) + program.delay(3000) + program.halt())
    rig.run(2500)
    seen = []
    for _ in range(80):
        rig.run(5)
        seen.append(rig.core.sense.temperature_millidegc[0])
    rig.run(300)

    assert 44_000 < min(seen) <= max(seen) < 46_000
    assert rig.board.chip.duty_permille[0] == 0
    assert rig.events("cut-off") == []
    assert rig.events("finished")


def waits_for(rig, condition):
    """Return whether a condition is met within a while."""
    run_program(rig, program.wait(condition, 100, program.ABORT) + program.halt())
    rig.run(250)
    return bool(rig.events("finished"))


@pytest.mark.parametrize(
    ("source", "compare", "value", "met"),
    [
        (program.RESISTANCE, program.ABOVE, 400, True),
        (program.RESISTANCE, program.BELOW, 400, False),
        (program.MARTENSITE, program.ABOVE, 900, True),
        (program.MARTENSITE, program.BELOW, 900, False),
    ],
)
def test_a_condition_on_what_the_resistance_says_is_held_against_the_last_measurement(rig, source, compare, value, met):
    resistance = rig.core.control.resistance
    rig.arm()
    for channel in (0, 1):
        resistance.refer(channel, 4900)
        resistance.take(channel, 4900)

    assert waits_for(rig, Condition(source, program.ALL, compare, value, 0b11)) == met


@pytest.mark.parametrize("source", [program.RESISTANCE, program.MARTENSITE])
@pytest.mark.parametrize("compare", [program.BELOW, program.ABOVE])
@pytest.mark.parametrize("quantifier", [program.ANY, program.ALL])
def test_a_coil_that_was_not_measured_meets_no_condition_on_its_resistance(rig, source, compare, quantifier):
    rig.core.control.resistance.__init__(8, rig.profile.coil)
    rig.core.control.patrol.step = lambda: 0
    rig.core.control.selftest.resistance = None

    run_program(rig, program.halt())
    rig.run(50)
    resistance = rig.core.control.resistance
    resistance.__init__(8, rig.profile.coil)

    rig.core.player.load(Held(Condition(source, quantifier, compare, 0 if compare else 0x7FFF, 0b11)), rig.core.now_ms)
    assert rig.core.player.run(rig.core.now_ms) == 0
    assert rig.core.player.run(rig.core.now_ms + 20) == 2


class Held:
    """A program of one wait, as an upload holds it."""

    streamed, fault_at, labels = False, -1, ()

    def __init__(self, condition):
        self.code = program.wait(condition, 10, program.ABORT) + program.halt()
        self.checked = len(self.code)
