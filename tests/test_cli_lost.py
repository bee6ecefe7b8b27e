"""Commands on a line that is lost: `run --if-lost`, and `attach` to what goes on without its host."""

import json

import pytest

from protocol import messages, program
from tests.fake_robot import FakeRobot, plug_in
from tests.test_host_reattach import BreakingLine

SCRIPT = "gait 1\nrobot circular\nfire A at 60 % for 400 ms\nwait 5 s\n"


@pytest.fixture
def peer():
    peer = FakeRobot()
    peer.program_ms = 5000
    return peer


@pytest.fixture
def line(peer, monkeypatch):
    """A line to `peer` that can be unplugged, at the address fake:."""
    line = BreakingLine(peer)
    plug_in(line, monkeypatch)
    return line


@pytest.fixture
def script(tmp_path):
    path = tmp_path / "a.gait"
    path.write_text(SCRIPT)
    return str(path)


def test_a_run_reports_its_interruptions(softrig, line, script):
    line.unplug(at_ms=1500, for_ms=1000)

    told = softrig("run", script, "--json")

    assert told.status == 0
    (interruption,) = json.loads(told.out)["interruptions"]
    assert interruption["cause"] == "/dev/robot: the line broke"
    assert interruption["for_s"] == pytest.approx(1.0, abs=0.6)
    assert interruption["telemetry_missed"] > 10


def test_the_text_of_a_report_tells_an_interruption_and_the_robots_clock(softrig, line, script):
    line.unplug(at_ms=1500, for_ms=1000)

    told = softrig("run", script)

    assert "  interrupted      at 1." in told.out
    assert "  robot's clock    " in told.out


def test_a_line_that_does_not_come_back_in_time_is_lost(softrig, line, script):
    line.unplug(at_ms=1500, for_ms=60_000)

    told = softrig("run", script, "--patience", "2 s")

    assert told.status == 7
    assert "/dev/robot: the line broke" in told.err


def test_a_run_can_be_stopped_instead(softrig, peer, line, script):
    line.unplug(at_ms=1500, for_ms=1000)
    line.at[line.now_ms + 5000] = lambda: peer.tell(messages.TRIP, 101, 255, 0, line.now_ms)

    told = softrig("run", script, "--if-lost", "stop")

    assert told.status == 7
    assert peer.stops >= 1


@pytest.mark.parametrize("outlive", [False, True])
def test_a_program_outlives_its_host_only_when_that_is_asked_for(softrig, peer, line, script, outlive):
    told = softrig("run", script, "--json", *(["--outlive"] if outlive else []))

    (header,) = [order.header for _, name, order in peer.orders if name == "program"]
    assert program.read_header(header).flags == (program.OUTLIVES_HOST if outlive else 0)
    session = json.loads(told.out)["session"]
    assert (f"session {session}: `softrig attach` takes the program up again" in told.err) is outlive


def running(peer, line):
    peer.holder, peer.state, peer._ends_ms = 77, messages.RUNNING, line.now_ms + 1500


def test_attach_takes_over_and_reports_the_end(softrig, peer, line):
    running(peer, line)

    told = softrig("attach", "--json")

    fields = json.loads(told.out)
    assert told.status == 0
    assert fields["result"] == "done"
    assert fields["attached_to"] == 77
    assert [order.attach for _, name, order in peer.orders if name == "hello"] == [0, 77]
    assert [event["event"] for event in fields["events"]] == ["finished", "disarmed"]


def test_attach_can_end_the_program(softrig, peer, line):
    running(peer, line)

    told = softrig("attach", "--stop")

    assert told.status == 0
    assert [name for _, name, _ in peer.orders][-2:] == ["cancel", "disarm"]


def test_attach_refuses_a_session_that_holds_nothing(softrig, peer, line):
    running(peer, line)

    told = softrig("attach", "--session", "5")

    assert told.status == 2
    assert "the robot obeys session 77" in told.err


def test_attach_to_a_robot_that_runs_nothing_disarms_it(softrig, peer, line):
    peer.holder, peer.state = 77, messages.ARMED

    told = softrig("attach")

    assert told.status == 2
    assert "no program runs, the robot is armed: it has been disarmed now" in told.err
    assert [name for _, name, _ in peer.orders][-1] == "disarm"
