"""A linear servo: a motor, a screw that locks itself and a position loop of first order.

Positions are in mm and grow downwards, `force_n` is what the block pushes up with. The loop asks for a speed in
proportion to the way that is left. A force against the motion takes its share of the stall force from the greatest
speed, down to none; a force with it adds nothing, and none moves a screw that is not driven: limp it stays where it is.

    screw = Screw(ScrewNumbers(rate_mm_per_s=12.0, bandwidth_rad_per_s=60.0, stall_n=40.0, stall_a=1.5, idle_a=0.01))
    screw.advance(4.0, force_n=3.0, seconds=0.005)       # None: limp
    screw.at_mm, screw.current_a

ASSUMED: the current grows with the force from the idle to the stall current, also while the screw stands: the loop
works on against its friction. What cannot turn at all takes what the loop drives it with.
"""

from math import exp
from typing import NamedTuple


class ScrewNumbers(NamedTuple):
    """What a linear servo can do."""

    rate_mm_per_s: float  # without load
    bandwidth_rad_per_s: float
    stall_n: float
    stall_a: float
    idle_a: float


class Screw:
    """One linear servo, at 0 when it is made."""

    def __init__(self, numbers: ScrewNumbers) -> None:
        self.at_mm = 0.0
        self.jammed = False
        self.effort = 0.0  # share of what the motor can do
        self._numbers = numbers

    @property
    def current_a(self) -> float:
        """Current while it has power."""
        numbers = self._numbers
        return numbers.idle_a + (numbers.stall_a - numbers.idle_a) * self.effort

    def advance(self, command_mm: float | None, force_n: float, seconds: float) -> None:
        """Let it go towards a position for some time, under a force that does not change meanwhile."""
        if command_mm is None:
            self.effort = 0.0
            return
        way_mm = command_mm - self.at_mm
        sign = 1.0 if way_mm > 0.0 else -1.0
        limit_mm_per_s = 0.0 if self.jammed else self._limit(sign * force_n)
        left_mm = self._left(abs(way_mm), limit_mm_per_s, seconds)
        if left_mm != abs(way_mm):
            self.at_mm = command_mm - sign * left_mm
        self.effort = self._effort(left_mm, limit_mm_per_s, force_n)

    def _limit(self, against_n: float) -> float:
        """Return the greatest speed under a force against the motion."""
        share = min(1.0, max(0.0, 1.0 - against_n / self._numbers.stall_n))
        return self._numbers.rate_mm_per_s * share

    def _left(self, way_mm: float, limit_mm_per_s: float, seconds: float) -> float:
        """Return how far it still has to go: at the greatest speed first, then ever slower."""
        if not limit_mm_per_s:
            return way_mm
        near_mm = limit_mm_per_s / self._numbers.bandwidth_rad_per_s
        fast_s = max(0.0, (way_mm - near_mm) / limit_mm_per_s)
        if seconds <= fast_s:
            return way_mm - limit_mm_per_s * seconds
        return min(way_mm, near_mm) * exp(-self._numbers.bandwidth_rad_per_s * (seconds - fast_s))

    def _effort(self, left_mm: float, limit_mm_per_s: float, force_n: float) -> float:
        """Return which share of its force the motor exerts: the load, or what drives it without moving it."""
        numbers = self._numbers
        asked_mm_per_s = numbers.bandwidth_rad_per_s * left_mm
        unmet = (
            min(asked_mm_per_s, numbers.rate_mm_per_s) - min(asked_mm_per_s, limit_mm_per_s)
        ) / numbers.rate_mm_per_s
        return min(1.0, max(abs(force_n) / numbers.stall_n, unmet))
