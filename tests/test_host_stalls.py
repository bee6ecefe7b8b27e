"""A robot whose clock stands still for a while, as that of a bench on a busy machine does: it has not restarted."""

import pytest

from host.errors import LinkLost
from host.records import Telemetry
from host.robot import Robot
from tests.fake_robot import FakeLine, FakeRobot


@pytest.fixture
def peer():
    return FakeRobot()


@pytest.fixture
def line(peer):
    return FakeLine(peer)


@pytest.fixture
def robot(line):
    robot = Robot(line)
    robot.connect()
    list(robot.listen(1000))
    return robot


def stall(peer, time_ms):
    """Have the robot stand still for that long from now on; what arrives meanwhile waits for it."""
    step, until_ms, waiting = peer.step, peer.now_ms + time_ms, []

    def still(now_ms, data):
        waiting.append(data)
        if now_ms < until_ms:
            return b""
        peer.step = step
        peer.started_ms += time_ms
        return step(now_ms, b"".join(waiting))

    peer.step = still


def stalled(peer, robot):
    """Return when telemetry has come that was made after a stall, and no answer about the clock yet."""
    robot.subscribe(5000)  # so that silence is no reason to ask
    list(robot.listen(5100))
    peer.deaf = True
    list(robot.listen(1000))
    peer.deaf = False
    peer.started_ms += 1000
    peer.telemetry()
    robot.talk.wait(lambda: robot.talk.session.hearing.keeper.doubts)


def hellos(peer):
    return [time_ms for time_ms, name, _ in peer.orders if name == "hello"]


@pytest.mark.parametrize("stall_ms", [300, 2000])
@pytest.mark.parametrize("period_ms", [0, 50])
def test_a_robot_that_stood_still_goes_on(peer, robot, stall_ms, period_ms):
    robot.endure(5000)
    robot.subscribe(period_ms)
    list(robot.listen(200))

    stall(peer, stall_ms)

    assert robot.status().uptime_ms < robot.now_ms() - stall_ms + 50
    assert len([record for record in robot.listen(2000) if isinstance(record, Telemetry)]) >= (30 if period_ms else 0)


@pytest.mark.parametrize("late_ms", [300, 2000])
@pytest.mark.parametrize("period_ms", [0, 50])
def test_a_clock_that_stood_still_while_the_robot_talked_is_no_restart(peer, robot, late_ms, period_ms):
    robot.subscribe(period_ms)
    list(robot.listen(3000))
    for _ in range(late_ms // 5):
        peer.started_ms += 5
        list(robot.listen(5))

    assert robot.status().state == "idle"
    list(robot.listen(2000))
    assert robot.robot_ms() == pytest.approx(peer.uptime_ms, abs=10)


def test_a_clock_that_is_behind_has_the_robot_asked_at_once_who_it_is(peer, robot):
    before = len(hellos(peer))

    stalled(peer, robot)
    list(robot.listen(100))

    assert len(hellos(peer)) == before + 1
    assert robot.status().state == "idle"


def test_a_robot_in_doubt_that_has_another_number_has_restarted(peer, robot):
    stalled(peer, robot)
    peer.boot += 1

    with pytest.raises(LinkLost, match="restarted"):
        list(robot.listen(100))


def test_a_robot_in_doubt_whose_answer_is_earlier_than_what_it_told_has_restarted(peer, robot):
    """Its telemetry was not: it might have been late on its way."""
    stalled(peer, robot)
    peer.started_ms += 300

    with pytest.raises(LinkLost, match="restarted"):
        list(robot.listen(100))


def test_a_robot_whose_clock_runs_at_half_speed_keeps_its_session(peer, robot):
    robot.arm()
    robot.subscribe(50)

    for _ in range(1000):
        peer.started_ms += 5
        list(robot.listen(10))

    assert robot.status().state == "armed"
    assert robot.statistics()["clock_bound_ms"] is None
