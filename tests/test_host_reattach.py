"""A run over a line that breaks and comes back: the session goes on, and says what happened."""

from math import ceil

import pytest

from host.errors import LinkLost, PortAbsent
from host.keeper import Keeper
from host.log import LogWriter
from host.logbook import read_log
from host.robot import Robot
from host.run import IfLost, run
from protocol import codes, messages
from tests.fake_robot import PROFILE, FakeLine, FakeRobot

HEADER = bytes(16)
QUIET = lambda stage, done: None  # noqa: E731


class BreakingLine(FakeLine):
    """A line to a fake robot whose port goes away; the robot stays and does what it does without a host."""

    def __init__(self, robot, **options):
        super().__init__(robot, **options)
        self.broken = False
        self.breaks = 0

    def unplug(self, at_ms, for_ms):
        """Have the port go away, counted from now on."""
        self.at[self.now_ms + at_ms] = self._break
        self.at[self.now_ms + at_ms + for_ms] = lambda: setattr(self, "cut", False)

    def reopen(self):
        if self.cut:
            raise PortAbsent("no port")
        self.broken = False
        return self

    def pause(self, until_s):
        self.unread(max(0, ceil(until_s * 1000 - 1e-6) - self.now_ms))

    def _break(self):
        self.cut = self.broken = True
        self.breaks += 1
        self._outward = self._inward = b""

    def _check(self):
        if self.broken:
            raise LinkLost("/dev/robot: the line broke")

    def _pass(self):
        super()._pass()
        if self.cut:
            self._inward = b""


@pytest.fixture
def peer():
    peer = FakeRobot()
    peer.program_ms = 5000
    return peer


@pytest.fixture
def line(peer):
    return BreakingLine(peer)


def ran(line, if_lost=None, keeper=None):
    robot = Robot(line, keeper)
    robot.connect()
    return robot, run(robot, HEADER, QUIET, if_lost=if_lost)


def test_a_run_goes_on_over_a_port_that_went_away_and_came_back(line):
    line.unplug(at_ms=1000, for_ms=1500)
    keeper = Keeper()

    robot, ending = ran(line, keeper=keeper)

    assert ending.result == "done"
    assert ending.error() is None
    (interruption,) = robot.interruptions()
    assert interruption.cause == "/dev/robot: the line broke"
    assert interruption.for_ms == pytest.approx(1500, abs=600)
    assert interruption.telemetry_missed == pytest.approx(interruption.for_ms / 50, abs=2)


@pytest.mark.parametrize("at_ms", range(200, 700, 45))
def test_what_the_robot_said_meanwhile_comes_once_and_in_order(peer, line, at_ms):
    peer.program_ms = 3000
    line.unplug(at_ms=at_ms, for_ms=1000)
    for value in range(20):
        line.at[line.now_ms + 100 + 90 * value] = lambda value=value: peer.tell(
            messages.STEP, 0, 255, value, line.now_ms
        )
    keeper = Keeper()

    _, ending = ran(line, keeper=keeper)

    assert ending.result == "done"
    assert [event.value for event in keeper.recording.events if event.event == "step"] == list(range(20))


def test_an_order_that_was_lost_with_the_port_is_given_once(peer, line):
    robot = Robot(line)
    robot.connect()
    robot.arm()
    robot.endure(10_000)
    line.unplug(at_ms=1, for_ms=700)

    for hold_ms in range(100, 110):
        robot.fire(["A"], 500, hold_ms)

    assert [order.hold_ms for _, name, order in peer.orders if name == "fire"] == list(range(100, 110))


def test_a_robot_that_disarmed_itself_meanwhile_is_said_so_as_a_lost_link(peer, line):
    line.unplug(at_ms=1000, for_ms=1500)
    line.at[line.now_ms + 1600] = lambda: peer.tell(messages.DISARMED, codes.LEASE_EXPIRED, 255, 500, line.now_ms)

    robot, ending = ran(line)

    assert ending.result == "lease"
    assert ending.error().exit_code == 7
    assert len(robot.interruptions()) == 1


def test_a_line_that_stays_away_for_longer_than_patience_is_lost(peer, line):
    line.unplug(at_ms=1000, for_ms=60_000)
    begun_ms = line.now_ms

    _, ending = ran(line, IfLost(patience_ms=3000))

    assert ending.result == "link lost"
    assert str(ending.error()) == "/dev/robot: the line broke"
    assert line.now_ms - begun_ms < 1000 + 3000 + 2000


def test_a_line_that_only_falls_silent_is_borne_as_long(peer, line):
    line.at[line.now_ms + 1000] = lambda: setattr(peer, "deaf", True)
    line.at[line.now_ms + 4500] = lambda: setattr(peer, "deaf", False)
    peer.program_ms = 8000

    robot, ending = ran(line)

    assert ending.result == "done"
    assert [interruption.cause for interruption in robot.interruptions()] == ["the robot has fallen silent"]


def test_a_robot_that_stays_silent_for_longer_than_patience_is_lost(peer, line):
    line.at[line.now_ms + 1000] = lambda: setattr(peer, "deaf", True)
    begun_ms = line.now_ms

    _, ending = ran(line, IfLost(patience_ms=3000))

    assert ending.result == "link lost"
    assert line.now_ms - begun_ms < 1000 + 3000 + 2000 + 2000


def test_who_asked_for_it_has_the_robot_stopped_once_the_line_is_back(peer, line):
    line.unplug(at_ms=1000, for_ms=1500)
    line.at[line.now_ms + 3500] = lambda: peer.tell(messages.TRIP, codes.STOP, 255, 0, line.now_ms)

    robot, ending = ran(line, IfLost(stops=True))

    assert peer.stops >= 1
    assert ending.result == "link lost"
    assert ending.error().exit_code == 7
    assert "the robot was stopped, as asked" in str(ending.error())
    assert len(robot.interruptions()) == 1


def test_a_robot_that_restarted_meanwhile_is_noticed(peer, line):
    line.unplug(at_ms=1000, for_ms=1500)
    line.at[line.now_ms + 1600] = peer.restart

    _, ending = ran(line)

    assert ending.result == "link lost"
    assert "the robot restarted" in str(ending.error())


def test_another_robot_at_the_port_is_noticed(peer, line):
    other = FakeRobot(profile=PROFILE.replace(b'"circular"', b'"other"'))
    line.unplug(at_ms=1000, for_ms=1500)
    line.at[line.now_ms + 1600] = lambda: setattr(line, "robot", other)

    _, ending = ran(line)

    assert "another robot answers at this address now" in str(ending.error())
    assert [name for _, name, _ in other.orders if name != "hello"] == []


def test_a_log_says_when_the_line_was_interrupted_and_how_the_clocks_stood(tmp_path, line):
    line.unplug(at_ms=1000, for_ms=1500)
    with LogWriter(tmp_path / "run.mcap") as log, Robot(line, Keeper(log)) as robot:
        robot.connect()
        run(robot, HEADER, QUIET)

    rows = read_log(tmp_path / "run.mcap").rows["line"]

    assert [row["what"] for row in rows] == ["begins", "interrupted", "resumed", "ends"]
    assert rows[1]["cause"] == rows[2]["cause"] == "/dev/robot: the line broke"
    assert rows[3]["clock_offset_ms"] == pytest.approx(rows[3]["now_ms"] - rows[3]["host_ms"], abs=5)
    assert rows[3]["clock_bound_ms"] < 10
