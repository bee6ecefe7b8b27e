"""An I2C bus: who answers an address, what they say, and how long it takes.

A chip is anything with the methods of `Chip`. A transfer is one START..STOP; its writes take effect at STOP. An
address or a byte that nobody acknowledges ends it with OSError(5, "EIO"), as the rp2 port reports it.

    bus = Bus({0x40: ina, 0x60: pca})
    bus.write(0x60, bytes((0x00, 0x20)))
    bus.read(0x40, 2)
"""

from collections.abc import Iterable
from typing import Protocol

GENERAL_CALL = 0
BITS_PER_BYTE = 9  # eight and the acknowledge bit


class Chip(Protocol):
    """What a bus needs of a chip."""

    def answers(self, address: int) -> bool:
        """Return whether the chip acknowledges this 7-bit address."""

    def write(self, address: int, data: bytes) -> int:
        """Take the bytes of one write up to STOP; return how many of them were acknowledged."""

    def read(self, count: int) -> bytes:
        """Return `count` bytes from the place the last write pointed at."""


class Bus:
    """Chips on two wires."""

    def __init__(self, chips: Iterable[Chip] = ()) -> None:
        self.chips = list(chips)
        self.stuck = False  # SDA held low: nothing is acknowledged any more

    def answered(self, address: int) -> bool:
        """Return whether anybody acknowledges this address."""
        return bool(self._at(address))

    def write(self, address: int, data: bytes) -> int:
        """Send `data` to `address` and return the number of bytes acknowledged; -1 for the address itself."""
        heard = [chip.write(address, data) for chip in self._at(address)]
        return max(heard, default=-1)

    def read(self, address: int, count: int) -> bytes | None:
        """Return `count` bytes from `address`, or None when nobody answers. Several chips pull down as one."""
        said = [chip.read(count) for chip in self._at(address)]
        if not said:
            return None
        return said[0] if len(said) == 1 else bytes(_and(column) for column in zip(*said, strict=True))

    def _at(self, address: int) -> list[Chip]:
        return [] if self.stuck else [chip for chip in self.chips if chip.answers(address)]


def bus_time_us(byte_count: int, freq_hz: int) -> int:
    """Return the time of `byte_count` bytes, addresses included, rounded up to a microsecond."""
    return -(-byte_count * BITS_PER_BYTE * 1_000_000 // freq_hz)


def _and(column: Iterable[int]) -> int:
    low = 0xFF
    for byte in column:
        low &= byte
    return low
