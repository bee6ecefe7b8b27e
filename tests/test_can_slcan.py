"""The slcan adapter of the bench: its protocol byte by byte, and python-can's slcan interface on a real terminal."""

import can
import pytest
import serial
from can import Message
from hypothesis import given
from hypothesis import strategies as st

from hil_sim.can.desk import CanDesk
from hil_sim.can.ports import SlcanPort
from hil_sim.can.slcan import LINE_MAX, Slcan
from hil_sim.devices.canframe import Frame
from tests.can_served import PATIENCE_S, Echo, frames_heard, next_frame, serving


class Rig:
    """An adapter and another node on one bus."""

    def __init__(self) -> None:
        self.desk = CanDesk()
        self.adapter = Slcan(self.desk)
        self.other = self.desk.host(500_000)

    def run_ms(self, ms: int = 10) -> None:
        self.desk.clock.run_until(self.desk.clock.now_us + 1000 * ms)

    def heard(self) -> list[Frame]:
        """Return what the other node has heard by some time from now."""
        self.run_ms()
        return frames_heard(self.other)


@pytest.fixture
def rig():
    return Rig()


@pytest.mark.parametrize(
    ("command", "frame", "answer"),
    [
        (b"t1230", Frame(0x123), b"z\r"),
        (b"t7FF3010aFF", Frame(0x7FF, b"\x01\x0a\xff"), b"z\r"),
        (b"T1ABCDEF58" + b"00" * 8, Frame(0x1ABCDEF5, bytes(8), extended=True), b"Z\r"),
        (b"r1235", Frame(0x123, remote=True, length=5), b"z\r"),
        (b"R000001230", Frame(0x123, extended=True, remote=True, length=0), b"Z\r"),
    ],
)
def test_a_command_to_send_puts_its_frame_on_the_bus(rig, command, frame, answer):
    assert rig.adapter.take(b"O\r" + command + b"\r") == b"\r" + answer

    assert rig.heard() == [frame]


def test_a_received_frame_comes_by_itself_in_capitals(rig):
    rig.adapter.take(b"O\r")
    for frame in (
        Frame(0x12, b"\xab\x01"),
        Frame(0x1ABCDEF5, extended=True),
        Frame(0x7FF, remote=True, length=8),
        Frame(0x1F, extended=True, remote=True, length=2),
    ):
        rig.other.send(frame)
    rig.run_ms()

    assert rig.adapter.told() == b"t0122AB01\rT1ABCDEF50\rr7FF8\rR0000001F2\r"
    assert rig.adapter.told() == b""


def test_a_command_may_come_in_pieces_and_with_line_feeds(rig):
    assert rig.adapter.take(b"O\r\nt1") == b"\r"
    assert rig.adapter.take(b"23") == b""
    assert rig.adapter.take(b"0\rV\n\r") == b"z\rV1013\r"


@pytest.mark.parametrize(
    "command",
    [
        b"t123", b"t1239", b"t1231", b"t12310", b"t1231001", b"t8000", b"tXYZ0", b"t12 0", b"T200000000", b"r1239",
        b"R12345", b"r12310", b"x", b"S", b"\xff\xfe", b"t\xb2\xb2\xb20", b"t" * 1000, b"O", b"O1", b"F1", b"C1", b"Z1",
        b"X0", b"S6", b"s0000",
    ],
)  # fmt: skip
def test_what_is_not_understood_is_answered_with_a_bell_and_changes_nothing(rig, command):
    rig.adapter.take(b"O\r")

    assert rig.adapter.take(command + b"\r") == b"\a"

    assert rig.adapter.take(b"t1230\r") == b"z\r"
    assert rig.heard() == [Frame(0x123)]


@pytest.mark.parametrize("command", [b"t1230", b"C", b"F"])
def test_a_closed_channel_neither_sends_nor_has_flags(rig, command):
    assert rig.adapter.take(command + b"\r") == b"\a"


def test_a_closed_channel_hears_nothing_and_a_silent_one_sends_nothing(rig):
    rig.other.send(Frame(0x100))
    rig.run_ms(1)
    assert rig.adapter.told() == b""

    assert rig.adapter.take(b"L\rt1230\r") == b"\r\a"
    rig.run_ms(20)
    assert rig.adapter.told() == b""  # without an acknowledgement a frame is none
    helper = rig.desk.host(500_000)
    rig.run_ms()

    assert rig.adapter.told() == b"t1000\r"
    assert helper.take() is not None


@pytest.mark.parametrize(
    ("command", "bitrate_hz"),
    [(b"S0", 10_000), (b"S4", 125_000), (b"S7", 750_000), (b"S8", 1_000_000), (b"S9", 83_300), (b"s031C", 125_000),
     (b"s001C", 500_000)],
)  # fmt: skip
def test_the_rate_is_set_before_the_channel_is_opened(rig, command, bitrate_hz):
    rig.desk.leave(rig.other)
    other = rig.desk.host(bitrate_hz)

    assert rig.adapter.take(command + b"\rO\rt1230\r") == b"\r\rz\r"
    rig.run_ms()

    assert other.take().frame == Frame(0x123)


def test_the_flags_tell_of_single_events_once_and_of_states_as_long_as_they_last(rig):
    rig.adapter.take(b"O\r")
    assert rig.adapter.take(b"F\r") == b"F00\r"
    rig.desk.wire.spoil(20)
    rig.adapter.take(b"t1230\r")
    rig.run_ms(20)

    assert rig.adapter.take(b"F\rF\r") == b"FA4\rF24\r"  # bus error, passive, warning; then the last two


def test_a_full_queue_is_a_bell_and_a_flag(rig):
    rig.adapter.take(b"O\r")

    answers = rig.adapter.take(b"t1230\r" * 130)

    assert answers == b"z\r" * 128 + b"\a" * 2
    assert rig.adapter.take(b"F\r") == b"F02\r"


def test_answers_that_programs_ask_for(rig):
    assert rig.adapter.take(b"V\rv\rN\rZ0\rX1\r\r\r") == b"V1013\rv1013\rNSR01\r\r\r\r\r"


@given(st.lists(st.binary(max_size=2 * LINE_MAX) | st.sampled_from([b"O\r", b"C\r", b"t1230\r", b"S6\r"]), max_size=30))
def test_no_input_breaks_it_or_makes_it_remember_much(pieces):
    rig = Rig()

    for piece in pieces:
        rig.adapter.take(piece)
        rig.run_ms(1)
        rig.adapter.told()

    assert len(rig.adapter._line) <= LINE_MAX + 1
    rig.adapter.take(b"\rC\rS6\rO\r")
    assert rig.adapter.take(b"t1230\r") in (b"z\r", b"\a")


def opened(port: SlcanPort, **options) -> can.BusABC:
    channel = port.address.removeprefix("can:slcan:")
    return can.Bus(interface="slcan", channel=channel, bitrate=500_000, sleep_after_open=0, **options)


@pytest.mark.parametrize(
    "message",
    [
        Message(arbitration_id=0x122, data=b"", is_extended_id=False),
        Message(arbitration_id=0x122, data=bytes(range(8)), is_extended_id=False),
        Message(arbitration_id=0x1ABCDEF0, data=b"\xff\x00", is_extended_id=True),
        Message(arbitration_id=0x122, is_remote_frame=True, dlc=4, is_extended_id=False),
    ],
    ids=str,
)
def test_python_can_sends_a_message_through_the_terminal_and_gets_its_answer(message):
    desk = CanDesk()
    with SlcanPort(desk) as port, serving(desk, port, Echo(desk)), opened(port) as bus:
        bus.send(message)
        answer = next_frame(bus)

    assert answer.arbitration_id == message.arbitration_id + 1
    assert (bytes(answer.data), answer.is_extended_id) == (bytes(message.data), message.is_extended_id)
    assert (answer.is_remote_frame, answer.dlc) == (message.is_remote_frame, message.dlc)


def test_python_can_asks_for_version_and_serial_number():
    desk = CanDesk()
    with SlcanPort(desk) as port, serving(desk, port), opened(port) as bus:
        assert bus.get_version(PATIENCE_S) == (10, 13)
        assert bus.get_serial_number(PATIENCE_S) == "SR01"


def test_a_hundred_messages_come_back_in_order():
    desk = CanDesk()
    with SlcanPort(desk) as port, serving(desk, port, Echo(desk)), opened(port) as bus:
        for number in range(100):
            bus.send(Message(arbitration_id=0x100, data=bytes((number,)), is_extended_id=False))
        got = [next_frame(bus).data[0] for _ in range(100)]

    assert got == list(range(100))


def test_rubbish_on_the_terminal_stops_nobody():
    desk = CanDesk()
    with SlcanPort(desk) as port, serving(desk, port, Echo(desk)):
        with serial.Serial(port.address.removeprefix("can:slcan:"), timeout=PATIENCE_S) as line:
            line.write(bytes(range(256)) * 8 + b"\rt999\rV\r")
            while b"V1013\r" not in line.read_until(b"\r"):
                pass
        with opened(port) as bus:
            bus.send(Message(arbitration_id=0x100, is_extended_id=False))
            assert next_frame(bus).arbitration_id == 0x101


def test_who_opens_the_channel_finds_no_frames_of_the_past():
    desk = CanDesk()
    with SlcanPort(desk) as one, SlcanPort(desk) as two, serving(desk, one, two, Echo(desk)):
        dead = opened(one)
        with opened(two) as other:
            for _ in range(20):
                other.send(Message(arbitration_id=0x200, is_extended_id=False))
                next_frame(other)
        dead.serialPortOrig.close()  # it never reads and dies without a word
        with opened(one) as bus:
            bus.send(Message(arbitration_id=0x300, is_extended_id=False))
            assert next_frame(bus).arbitration_id == 0x301
        dead._is_shutdown = True


def test_the_link_names_the_adapter_as_long_as_it_lives(tmp_path):
    link = tmp_path / "slcan"

    with SlcanPort(CanDesk(), link) as port:
        assert port.address == f"can:slcan:{link}"
        assert link.is_symlink()
    assert not link.is_symlink()
