"""A program that is sent while it runs does what it would have done had it been uploaded."""

from binascii import crc32
from itertools import islice

import pytest

from host.gait.compiler import compile_script
from host.gait.script import loads
from host.link import open_link
from host.records import Event, Sample
from host.robot import Robot
from host.run import run
from host.stream import Stream, pieces, streamed, unrolled
from protocol import program
from protocol.program import Condition

STEP_MS = 5
NEVER = Condition(program.TEMPERATURE, program.ANY, program.ABOVE, 2000, 1)
COLD = Condition(program.TEMPERATURE, program.ANY, program.BELOW, 900, 1)
CIRCULAR = """\
gait 1
robot circular
repeat 3:
    fire A at 30 % for 100 ms overlap 90 ms
    wait until A.temperature > 30 C timeout 1 s else abort
    together:
        fire B at 20 % for 60 ms ramp 30 ms
        repeat 2:
            fire C at 40 % for 45 ms
    wait 200 ms
fire D at 20 % for 33 ms
"""
SPHERE = """\
gait 1
robot sphere-b
repeat 2:
    fire A001 at 30 % for 200 ms overlap 50 ms
    fire A100 A010 at 20 % for 100 ms ramp 40 ms
"""
PRESS = """\
gait 1
robot press
move P to -1 mm over 300 ms
repeat 2:
    move P to 0 mm over 200 ms
    wait 40 ms
    move P to -1 mm over 200 ms
"""


class Tape:
    """Keeps what a robot tells."""

    def __init__(self) -> None:
        self.records = []

    def line(self, *_) -> None:
        pass

    def link(self, _) -> None:
        pass

    def record(self, record) -> None:
        self.records.append(record)

    def events(self) -> list[tuple]:
        """Return (what, code, step) of each event."""
        return [(each.event, each.code, each.step) for each in self.records if isinstance(each, Event)]

    def trace(self) -> dict[int, dict]:
        """Return the values of slot 3 by the time since the program began."""
        began_ms = next(each.now_ms for each in self.records if isinstance(each, Event) and each.event == "started")
        rows = [each for each in self.records if isinstance(each, Sample) and each.slot == 3]
        return {each.now_ms - began_ms: each.values for each in rows if each.now_ms >= began_ms}


def quiet(stage, done):
    pass


def played(address, code, is_streamed, variable="duty_permille"):
    """Run a code, or a script, on a bench of its own; return how it ended and what was told."""
    tape = Tape()
    with Robot(open_link(address), tape) as robot:
        robot.connect()
        robot.subscribe(STEP_MS, [variable], on_change=True, slot=3)
        return run(robot, whole(robot, code), quiet, streamed=is_streamed), tape


def whole(robot, code):
    """Return header and code of a code, or of the text of a script."""
    if isinstance(code, str):
        return compile_script(loads(code), robot.profile).program
    return program.header(code, crc32(robot.dictionary.split(b"\n\n", 1)[1])) + code


def values(trace, until_ms):
    """Return what was told last at each control step."""
    told, rows = None, []
    for at_ms in range(until_ms):
        told = trace.get(at_ms, told)
        if at_ms % STEP_MS == 0:
            rows.append(told)
    return rows


@pytest.mark.parametrize(
    ("address", "script", "variable"),
    [
        ("sim:circular?body=still", CIRCULAR, "duty_permille"),
        ("sim:sphere-b?body=still&baud=921600", SPHERE, "duty_permille"),
        ("sim:press", PRESS, "commanded_centi"),
    ],
)
def test_a_streamed_script_gives_the_traces_of_the_uploaded_one_to_a_control_step(address, script, variable):
    uploaded, streamed_ = (played(address, script, how, variable) for how in (False, True))
    lasts_ms = max(uploaded[1].trace())
    one, other = (values(each[1].trace(), lasts_ms) for each in (uploaded, streamed_))

    assert uploaded[0].result == streamed_[0].result == "done"
    assert len(one) >= 100
    for place, told in enumerate(one):
        assert told in other[max(place - 1, 0) : place + 2]


def turns(count):
    """Return a body of 52 bytes that takes 20 ms, so many times over."""
    fires = b"".join(program.fire(1 << coil, 10, 15) for coil in range(4))
    return program.repeat(count) + program.step(2) + fires + program.delay(20) + program.next_()


@pytest.mark.parametrize("world", ["cpython", "micropython"])
def test_a_program_larger_than_the_robots_memory_is_streamed(world):
    code = turns(120) + program.halt()

    ending, tape = played(f"sim:circular?body=still&world={world}", code, True)

    on = [at_ms for at_ms, values in tape.trace().items() if values["duty_permille"]["A"]]
    assert sum(map(len, unrolled(code))) > 6000
    assert ending.result == "done"
    assert len(on) == 120
    assert max(on) == pytest.approx(119 * 20, abs=STEP_MS)


def test_a_wait_that_goes_on_at_a_label_passes_what_comes_before_it():
    ahead = program.step(1) + program.fire(1, 300, 500) + program.wait(NEVER, 100, program.JUMP + 3)
    code = ahead + turns(120) + program.label(3) + program.step(3) + program.fire(2, 300, 100) + program.halt()

    ending, tape = played("sim:circular?body=still", code, True)

    assert ending.result == "done"
    assert [step for event, _, step in tape.events() if event == "step"] == [1, 3]


def test_what_runs_after_an_abort_is_found_at_the_end_of_a_stream():
    ahead = program.step(1) + program.fire(1, 300, 2000) + program.wait(NEVER, 100, program.ABORT)
    after = program.label(program.ON_FAULT) + program.step(3) + program.fire(2, 300, 100) + program.halt()

    ending, tape = played("sim:circular?body=still", ahead + turns(120) + program.halt() + after, True)

    assert ending.result == "timeout"
    assert [step for event, _, step in tape.events() if event == "step"] == [1, 3]
    assert all(not row["duty_permille"]["A"] for at_ms, row in tape.trace().items() if at_ms >= 100 + STEP_MS)


def test_a_program_whose_next_order_is_not_there_in_time_ends_with_its_coils_off(monkeypatch):
    monkeypatch.setattr(Stream, "take", lambda stream, record: None)

    ending, tape = played("sim:circular?body=still", program.fire(1, 300, 9000) + turns(120) + program.halt(), True)

    assert ending.result == "starved"
    assert "R37 The next order of a streamed program was due and had not arrived" in str(ending.error())
    assert not any(list(tape.trace().values())[-1]["duty_permille"].values())


def test_a_guard_that_comes_late_in_a_stream_guards_although_another_stood_in_its_place():
    late = program.guard(NEVER) + program.step(1) * 90 + program.delay(400) + program.guard(COLD)

    ending, _ = played("sim:circular?body=still", late + turns(120) + program.halt(), True)

    assert ending.result == "guard"


def test_a_bad_line_delays_no_order_of_a_stream(tmp_path):
    faults = tmp_path / "faults.toml"
    faults.write_text('seed = 3\n[[fault]]\nname = "line-flip:2"\nat_ms = 900\nfor_ms = 1500\n')

    ending, tape = played(f"sim:circular?body=still&faults={faults}", turns(120) + program.halt(), True)

    assert ending.result == "done"
    finished, started = (
        next(each.now_ms for each in tape.records if isinstance(each, Event) and each.event == event)
        for event in ("finished", "started")
    )
    assert finished - started == pytest.approx(120 * 20, abs=2 * STEP_MS)


def test_pieces_are_whole_ops_and_loops_are_unrolled_only_as_they_are_sent():
    loop = program.repeat(65535) * 8 + program.fire(1, 10, 15) + program.delay(20) + program.next_() * 8

    first = list(islice(pieces(loop + program.halt()), 3))

    assert [len(piece) for piece in first] == [192, 192, 192]
    assert all(piece == first[0] for piece in first)


def test_a_loop_has_as_many_turns_as_it_says():
    step, loop = program.step, program.repeat(2) + program.step(2) + program.next_()

    ops = list(unrolled(step(1) + program.repeat(3) + loop + step(3) + program.next_() + program.halt()))

    assert b"".join(ops) == step(1) + 3 * (2 * step(2) + step(3)) + program.halt()


@pytest.mark.parametrize(("tail", "flags"), [(b"", 0), (program.label(program.ON_FAULT) + b"\0", program.CATCHES)])
def test_the_header_of_a_stream_says_whether_something_runs_after_an_abort(tail, flags):
    code = program.step(255) + program.halt() + tail

    read = program.read_header(streamed(program.header(code, 7) + code))

    assert (read.flags, read.robot_crc, read.length, read.crc) == (program.STREAMED | flags, 7, 0, 0)
