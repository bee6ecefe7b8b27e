"""The commands against the bench in this process: the real firmware behind the real wire, on virtual time."""

import json
import os
import pty
import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest

from host.errors import Refused
from host.link import open_link
from host.logbook import read_log
from host.robot import Robot

FIRES = (
    "gait 1\nrobot circular\nrepeat 2:\n    fire A at 60 % for 400 ms\n    wait 200 ms\nfire C E at 50 % for 300 ms\n"
)
FOREVER = "gait 1\nrobot circular\nrepeat 5000:\n    fire A at 20 % for 400 ms\n    wait 1 s\n"
GUARDED = "gait 1\nrobot circular\nguard any all.temperature > 40 C\nfire A at 90 % for 800 ms\n"
ROOT = Path(__file__).parents[1]
PATIENCE_S = 60


@pytest.fixture
def softrig(softrig, monkeypatch):
    """Run a command line in the sources' folder."""
    monkeypatch.chdir(ROOT)
    return softrig


@pytest.fixture
def script(tmp_path):
    path = tmp_path / "fires.gait"
    path.write_text(FIRES)
    return path


def test_a_script_names_its_own_bench(softrig, script):
    fields = json.loads(softrig("run", str(script), "--json").out)

    assert fields["address"] == "sim:circular"
    assert fields["result"] == "done"
    assert fields["duration_s"] == pytest.approx(1.5, abs=0.02)
    assert fields["observed"]["peak_coil_degc"] > 40


def test_the_same_run_gives_the_same_bytes_but_for_the_wall(softrig, script):
    first = json.loads(softrig("run", str(script), "--json").out)
    second = json.loads(softrig("run", str(script), "--json").out)

    assert first.pop("wall") is not None
    assert second.pop("wall") is not None
    assert json.dumps(first) == json.dumps(second)


def test_a_log_of_the_same_run_is_the_same_file_but_for_the_report(softrig, script, tmp_path):
    for name in ("a", "b"):
        softrig("run", str(script), "--log", str(tmp_path / f"{name}.mcap"))

    assert read_log(tmp_path / "a.mcap").rows == read_log(tmp_path / "b.mcap").rows


def test_a_log_or_a_plot_does_not_change_what_happens(softrig, script, tmp_path):
    plain = json.loads(softrig("run", str(script), "--json").out)
    logged = json.loads(softrig("run", str(script), "--json", "--log", str(tmp_path / "a.mcap")).out)

    assert logged["observed"] == plain["observed"]


def test_the_report_agrees_with_what_the_bench_did_to_each_coil(softrig, script):
    fields = json.loads(softrig("run", str(script), "--json").out)

    for label, coil in fields["coils"].items():
        assert coil["on_s"] == pytest.approx(fields["observed"]["coil_on_s"][label], abs=0.1)  # two records a fire


def test_a_guard_trips_on_the_device(softrig, tmp_path):
    (tmp_path / "guarded.gait").write_text(GUARDED)

    told = softrig("run", str(tmp_path / "guarded.gait"), "--json")

    assert told.status == 1
    assert json.loads(told.out.splitlines()[0])["faults"][0]["code"] == "F10"


def test_a_run_is_drawn_from_its_log(softrig, script, tmp_path):
    pytest.importorskip("matplotlib")
    log, picture = str(tmp_path / "a.mcap"), tmp_path / "a.svg"
    softrig("run", str(script), "--log", log)

    told = softrig("log", "plot", log, "-o", str(picture))

    assert told.status == 0
    assert picture.read_text().lstrip().startswith("<?xml")


def test_an_unknown_robot_names_the_known_ones(softrig):
    told = softrig("info", "--robot", "sim:squared")

    assert told.status == 3
    assert "circular" in told.err


def test_a_coil_outside_the_limits_is_refused_by_the_robot_itself(softrig):
    told = softrig("fire", "A", "--duty", "10%", "--hold", "11s", "--robot", "sim:circular")

    assert told.status == 4
    assert "R05" in told.err


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_run_stops_the_robot_and_keeps_its_log(softrig, terminal, tmp_path, number):
    """Also: a run on a terminal shows how far it is."""
    (tmp_path / "forever.gait").write_text(FOREVER)
    log = tmp_path / "run.mcap"
    running = terminal("run", str(tmp_path / "forever.gait"), "--log", str(log))
    running.wait_for(b"s at most")

    running.process.send_signal(number)
    told = running.rest()

    assert running.process.wait(PATIENCE_S) == 130, told
    assert "stop acknowledged" in told
    assert json.loads(softrig("log", "info", str(log), "--json").out)["complete"]


class Running:
    """A command in a process of its own, whose stderr is a terminal."""

    def __init__(self, *arguments: str) -> None:
        self._near, far = pty.openpty()
        command = [sys.executable, "-c", "from host.cli import main; main()", *arguments]
        self.process = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=far)
        os.close(far)

    def wait_for(self, text: bytes) -> None:
        """Return once it has printed `text`."""
        seen = b""
        while text not in seen:
            seen += os.read(self._near, 4096)

    def rest(self) -> str:
        """Return what else it prints up to its end."""
        seen = b""
        with suppress(OSError):  # a terminal without its far end reads as an error
            while piece := os.read(self._near, 4096):
                seen += piece
        return seen.decode()


@pytest.fixture
def terminal():
    """Start commands, and end those that a failed test left running."""
    started: list[Running] = []

    def start(*arguments: str) -> Running:
        started.append(Running(*arguments))
        return started[-1]

    yield start
    for running in started:
        running.process.kill()
        running.process.wait()


def test_a_run_at_too_low_a_supply_is_told_the_true_cause(softrig, script):
    told = softrig("run", str(script), "--robot", "sim:circular?supply=1")

    assert told.status in (4, 6)  # refused at once, or tripped as soon as the first coil is on
    assert "F07 The supply voltage is below its limit." in told.err


def test_a_robot_that_has_tripped_refuses_the_next_order_with_the_fault():
    with Robot(open_link("sim:circular?supply=1")) as robot:
        robot.connect()
        robot.arm()
        robot.fire(["A"], 600, 300)
        list(robot.listen(1000))

        with pytest.raises(Refused, match="R02 The robot has tripped and is latched: F07 The supply voltage"):
            robot.arm()
