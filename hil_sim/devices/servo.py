"""A hobby servo's input: the width of its pulses says the angle it is to go to. The joint itself is the body's.

Pulses of 1.5 ms mean the middle, and it covers its range from 0.5 to 2.5 ms, as makers of 180 degree servos print it.
ASSUMED, in the order of what they print: pulses come 40 to 333 times a second; a change within the dead band, 5 us of
a plain servo and 1 us of a digital one, moves nothing; a pulse outside the range counts as its end up to 100 us beyond,
and is no pulse further out; without pulses for 100 ms it goes limp.

    servo = Servo()
    servo.pulsed(now_us, 1500.0, 20_000.0)
    servo.commanded_deg(now_us + 20_000)
"""

from collections import deque

RATE_MIN_HZ, RATE_MAX_HZ = 40, 333
DEAD_BAND_US = 5.0
OUTSIDE_US = 100.0
LIMP_AFTER_US = 100_000


class Servo:
    """Follows the pulses on its pin, from `low_us` at `low_deg` to `high_us` at `high_deg`."""

    def __init__(
        self,
        low_us: float = 500.0,
        high_us: float = 2500.0,
        low_deg: float = -90.0,
        high_deg: float = 90.0,
        dead_band_us: float = DEAD_BAND_US,
    ) -> None:
        self._low_us = low_us
        self._high_us = high_us
        self._low_deg = low_deg
        self._high_deg = high_deg
        self._dead_band_us = dead_band_us
        self._coming: deque[tuple[int, float | None]] = deque()  # when a width is first measured, None: no more
        self._width_us: float | None = None

    def pulsed(self, from_us: int, width_us: float, period_us: float) -> None:
        """Pulses of this width and period come from then on; a pulse is known at its end."""
        valid = self._measured(width_us) and 1e6 / RATE_MAX_HZ <= period_us <= 1e6 / RATE_MIN_HZ
        if not valid and self._coming and self._coming[-1][1] is None:
            return  # still none: it waits since the last one
        known_us = from_us + round(width_us) if valid else from_us + LIMP_AFTER_US
        while self._coming and self._coming[-1][0] > from_us:
            self._coming.pop()  # never measured: its pulse does not come any more
        self._coming.append((known_us, width_us if valid else None))

    def commanded_deg(self, now_us: int) -> float | None:
        """Return the angle that it is told to go to, or None while it is limp."""
        while self._coming and self._coming[0][0] <= now_us:
            self._take(self._coming.popleft()[1])
        if self._width_us is None:
            return None
        share = (self._width_us - self._low_us) / (self._high_us - self._low_us)
        return self._low_deg + share * (self._high_deg - self._low_deg)

    def _take(self, width_us: float | None) -> None:
        if width_us is None:
            self._width_us = None
        elif self._width_us is None or abs(width_us - self._width_us) >= self._dead_band_us:
            self._width_us = min(self._high_us, max(self._low_us, width_us))

    def _measured(self, width_us: float) -> bool:
        return self._low_us - OUTSIDE_US <= width_us <= self._high_us + OUTSIDE_US
