"""A program that outlives its host, paused and stepped through by commands: the real firmware, on virtual time."""

import json

import pytest

from host.robot import Robot
from host.run import outliving, upload
from protocol import program
from tests.fake_robot import plug_in
from tests.hil_rig import HilRig
from tests.test_hil_stream import whole

CODE = b"".join(program.step(n) + program.delay(2000) for n in (1, 2, 3)) + program.halt()


class Shared:
    """A line that one command after another opens and closes; `at_s` is when `then` happens while it is read."""

    def __init__(self, link) -> None:
        self.link = link
        self.at_s, self.then = float("inf"), None

    def __getattr__(self, name):
        return getattr(self.link, name)

    def read(self, until_s):
        if self.link.now_s() >= self.at_s:
            self.at_s = float("inf")
            self.then()
        return self.link.read(until_s)

    def close(self) -> None:
        pass


@pytest.fixture
def shared(monkeypatch):
    """The line to a robot whose host has gone and whose program of three steps runs on."""
    rig = HilRig("sim:circular?body=still")
    shared = Shared(rig.link)
    plug_in(shared, monkeypatch)
    upload(rig.robot, outliving(whole(rig.robot, CODE)), lambda stage, done: None)
    rig.robot.arm()
    rig.robot.start()
    rig.run_alone(1)
    yield shared
    rig.link.close()


def test_a_program_is_paused_stepped_and_resumed_from_another_terminal(softrig, shared):
    paused = softrig("pause", "--leave")
    shared.link.bench.run(30)
    status = softrig("status").out
    stepped = [json.loads(line) for line in softrig("step", "2", "--leave", "--json").out.splitlines()]
    resumed = softrig("resume")

    assert paused.out == "paused in step 1\n"
    assert "  program     paused in step 1\n" in status
    assert stepped == [{"event": "paused", "step": 1}, {"event": "paused", "step": 2}]
    assert (resumed.status, resumed.out) == (0, "done\n")


def test_who_pauses_a_program_holds_it_until_another_takes_it_over(softrig, shared):
    def take_over():
        assert Robot(shared.link).attach()

    shared.at_s, shared.then = shared.link.now_s() + 3, take_over
    told = softrig("pause")

    assert told.status == 0
    assert told.err.splitlines()[-1] == "another host has taken the robot over"
    assert softrig("status", "--json").status == 0


def test_a_program_that_ends_with_a_step_is_disarmed(softrig, shared):
    told = softrig("step", "9")

    assert told.out.splitlines() == ["paused in step 1", "paused in step 2", "finished in step 3"]
    assert json.loads(softrig("status", "--json").out)["state"] == "idle"


def test_where_no_program_runs_nothing_is_paused(softrig, shared):
    softrig("attach", "--stop")

    told = softrig("pause")

    assert told.status == 2
    assert "no program runs" in told.err
