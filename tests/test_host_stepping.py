"""A program that stands still before each step: what an operator is shown, and what the robot does of it."""

import pytest

from host.gait.compiler import compile_script
from host.gait.script import loads
from host.run import run
from host.stepping import WAITING, Stepper
from tests.hil_rig import HilRig

SCRIPT = """\
gait 1
robot circular
guard any.temperature > 100 C
repeat 2:
    fire A at 30 % for 100 ms
    fire B at 30 % for 100 ms
fire C at 30 % for 100 ms
"""


@pytest.fixture
def gone_through():
    """Go through the script with these lines on the keyboard; return how it ended, what was told, and the events."""
    rigs = []

    def gone_through(*lines, is_streamed=False, waits=True):
        rigs.append(HilRig("sim:circular?body=still"))
        robot, told, events = rigs[-1].robot, [], []
        compiled = compile_script(loads(SCRIPT), robot.profile)
        keys = iter(lines)
        stepper = Stepper(robot, compiled, lambda: next(keys, "q" if waits else None), told.append, is_streamed, waits)

        def take(record):
            events.append(record)
            stepper.take(record)

        ending = run(robot, compiled.program, lambda stage, done: None, streamed=is_streamed, stepper=take)
        return ending, told, [each for each in events if hasattr(each, "event")]

    yield gone_through
    for rig in rigs:
        rig.link.close()


def begun(events):
    """Return the steps that began, before which the program stood still or did not."""
    return [each.step for each in events if each.event == "step"]


@pytest.mark.parametrize("is_streamed", [False, True])
def test_each_step_is_shown_before_it_begins(gone_through, is_streamed):
    ending, told, events = gone_through("", "", "", "", "", is_streamed=is_streamed)

    assert ending.result == "done"
    assert told[0] == WAITING
    assert [line[:34] for line in told[1:]] == [
        f"next is step {step}: fire {coil} at 30 % for"
        for step, coil in ((1, "A"), (2, "B"), (1, "A"), (2, "B"), (3, "C"))
    ]
    assert [each.event for each in events].count("paused") == 5


def test_a_number_is_so_many_steps(gone_through):
    ending, told, _ = gone_through("3", "2")

    assert ending.result == "done"
    assert [line[:14] for line in told[1:]] == ["next is step 1", "next is step 2"]


def test_a_program_runs_on_when_it_is_told_to(gone_through):
    ending, told, events = gone_through("", "r")

    assert ending.result == "done"
    assert len(told) == 3
    assert begun(events) == [1, 2, 1, 2, 3]


def test_a_program_is_ended_by_hand_with_its_coils_off(gone_through):
    ending, _, events = gone_through("", "q")

    assert ending.result == "cancelled"
    assert begun(events) == [1]


def test_what_is_no_line_to_obey_is_answered_with_those_there_are(gone_through):
    ending, told, _ = gone_through("faster", "0", "r")

    assert ending.result == "done"
    assert told.count(WAITING) == 3


def test_a_program_that_runs_is_paused_in_the_middle_of_a_step(gone_through):
    ending, told, events = gone_through("r", None, "", *[None] * 9, "r", waits=False)
    clock = [(each.event, each.now_ms) for each in events if each.event in ("paused", "resumed")]
    still_ms = sum(each[1] - before[1] for before, each in zip(clock[::2], clock[1::2], strict=True))
    began, ended = (next(each.now_ms for each in events if each.event == name) for name in ("started", "finished"))

    assert ending.result == "done"
    assert told[-1].startswith("next is step 2: fire B")
    assert ended - began == pytest.approx(500 + still_ms, abs=10)  # two control steps
