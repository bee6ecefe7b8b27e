"""A run that is taken up from a step, paused, stepped through: the commands, against a fake robot."""

import pytest

from protocol.program import disassemble
from tests.fake_robot import FakeLine, FakeRobot, plug_in

SCRIPT = "gait 1\nrobot circular\nfire A at 60 % for 400 ms\nfire B at 60 % for 400 ms\nfire C at 60 % for 400 ms\n"


@pytest.fixture
def peer():
    return FakeRobot()


@pytest.fixture
def line(peer, monkeypatch):
    """A line to `peer`, at the address fake:."""
    line = FakeLine(peer)
    plug_in(line, monkeypatch)
    monkeypatch.delenv("XDG_RUNTIME_DIR", raising=False)
    return line


@pytest.fixture
def script(tmp_path):
    path = tmp_path / "a.gait"
    path.write_text(SCRIPT)
    return str(path)


def steps(code) -> list[int]:
    return [row[2] for row in disassemble(bytes(code)) if row[1] == "step"]


def test_a_run_begins_with_the_step_that_was_asked_for(softrig, line, peer, script):
    told = softrig("run", script, "--from", "2")

    assert told.status == 0
    assert steps(peer.code) == [2, 3]


def test_a_step_that_there_is_not_is_told_in_one_line_and_nothing_moves(softrig, line, peer, script):
    told = softrig("run", script, "--from", "7")

    assert told.status == 2
    assert told.err == f"softrig: no step 7 to begin from: {script} has steps 1 to 3\n"
    assert not peer.taken("program", "arm")
