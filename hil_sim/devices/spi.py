"""An SPI bus: who is selected, what is clocked in and out, and how long it takes.

Each chip hangs on a chip-select pin with a pull-up: it is selected while the processor drives that pin low, and not
while the pin is an input, as after a reset. A chip that is clocked faster than it can, or in a mode that it does not
know, hears nothing; nobody selected, or nobody heard: MISO rests low, by the pull-down of the processor's pad.

    bus = SpiBus({17: Mcp2515(clock, wire)}, lambda pin: pins.mode(pin) == OUT and not pins.driven(pin))
    bus.transfer(b"\\x03\\x0e\\x00", rate_hz=8_000_000, mode=0)
"""

from collections.abc import Callable, Mapping
from typing import Protocol

BITS_PER_BYTE = 8
RESTING = 0x00


class SpiChip(Protocol):
    """What a bus needs of a chip; a mode is its clock's polarity, twice, plus its phase."""

    rate_max_hz: int
    modes: tuple[int, ...]

    def select(self, selected: bool) -> None:
        """Follow the chip-select pin, True for low."""

    def exchange(self, byte: int) -> int:
        """Take one byte and return the one that is clocked out meanwhile."""


class SpiBus:
    """Chips by their chip-select pins; `low` tells whether the processor drives such a pin low."""

    def __init__(self, chips: Mapping[int, SpiChip], low: Callable[[int], bool]) -> None:
        self.chips = dict(chips)
        self._low = low
        self._selected = dict.fromkeys(chips, False)

    def look(self) -> None:
        """Tell each chip whose chip-select pin has changed."""
        for pin, chip in self.chips.items():
            low = self._low(pin)
            if low != self._selected[pin]:
                self._selected[pin] = low
                chip.select(low)

    def transfer(self, data: bytes, rate_hz: int, mode: int) -> bytes:
        """Clock bytes out; return those that were clocked in meanwhile."""
        self.look()
        heard = [
            chip
            for pin, chip in self.chips.items()
            if self._selected[pin] and rate_hz <= chip.rate_max_hz and mode in chip.modes
        ]
        return bytes(_together(heard, byte) for byte in data)


def transfer_time_us(byte_count: int, rate_hz: int) -> int:
    """Return the time of so many bytes, rounded up to a microsecond."""
    return -(-byte_count * BITS_PER_BYTE * 1_000_000 // rate_hz)


def _together(chips: list[SpiChip], byte: int) -> int:
    """Return what several chips that were selected at once put on one line: whoever pulls it high wins."""
    said = RESTING
    for chip in chips:
        said |= chip.exchange(byte)
    return said
