"""The CAN bus: arbitration, time, acknowledgement, errors."""

import pytest

from hil_sim.clock import Clock
from hil_sim.devices.canframe import Frame, length_bits
from hil_sim.devices.canstation import CanStation
from hil_sim.devices.canwire import CanWire

RATE_HZ, BIT_US = 500_000, 2


class Rig:
    """A wire with as many stations as a test asks for."""

    def __init__(self) -> None:
        self.clock = Clock()
        self.wire = CanWire(self.clock)

    def station(self, bitrate_hz: int = RATE_HZ, silent: bool = False) -> CanStation:
        return CanStation(self.wire, bitrate_hz, silent)

    def run_bits(self, bits: int) -> None:
        self.clock.run_until(self.clock.now_us + bits * BIT_US)

    def run_ms(self, ms: int) -> None:
        self.clock.run_until(self.clock.now_us + ms * 1000)


@pytest.fixture
def rig() -> Rig:
    return Rig()


def test_a_frame_arrives_at_all_others_when_its_last_bit_has_passed(rig):
    one, two, three = (rig.station() for _ in range(3))
    frame = Frame(0x123, b"\x55\xaa")

    one.send(frame)
    rig.clock.run_until(length_bits(frame) * BIT_US - 1)
    assert two.received == []
    rig.clock.run_until(length_bits(frame) * BIT_US)

    assert two.received == three.received == [frame]
    assert (one.received, one.waiting) == ([], [])


def test_the_lower_identifier_wins_and_the_loser_follows_after_three_bits(rig):
    one, two, three = (rig.station() for _ in range(3))
    weak, strong = Frame(0x200, b"w"), Frame(0x100, b"s")

    one.send(weak)
    two.send(strong)
    ends_us = (length_bits(strong) + 3 + length_bits(weak)) * BIT_US
    rig.clock.run_until(ends_us - 1)
    assert three.received == [strong]
    rig.clock.run_until(ends_us)

    assert three.received == [strong, weak]
    assert (one.losses, two.losses) == (1, 0)
    assert one.errors.transmit == two.errors.transmit == 0


def test_a_frame_that_is_asked_for_later_waits_even_if_it_is_stronger(rig):
    one, two = rig.station(), rig.station()
    one.send(Frame(0x7FF, bytes(8)))
    rig.run_bits(5)

    two.send(Frame(0x001))
    rig.run_ms(1)

    assert two.received == [Frame(0x7FF, bytes(8))]
    assert one.received == [Frame(0x001)]


def test_a_lone_controller_becomes_passive_and_repeats_for_ever(rig):
    one = rig.station()

    one.send(Frame(0x100))
    rig.run_ms(100)

    assert one.errors.transmit == 128
    assert (one.errors.passive, one.errors.bus_off) == (True, False)
    assert one.failures > 100
    assert one.waiting


def test_who_only_listens_acknowledges_nothing(rig):
    one, listener = rig.station(), rig.station(silent=True)

    one.send(Frame(0x100))
    rig.run_ms(10)

    assert one.failures > 0
    assert listener.received == []
    assert listener.errors.receive == 0


def test_a_damaged_frame_counts_eight_for_its_sender_and_is_repeated(rig):
    one, two = rig.station(), rig.station()
    rig.wire.spoil(1)

    one.send(Frame(0x100))
    rig.run_bits(40)
    assert (one.errors.transmit, two.errors.receive, two.received) == (8, 1, [])
    rig.run_bits(80)

    assert (one.errors.transmit, two.errors.receive, two.received) == (7, 0, [Frame(0x100)])


def test_the_frames_of_one_sender_alone_can_be_damaged(rig):
    one, two, three = (rig.station() for _ in range(3))
    rig.wire.spoil(2, two)

    one.send(Frame(0x100))
    two.send(Frame(0x200))
    rig.run_ms(2)

    assert (one.failures, two.failures) == (0, 2)
    assert three.received == [Frame(0x100), Frame(0x200)]


def test_thirty_two_damaged_frames_put_the_sender_off_the_bus(rig):
    one, two = rig.station(), rig.station()
    rig.wire.spoil(32)

    one.send(Frame(0x100))
    while not one.errors.bus_off:
        rig.run_bits(10)
    off_us = rig.clock.now_us
    while one.errors.bus_off:
        rig.run_bits(10)

    assert one.failures == 32
    assert rig.clock.now_us - off_us == pytest.approx(128 * 11 * BIT_US, abs=20 * BIT_US)
    assert (one.errors.transmit, one.errors.receive) == (0, 0)
    rig.run_bits(80)
    assert two.received == [Frame(0x100)]


def test_a_busy_wire_delays_the_return_from_bus_off(rig):
    one, two, three = (rig.station() for _ in range(3))
    rig.wire.spoil(32)
    one.send(Frame(0x100))
    while not one.errors.bus_off:
        rig.run_bits(10)
    off_us = rig.clock.now_us

    for _ in range(60):
        two.send(Frame(0x200, bytes(8)))
    while one.errors.bus_off:
        rig.run_bits(10)

    assert len(three.received) == 60
    assert rig.clock.now_us - off_us > 60 * 108 * BIT_US  # each frame is one quiet time, however long it lasts


def test_an_error_passive_sender_leaves_the_others_eight_bits_more(rig):
    one, two = rig.station(), rig.station()
    one.errors.transmit = 200
    one.send(Frame(0x100))
    one.send(Frame(0x101))
    rig.run_bits(30)

    two.send(Frame(0x7FF))
    rig.run_ms(1)

    assert one.received == [Frame(0x7FF)]
    assert two.received == [Frame(0x100), Frame(0x101)]
    assert one.losses == 0  # it was not there when the other began


def test_another_bit_rate_destroys_frames_until_it_is_passive(rig):
    one, two, alien = rig.station(), rig.station(), rig.station(250_000)

    one.send(Frame(0x100))
    rig.run_ms(20)

    assert alien.errors.passive
    assert alien.received == []
    assert two.received == [Frame(0x100)]
    assert not one.errors.bus_off


def test_a_sender_at_another_bit_rate_makes_the_whole_bus_passive(rig):
    one, alien = rig.station(), rig.station(250_000)

    alien.send(Frame(0x100))
    rig.run_ms(20)

    assert one.errors.passive
    assert alien.errors.passive
    assert one.received == []


def test_a_rate_within_the_tolerance_is_understood(rig):
    one, two = rig.station(500_000), rig.station(505_000)

    one.send(Frame(0x100))
    rig.run_ms(1)

    assert two.received == [Frame(0x100)]


def test_the_same_identifier_with_other_data_is_an_error_for_both(rig):
    one, two, three = (rig.station() for _ in range(3))

    one.send(Frame(0x100, b"\x01"))
    two.send(Frame(0x100, b"\x02"))
    rig.run_bits(60)

    assert one.errors.transmit == two.errors.transmit == 8
    assert three.errors.receive == 1


def test_a_sender_that_is_cut_off_leaves_a_damaged_frame(rig):
    one, two, three = (rig.station() for _ in range(3))
    one.send(Frame(0x100, bytes(8)))
    rig.run_bits(20)

    rig.wire.leave(one)
    rig.run_ms(1)

    assert two.received == three.received == []
    assert two.damaged == three.damaged == 1


def test_two_runs_take_the_same_course(rig):
    def course():
        rig = Rig()
        stations = [rig.station() for _ in range(4)]
        for index in range(40):
            stations[index % 3].send(Frame(0x100 + index * 37 % 64, bytes(index % 9)))
        rig.wire.spoil(5)
        rig.run_ms(30)
        return [(station.received, station.losses, station.errors.receive) for station in stations]

    assert course() == course()


def ends_of_failures(rig, station, count: int) -> list[int]:
    """Return when the station's first failures ended, in bit times."""
    ends = []
    while len(ends) < count:
        rig.clock.run_until(rig.clock.now_us + 1)
        if station.failures > len(ends):
            ends.append(rig.clock.now_us // BIT_US)
    return ends


def test_an_unanswered_frame_ends_with_one_error_flag_after_its_acknowledge_slot(rig):
    one, frame = rig.station(), Frame(0x100)
    one.send(frame)

    first, second = ends_of_failures(rig, one, 2)

    assert first == length_bits(frame) - 10 + 2 + 6 + 8  # checksum delimiter and slot, flag, delimiter
    assert second - first == 3 + first


def test_who_hears_a_damaged_frame_adds_a_flag_of_its_own_unless_passive(rig):
    one, two = rig.station(), rig.station()
    frame = Frame(0x100)
    rig.wire.spoil(1)
    one.send(frame)
    (active,) = ends_of_failures(rig, one, 1)
    rig.run_ms(1)
    start = rig.clock.now_us // BIT_US
    two.errors.receive = 128
    rig.wire.spoil(1)
    one.send(frame)
    one.failures = 0
    (passive,) = ends_of_failures(rig, one, 1)

    half = (length_bits(frame) - 10) // 2
    assert active == half + 6 + 6 + 8
    assert passive - start == half + 6 + 8


def test_a_sender_that_recovers_from_passive_waits_no_longer(rig):
    one, two = rig.station(), rig.station()
    one.errors.transmit = 128
    one.send(Frame(0x100))
    rig.run_ms(1)
    assert one.errors.transmit == 127
    start_us = rig.clock.now_us

    one.send(Frame(0x101))
    rig.run_bits(length_bits(Frame(0x101)))

    assert two.received[-1] == Frame(0x101)
    assert rig.clock.now_us - start_us == length_bits(Frame(0x101)) * BIT_US


@pytest.mark.parametrize(
    ("transmit", "receive", "passive", "bus_off"),
    [
        (127, 127, False, False),
        (128, 0, True, False),
        (0, 128, True, False),
        (255, 0, True, False),
        (256, 0, True, True),
    ],
)
def test_the_limits_of_the_counters_are_those_of_the_specification(rig, transmit, receive, passive, bus_off):
    errors = rig.station().errors
    errors.transmit, errors.receive = transmit, receive

    assert (errors.passive, errors.bus_off) == (passive, bus_off)


def test_the_receive_counter_stays_within_eight_bits_and_falls_to_127_at_once(rig):
    errors = rig.station().errors
    for _ in range(40):
        errors.garbled(destroyed=True)
    assert errors.receive == 255

    errors.heard()

    assert errors.receive == 127
