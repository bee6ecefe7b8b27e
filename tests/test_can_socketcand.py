"""The socketcand server of the bench: its protocol word by word, and python-can's own interface on a real socket."""

import socket

import can
import pytest
from can import Message
from hypothesis import given
from hypothesis import strategies as st

from hil_sim.can.desk import CanDesk
from hil_sim.can.ports import CLIENTS_MAX, SlcanPort, SocketcandPort
from hil_sim.can.socketcand import HOLD_US, PENDING_MAX, Socketcand
from hil_sim.devices.canframe import Frame
from hil_sim.ports import PortError
from tests.can_served import PATIENCE_S, Echo, frames_heard, next_frame, serving

OPEN = b"< open can0 >< rawmode >"


class Rig:
    """A client and another node on one bus."""

    def __init__(self) -> None:
        self.desk = CanDesk()
        self.client = Socketcand(self.desk)
        self.other = self.desk.host(500_000)

    def run_us(self, us: int) -> None:
        self.desk.clock.run_until(self.desk.clock.now_us + us)

    def opened(self) -> "Rig":
        assert self.client.take(OPEN) == b"< ok >< ok >"
        self.run_us(HOLD_US)
        return self

    def heard(self) -> list[Frame]:
        """Return what the other node has heard by some time from now."""
        self.run_us(10_000)
        return frames_heard(self.other)


@pytest.fixture
def rig():
    return Rig()


@pytest.mark.parametrize(
    ("command", "frame"),
    [
        (b"< send 123 0 >", Frame(0x123)),
        (b"< send 123 0  >", Frame(0x123)),  # as python-can writes it
        (b"< send 7FF 2 1 F1 >", Frame(0x7FF, b"\x01\xf1")),
        (b"<send 00000123 8 0 0 0 0 0 0 0 ff>", Frame(0x123, bytes(7) + b"\xff", extended=True)),
        (b"< sendrtr 123 5 >", Frame(0x123, remote=True, length=5)),
    ],
)
def test_an_order_to_send_puts_its_frame_on_the_bus_and_has_no_answer(rig, command, frame):
    assert rig.opened().client.take(command) == b""

    assert rig.heard() == [frame]


def test_received_frames_come_with_the_time_of_the_bench(rig):
    rig.opened()
    rig.other.send(Frame(0x12, b"\xab\x01"))
    rig.other.send(Frame(0x1F, extended=True))
    rig.other.send(Frame(0x7FF, remote=True, length=3))
    rig.run_us(1_000)

    frames = rig.client.told().split(b">")[:3]

    assert frames[0].startswith(b"< frame 012 0.200")
    assert [frame.split()[1:] for frame in frames] == [
        [b"frame", b"012", frames[0].split()[3], b"AB01"],
        [b"frame", b"0000001F", frames[1].split()[3]],
        [b"rtr", b"7FF", frames[2].split()[3], b"3"],
    ]


def test_frames_are_kept_back_for_a_moment_so_that_none_is_glued_to_an_answer(rig):
    rig.client.take(OPEN)
    rig.other.send(Frame(0x100))
    rig.run_us(HOLD_US - 1)
    assert rig.client.told() == b""
    rig.run_us(1)

    assert rig.client.told().startswith(b"< frame 100 0.100")


def test_outside_of_raw_mode_no_frames_come_but_they_can_be_sent(rig):
    rig.client.take(b"< open can0 >< send 123 0 >")
    rig.other.send(Frame(0x100))

    assert rig.heard() == [Frame(0x123)]
    assert rig.client.told() == b""


def test_errors_come_with_their_class(rig):
    rig.opened().desk.wire.spoil(1)
    rig.other.send(Frame(0x100))
    rig.run_us(1_000)

    assert rig.client.told().startswith(b"< error 288 0.200")


@pytest.mark.parametrize(
    "command",
    [
        b"< send >", b"< send 123 >", b"< send 123 1 >", b"< send 123 2 0 >", b"< send 123 9 0 0 0 0 0 0 0 0 0 >",
        b"< send 800 0 >", b"< send 20000000 0 >", b"< send 1234 0 >", b"< send 123 1 100 >", b"< send 123 1 -1 >",
        b"< send 0x123 0 >", b"< send 123 \xb2 >", b"< sendrtr 123 1 0 >", b"< open can0 >", b"< >", b"<>",
        b"< add 1 0 123 0 >", b"< controlmode >", b"< fdsend 123 00 0 >", b"\xff< no >", b"<" + b"x" * 600,
    ],
)  # fmt: skip
def test_what_is_not_understood_is_answered_with_an_error_and_changes_nothing(rig, command):
    answer = rig.opened().client.take(command)

    assert answer in (b"< error syntax >", b"< error unknown command >")
    assert rig.client.take(b"< send 123 0 >") == b""
    assert rig.heard() == [Frame(0x123)]


@pytest.mark.parametrize("command", [b"< send 123 0 >", b"< rawmode >", b"< echo >"])
def test_nothing_works_before_the_bus_is_opened(rig, command):
    assert rig.client.take(command) == b"< error unknown command >"


def test_a_command_may_come_in_pieces_and_is_echoed(rig):
    rig.opened()

    assert rig.client.take(b"< ec") == b""
    assert rig.client.take(b"ho >< echo >") == b"< echo >< echo >"


def test_a_full_queue_is_told(rig):
    rig.opened()

    answer = rig.client.take(b"< send 123 0 >" * 129)

    assert answer == b"< error queue is full >"


@given(st.lists(st.binary(max_size=PENDING_MAX) | st.sampled_from([OPEN, b"< send 123 0 >", b"<", b">"]), max_size=30))
def test_no_input_breaks_it_or_makes_it_remember_much(pieces):
    rig = Rig()

    for piece in pieces:
        rig.client.take(piece)
        rig.run_us(1_000)
        rig.client.told()

    assert len(rig.client._pending) <= PENDING_MAX


def opened(port: SocketcandPort) -> can.BusABC:
    return can.Bus(interface="socketcand", host="127.0.0.1", port=port.port, channel="can0")


@pytest.mark.parametrize(
    "message",
    [
        Message(arbitration_id=0x122, data=b"", is_extended_id=False),
        Message(arbitration_id=0x122, data=bytes(range(8)), is_extended_id=False),
        Message(arbitration_id=0x1ABCDEF0, data=b"\xff\x00", is_extended_id=True),
    ],
    ids=str,
)
def test_python_can_sends_a_message_through_the_server_and_gets_its_answer(message):
    desk = CanDesk()
    with SocketcandPort(desk, 0) as port, serving(desk, port, Echo(desk)), opened(port) as bus:
        bus.send(message)
        answer = next_frame(bus)

    assert answer.arbitration_id == message.arbitration_id + 1
    assert (bytes(answer.data), answer.is_extended_id) == (bytes(message.data), message.is_extended_id)


def test_several_clients_and_an_slcan_adapter_hear_each_other():
    desk = CanDesk()
    with SocketcandPort(desk, 0) as port, SlcanPort(desk) as slcan, serving(desk, port, slcan):
        channel = slcan.address.removeprefix("can:slcan:")
        serial = can.Bus(interface="slcan", channel=channel, bitrate=500_000, sleep_after_open=0)
        with opened(port) as one, opened(port) as two, serial:
            assert serial.get_version(PATIENCE_S) == (10, 13)  # its channel is open now
            one.send(Message(arbitration_id=0x100, data=b"hello", is_extended_id=False))
            got = [next_frame(bus) for bus in (two, serial)]
            serial.send(Message(arbitration_id=0x200, is_extended_id=False))
            back = [next_frame(bus) for bus in (one, two)]

    assert [bytes(message.data) for message in got] == [b"hello", b"hello"]
    assert [message.arbitration_id for message in back] == [0x200, 0x200]


def test_error_frames_reach_python_can():
    desk = CanDesk()
    desk.wire.spoil(1)
    with SocketcandPort(desk, 0) as port, serving(desk, port, Echo(desk)), opened(port) as bus:
        bus.send(Message(arbitration_id=0x100, is_extended_id=False))
        first = bus.recv(PATIENCE_S)

    assert first.is_error_frame


def test_a_client_that_writes_rubbish_or_never_reads_stops_nobody():
    desk = CanDesk()
    with SocketcandPort(desk, 0) as port, serving(desk, port, Echo(desk)):
        rude = socket.create_connection(("127.0.0.1", port.port), timeout=PATIENCE_S)
        rude.sendall(OPEN + bytes(range(256)) * 100)
        with opened(port) as bus:
            for _ in range(50):
                bus.send(Message(arbitration_id=0x100, is_extended_id=False))
                assert next_frame(bus).arbitration_id == 0x101
        rude.close()
        with opened(port) as bus:
            bus.send(Message(arbitration_id=0x100, is_extended_id=False))
            assert next_frame(bus).arbitration_id == 0x101


def test_a_client_that_hangs_up_leaves_the_bus():
    desk = CanDesk()
    with SocketcandPort(desk, 0) as port, serving(desk, port):
        with opened(port):
            assert len(desk.wire.nodes) == 1
        with opened(port) as bus:
            bus.send(Message(arbitration_id=0x100, is_extended_id=False))
            assert bus.recv(PATIENCE_S).is_error_frame  # nobody acknowledges


def test_more_clients_than_there_is_room_for_are_refused():
    with SocketcandPort(CanDesk(), 0) as port, serving(port._desk, port):
        lines = [socket.create_connection(("127.0.0.1", port.port), timeout=PATIENCE_S) for _ in range(CLIENTS_MAX)]
        assert [line.recv(16) for line in lines] == [b"< hi >"] * CLIENTS_MAX
        with socket.create_connection(("127.0.0.1", port.port), timeout=PATIENCE_S) as one_too_many:
            assert one_too_many.recv(16) == b""
        for line in lines:
            line.close()


def test_a_taken_port_is_refused_with_its_number():
    with (
        SocketcandPort(CanDesk(), 0) as port,
        pytest.raises(PortError, match=f"TCP port {port.port}: Address already in use"),
    ):
        SocketcandPort(CanDesk(), port.port)
