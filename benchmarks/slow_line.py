"""A line on virtual time with a speed, a delay and losses, for what must not depend on the machine.

line = SlowLine(baud=115200, delay_ms=16, loss=0.01)
line.out.carry(data, now_us)
arrived = line.out.landed(now_us)
"""

import random


class Way:
    """One direction: frames go one after the other, and each arrives whole, or not at all, a delay after its end."""

    def __init__(self, baud: int, delay_ms: float, chance: random.Random, loss: float) -> None:
        self.busy_until_us = 0.0
        self._byte_us = 10e6 / baud if baud else 0.0
        self._delay_us = 1000 * delay_ms
        self._chance = chance
        self._loss = loss
        self._flying: list[tuple[float, bytes]] = []

    def carry(self, data: bytes, now_us: float) -> None:
        """Take the bytes of a write."""
        for piece in data.split(b"\x00")[:-1]:
            frame = piece + b"\x00"
            self.busy_until_us = max(self.busy_until_us, now_us) + len(frame) * self._byte_us
            if self._chance.random() >= self._loss:
                self._flying.append((self.busy_until_us + self._delay_us, frame))

    def landed(self, now_us: float) -> bytes:
        """Return what has arrived by now."""
        landed = [frame for at_us, frame in self._flying if at_us <= now_us]
        self._flying = self._flying[len(landed) :]
        return b"".join(landed)


class SlowLine:
    """Both directions; a `baud` of 0 is without limit."""

    def __init__(self, baud: int = 0, delay_ms: float = 0.0, loss: float = 0.0, seed: int = 1) -> None:
        chance = random.Random(seed)
        self.out = Way(baud, delay_ms, chance, loss)
        self.back = Way(baud, delay_ms, chance, loss)
