"""Programs that come while they run: on the core alone."""

import pytest

from protocol import codes, messages, program
from protocol.program import Condition
from tests.firmware_bench import FINGERS, Rig, refusal, run_program

NEVER = Condition(program.CURRENT, program.ANY, program.ABOVE, 0x7FFF, 0)
LONGER_THAN_THE_ROBOT_HOLDS = 6000


@pytest.fixture
def rig():
    return Rig()


class Stream:
    """A host that sends a code in pieces of whole ops."""

    def __init__(self, rig, flags=0):
        self.rig, self.sent = rig, 0
        rig.say(messages.PROGRAM, header=program.header(b"", rig.profile.crc, program.STREAMED | flags))

    def send(self, code):
        answers = self.rig.say(messages.CODE, offset=self.sent & 0xFFFF, code=code)
        if tuple(name for name, _ in answers)[:1] == ("ok",):
            self.sent += len(code)
        return answers

    def start(self):
        self.rig.arm()
        return self.rig.say(messages.START, paused=0, at_ms=0)


def pulse(k):
    return program.step(1 + k) + program.fire(1 << k % 8, 500, 20) + program.delay(40)


def pace(rig):
    """Return when each step began, since the program did, and when it ended."""
    begin = rig.events("started")[0].now_ms
    return [event.now_ms - begin for event in [*rig.events("step"), *rig.events("finished")]]


def test_a_streamed_program_keeps_the_pace_of_an_uploaded_one():
    code = b"".join(pulse(k) for k in range(8)) + program.halt()
    there, here = Rig(), Rig()
    run_program(there, code)
    stream = Stream(here)
    stream.send(code[:57])
    stream.start()
    stream.send(code[57:])
    there.run(400)
    here.run(400)

    assert pace(here) == pace(there) == [*range(0, 320, 40), 320]


def test_a_stream_may_be_longer_than_the_robot_holds(rig):
    stream = Stream(rig)
    count = LONGER_THAN_THE_ROBOT_HOLDS // len(pulse(0))
    stream.send(pulse(0))
    stream.start()
    for k in range(1, count):
        while refused := [body for name, body in stream.send(pulse(k)) if name == "refused"]:
            assert refused[0].code == codes.TOO_LARGE
            rig.run(40)
    stream.send(program.halt())
    rig.run(40 * count)

    assert [event.step for event in rig.events("step")] == list(range(1, count + 1))
    assert rig.events("finished")


def test_a_stream_that_does_not_come_in_time_ends_with_everything_off(rig):
    stream = Stream(rig)
    stream.send(program.fire(1, 500, 5000) + program.delay(100))
    stream.start()
    rig.run(200)

    assert rig.events("aborted")[0].code == codes.STARVED
    assert rig.board.chip.duty_permille[0] == 0
    assert rig.core.state == messages.ARMED


def test_how_far_the_sequencer_has_come_can_be_read(rig):
    run_program(rig, program.delay(50) + program.delay(5000) + program.halt())
    rig.run(20)
    values = []
    rig.core.reports.subscriptions._readings.readers[-1](values)
    rig.run(100)
    rig.core.reports.subscriptions._readings.readers[-1](values)

    assert values == [5, 10]


def test_a_jump_in_a_stream_passes_what_comes_until_its_label(rig):
    stream = Stream(rig)
    stream.send(program.wait(NEVER, 50, program.JUMP + 1) + program.step(1))
    stream.start()
    rig.run(300)
    stream.send(program.delay(60_000) + program.step(2) + program.fire(1, 500, 5000))
    rig.run(20)
    assert rig.board.chip.duty_permille[0] == 0
    stream.send(program.label(1) + program.step(3) + program.delay(10) + program.halt())
    rig.run(100)

    assert [event.step for event in rig.events("step")] == [3]
    assert rig.events("finished")


def test_an_abort_in_a_stream_goes_on_at_what_it_says_about_it(rig):
    stream = Stream(rig, program.CATCHES)
    stream.send(program.wait(NEVER, 50, program.ABORT) + program.step(1) + program.delay(60_000))
    stream.start()
    rig.run(100)
    stream.send(program.halt() + program.label(program.ON_FAULT) + program.step(2) + program.delay(10) + b"\0")
    rig.run(100)

    assert [event.step for event in rig.events("step")] == [2]
    assert rig.events("aborted")[0].code == codes.WAIT_TIMEOUT


def test_what_nobody_may_run_ends_a_stream(rig):
    stream = Stream(rig)
    stream.send(program.delay(500))
    stream.start()
    stream.send(program.fire(1 << 12, 500, 100))
    rig.run(50)

    assert rig.events("aborted")[0].code == codes.BAD_CODE


def test_what_a_robot_cannot_know_ends_a_stream(rig):
    stream = Stream(rig)
    stream.send(program.delay(500))
    stream.start()
    stream.send(program.wait(Condition(program.FORCE, 0, program.ABOVE, 0, 0), 50, program.ABORT))
    rig.run(50)

    assert rig.events("aborted")[0].code == codes.NO_LOAD_CELL


def test_a_piece_that_does_not_follow_the_last_is_refused(rig):
    stream = Stream(rig)
    stream.send(program.delay(500))

    answers = rig.say(messages.CODE, offset=3, code=program.halt())

    assert (refusal(answers).code, refusal(answers).limit) == (codes.BAD_CODE, 5)


def test_a_stream_of_nothing_does_not_begin(rig):
    stream = Stream(rig)

    assert refusal(stream.start()).code == codes.NO_PROGRAM


def test_a_stream_whose_beginning_is_gone_does_not_begin_again(rig):
    stream = Stream(rig)
    stream.send(program.delay(100))
    stream.start()
    for _ in range(rig.profile.program_bytes_max // len(program.delay(1) * 40) + 1):
        stream.send(program.delay(1) * 40)
        rig.run(25)
    stream.send(program.halt())
    rig.run(300)

    assert rig.events("finished")
    assert refusal(rig.say(messages.START, paused=0, at_ms=0)).code == codes.NO_PROGRAM


def test_a_stream_that_nobody_may_run_is_refused_however_often_it_is_started(rig):
    stream = Stream(rig)
    stream.send(program.next_())
    rig.arm()
    refused = [refusal(rig.say(messages.START, paused=0, at_ms=0)) for _ in range(3)]

    assert [(each.code, each.value) for each in refused] == [(codes.BAD_CODE, 0)] * 3


def test_a_stream_that_lost_the_object_still_does_what_it_says_about_it():
    rig = Rig(FINGERS)
    stream = Stream(rig, program.CATCHES)
    rig.board.watcher.seen = True
    rig.run(100)
    stream.send(program.wait(Condition(program.ORIENTATION, 0, program.ABOVE, 9000, 0), 5000, program.ABORT))
    stream.start()
    rig.board.watcher.absent = True
    rig.run(300)
    assert rig.events("caught")[0].code == codes.CAMERA
    stream.send(program.halt() + program.label(program.ON_FAULT) + program.step(2) + program.delay(10) + b"\0")
    rig.run(50)

    assert [event.step for event in rig.events("step")] == [2]
    assert rig.events("aborted")[0].code == codes.CAMERA


def test_a_program_that_has_ended_takes_no_room_from_the_next(rig):
    run_program(rig, program.delay(50) + program.halt())
    rig.say(messages.CANCEL)

    assert len(rig.core.player.code) == 0
