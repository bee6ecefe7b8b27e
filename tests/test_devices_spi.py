"""SPI: the bus, its chip select, and `machine.SPI`."""

import pytest

from hil_sim.devices.spi import SpiBus, transfer_time_us
from hil_sim.worlds.spi import rate_hz


class Echo:
    """A chip that answers with the byte before."""

    rate_max_hz = 1_000_000
    modes = (0, 3)

    def __init__(self) -> None:
        self.selections: list[bool] = []
        self.last = 0x11

    def select(self, selected: bool) -> None:
        self.selections.append(selected)

    def exchange(self, byte: int) -> int:
        said, self.last = self.last, byte
        return said


@pytest.fixture
def bus():
    low, chip = {17: False}, Echo()
    return SpiBus({17: chip}, low.get), low, chip


def test_only_a_selected_chip_hears(bus):
    bus, low, chip = bus
    assert bus.transfer(b"\x01\x02", 1_000_000, 0) == bytes(2)

    low[17] = True

    assert bus.transfer(b"\x01\x02", 1_000_000, 0) == b"\x11\x01"
    assert chip.selections == [True]


@pytest.mark.parametrize(("rate", "mode"), [(1_000_001, 0), (1_000_000, 1), (1_000_000, 2)])
def test_a_chip_that_is_clocked_wrongly_hears_nothing(bus, rate, mode):
    bus, low, chip = bus
    low[17] = True

    assert bus.transfer(b"\x01\x02", rate, mode) == bytes(2)
    assert chip.last == 0x11


def test_a_byte_takes_eight_bits():
    assert transfer_time_us(1, 8_000_000) == 1
    assert transfer_time_us(14, 1_000_000) == 112
    assert transfer_time_us(3, 7_000_000) == 4


@pytest.mark.parametrize(
    ("wanted", "reached"), [(10_000_000, 8_928_571), (1_000_000, 992_063), (62_500_000, 62_500_000), (100_000, 122_070)]
)
def test_the_divider_reaches_what_the_sdk_computes(wanted, reached):
    assert rate_hz(wanted) == reached
