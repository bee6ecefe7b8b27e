"""The promise over a real port: the script of the bench, unchanged, sent by one process to another in real time.

Nothing here asserts how fast the machine is: the bench's own clock is what is looked at.
"""

import json
import signal
import subprocess
import sys
from contextlib import contextmanager

import pytest

SOFTRIG = [sys.executable, "-c", "from host.cli import main; main()"]
PATIENCE_S = 100
TWO_STEPS = """gait 1
robot circular
def held(c):
    fire $c at 100 % for 700 ms
    fire $c at 32 % for 1300 ms
held(A)
held(B)
held(C)
"""
HOST_THAT_FIRES = """
import sys
from host.link import open_link
from host.robot import Robot
robot = Robot(open_link(sys.argv[1]))
robot.connect()
robot.arm()
robot.fire(["A"], 200, 9000)
print("on", flush=True)
list(robot.listen(60_000))
"""


def softrig(*arguments: str) -> subprocess.Popen:
    """Start a command line in a process of its own."""
    return subprocess.Popen([*SOFTRIG, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def said(process: subprocess.Popen) -> dict:
    """Return the last JSON object that a process prints, once it has ended."""
    out, err = process.communicate(timeout=PATIENCE_S)
    assert process.returncode == 0, err
    return json.loads(out.splitlines()[-1])


@contextmanager
def bench(link):
    """Serve a bench at `link` as long as the context lasts; what it saw stands in the yielded dict afterwards."""
    seen: dict = {}
    process = softrig("sim", "circular", "--link", str(link), "--json")
    try:
        assert json.loads(process.stdout.readline())["event"] == "listening"
        yield seen
        process.send_signal(signal.SIGINT)
        seen.update(said(process))
    finally:
        process.kill()
        process.communicate()


@pytest.fixture
def script(tmp_path):
    """A function that writes a script and returns its path."""

    def write(text):
        path = tmp_path / "script.gait"
        path.write_text(text)
        return str(path)

    return write


def test_a_script_travels_as_far_over_the_port_as_in_the_process(script, tmp_path):
    path = script(TWO_STEPS)
    expected = said(softrig("run", path, "--robot", "sim:circular", "--json"))["observed"]["travel_mm"]

    with bench(tmp_path / "robot") as seen:
        report = said(softrig("run", path, "--robot", str(tmp_path / "robot"), "--json"))

    assert report["result"] == "done"
    assert seen["travel_mm"] == pytest.approx(expected, rel=0.02)


def test_a_host_killed_outright_leaves_a_robot_that_cools(tmp_path):
    """kill -9 gives the host no chance to stop; the lease, which the virtual-time tests hold to a step, ends it."""
    link = str(tmp_path / "robot")
    with bench(link) as seen:
        host = subprocess.Popen([sys.executable, "-c", HOST_THAT_FIRES, link], stdout=subprocess.PIPE, text=True)
        assert host.stdout.readline() == "on\n"
        host.kill()
        host.communicate()
        status = said(softrig("status", "--robot", link, "--json"))

    assert (status["state"], status["coils"]) == ("idle", [])
    assert 0.4 < seen["coil_on_s"]["A"] < 9
