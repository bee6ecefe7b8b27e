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


class Trouble(Protocol):
    """What disturbs the transfers of a bus."""

    def met(self, chips: list[Chip]) -> list[Chip]:
        """Return who answers a transfer to these chips."""


class Bus:
    """Chips on two wires, with the troubles that there are on them."""

    def __init__(self, chips: Iterable[Chip] = ()) -> None:
        self.chips = list(chips)
        self.stuck = False  # SCL held low: no transfer ends before its time-out
        self.troubles: list[Trouble] = []

    def at(self, address: int) -> list[Chip]:
        """Begin a transfer: return the chips that acknowledge this address."""
        chips = [] if self.stuck else [chip for chip in self.chips if chip.answers(address)]
        for trouble in self.troubles:
            chips = trouble.met(chips)
        return chips

    def write(self, address: int, data: bytes) -> int:
        """Send `data` to `address` and return the number of bytes acknowledged; -1 for the address itself."""
        return write(self.at(address), address, data)

    def read(self, address: int, count: int) -> bytes | None:
        """Return `count` bytes from `address`, or None when nobody answers."""
        chips = self.at(address)
        return read(chips, count) if chips else None


def write(chips: list[Chip], address: int, data: bytes) -> int:
    """Send `data` to chips that answer one address; return how many bytes any of them acknowledged, else -1."""
    if len(chips) == 1:
        return chips[0].write(address, data)
    return max((chip.write(address, data) for chip in chips), default=-1)


def read(chips: list[Chip], count: int) -> bytes:
    """Return `count` bytes from the chips at one address, at least one; several pull the line down as one."""
    if len(chips) == 1:
        return chips[0].read(count)
    return bytes(_and(column) for column in zip(*[chip.read(count) for chip in chips], strict=True))


def bus_time_us(byte_count: int, freq_hz: int) -> int:
    """Return the time of `byte_count` bytes, addresses included, rounded up to a microsecond."""
    return -(-byte_count * BITS_PER_BYTE * 1_000_000 // freq_hz)


def _and(column: Iterable[int]) -> int:
    low = 0xFF
    for byte in column:
        low &= byte
    return low
