"""A host's session with a robot: over good lines, bad lines and lines that end, on a virtual clock."""

import random
from contextlib import suppress
from itertools import pairwise

import pytest

from hil_sim.faults.happening import schedule
from hil_sim.link import open_link
from host.definitions import dictionary_of
from host.errors import (
    DictionaryMismatch,
    LinkLost,
    Mismatch,
    NotOurs,
    Refused,
    RobotFault,
    Silent,
)
from host.records import Event, Telemetry
from host.robot import Robot
from protocol import codes, frames, messages
from tests.fake_robot import LABELS, PROFILE, FakeLine, FakeRobot


@pytest.fixture
def peer():
    return FakeRobot()


@pytest.fixture
def line(peer):
    return FakeLine(peer)


def connected(line) -> Robot:
    robot = Robot(line)
    robot.connect()
    assert list(robot.listen(20)) == []  # the robot takes up the session with its first frame
    return robot


def test_a_session_learns_the_robot_from_the_robot(line):
    robot = connected(line)

    assert robot.profile.labels == tuple(LABELS)
    assert robot.dictionary.endswith(PROFILE)
    assert robot.info()["firmware"] == "softrig 0.1.0"


def test_connecting_takes_less_than_a_tenth_of_a_second_on_a_quick_line(line):
    connected(line)

    assert line.now_ms - 1000 <= 100


@pytest.mark.parametrize("seed", range(5))
def test_every_order_arrives_exactly_once_although_a_fifth_of_the_frames_is_lost(peer, seed):
    robot = connected(FakeLine(peer, loss=0.2, seed=seed))
    robot.arm()

    for hold_ms in range(100, 130):
        robot.fire(["A", "C"], duty_permille=600, hold_ms=hold_ms)

    fired = [order.hold_ms for _, name, order in peer.orders if name == "fire"]
    assert fired == list(range(100, 130))
    assert robot.statistics()["frames_resent"] > 0


def test_a_robot_with_another_table_of_messages_is_refused_and_the_lines_are_named():
    table, profile = dictionary_of(PROFILE).split(b"\n\n", 1)
    other = table.replace(b"[0..1000] hold_ms:H", b"[0..1000] hold_ms:I") + b"\n\n" + profile
    robot = Robot(FakeLine(FakeRobot(dictionary=other)))

    with pytest.raises(DictionaryMismatch) as caught:
        robot.connect()

    assert caught.value.exit_code == 5
    assert caught.value.lines == [
        "- 20 fire coils:I duty_permille:H[0..1000] hold_ms:H",
        "+ 20 fire coils:I duty_permille:H[0..1000] hold_ms:I",
    ]


def test_a_robot_of_another_protocol_version_is_refused(peer, line):
    peer._hello = lambda order: peer._post(messages.NAK, kind=1, code=codes.OTHER_VERSION, version=3)

    with pytest.raises(Mismatch, match="version 3 of the protocol, this host 2: update the softrig"):
        connected(line)


def test_a_robot_that_answers_in_another_version_is_refused(peer, line):
    peer._post = lambda message, **values: FakeRobot._post(peer, message, **{**values, "version": 0})

    with pytest.raises(Mismatch, match="update the robot's firmware"):
        connected(line)


def test_a_profile_that_lacks_a_limit_is_a_mismatch():
    robot = Robot(FakeLine(FakeRobot(profile=PROFILE.replace(b"trip_degc", b"trip_degf"))))

    with pytest.raises(Mismatch, match="trip_degc"):
        robot.connect()


def test_a_dictionary_that_never_fits_its_checksum_is_a_mismatch(peer, line):
    peer.seed += 1

    with pytest.raises(Mismatch, match="checksum"):
        connected(line)


def test_a_robot_that_gets_another_firmware_between_two_pages_is_learnt_anew(peer, line):
    peer.seed += 1
    line.at[1015] = lambda: setattr(peer, "seed", peer.seed - 1)

    assert connected(line).profile.labels == tuple(LABELS)


def test_a_refusal_says_what_was_asked_what_is_allowed_and_what_to_do(peer, line):
    peer.refuse["fire"] = (codes.DUTY_LIMIT, 2, 900, 800)
    robot = connected(line)

    with pytest.raises(Refused) as caught:
        robot.fire(["C"], duty_permille=900, hold_ms=100)

    assert caught.value.exit_code == 4
    assert str(caught.value).startswith(
        "fire (coil C) refused: R04 The duty is above the coil's limit. 900 permille, at most 800."
    )


def test_a_port_where_nobody_answers_is_silent(peer, line):
    peer.deaf = True

    with pytest.raises(Silent, match="is the robot switched on"):
        connected(line)

    assert line.now_ms - 1000 == pytest.approx(3000, abs=10)


def test_something_that_talks_otherwise_is_not_ours(line):
    line.robot.step = lambda now_ms, data: b"$GPGGA,123519,4807.038,N\r\n"

    with pytest.raises(NotOurs, match="check the port and its baud rate") as caught:
        connected(line)

    assert caught.value.exit_code == 3


def test_random_bytes_never_raise(peer, line):
    robot, noise = connected(line), random.Random(7)
    robot.subscribe(50)

    for _ in range(200):
        robot.talk.session.receive(noise.randbytes(100), robot.talk.now_us())

    assert robot.status().state == "idle"


def test_the_host_keeps_its_lease_alive_at_least_every_tenth_of_a_second(peer, line):
    robot = connected(line)
    robot.arm()
    heard = []
    receive = peer.link.receive
    peer.link.receive = lambda data, now_ms: (heard.append(now_ms) if data else None, receive(data, now_ms))[1]

    list(robot.listen(2000))

    gaps = [later - earlier for earlier, later in pairwise(heard)]
    assert max(gaps) <= 105


def test_a_session_that_holds_no_lease_sends_nothing_unasked(line):
    robot = connected(line)
    list(robot.listen(100))
    before = len(line.written)

    list(robot.listen(3000))

    assert len(line.written) == before


def test_a_robot_that_falls_silent_is_asked_and_then_given_up(peer, line):
    robot = connected(line)
    robot.subscribe(50)
    peer.deaf = True
    start_ms = line.now_ms

    with pytest.raises(LinkLost, match="fallen silent") as caught:
        list(robot.listen(10000))

    assert caught.value.exit_code == 7
    assert line.now_ms - start_ms == pytest.approx(2000, abs=60)


def test_a_robot_that_restarts_is_noticed(peer, line):
    robot = connected(line)
    robot.subscribe(50)
    peer.restart()

    with pytest.raises(LinkLost, match="restarted"):
        list(robot.listen(5000))


def test_a_robot_that_was_restarted_by_its_watchdog_is_a_fault(peer, line):
    robot = connected(line)
    robot.subscribe(50)
    peer.restart()
    peer.state = messages.TRIPPED

    with pytest.raises(RobotFault, match="F12"):
        list(robot.listen(5000))


def test_a_restart_is_noticed_within_a_second_although_the_number_of_the_start_repeats(peer, line):
    robot = connected(line)
    robot.subscribe(50)
    peer.restart(boot=peer.boot)
    start_ms = line.now_ms

    with pytest.raises(LinkLost, match="restarted"):
        list(robot.listen(5000))

    assert line.now_ms - start_ms <= 1000


def test_a_restart_is_noticed_by_the_first_telemetry_whose_clock_has_begun_anew(peer, line):
    robot = connected(line)
    robot.subscribe(50)
    peer.restart(boot=peer.boot)
    peer.period_ms = 50
    start_ms = line.now_ms

    with pytest.raises(LinkLost, match="restarted"):
        list(robot.listen(5000))

    assert line.now_ms - start_ms <= 60


def test_a_restart_is_noticed_by_an_event_older_than_the_one_before(peer, line):
    robot = connected(line)
    peer.tell(messages.STEP, 0, 255, 0, 9000)
    list(robot.listen(50))
    peer.tell(messages.STEP, 0, 255, 0, 20)

    with pytest.raises(LinkLost, match="restarted"):
        list(robot.listen(5000))


def test_a_restart_is_noticed_by_the_time_in_the_status(peer, line):
    robot = connected(line)
    peer.started_ms = peer.now_ms

    with pytest.raises(LinkLost, match="restarted"):
        robot.status()


def test_a_restart_is_noticed_by_the_time_in_the_answer_to_a_stop(peer, line):
    robot = connected(line)
    peer.started_ms = peer.now_ms
    peer.state = messages.TRIPPED
    robot.stop()

    with pytest.raises(RobotFault, match="F12"):
        robot.status()


def test_a_clock_that_wraps_is_no_restart(peer, line):
    peer.started_ms = line.now_ms - (1 << 32) + 2000
    robot = connected(line)
    robot.subscribe(50)

    times = [record.now_ms for record in robot.listen(5000)]

    assert times[0] > times[-1]
    assert robot.status().uptime_ms < 5000


def test_telemetry_that_comes_late_is_no_restart(peer, line):
    robot = connected(line)
    robot.subscribe(50)
    for at_ms in range(1500, 4000, 100):
        line.at[at_ms] = lambda: peer.telemetry(late_ms=300)

    assert len(list(robot.listen(4000))) > 100


def test_a_host_that_was_held_up_takes_what_waited_for_it_for_no_restart(peer, line):
    robot = connected(line)
    robot.subscribe(50)
    list(robot.listen(200))

    line.unread(10_000)

    assert len(list(robot.listen(1000))) > 200


def test_an_event_that_was_long_on_its_way_is_no_restart(peer, line):
    peer.started_ms = -60_000
    robot = connected(line)
    robot.subscribe(50)
    list(robot.listen(200))
    peer.tell(messages.STEP, 0, 255, 0, peer.uptime_ms - 20_000)

    assert any(isinstance(record, Event) for record in robot.listen(1000))


def test_clocks_that_run_apart_are_no_restart(peer, line):
    robot = connected(line)
    robot.subscribe(5000)

    for _ in range(20):
        peer.started_ms += 30  # 300 ppm of 100 s
        assert list(robot.listen(100_000))

    assert robot.robot_ms() == pytest.approx(peer.uptime_ms, abs=30)


def test_a_robot_on_the_bench_that_is_reset_is_noticed_within_a_second():
    link = open_link("sim:circular")
    robot = connected(link)
    robot.subscribe(50)
    schedule(link.bench, link.bench.clock.now_us + 300_000, "reset")
    start_s = link.now_s()

    with pytest.raises(RobotFault, match="F12"):
        list(robot.listen(5000))

    assert link.now_s() - start_s <= 0.3 + 1


def test_an_order_without_an_answer_ends_the_session(peer, line):
    robot = connected(line)
    peer.deaf = True

    with pytest.raises(LinkLost, match="fallen silent"):
        robot.arm()


@pytest.mark.parametrize("period_ms", [0, 50])
def test_a_robot_that_greets_but_never_answers_is_given_up_after_five_seconds(peer, line, period_ms):
    robot = connected(line)
    robot.subscribe(period_ms)
    obey = peer._serve
    peer._serve = lambda received, now_ms: obey(received, now_ms) if received.kind == messages.HELLO.number else None
    start_ms = line.now_ms

    with pytest.raises(LinkLost, match="frames_resent"):
        robot.status()

    assert line.now_ms - start_ms <= 5300


def test_a_robot_that_only_greets_has_fallen_silent(peer, line):
    robot = connected(line)
    robot.subscribe(50)
    peer.period_ms = 0

    with pytest.raises(LinkLost, match="fallen silent"):
        list(robot.listen(10_000))


def test_a_restart_is_noticed_by_an_order_although_the_robot_acknowledges_it(peer, line):
    robot = connected(line)
    robot.status()
    peer.restart(boot=peer.boot)
    start_ms = line.now_ms

    with pytest.raises(LinkLost, match="restarted"):
        robot.status()

    assert line.now_ms - start_ms <= 1000


def test_a_robot_that_may_be_quiet_for_long_is_not_taken_for_silent(peer, line):
    robot = connected(line)
    robot.subscribe(3000)

    assert len(list(robot.listen(30_000))) == pytest.approx(10, abs=1)


def test_a_refused_subscription_lets_nothing_be_expected(peer, line):
    peer.refuse["subscribe"] = (codes.BAD_PAYLOAD, 255, 0, 0)
    robot = connected(line)
    with pytest.raises(Refused):
        robot.subscribe(50)

    assert list(robot.listen(5000)) == []


@pytest.mark.parametrize("period_ms", [0, 50])
def test_a_cable_that_was_cut_for_long_never_holds_the_host_up(period_ms):
    link = open_link("sim:circular")
    robot = connected(link)
    robot.subscribe(period_ms)
    for at_s, fault in ((0.5, "estop-open"), (0.51, "cable-cut"), (15.5, "cable-join")):
        schedule(link.bench, round((link.now_s() + at_s) * 1e6), fault)
    link.bench.run(16)
    start_s = link.now_s()

    with suppress(LinkLost):
        assert robot.status().code == codes.ESTOP

    assert link.now_s() - start_s <= 5.3


def test_telemetry_is_decoded_with_both_clocks(line):
    robot = connected(line)
    robot.subscribe(50)
    robot.fire(["B"], duty_permille=600, hold_ms=500)

    record = [record for record in robot.listen(200) if isinstance(record, Telemetry)][-1]

    assert record.duty_permille[1] == 600
    assert record.temperature_degc[:2] == (25.0, 85.0)
    assert record.board_degc == 23.1
    assert 0 <= record.host_ms - record.now_ms <= 5


def test_the_clocks_are_compared_by_the_frame_that_was_quickest(peer, line):
    robot = connected(line)
    for late_ms in (40, 0, 25):
        peer.tell(messages.STEP, 0, 255, 0, line.now_ms + 7000 - late_ms)
        list(robot.listen(50))

    assert robot.robot_ms() == pytest.approx(line.now_ms + 7000, abs=5)


def test_a_lost_telemetry_record_is_counted(peer):
    robot = connected(FakeLine(peer, loss=0.1, seed=3))
    robot.subscribe(10)

    received = [record for record in robot.listen(5000) if isinstance(record, Telemetry)]

    made = (received[-1].now_ms - received[0].now_ms) / 10 + 1
    assert len(received) + robot.statistics()["telemetry_missed"] == pytest.approx(made, abs=5)
    assert robot.statistics()["telemetry_missed_by_slot"] == {"0": robot.statistics()["telemetry_missed"]}


def test_a_second_host_may_watch_but_gives_no_orders_and_renews_no_lease(peer, line):
    peer.role = messages.VIEWER
    robot = connected(line)
    before = len(line.written)

    with pytest.raises(Refused, match="R06"):
        robot.arm()
    peer.tell(messages.STEP, 0, 255, 0, line.now_ms)
    list(robot.listen(1000))

    assert len(line.written) == before


def test_a_host_waits_a_moment_for_the_lease_of_one_that_has_gone(peer, line):
    peer.role = messages.VIEWER
    line.at[1600] = lambda: setattr(peer, "role", messages.HOLDER)

    robot = connected(line)

    assert robot.info()["may_arm"]


def test_stop_needs_no_hello(peer, line):
    stopped = Robot(line).stop()

    assert peer.stops >= 1
    assert stopped.state == "tripped"
    assert [name for _, name, _ in peer.orders] == []
    assert line.written.startswith(frames.STOP * 3)


def test_stop_is_repeated_until_it_is_answered(peer):
    stopped = Robot(FakeLine(peer, loss=0.6, seed=2)).stop()

    assert stopped.state == "tripped"


def test_a_stop_that_nobody_answers_says_so(peer, line):
    peer.deaf = True

    with pytest.raises(Silent, match="switch its supply off by hand"):
        Robot(line).stop()


def test_events_come_once_and_in_order_over_a_bad_line(peer):
    robot = connected(FakeLine(peer, loss=0.2, seed=4))
    robot.status()
    for value in range(12):
        peer.tell(messages.STEP, 0, 255, value, 0)

    values = [record.value for record in robot.listen(4000) if isinstance(record, Event)]

    assert values == list(range(12))
