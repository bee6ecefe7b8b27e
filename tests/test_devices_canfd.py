"""CAN-FD frames: bits, stuffing, two bit rates, and what a classic controller makes of them."""

import pytest

from hil_sim.clock import Clock
from hil_sim.devices.canbits import CRC_17, CRC_21, bits_of
from hil_sim.devices.canframe import FD_LENGTHS, TAIL_BITS, Frame, bits, length_bits, remainder, stuffed
from hil_sim.devices.canstation import CanStation
from hil_sim.devices.canwire import CanWire
from tests.can_bench import CanRig

BIT_NS, DATA_BIT_NS = 2_000, 500
RATE_HZ, DATA_RATE_HZ = 500_000, 2_000_000
ALTERNATING = 0x555  # an identifier without runs


def fd(number, data=b"", **options):
    return Frame(number, data, fd=True, **options)


class Rig:
    def __init__(self, count=3):
        self.clock = Clock()
        self.wire = CanWire(self.clock)
        self.stations = [CanStation(self.wire, RATE_HZ, data_bitrate_hz=DATA_RATE_HZ) for _ in range(count)]

    def run_us(self, us):
        self.clock.run_until(self.clock.now_us + us)


@pytest.mark.parametrize(("crc", "check"), [(CRC_17, 0x04F03), (CRC_21, 0x0ED841)])
def test_the_checksums_give_the_check_values_of_the_catalogues(crc, check):
    said = [int(bit) for byte in b"123456789" for bit in f"{byte:08b}"]

    assert remainder(said, *crc) == check


@pytest.mark.parametrize(("size", "overhead"), [(0, 59), (16, 59), (20, 64), (64, 64)])
@pytest.mark.parametrize(("extended", "more"), [(False, 0), (True, 19)])
def test_a_frame_has_the_bits_that_linux_counts_and_those_stuffed_before_its_checksum(size, overhead, extended, more):
    frame = fd(ALTERNATING, b"\x55" * size, extended=extended)
    begin = [0, *frame.arbitration, 1, 0, 0, 0, *bits(frame.length, 4), *bits(int.from_bytes(frame.data), 8 * size)]
    dynamic = len(stuffed(begin)) - len(begin)

    assert len(bits_of(frame).sent) + TAIL_BITS == overhead + more + 8 * size + dynamic


def test_lengths_go_by_their_code():
    assert [fd(1, bytes(size)).length for size in FD_LENGTHS] == list(range(16))


@pytest.mark.parametrize("size", [9, 63, 65])
def test_a_length_between_them_is_refused(size):
    with pytest.raises(ValueError, match=f"{size} data bytes, CAN FD has 0, 1"):
        fd(1, bytes(size))


@pytest.mark.parametrize("options", [{"brs": True}, {"esi": True}, {"fd": True, "remote": True}])
def test_what_the_other_format_has_not_is_refused(options):
    with pytest.raises(ValueError, match="brs and esi are of CAN FD, which has no remote frames"):
        Frame(1, **options)


def test_the_checksum_field_has_a_fixed_bit_before_each_four_that_differs_from_the_one_before():
    sent = bits_of(fd(ALTERNATING, b"\x55" * 8)).sent
    field = sent[-27:]  # 4 bits of count, 17 of checksum, 6 fixed

    assert [place for place in range(27) if place % 5 == 0] == [0, 5, 10, 15, 20, 25]
    assert all(field[place] != sent[len(sent) - 27 + place - 1] for place in range(0, 27, 5))


def test_five_equal_bits_at_the_end_of_the_data_are_not_stuffed_twice():
    ends, runs_on = fd(ALTERNATING, b"\xa0"), fd(ALTERNATING, b"\x20")  # 5 dominant bits end both

    assert len(bits_of(ends).sent) == len(bits_of(fd(ALTERNATING, b"\xaa")).sent)
    assert len(bits_of(runs_on).sent) == len(bits_of(fd(ALTERNATING, b"\x2a")).sent)


def test_the_count_of_stuffed_bits_is_in_gray_code_with_parity():
    codes = ("0000", "0011", "0110", "0101", "1100", "1111", "1010", "1001")
    seen = set()
    for size in range(1, 9):
        frame = fd(ALTERNATING, bytes(size - 1) + b"\x55")
        sent = bits_of(frame).sent
        count = (
            len(sent) - 27 - (1 + 13 + 1 + 1 + 2 + 4 + 8 * size)
        )  # less the checksum's field and what is not stuffed

        assert "".join(map(str, sent[-26:-22])) == codes[count % 8]
        seen.add(count % 8)

    assert len(seen) > 5


def test_only_what_lies_between_the_two_switches_is_fast():
    slow, fast = fd(ALTERNATING, bytes(64)), fd(ALTERNATING, bytes(64), brs=True)
    count = len(bits_of(fast).sent) + TAIL_BITS
    outside = 1 + 13 + 3 + (TAIL_BITS - 1)  # to BRS, and from the acknowledge slot on

    assert bits_of(slow).duration_ns(count, BIT_NS, DATA_BIT_NS) == count * BIT_NS
    assert bits_of(fast).duration_ns(count, BIT_NS, DATA_BIT_NS) == outside * BIT_NS + (count - outside) * DATA_BIT_NS


def test_a_frame_with_64_bytes_arrives_after_the_time_of_its_two_rates():
    rig, frame = Rig(), fd(0x123, bytes(range(64)), brs=True)
    took_ns = bits_of(frame).duration_ns(len(bits_of(frame).sent) + TAIL_BITS, BIT_NS, DATA_BIT_NS)
    took_us = -(-took_ns // 1000)

    rig.stations[0].send(frame)
    rig.run_us(took_us - 1)
    assert rig.stations[1].received == []
    rig.run_us(1)

    assert rig.stations[1].received == rig.stations[2].received == [frame]


def test_classic_and_flexible_frames_share_the_bus():
    rig = Rig()
    frames = [fd(0x200, bytes(12), brs=True), Frame(0x100, bytes(8)), fd(0x150)]

    for station, frame in zip(rig.stations, frames, strict=True):
        station.send(frame)
    rig.run_us(2000)

    assert rig.stations[0].received == [Frame(0x100, bytes(8)), fd(0x150)]
    assert rig.stations[2].received == [Frame(0x100, bytes(8)), fd(0x200, bytes(12), brs=True)]


def test_an_error_passive_sender_says_so_in_its_frames():
    rig = Rig()
    rig.stations[0].errors.transmit = 200

    rig.stations[0].send(fd(0x100))
    rig.run_us(1000)

    assert rig.stations[1].received == [fd(0x100, esi=True)]


def test_another_data_rate_is_noticed_only_where_the_rate_is_switched():
    rig = Rig(2)
    other = CanStation(rig.wire, RATE_HZ, data_bitrate_hz=1_000_000)

    rig.stations[0].send(fd(0x100, bytes(12)))
    rig.run_us(1000)
    assert (len(other.received), other.damaged) == (1, 0)
    rig.stations[0].send(fd(0x100, bytes(12), brs=True))
    rig.run_us(500)

    assert (len(other.received), other.damaged > 0) == (1, True)


def test_a_classic_controller_that_hears_such_a_frame_destroys_it_until_it_is_passive():
    """The board of the robots has an MCP2515, which knows no CAN FD: its bus is a classic one."""
    rig = CanRig(stations=0).start()
    stations = [CanStation(rig.wire, RATE_HZ, data_bitrate_hz=DATA_RATE_HZ) for _ in range(2)]

    stations[0].send(fd(0x100, bytes(8)))
    rig.run_us(20)
    assert stations[1].received == []
    rig.run_us(500)
    assert stations[1].damaged > 0
    rig.run_us(10_000)

    assert rig.chip.can.errors.passive
    assert stations[1].received == [fd(0x100, bytes(8))]
    assert rig.get(0x2C) & 0x80  # MERRF: the chip says that it heard something damaged
    assert rig.get(0x2C) & 3 == 0  # and has received nothing


def test_a_station_without_a_data_rate_does_not_send_them():
    station = CanStation(CanWire(Clock()), RATE_HZ)

    with pytest.raises(ValueError, match="no bit rate for the data of CAN FD"):
        station.send(fd(0x100))


def test_a_classic_frame_is_as_long_as_ever():
    frame = Frame(0x1234567, b"softrig", extended=True)

    assert len(bits_of(frame).sent) + TAIL_BITS == length_bits(frame)
