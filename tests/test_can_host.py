"""The host's end of CAN: addresses, errors in one line, and lines over python-can's own virtual bus."""

from itertools import pairwise
from math import ceil

import can
import pytest

from host.canaddress import open_bus, parse
from host.canbus import CanBus
from host.canlane import GAP_MAX_S, GAP_S, WAKE_S, Lane
from host.canlink import CanLink, open_can, roll
from host.errors import BadRequest, LinkLost, NoRobot, PortAbsent, Silent, SoftrigError
from host.link import open_link
from host.robot import Robot
from protocol import frames, messages
from protocol.canbus import ALL, CLASSIC, FD, FROM_ROBOT, Assembler, CanFrame, Segmenter
from tests.fake_robot import STEP_MS, FakeRobot

NOW_MS = 1000


class VirtualBus:
    """A bus of python-can on a clock of the test's own: robots without a bench are served while the host waits."""

    def __init__(self, *robots: int, fd: bool = False) -> None:
        self.robots = {node: FakeRobot() for node in robots}
        self.sent: list[can.Message] = []
        self.now_ms = NOW_MS
        self.loss = 0
        self.broken: Exception | None = None
        self._mtu = FD if fd else CLASSIC
        self._cutters = {node: Segmenter(node, 1, True, self._mtu) for node in robots}
        self._assemblers = {node: Assembler(False) for node in robots}
        self._arriving: list[can.Message] = []
        self._heard: dict[int, bytes] = dict.fromkeys(robots, b"")
        self._next_ms = NOW_MS + STEP_MS

    def now_s(self) -> float:
        return self.now_ms / 1000

    def send(self, message: can.Message, timeout: float | None = None) -> None:
        if self.broken:
            raise self.broken
        self.sent.append(message)
        for node, assembler in self._assemblers.items():
            data = bytes(message.data)
            taken = assembler.feed(message.arbitration_id, message.is_extended_id, data, self.now_ms, message.is_fd)
            if taken and taken.robot in (node, ALL):
                self._heard[node] += taken.line

    def recv(self, timeout: float | None = None) -> can.Message | None:
        if self.broken:
            raise self.broken
        until_ms = self.now_ms + max(0, ceil((timeout or 0) * 1000 - 1e-6))
        while not self._arriving and self.now_ms < until_ms:
            self.now_ms += 1
            self._serve()
        return self._arriving.pop(0) if self._arriving else None

    def say(self, frame: CanFrame) -> None:
        self._arriving.append(
            can.Message(
                arbitration_id=frame.identifier, is_extended_id=frame.extended, data=frame.data,
                is_fd=self._mtu == FD,
            )
        )  # fmt: skip

    def error(self, kind: int) -> None:
        self._arriving.append(can.Message(arbitration_id=kind, is_error_frame=True, data=bytes(8)))

    def shutdown(self) -> None:
        self.broken = can.CanOperationError("the bus is shut down")

    def _serve(self) -> None:
        if self.now_ms < self._next_ms:
            return
        self._next_ms += STEP_MS
        for node, robot in self.robots.items():
            data, self._heard[node] = self._heard[node], b""
            for frame in self._cutters[node].feed(robot.step(self.now_ms, data)):
                self.say(frame)


def bus_with(*robots: int, fd: bool = False) -> CanBus:
    address = parse(f"can:virtual:test?fd={int(fd)}")
    return CanBus(VirtualBus(*robots, fd=fd), address)


@pytest.mark.parametrize(
    ("text", "interface", "channel", "node"),
    [
        ("can:slcan:/dev/pts/4@3", "slcan", "/dev/pts/4", 3),
        ("can:socketcand:127.0.0.1:29536@2", "socketcand", "127.0.0.1:29536", 2),
        ("can:socketcan:can0", "socketcan", "can0", ALL),
        ("can:softrig:circular@1,sphere-b@2@all", "softrig", "circular@1,sphere-b@2", ALL),
        ("can:softrig:circular?slope=10@1", "softrig", "circular?slope=10", 1),
        ("can:slcan:COM3@126?host=9", "slcan", "COM3", 126),
    ],
)
def test_an_address_names_interface_channel_and_robot(text, interface, channel, node):
    address = parse(text)

    assert (address.interface, address.channel, address.node) == (interface, channel, node)


def test_what_stands_after_the_question_mark_is_ours_or_goes_to_the_interface():
    address = parse("can:slcan:/dev/ttyACM0@3?host=9&bitrate=250000&fd=1&rtscts=1&name=x")

    assert (address.host, address.bitrate_hz, address.fd) == (9, 250_000, True)
    assert address.options == {"rtscts": 1, "name": "x"}


@pytest.mark.parametrize(
    "text",
    [
        "can:", "can:slcan", "can:slcan:", "can:slcan:x@0", "can:slcan:x@127", "can:slcan:x@999", "can:slcan:x?host=0",
        "can:slcan:x?host=a", "can:slcan:x?fd=2", "can:slcan:x?bitrate=fast", "can:slcan:x?bitrate=0", "can:slcan:x?y",
        "can:nonsense:x", "can:socketcand:here",
    ],
)  # fmt: skip
def test_an_address_that_cannot_be_is_refused_in_one_line(text):
    with pytest.raises(BadRequest) as refused:
        open_link(text)

    assert text in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("text", "kind", "words"),
    [
        ("can:slcan:/dev/no-such-port@1", PortAbsent, "no such channel"),
        ("can:socketcand:127.0.0.1:9@1", PortAbsent, "no such channel"),
        ("can:slcan:/dev/null@1?bitrate=123", SoftrigError, "/dev/null"),
        ("can:socketcan:no-such-can@1", NoRobot, "no-such-can"),
    ],
)
def test_a_bus_that_cannot_be_had_is_told_in_one_line(text, kind, words):
    with pytest.raises(kind) as refused:
        open_link(text)

    assert words in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("fd", [False, True])
def test_a_robot_is_commanded_over_classic_can_and_can_fd(fd):
    bus = bus_with(3, fd=fd)
    robot = Robot(CanLink(bus, 3))

    robot.connect()
    robot.arm()
    robot.fire(["A"], 500, 200)

    assert [name for _, name, _ in bus._bus.robots[3].orders][-2:] == ["arm", "fire"]
    assert {message.is_fd for message in bus._bus.sent} == {fd}


def test_the_only_robot_that_answers_is_found():
    link = CanLink(bus_with(5), ALL)

    Robot(link).connect()

    assert link.node == 5


def test_several_robots_that_answer_are_named():
    link = CanLink(bus_with(2, 7, 9), ALL)

    with pytest.raises(BadRequest, match="robots 2, 7, 9 answer: name one, as can:virtual:test@2"):
        Robot(link).connect()


def test_one_bus_carries_the_lines_of_several_robots():
    bus = bus_with(1, 2, 3)
    robots = [Robot(CanLink(bus, node)) for node in (1, 2, 3)]

    for robot in robots:
        robot.connect()
    robots[1].arm()

    armed = [bus._bus.robots[node].state == messages.ARMED for node in (1, 2, 3)]
    assert armed == [False, True, False]


def test_a_stop_goes_to_every_robot_before_all_that_waits_and_each_says_so():
    bus = bus_with(1, 2, 3)
    link = CanLink(bus, 2)
    robot = Robot(link)
    robot.connect()
    waiting = frames.encode(frames.seal(0x20, 1, 0, bytes(200), 0, 0))
    link.write(waiting)
    before = len(bus._bus.sent)

    stopped = robot.stop()

    assert bus._bus.sent[before].arbitration_id == 0
    assert stopped.state == "tripped"
    assert sorted(roll(link)) == [1, 2, 3]


def test_a_stop_is_one_frame_however_often_its_pattern_is_written():
    bus = bus_with()

    CanLink(bus, 1).write(frames.STOP * 3)

    assert [(m.arbitration_id, bytes(m.data), m.is_extended_id) for m in bus._bus.sent] == [(0, b"STOP", False)]


def test_a_line_of_no_robot_is_told_with_those_that_were_heard():
    bus = bus_with(4)
    bus._bus.robots[4].deaf = True
    bus._bus.say(CanFrame(FROM_ROBOT | 4 << 10 | 2 << 3 | 0x58 << 18, True, bytes(8)))

    with pytest.raises(Silent, match="robot 9 does not answer; on this bus: 4"):
        Robot(CanLink(bus, 9)).connect()


def test_a_bus_full_of_errors_raises_the_question_of_its_rate():
    bus = bus_with()
    for _ in range(5):
        bus._bus.error(0x80)

    with pytest.raises(Silent, match="is the bit rate right"):
        Robot(CanLink(bus, 9)).connect()


def test_an_adapter_that_stays_bus_off_is_a_lost_line():
    bus = bus_with(1)
    robot = Robot(CanLink(bus, 1))
    robot.connect()
    bus._bus.robots[1].deaf = True
    bus._bus.error(0x40)

    with pytest.raises(LinkLost, match="bus-off"):
        list(robot.listen(3000))


@pytest.mark.parametrize("error", [can.CanOperationError("gone\nwith more"), OSError(5, "Input/output error")])
def test_a_bus_that_breaks_is_a_lost_line_told_in_one_line(error):
    bus = bus_with(1)
    link = CanLink(bus, 1)
    bus._bus.broken = error

    for use in (lambda: link.read(link.now_s() + 1), lambda: link.write(frames.STOP)):
        with pytest.raises(LinkLost) as lost:
            use()
        assert "\n" not in str(lost.value)
    link.close()


def test_frames_for_other_hosts_and_strange_frames_are_passed_over():
    bus = bus_with(1)
    link = CanLink(bus, 1)
    body = frames.encode(frames.seal(messages.ALIVE.number, 0, 0, bytes(5), 0, 0))
    for frame in (*Segmenter(1, 9, True).feed(body), CanFrame(0x7FF, False, b"\x01"), CanFrame(1, True, b"")):
        bus._bus.say(frame)

    assert link.read(link.now_s() + 0.1) == b""


def test_the_segments_of_a_body_keep_their_distance():
    bus = bus_with(1)
    link = CanLink(bus, 1)
    times = []
    real = bus._bus.send
    bus._bus.send = lambda message, timeout=None: (times.append(bus._bus.now_ms), real(message))

    link.write(frames.encode(frames.seal(0x20, 1, 0, bytes(range(40)), 0, 0)))
    link.close()

    gaps = [later - earlier for earlier, later in pairwise(times)]
    assert gaps[0] == WAKE_S * 1000
    assert set(gaps[1:]) == {GAP_S * 1000}


def test_a_frame_that_is_sent_again_widens_the_distance_and_many_that_are_not_narrow_it():
    lane, frame = Lane(), CanFrame(1, True, b"")
    again = frames.encode(frames.seal(0x20, 0, 0, b"", 0, frames.RELIABLE))[:-1]

    for _ in range(5):
        lane.notice(again)
    waiting = lane._gap_s
    for _ in range(5):
        lane.notice(again)
        lane.add(frame)
        lane.pop(0)
    widest = lane._gap_s
    for at in range(400):
        lane.add(frame)
        lane.pop(at / 100)

    assert waiting == GAP_S  # the first has not even left
    assert widest == GAP_MAX_S
    assert lane._gap_s == GAP_S


def test_the_last_line_that_is_closed_closes_the_bus():
    bus = bus_with(1, 2)
    one, two = CanLink(bus, 1), CanLink(bus, 2)

    one.close()
    one.close()
    assert bus._bus.broken is None
    two.close()
    assert bus._bus.broken is not None


def test_a_bus_of_python_can_without_a_clock_of_its_own_goes_by_the_monotonic_one():
    other = open_bus(parse("can:virtual:real"))
    link = open_can("can:virtual:real@1")
    body = frames.encode(frames.seal(messages.STOPPED.number, 0, 0, bytes(11), 0, 0))
    for frame in Segmenter(1, ALL, True).feed(body):
        other.send(can.Message(arbitration_id=frame.identifier, data=frame.data))

    assert link.read(link.now_s() + 5) == body
    assert not link.repeatable
    assert link.observer is None
    link.close()
    other.shutdown()
