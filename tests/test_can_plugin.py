"""The bench as a bus of python-can, opened as any other interface: arbitration, bit time, errors, filters, robots."""

import subprocess
import sys
import threading

import can
import pytest
from can import BusState, CanInitializationError, CanOperationError, Message

from hil_sim.can.desk import addresses
from hil_sim.can.host import (
    ACTIVE,
    BUS_ERROR,
    BUS_OFF,
    CONTROLLER,
    COUNTERS,
    NOT_ACKNOWLEDGED,
    PROTOCOL,
    RESTARTED,
    SEND_PASSIVE,
)
from hil_sim.devices.canbits import bits_of
from hil_sim.devices.canframe import TAIL_BITS, Frame, length_bits
from host.link import open_link
from host.robot import Robot

BIT_US = 2


@pytest.fixture
def hosts():
    """Open that many hosts on one bus without robots."""
    opened = []

    def some(count, **options):
        for _ in range(count):
            desk = opened[0].desk if opened else None
            opened.append(can.Bus(interface="softrig", channel="", desk=desk, **options))
        return opened[-count:]

    yield some
    for bus in opened:
        bus.shutdown()


def message(number, data=b"", extended=False, **options):
    return Message(arbitration_id=number, data=data, is_extended_id=extended, **options)


def frames(bus, seconds=0.01):
    """Return the identifiers of the frames that arrive until nothing has for so long."""
    got = []
    while (one := bus.recv(seconds)) is not None:
        if not one.is_error_frame:
            got.append(one.arbitration_id)
    return got


def errors(bus, seconds=0.01):
    got = []
    while (one := bus.recv(seconds)) is not None:
        if one.is_error_frame:
            got.append(one)
    return got


def test_a_message_arrives_after_its_bit_time_and_is_stamped_with_it(hosts):
    one, two = hosts(2)
    began_s = one.now_s()

    one.send(message(0x123, b"\x55\xaa", extended=True))
    got = two.recv(1.0)

    took_s = length_bits(Frame(0x123, b"\x55\xaa", extended=True)) * BIT_US * 1e-6
    assert (got.arbitration_id, bytes(got.data), got.is_extended_id, got.is_rx) == (0x123, b"\x55\xaa", True, True)
    assert got.timestamp == two.now_s() == pytest.approx(began_s + took_s, abs=1e-9)


def test_waiting_takes_virtual_time_and_looking_takes_none(hosts):
    (one,) = hosts(1)
    began_s = one.now_s()

    assert one.recv(0) is None
    assert one.now_s() == began_s
    assert one.recv(3600.0) is None
    assert one.now_s() == pytest.approx(began_s + 3600.0)


def test_the_shortest_wait_takes_some_time_so_that_who_waits_in_a_loop_gets_there(hosts):
    (one,) = hosts(1)
    until_s = one.now_s() + 1e-7

    one.recv(until_s - one.now_s())

    assert one.now_s() >= until_s


def test_a_bus_that_nobody_shuts_down_ends_quietly_with_its_program():
    program = "import can; bus = can.Bus(interface='softrig', channel='circular?body=still'); bus.recv(0.1)"

    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)

    assert "Traceback" not in done.stderr


def test_the_lowest_identifier_goes_first_whoever_asked_first(hosts):
    *senders, listener = hosts(5)
    listener_first = message(0x7FF)
    senders[0].send(listener_first)
    assert listener.recv(0.00001) is None  # the bus is busy now

    for bus, number in zip(senders, (0x300, 0x100, 0x400, 0x200), strict=True):
        bus.send(message(number))

    assert frames(listener) == [0x7FF, 0x100, 0x200, 0x300, 0x400]


def test_a_standard_identifier_wins_against_an_extended_one_with_the_same_beginning(hosts):
    one, two, listener = hosts(3)

    one.send(message(0x100 << 18, extended=True))
    two.send(message(0x100))

    assert frames(listener) == [0x100, 0x100 << 18]


def test_one_host_sends_in_the_order_in_which_it_was_told(hosts):
    one, listener = hosts(2)

    for number in (0x300, 0x100, 0x200):
        one.send(message(number))

    assert frames(listener) == [0x300, 0x100, 0x200]


def test_remote_frames_and_lengths_come_as_they_were_sent(hosts):
    one, two = hosts(2)

    one.send(message(0x100, is_remote_frame=True, dlc=5))
    got = two.recv(1.0)

    assert (got.is_remote_frame, got.dlc, bytes(got.data)) == (True, 5, b"")


def test_own_messages_are_received_only_where_that_was_asked_for(hosts):
    (silent,), (echoing,) = hosts(1), hosts(1, receive_own_messages=True)

    silent.send(message(0x100))
    echoing.send(message(0x200))
    got = [echoing.recv(0.01), echoing.recv(0.01)]

    assert [(one.arbitration_id, one.is_rx) for one in got] == [(0x100, True), (0x200, False)]
    assert frames(silent) == [0x200]


def test_filters_let_pass_what_they_match_and_errors_always(hosts):
    one, two = hosts(2)
    two.set_filters([{"can_id": 0x120, "can_mask": 0x7F0, "extended": False}])
    two.desk.wire.spoil(1)

    for number, extended in ((0x123, False), (0x133, False), (0x123, True), (0x12F, False)):
        one.send(message(number, extended=extended))
    got = [two.recv(0.01) for _ in range(4)]

    assert [one and (one.arbitration_id, one.is_error_frame) for one in got] == [
        (PROTOCOL | BUS_ERROR | COUNTERS, True),
        (0x123, False),
        (0x12F, False),
        None,
    ]


def test_a_damaged_frame_is_told_to_both_ends_with_their_counters_and_is_repeated(hosts):
    one, two = hosts(2)
    one.desk.wire.spoil(1)

    one.send(message(0x100))
    told, heard = two.recv(0.01), two.recv(0.01)
    own = one.recv(0.01)

    assert (told.is_error_frame, told.data[6], told.data[7]) == (True, 0, 1)
    assert (heard.is_error_frame, heard.arbitration_id) == (False, 0x100)
    assert (own.is_error_frame, own.data[2], own.data[6], own.data[7]) == (True, 0x80, 8, 0)


def test_a_lone_host_is_told_that_nobody_acknowledges_until_it_is_passive(hosts):
    (one,) = hosts(1)

    one.send(message(0x100))
    told = errors(one)

    assert [error.data[6] for error in told] == list(range(8, 129, 8))
    assert all(error.arbitration_id & (NOT_ACKNOWLEDGED | BUS_ERROR) for error in told)
    assert told[-1].arbitration_id & CONTROLLER
    assert told[-1].data[1] & SEND_PASSIVE
    assert one.state is BusState.PASSIVE


def test_damage_puts_a_host_off_the_bus_and_quiet_brings_it_back(hosts):
    one, two = hosts(2)
    one.desk.wire.spoil(32)

    one.send(message(0x100))
    while one.state is not BusState.ERROR:
        last = one.recv(0.01)
    off_s = one.now_s()
    back = one.recv(0.01)

    assert last.arbitration_id & BUS_OFF
    assert back.arbitration_id == RESTARTED | COUNTERS
    assert back.timestamp - off_s == pytest.approx(128 * 11 * BIT_US * 1e-6, abs=1e-4)
    assert one.state is BusState.ACTIVE
    assert frames(two) == [0x100]


def test_the_end_of_a_warning_is_told(hosts):
    one, _ = hosts(2)
    one.desk.wire.spoil(12)
    for _ in range(3):
        one.send(message(0x100))

    told = errors(one)

    assert told[-1].arbitration_id == CONTROLLER | COUNTERS
    assert told[-1].data[1] == ACTIVE


def test_a_host_at_another_bit_rate_hears_only_damage(hosts):
    (one, two), (slow,) = hosts(2), hosts(1, bitrate=250_000)

    one.send(message(0x100))

    assert frames(slow, 0.1) == []
    assert slow.state is BusState.PASSIVE
    assert frames(two) == [0x100]


def test_a_full_queue_refuses_at_once_or_when_the_patience_is_over(hosts):
    (one,) = hosts(1)
    for _ in range(128):
        one.send(message(0x100))

    with pytest.raises(CanOperationError, match="the queue is full"):
        one.send(message(0x100))
    began_s = one.now_s()
    with pytest.raises(CanOperationError):
        one.send(message(0x100), timeout=0.5)
    assert one.now_s() == pytest.approx(began_s + 0.5)

    one.flush_tx_buffer()
    one.send(message(0x101))
    (listener,) = hosts(1)
    assert frames(listener) == [0x100, 0x101]  # the first was on the wire


def test_a_queue_that_empties_takes_a_message_within_the_patience(hosts):
    one, two = hosts(2)
    for _ in range(128):
        one.send(message(0x100))

    one.send(message(0x101), timeout=0.5)

    assert frames(two)[-1] == 0x101


def test_who_only_listens_acknowledges_nothing(hosts):
    (one,), (listener,) = hosts(1), hosts(1, listen_only=True)

    one.send(message(0x100))

    assert frames(listener) == []
    assert one.recv(0.01).arbitration_id & NOT_ACKNOWLEDGED


def test_messages_of_can_fd_take_the_time_of_two_bit_rates(hosts):
    one, two = hosts(2, fd=True, data_bitrate=2_000_000)
    frame = Frame(0x123, bytes(range(64)), fd=True, brs=True)
    began_s = one.now_s()

    one.send(message(0x123, bytes(range(64)), is_fd=True, bitrate_switch=True))
    got = two.recv(1.0)

    took_ns = bits_of(frame).duration_ns(len(bits_of(frame).sent) + TAIL_BITS, 2000, 500)
    assert (bytes(got.data), got.is_fd, got.bitrate_switch) == (bytes(range(64)), True, True)
    assert got.timestamp - began_s == pytest.approx(took_ns * 1e-9, abs=1e-6)
    assert one.protocol is can.CanProtocol.CAN_FD


def test_a_classic_host_cannot_send_can_fd(hosts):
    (one,) = hosts(1)

    with pytest.raises(ValueError, match="no bit rate for the data of CAN FD"):
        one.send(message(0x100, is_fd=True))
    with pytest.raises(ValueError, match="an error frame cannot be sent"):
        one.send(Message(is_error_frame=True))
    with pytest.raises(ValueError, match="identifier 0x800"):
        one.send(message(0x800))


def test_periodic_messages_go_out_on_the_virtual_clock(hosts):
    one, two = hosts(2)

    task = one.send_periodic(message(0x100), period=0.02, duration=0.1)
    stamps = []
    while (got := two.recv(0.05)) is not None:
        stamps.append(got.timestamp)
    task.start()
    two.recv(0.001)
    task.stop()

    assert len(stamps) == 5
    assert stamps[4] - stamps[0] == pytest.approx(0.08)
    assert frames(two, 0.1) == []


def test_robots_are_found_by_their_numbers_and_watched_from_outside():
    channel = "circular@3?body=still&open=A,C,circular?body=still,circular@1?body=still"
    with can.Bus(interface="softrig", channel=channel) as bus:
        bus.recv(0.2)

        assert sorted(bus.benches) == [1, 2, 3]
        assert bus.benches[3].observe()["t_s"] == pytest.approx(bus.now_s()) == pytest.approx(0.3)
        assert bus.repeatable


def test_the_robots_live_as_long_as_one_host_does():
    one = can.Bus(interface="softrig", channel="circular?body=still")
    two = can.Bus(interface="softrig", desk=one.desk)

    one.shutdown()
    one.shutdown()
    two.recv(0.1)
    assert two.benches[1].world.running
    two.shutdown()

    assert two.benches[1].closed
    with pytest.raises(CanOperationError, match="shut down"):
        two.recv(0)


def test_two_runs_take_the_same_course():
    def course():
        with can.Bus(interface="softrig", channel="circular@1?body=still,circular@2?body=still") as bus:
            bus.desk.wire.spoil(3)
            for number in range(20):
                bus.send(message(0x100 + number * 37 % 64, bytes(number % 9)))
                bus.recv(0.001)
            return bus.now_s(), [bench.trace_sha256() for bench in bus.benches.values()]

    assert course() == course()


@pytest.mark.parametrize(
    ("channel", "what"),
    [
        ("circular@1,circular@1", "two robots have the number 1"),
        ("cicular@1", "circular"),
        ("circular@200", "a whole number from 1 to 126"),
        ("circular?slop=2", "slope"),
    ],
)
def test_a_channel_that_cannot_be_is_refused_as_python_can_does(channel, what):
    with pytest.raises(CanInitializationError, match=what):
        can.Bus(interface="softrig", channel=channel)


def test_a_bus_stays_in_the_thread_that_opened_it(hosts):
    (one,) = hosts(1)
    caught = []

    def elsewhere():
        try:
            one.recv(0.1)
        except CanOperationError as error:
            caught.append(str(error))

    thread = threading.Thread(target=elsewhere)
    thread.start()
    thread.join()

    assert "belongs to the thread that opened it" in caught[0]


def test_the_robots_of_the_bench_are_offered_as_channels():
    found = can.detect_available_configs("softrig")

    assert {"interface": "softrig", "channel": "sphere-b"} in found


@pytest.mark.parametrize(
    ("channel", "node", "robots"),
    [
        ("circular", 3, {3: "circular"}),
        ("circular@1,sphere-b", 5, {1: "circular", 5: "sphere-b"}),
        ("circular@1,sphere-b@5", 1, {1: "circular", 5: "sphere-b"}),
        ("circular,sphere-b@5", 5, {1: "circular", 5: "sphere-b"}),
        ("circular@2,sphere-b@5", 7, {2: "circular", 5: "sphere-b"}),
        ("circular,sphere-b", 1, {1: "sphere-b", 2: "circular"}),
        ("", 4, {}),
    ],
)
def test_the_last_robot_without_a_number_gets_the_one_that_is_looked_for(channel, node, robots):
    assert {address.node: address.robot for address in addresses(channel, node)} == robots


def test_a_robot_is_found_on_the_bench_by_the_number_after_its_name():
    """As behind any adapter: can:slcan:/dev/ttyACM0@3."""
    robot = Robot(open_link("can:softrig:circular@3?body=still"))

    robot.connect()

    assert (robot.link.node, sorted(robot.link.bus.observers)) == (3, [3])
    robot.talk.end()


def test_options_of_an_address_are_taken_for_every_robot_and_others_refused():
    channel = "circular,circular@5?seed=4"
    with can.Bus(interface="softrig", channel=channel, body="still", supply=1.5) as bus:
        assert {number: bench.supply._source_v() for number, bench in bus.benches.items()} == {1: 1.5, 5: 1.5}
    with pytest.raises(CanInitializationError, match=r"no option 'slop'.*slope"):
        can.Bus(interface="softrig", channel="circular", slop=10)
