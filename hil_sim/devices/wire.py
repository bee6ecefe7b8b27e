"""One direction of a serial line at its real pace: ten bits a byte, one byte after the other.

Nothing happens per byte. A `Wire` knows when each byte will have arrived and hands over what has, to whoever looks;
times are exact, because positions on the line are kept in bits and not in rounded microseconds.

    wire = Wire(115_200)
    wire.send(b"hello", now_us=0)
    wire.take(now_us=200)  # two bytes: each needs 86.8 us
"""

from collections import deque
from typing import Protocol

BITS_PER_BYTE = 10  # start, eight, stop
_SECOND_US = 1_000_000


class Disturbance(Protocol):
    """What makes others of the bytes on a line."""

    def heard(self, data: bytes) -> bytes:
        """Return what arrives of bytes that were sent."""


class Wire:
    """One direction of a line. Times are held as us * baud, in which a byte is a whole number.

    Bytes arrive `delay_us` after they have left, and as the `noises` make them.
    """

    def __init__(self, baud: int) -> None:
        self.baud = baud
        self.delay_us = 0
        self.noises: list[Disturbance] = []
        self._runs: deque[tuple[int, bytes]] = deque()  # start of the first byte, bytes
        self._free = 0

    def send(self, data: bytes, now_us: int) -> int:
        """Put `data` on the line after what is on it already; return when its last byte will have arrived [us]."""
        start = max(now_us * self.baud, self._free)
        self._free = start + len(data) * BITS_PER_BYTE * _SECOND_US
        if data:
            self._runs.append((start, data))
        return -(-self._free // self.baud) + self.delay_us

    def take(self, now_us: int) -> bytes:
        """Return, once, the bytes that have arrived by now."""
        taken = self._arrived(now_us - self.delay_us)
        for noise in self.noises:
            taken = noise.heard(taken)
        return taken

    def _arrived(self, now_us: int) -> bytes:
        taken = b""
        while self._runs:
            start, data = self._runs[0]
            count = (now_us * self.baud - start) // (BITS_PER_BYTE * _SECOND_US)
            if count < len(data):
                if count > 0:
                    self._runs[0] = (start + count * BITS_PER_BYTE * _SECOND_US, data[count:])
                    taken += data[:count]
                break
            taken += data
            self._runs.popleft()
        return taken

    def next_us(self) -> int | None:
        """Return when the oldest write on the line will have arrived as a whole, or None on a silent line."""
        if not self._runs:
            return None
        start, data = self._runs[0]
        return -(-(start + len(data) * BITS_PER_BYTE * _SECOND_US) // self.baud) + self.delay_us

    def waiting(self, now_us: int) -> int:
        """Return how many bytes have not fully left yet."""
        bits = max(0, self._free - now_us * self.baud)
        return -(-bits // (BITS_PER_BYTE * _SECOND_US))

    def clear(self, now_us: int) -> None:
        """Drop what is on the line."""
        self._runs.clear()
        self._free = now_us * self.baud

    def at(self, baud: int) -> "Wire":
        """Return the same wire at another rate, with nothing on it."""
        wire = Wire(baud)
        wire.delay_us, wire.noises = self.delay_us, self.noises
        return wire
