"""MCP3208 against sections 5 and 6 of its data sheet, clock by clock."""

import pytest

from hil_sim.devices.mcp3208 import Mcp3208
from hil_sim.devices.spi import SpiBus

SELECT = 13
VOLTS = 3.3 / 4096  # of a count
PATTERN = 0x9A5


class Rig:
    """A chip on a bus; channel n is at n + 1 tenths of a volt, and channel 3 at a pattern of bits."""

    def __init__(self, **options) -> None:
        inputs = {channel: lambda channel=channel: 0.1 * (channel + 1) for channel in range(8)}
        self.chip = Mcp3208({**inputs, 3: lambda: PATTERN * VOLTS}, **options)
        self.low = True
        self.bus = SpiBus({SELECT: self.chip}, lambda pin: self.low)

    def send(self, *data: int, rate_hz: int = 1_000_000, mode: int = 0) -> bytes:
        """Send bytes while the chip is selected anew."""
        self.low = False
        self.bus.look()
        self.low = True
        return self.bus.transfer(bytes(data), rate_hz, mode)

    def bits(self, order: int, clocks: int = 40, zeros: int = 0) -> str:
        """Send start bit and order behind so many zeros; return what comes from then on, a digit a clock."""
        count = -(-(zeros + clocks) // 8) * 8
        sent = int(f"{'0' * zeros}1{order:04b}".ljust(count, "0"), 2).to_bytes(count // 8, "big")
        came = "".join(f"{byte:08b}" for byte in self.send(*sent))
        return came[zeros : zeros + clocks]

    def counts(self, order: int) -> int:
        return int(self.bits(order)[7:19], 2)


@pytest.fixture
def rig() -> Rig:
    return Rig()


def test_the_null_bit_and_twelve_bits_follow_start_order_and_sample(rig):
    start, order, sample, null = "0", "0000", "0", "0"

    assert rig.bits(0b1011, 19) == start + order + sample + null + f"{PATTERN:012b}"


def test_who_clocks_on_gets_the_same_bits_from_the_lowest_up_and_then_zeros(rig):
    came = rig.bits(0b1011, 48)

    assert came[7:19] == f"{PATTERN:012b}"
    assert came[18:30] == f"{PATTERN:012b}"[::-1]
    assert came[30:] == "0" * 18


@pytest.mark.parametrize("zeros", [1, 5, 7, 30])
def test_leading_zeros_move_the_answer_and_nothing_else(rig, zeros):
    assert rig.bits(0b1011, zeros=zeros) == rig.bits(0b1011)


@pytest.mark.parametrize("mode", [0, 3])
def test_five_leading_zeros_put_the_result_at_the_end_of_three_bytes(rig, mode):
    came = rig.send(0x06, 0xC0, 0x00, mode=mode)

    assert (came[1] & 0x0F) << 8 | came[2] == PATTERN
    assert not came[1] & 0x10


@pytest.mark.parametrize("channel", [0, 1, 2, 4, 5, 6, 7])
def test_each_channel_is_read_by_itself(rig, channel):
    assert rig.counts(0b1000 | channel) == round(0.1 * (channel + 1) / VOLTS)


@pytest.mark.parametrize(("order", "plus", "minus"), [(1, 1, 0), (5, 5, 4), (7, 7, 6)])
def test_a_pair_reads_the_difference_and_0_the_other_way_round(rig, order, plus, minus):
    assert rig.counts(order) == round(0.1 * (plus - minus) / VOLTS)
    assert rig.counts(order - 1) == 0


def test_the_result_stays_within_twelve_bits(rig):
    rig.chip.inputs.update({0: lambda: 5.0, 1: lambda: -1.0, 2: lambda: 4095 * VOLTS})

    assert [rig.counts(order) for order in (8, 9, 10)] == [4095, 0, 4095]


def test_an_input_that_hangs_in_the_air_is_at_0(rig):
    del rig.chip.inputs[4]
    rig.chip.opened.add(5)

    assert (rig.counts(0b1100), rig.counts(0b1101)) == (0, 0)


def test_one_selection_is_one_conversion(rig):
    rig.send(0x06, 0xC0, 0x00)

    again = rig.bus.transfer(b"\x06\x00\x00", 1_000_000, 0)

    assert again[1:] == bytes((0b0010_0000, 0))  # the rest of the first one's bits, upwards
    assert rig.chip.conversions == 1


def test_a_conversion_that_is_cut_short_leaves_nothing_behind(rig):
    rig.send(0x06, 0xC0)

    assert rig.counts(0b1011) == PATTERN


def test_the_input_is_sampled_at_the_fifth_clock_after_the_start_bit(rig):
    start_and_order = 0b0001_1011
    rig.send(start_and_order)
    assert rig.chip.conversions == 0

    rig.bus.transfer(b"\x00", 1_000_000, 0)

    assert rig.chip.conversions == 1


@pytest.mark.parametrize(("rate_hz", "mode"), [(1_000_001, 0), (1_000_000, 1), (1_000_000, 2)])
def test_a_clock_that_the_sheet_does_not_allow_reads_nothing(rig, rate_hz, mode):
    assert rig.send(0x06, 0xC0, 0x00, rate_hz=rate_hz, mode=mode) == bytes(3)


def test_a_chip_that_begins_while_selected_waits_until_it_was_not(rig):
    rig.send()
    rig.chip.reset()

    assert rig.bus.transfer(b"\x06\xc0\x00", 1_000_000, 0) == bytes(3)
    assert rig.counts(0b1011) == PATTERN


def test_a_dead_chip_reads_nothing(rig):
    rig.chip.alive = False

    assert rig.send(0x06, 0xC0, 0x00) == bytes(3)


def test_noise_is_as_great_as_stated_and_the_same_for_a_seed():
    one, again, other = ([rig.counts(0b1011) for _ in range(400)] for rig in map(noisy, ("1", "1", "2")))

    mean = sum(one) / len(one)
    rms = (sum((count - mean) ** 2 for count in one) / len(one)) ** 0.5
    assert one == again != other
    assert mean == pytest.approx(PATTERN, abs=0.5)  # 2 / sqrt(400) is 0.1
    assert rms == pytest.approx(2.0, rel=0.15)  # of 400 samples, 4 times the error that is to be expected


def noisy(seed: str) -> Rig:
    """Return a rig whose chip has a noise of 2 bits."""
    return Rig(noise_lsb=2.0, seed=seed)
