"""The blocking face of a robot: orders, uploads, watching, and leaving with every coil off."""

import pytest

from hil_sim.link import open_link
from host.errors import BadRequest, Interrupted, LinkLost, Refused
from host.records import Event, Telemetry
from host.robot import Robot
from host.run import run
from protocol import codes, messages, program
from tests.fake_robot import FakeLine, FakeRobot

CODE = program.fire(1, 600, 300) + program.delay(300) + program.halt()
PROGRAM = program.header(CODE, 0) + CODE


@pytest.fixture
def peer():
    return FakeRobot()


@pytest.fixture
def line(peer):
    return FakeLine(peer)


def names(peer) -> list[str]:
    return [name for _, name, _ in peer.orders]


def quiet(stage: str, done: float) -> None:
    pass


def test_a_program_is_uploaded_run_watched_and_left_disarmed(peer, line):
    with Robot(line) as robot:
        robot.connect()
        ending = run(robot, PROGRAM, quiet)

    assert ending.result == "done"
    assert ending.error() is None
    assert bytes(peer.code) == CODE
    assert names(peer)[-1] == "disarm"
    assert line.closed


def test_a_long_program_arrives_whole_over_a_bad_line(peer):
    code = b"".join(program.delay(i) for i in range(400)) + program.halt()
    taken = []
    robot = Robot(FakeLine(peer, loss=0.15, seed=5))
    robot.connect()

    robot.upload(program.header(code, 0), code, taken.append)

    assert bytes(peer.code) == code
    assert taken[-1] == len(code)


@pytest.mark.parametrize(
    ("ending", "result", "status"),
    [
        ((messages.ABORTED, codes.WAIT_TIMEOUT, 255, 4000), "timeout", 1),
        ((messages.TRIP, codes.GUARD, 0, 1100), "guard", 1),
        ((messages.TRIP, codes.OVER_TEMPERATURE, 0, 1210), "fault", 6),
        ((messages.TRIP, codes.STOP, 255, 0), "stopped", 6),
        ((messages.DISARMED, codes.LEASE_EXPIRED, 255, 500), "lease", 7),
    ],
)
def test_every_bad_ending_has_a_word_and_an_exit_status(peer, line, ending, result, status):
    peer.ending = ending
    robot = Robot(line)
    robot.connect()

    got = run(robot, PROGRAM, quiet)

    assert got.result == result
    assert got.error().exit_code == status


def test_a_cable_cut_in_the_middle_ends_the_run_as_link_lost(line):
    robot = Robot(line)
    robot.connect()
    line.at[line.now_ms + 400] = lambda: setattr(line, "cut", True)

    ending = run(robot, PROGRAM, quiet)

    assert ending.result == "link lost"
    assert ending.error().exit_code == 7


def test_watching_yields_telemetry_and_events_up_to_the_end(line):
    robot = Robot(line)
    robot.connect()
    robot.subscribe(50)
    robot.arm()
    robot.start()

    records = list(robot.watch())

    assert [record.event for record in records if isinstance(record, Event)] == ["started", "finished"]
    assert len([record for record in records if isinstance(record, Telemetry)]) == pytest.approx(10, abs=2)


def test_a_program_that_ends_without_a_word_does_not_hang_the_host(peer, line):
    robot = Robot(line)
    robot.connect()
    robot.subscribe(50)
    robot.start()
    peer.state, peer._ends_ms = messages.IDLE, None

    with pytest.raises(LinkLost, match="was lost"):
        list(robot.watch())


def test_leaving_by_an_error_disarms(peer, line):
    def careless() -> None:
        with Robot(line) as robot:
            robot.connect()
            robot.arm()
            robot.fire(["A"], 600, 5000)
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        careless()

    assert names(peer)[-1] == "disarm"
    assert peer.duty == [0] * 8


def test_leaving_stops_a_robot_that_does_not_answer_to_disarm(peer, line):
    with Robot(line) as robot:
        robot.connect()
        robot.arm()
        peer._serve = lambda received, now_ms: None

    assert peer.stops >= 1


def test_leaving_over_a_cut_cable_raises_the_first_error(line):
    def cut_short() -> None:
        with Robot(line) as robot:
            robot.connect()
            robot.arm()
            line.cut = True
            robot.fire(["A"], 600, 100)

    with pytest.raises(LinkLost):
        cut_short()

    assert line.closed


def test_an_interrupt_sends_stop_and_says_what_was_acknowledged(peer, line):
    def interrupted() -> None:
        with Robot(line) as robot:
            robot.connect()
            robot.arm()
            robot.fire(["A", "E"], 600, 5000)
            raise KeyboardInterrupt

    with pytest.raises(
        Interrupted, match=r"stop acknowledged, coils A E were on and are off now.*tripped \(F01\)"
    ) as caught:
        interrupted()

    assert caught.value.exit_code == 130
    assert peer.duty == [0] * 8
    assert line.closed


def test_an_interrupt_of_a_robot_that_is_deaf_says_so(peer, line):
    def interrupted() -> None:
        with Robot(line) as robot:
            robot.connect()
            peer.deaf = True
            raise KeyboardInterrupt

    with pytest.raises(Interrupted, match="sent but not acknowledged"):
        interrupted()


def test_an_interrupt_before_the_hello_is_answered_still_stops(peer, line):
    def interrupted() -> None:
        with Robot(line):
            raise KeyboardInterrupt

    with pytest.raises(Interrupted, match="stop acknowledged, no coil was on"):
        interrupted()

    assert names(peer) == []


def test_an_unknown_coil_is_refused_before_anything_is_sent(peer, line):
    robot = Robot(line)
    robot.connect()

    with pytest.raises(BadRequest, match="no coil Z on circular: it has A B C D E F G H, groups all bottom front"):
        robot.fire(["A", "Z"], 600, 100)

    assert "fire" not in names(peer)


def test_a_group_stands_for_its_coils(peer, line):
    robot = Robot(line)
    robot.connect()

    robot.fire(["all"], 100, 100)

    assert peer.orders[-1][2].coils == 0xFF


def test_a_refused_arm_leaves_nothing_to_disarm(peer, line):
    peer.refuse["arm"] = (codes.TRIPPED, 255, 105, 0)

    def refused() -> None:
        with Robot(line) as robot:
            robot.connect()
            robot.arm()

    with pytest.raises(Refused, match="R02"):
        refused()

    assert "disarm" not in names(peer)


def test_a_robot_that_is_latched_says_which_fault_it_was(peer, line):
    peer.refuse["arm"] = (codes.TRIPPED, 255, codes.SUPPLY_LOW, 0)
    robot = Robot(line)
    robot.connect()

    with pytest.raises(Refused) as caught:
        robot.arm()

    assert str(caught.value) == (
        "arm refused: R02 The robot has tripped and is latched: F07 The supply voltage is below its limit. "
        "See the fault, mend its cause, then `softrig clear`."
    )


def test_a_fault_of_a_newer_robot_is_left_out_of_the_refusal(peer, line):
    peer.refuse["arm"] = (codes.TRIPPED, 255, 999, 0)
    robot = Robot(line)
    robot.connect()

    with pytest.raises(Refused, match=r"R02 The robot has tripped and is latched\. See"):
        robot.arm()


@pytest.mark.parametrize("name", ["", " ", "A\n", "A\x1b[2J"])
def test_a_coil_that_cannot_be_printed_is_refused_in_one_line(line, name):
    robot = Robot(line)
    robot.connect()

    with pytest.raises(BadRequest) as caught:
        robot.fire([name], 600, 100)

    assert str(caught.value) == f"no coil {name!r} on circular: it has A B C D E F G H, groups all bottom front"


def test_every_byte_is_kept_with_both_clocks(line):
    class Kept:
        lines: list = []  # noqa: RUF012
        records: list = []  # noqa: RUF012
        news: list = []  # noqa: RUF012

        def line(self, *row):
            self.lines.append(row)

        def record(self, record):
            self.records.append(record)

        def link(self, news):
            self.news.append(news)

    kept = Kept()
    robot = Robot(line, kept)
    robot.connect()
    robot.subscribe(50)
    list(robot.listen(200))

    assert b"".join(data for direction, data, _, _ in kept.lines if direction == "out") == line.written
    assert kept.lines[-1][2] - kept.lines[-1][3] == pytest.approx(0, abs=5)
    assert len(kept.records) == pytest.approx(4, abs=1)


def test_a_program_starts_at_once_at_a_time_of_the_robot_or_at_the_next_sync(peer, line):
    robot = Robot(line)
    robot.connect()

    robot.start()
    robot.start(at_ms=robot.robot_ms() + 500)
    robot.ready()

    at_once, later, ready = [order.at_ms for _, name, order in peer.orders if name == "start"]
    assert at_once == messages.AT_ONCE
    assert later == pytest.approx(peer.uptime_ms + 500, abs=20)
    assert ready == messages.AT_SYNC


def test_a_program_that_begins_later_is_watched_until_it_ends():
    """It waits for longer than a host waits for the word that a program has ended."""
    code = program.fire(1, 300, 200) + program.halt()
    with Robot(open_link("sim:circular?body=still")) as robot:
        robot.connect()
        robot.subscribe(100)
        robot.upload(program.header(code, robot.profile.crc), code)
        robot.arm()

        robot.start(at_ms=robot.robot_ms() + 5000)
        events = [record.event for record in robot.watch() if isinstance(record, Event)]

    assert events == ["accepted", "started", "finished"]
