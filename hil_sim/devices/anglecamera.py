"""An angle camera: looks at an object from above and tells its angle over I2C.

ASSUMED, all of it: no camera that is sold is meant, but one of those with a processor of their own, programmed as an
I2C peripheral with five registers, which count up while they are read:

    0     who, 0x5A
    1     status: bit 0, the object is seen
    2     frame counter, 8 bits; it begins at 0, which is no frame
    3, 4  angle in centidegrees, signed, low byte first; 0 while the object is not seen

A frame is exposed at each period, at the next point of the bench's grid, and can be read `latency_ms` later. What one
transfer reads is of one frame. Its noise is a function of the seed and the frame's number, so looking changes nothing.

    camera = AngleCamera(0x33, clock, Optics(rate_hz=100, latency_ms=10, noise_deg=0.02), seed="1")
    camera.expose(now_us, 4.2)  # None: nothing to be seen
"""

import random
from collections import deque
from dataclasses import dataclass

from hil_sim.clock import Clock

IDENTITY = 0x5A
SEEN = 1
STEP_DEG = 0.01


@dataclass(frozen=True)
class Optics:
    """What a camera sees and how fast it tells."""

    rate_hz: float = 100.0
    latency_ms: float = 10.0
    noise_deg: float = 0.02  # rms
    span_deg: float = 60.0  # to either side


class AngleCamera:
    """One camera at `address`; `seed` makes its noise, None an ideal one.

    Faults: not `alive`, it does not answer; `frozen`, its frame counter stands still; `hidden`, it sees no object.
    """

    def __init__(self, address: int, clock: Clock, optics: Optics | None = None, seed: str | None = None) -> None:
        self.address = address
        self.alive = True
        self.frozen = False
        self.hidden = False
        self._clock = clock
        self._optics = optics or Optics()
        self._seed = seed
        self.reset()

    def reset(self) -> None:
        """Begin anew, as a power cycle does."""
        self.frames = 0
        self._due_us = float(self._clock.now_us)
        self._coming: deque[tuple[int, bytes]] = deque()  # frames by the time from which they can be read
        self._shown = _registers(0, None)
        self._pointer = 0

    def expose(self, now_us: int, degrees: float | None) -> None:
        """Let it see the object at that angle, or none; it takes a frame when one is due."""
        self._develop()
        if now_us < self._due_us:
            return
        while self._due_us <= now_us:
            self._due_us += 1e6 / self._optics.rate_hz
        if not self.frozen:
            self.frames += 1
            ready_us = now_us + round(self._optics.latency_ms * 1000)
            self._coming.append((ready_us, _registers(self.frames, self._measured(degrees))))

    def answers(self, address: int) -> bool:
        """Its own address only."""
        return self.alive and address == self.address

    def write(self, address: int, data: bytes) -> int:
        """Take the register that is read next; there is nothing to be written."""
        if data:
            self._pointer = data[0]
        return min(1, len(data))

    def read(self, count: int) -> bytes:
        """Return the register pointed at and those that follow, all of one frame; there is nothing behind the last."""
        self._develop()
        at = self._pointer
        self._pointer = (at + count) & 0xFF
        return self._shown[at : at + count].ljust(count, b"\x00")

    def _develop(self) -> None:
        """Show the newest frame that is ready."""
        while self._coming and self._coming[0][0] <= self._clock.now_us:
            self._shown = self._coming.popleft()[1]

    def _measured(self, degrees: float | None) -> int | None:
        """Return the angle in centidegrees, or None when it is not seen."""
        if degrees is None or self.hidden or abs(degrees) > self._optics.span_deg:
            return None
        return round((degrees + self._noise_deg()) / STEP_DEG)

    def _noise_deg(self) -> float:
        if self._seed is None:
            return 0.0
        return random.Random(f"{self._seed} camera {self.frames}").gauss(0.0, self._optics.noise_deg)


def _registers(frame: int, centideg: int | None) -> bytes:
    angle = (centideg or 0).to_bytes(2, "little", signed=True)
    return bytes((IDENTITY, 0 if centideg is None else SEEN, frame & 0xFF)) + angle
