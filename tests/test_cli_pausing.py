"""A run from one of its steps on, streamed, gone through by hand, and what it reports of its steps."""

import json
import os
import sys

import pytest

from host.cli.asking import typed_lines
from host.logbook import read_log
from protocol.program import disassemble
from tests.fake_robot import FakeLine, FakeRobot, plug_in

BENCH = ("--robot", "sim:circular?body=still")
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


@pytest.fixture
def large(tmp_path):
    """A script of more than the 4096 bytes that the robot holds."""
    path = tmp_path / "large.gait"
    path.write_text("gait 1\nrobot circular\n" + "fire A at 1 % for 5 ms\n" * 220)
    return str(path)


def test_a_script_that_is_too_large_is_told_how_it_can_run(softrig, large):
    told = softrig("run", large, *BENCH)

    assert told.status == 4
    assert "E307" in told.err
    assert "softrig run --stream" in told.err


def test_a_script_that_is_too_large_is_streamed(softrig, large):
    fields = json.loads(softrig("run", large, *BENCH, "--stream", "--json").out)

    assert fields["result"] == "done"
    assert fields["duration_s"] == pytest.approx(1.1, abs=0.02)
    assert "2" in fields["link"]["telemetry_missed_by_slot"]


def test_a_streamed_dry_run_moves_nothing(softrig, large):
    assert json.loads(softrig("run", large, *BENCH, "--stream", "--dry-run", "--json").out)["result"] == "dry run"


def test_a_streamed_program_cannot_outlive_its_host(softrig, line, peer, script):
    told = softrig("run", script, "--stream", "--outlive")

    assert (told.status, told.err.count("\n")) == (2, 1)
    assert "cannot outlive its host" in told.err


def test_a_run_by_hand_without_a_keyboard_is_told_so_in_one_line(softrig, line, peer, script, monkeypatch):
    monkeypatch.setattr("sys.stdin", None)

    told = softrig("run", script, "--step")

    assert (told.status, told.err.count("\n")) == (2, 1)
    assert "stdin is no terminal" in told.err
    assert not peer.taken("program", "arm")


def test_a_run_by_hand_shows_each_step_and_reports_as_ever(softrig, script, monkeypatch):
    lines = iter(["", "2"])
    monkeypatch.setattr("host.cli.run.typed_lines", lambda waits: lambda: next(lines))

    told = softrig("run", script, *BENCH, "--step", "--json")

    assert json.loads(told.out)["result"] == "done"
    assert [line[:14] for line in told.err.splitlines()[1:]] == ["next is step 1", "next is step 2"]


@pytest.fixture
def keyboard(monkeypatch):
    """A terminal as stdin; what is written to the number comes from its keys."""
    near, far = os.openpty()
    with os.fdopen(far) as stdin:
        monkeypatch.setattr(sys, "stdin", stdin)
        yield near
    os.close(near)


def test_lines_are_taken_from_a_terminal_one_by_one_as_they_are_typed(keyboard):
    read = typed_lines(waits=False)

    assert read() is None
    os.write(keyboard, b"3\nr\n\x04")
    assert [typed_lines(waits=True)(), read(), read()] == ["3", "r", "q"]


def test_notes_and_the_step_a_run_ended_in_are_in_report_and_log(softrig, tmp_path):
    text = 'gait 1\nrobot circular\nparam d = 5 %\nfire A at $d for 50 ms\nnote "at $d"\n'
    waits = "wait until A.temperature > 90 C timeout 50 ms else abort\non fault:\n    fire B at $d for 50 ms\n"
    (tmp_path / "n.gait").write_text(text + waits)
    fields = json.loads(softrig("run", str(tmp_path / "n.gait"), *BENCH, "--log", str(tmp_path / "n.mcap"), "--json")
                        .out.splitlines()[0])  # fmt: skip

    place = {"file": str(tmp_path / "n.gait"), "line": 5}
    told = {"t_s": pytest.approx(0.06, abs=0.02), "step": 2, **place, "where": "line 5", "text": "at 5 %"}
    assert fields["notes"] == [told]
    assert (fields["caught"]["code"], fields["caught"]["step"], fields["ended_in"]["step"]) == ("F11", 3, 3)
    assert [(fault["code"], fault["line"]) for fault in fields["faults"]] == [("F11", 6)]
    (row,) = read_log(tmp_path / "n.mcap").rows["notes"]
    assert {key: row[key] for key in ("step", "file", "line", "text")} == {"step": 2, **place, "text": "at 5 %"}
