"""Who may only watch gets telemetry too: the usual variables, asked for from no session, at nobody's cost."""

import pytest

from hil_sim.link import open_link
from host.errors import Refused
from host.records import Telemetry
from host.robot import Robot
from protocol import codes, frames, messages, variables
from tests.fake_robot import FakeLine, FakeRobot
from tests.firmware_bench import SESSION, Rig


@pytest.fixture
def rig():
    return Rig()


def watched(rig, ms):
    """Return the records for watchers that come within that time."""
    return [body for name, body in rig.run(ms) if name == "telemetry" and body.slot == 4]


def test_a_watcher_gets_the_usual_variables_for_two_seconds_while_another_holds_the_lease(rig):
    rig.arm()
    rig.say(messages.WATCH, period_ms=100)

    records = watched(rig, 4000)

    assert len(records) == pytest.approx(20, abs=1)
    values = variables.unpack(
        variables.USUAL, variables.veiled(records[0].values), variables.counts(rig.core.channels.count)
    )
    assert values[variables.USUAL.index(variables.number("state"))] == messages.ARMED
    assert rig.core.session == SESSION
    assert rig.core.reports.subscriptions.active == []


def test_a_watcher_gets_no_more_than_twenty_records_a_second(rig):
    rig.say(messages.WATCH, period_ms=0)

    assert len(watched(rig, 1000)) == pytest.approx(20, abs=1)


def test_to_watch_renews_no_lease(rig):
    rig.arm()

    for _ in range(10):
        rig.host.post(messages.WATCH.number, messages.WATCH.packed(100))
        rig.run(100, silent=True, line=rig.host.poll(rig.now_ms))

    assert rig.core.state == messages.IDLE


def test_a_host_that_may_only_watch_asks_again_until_it_goes():
    peer = FakeRobot()
    peer.role = messages.VIEWER
    line = FakeLine(peer)
    robot = Robot(line)
    robot.connect(watch_only=True)

    robot.overhear(100)
    list(robot.listen(3000))
    asked = [now_ms for now_ms, name, _ in peer.orders if name == "watch"]
    robot.overhear(0)
    list(robot.listen(2000))

    assert len(asked) == 4
    assert [name for _, name, _ in peer.orders].count("watch") == 4
    with pytest.raises(Refused) as refused:
        robot.subscribe(50)
    assert refused.value.code == codes.LEASE_HELD


def test_what_a_stranger_asked_for_reaches_everybody_on_the_line():
    line = open_link("sim:circular?body=still")
    robot = Robot(line)
    robot.connect()
    robot.arm()

    line.write(frames.encode(frames.seal(messages.WATCH.number, 0, 0, messages.WATCH.packed(100), 0, 0)))
    records = [record for record in robot.listen(1000) if isinstance(record, Telemetry)]

    assert len(records) == pytest.approx(10, abs=1)
    assert {record.state for record in records} == {"armed"}
