"""What disturbs a serial line or a bus: bytes that flip, vanish or come twice, transfers that nobody acknowledges.

Each trouble draws from a generator of its own, byte by byte in their order, so that what happens depends neither on
how often somebody looks nor on the other troubles.

    noise = Noise(Random("1"), flip_permille=5)
    uart.inward.noises.append(noise)      # from now on, until it is removed
"""

from collections.abc import Callable, Sequence
from random import Random

from hil_sim.devices import i2c
from hil_sim.devices.i2c import Chip


class Noise:
    """What one direction of a bad line makes of its bytes; rates are per thousand bytes."""

    def __init__(self, draw: Random, flip_permille: int = 0, lose_permille: int = 0, double_permille: int = 0) -> None:
        self._draw = draw
        self._flip, self._lose, self._double = flip_permille, lose_permille, double_permille

    def heard(self, data: bytes) -> bytes:
        """Return what arrives of bytes that were sent."""
        return b"".join(map(self._one, data))

    def _one(self, byte: int) -> bytes:
        hit = self._draw.randrange(1000)
        bit = 1 << self._draw.randrange(8)
        if hit < self._flip:
            return bytes((byte ^ bit,))
        if hit < self._lose:
            return b""
        return bytes((byte,)) * (2 if hit < self._double else 1)


class BusTrouble:
    """What is wrong on a bus: the next `nacks` transfers find nobody, the next `flips` messages have a wrong bit.

    `trap` is called once, at the next transfer.
    """

    def __init__(self, draw: Random, nacks: int = 0, flips: int = 0, trap: Callable[[], None] | None = None) -> None:
        self.nacks = nacks
        self.flips = flips
        self._draw = draw
        self._trap = trap

    def met(self, chips: list[Chip]) -> list[Chip]:
        """Return who answers a transfer to these chips, one or none."""
        if self._trap is not None:
            trap, self._trap = self._trap, None
            trap()
        if self.nacks:
            self.nacks -= 1
            return []
        return [_Misheard(self, chips)] if self.flips and chips else chips

    def flipped(self, data: bytes) -> bytes:
        """Return a message with one bit wrong while there are flips left."""
        if not self.flips or not data:
            return data
        self.flips -= 1
        bit = self._draw.randrange(8 * len(data))
        return bytes(byte ^ (1 << bit % 8 if index == bit // 8 else 0) for index, byte in enumerate(data))


class _Misheard:
    """The chips at one address, heard and spoken to through a bus that flips bits."""

    def __init__(self, trouble: BusTrouble, chips: Sequence[Chip]) -> None:
        self._trouble = trouble
        self._chips = list(chips)

    def answers(self, address: int) -> bool:
        return True

    def write(self, address: int, data: bytes) -> int:
        return i2c.write(self._chips, address, self._trouble.flipped(data))

    def read(self, count: int) -> bytes:
        return self._trouble.flipped(i2c.read(self._chips, count))
