"""All lines that two clocks can have to each other, when some of their readings are bounded from above or below.

A line is how far the robot's clock is ahead of the host's at one time, and its drift. Each bound cuts a half-plane off
the set of possible lines, which stays a convex polygon. The drift may wander a little, so that a bound counts for less
the older it is. Derived here.

    lines, agreeing = Lines.through(newest, newest_first)
    low_ms, high_ms = lines.ahead_ms(now_ms)
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

DRIFT_MAX = 500e-6  # ten times what a poor crystal is off
WANDER_PER_MS = 0.05e-9  # ASSUMED: 0.05 ppm a second, a crystal whose board grows warmer
SLACK_MS = 1e-3  # clocks are read in microseconds
GAIN_MS = 0.02  # what rules out less is not worth the reckoning
FAR_MS = float(1 << 33)


class Bound(NamedTuple):
    """At the host's `now_ms` the robot's clock was ahead by `ahead_ms` at most (side 1) or at least (side -1)."""

    now_ms: float
    ahead_ms: float
    side: int


Corner = tuple[float, float]  # ahead at the time of the newest bound, drift


class Lines:
    """The possible lines: the corners of their polygon, about the time of the newest bound."""

    def __init__(self, now_ms: float, corners: list[Corner]) -> None:
        self._now_ms = now_ms
        self._corners = corners

    @classmethod
    def through(cls, newest: Bound, newest_first: list[Bound]) -> tuple[Lines, list[Bound]]:
        """Return the lines that agree with the bounds, and these; from the first that contradicts, none is heeded."""
        about_ms = newest.ahead_ms
        lines = cls(newest.now_ms, [
            (about_ms - FAR_MS, -DRIFT_MAX), (about_ms + FAR_MS, -DRIFT_MAX),
            (about_ms + FAR_MS, DRIFT_MAX), (about_ms - FAR_MS, DRIFT_MAX),
        ])  # fmt: skip
        agreeing: list[Bound] = []
        for bound in [newest, *(each for each in newest_first if each is not newest)]:
            corners = lines._cut(bound)
            if not corners:
                break
            lines = cls(newest.now_ms, corners)
            agreeing.append(bound)
        return lines, sorted(agreeing, key=lambda each: -each.now_ms)

    def ahead_ms(self, now_ms: float) -> tuple[float, float]:
        """Return how far the robot's clock is ahead at least and at most."""
        age_ms = now_ms - self._now_ms
        ahead = [ahead_ms + drift * age_ms for ahead_ms, drift in self._corners]
        wandered_ms = _wandered_ms(age_ms)
        return min(ahead) - wandered_ms, max(ahead) + wandered_ms

    def drift_ppm(self) -> float:
        """Return the middle of the possible drifts."""
        drifts = [drift for _, drift in self._corners]
        return (min(drifts) + max(drifts)) / 2 * 1e6

    def narrowed_by(self, bound: Bound) -> bool:
        """Return whether `bound` rules out any of these lines worth mentioning."""
        low_ms, high_ms = self.ahead_ms(bound.now_ms)
        return bound.ahead_ms < high_ms - GAIN_MS if bound.side > 0 else bound.ahead_ms > low_ms + GAIN_MS

    def _cut(self, bound: Bound) -> list[Corner]:
        """Return the corners of what `bound` leaves; none when it contradicts all lines."""
        age_ms = bound.now_ms - self._now_ms
        limit_ms = bound.ahead_ms + bound.side * (SLACK_MS + _wandered_ms(age_ms))
        beyond = [bound.side * (ahead_ms + drift * age_ms - limit_ms) for ahead_ms, drift in self._corners]
        kept: list[Corner] = []
        rim = zip(self._corners, beyond, strict=True)
        for (corner, over_ms), (following, next_over_ms) in pairwise([*rim, (self._corners[0], beyond[0])]):
            if over_ms <= 0:
                kept.append(corner)
            if over_ms * next_over_ms < 0:
                share = over_ms / (over_ms - next_over_ms)
                (ahead_ms, drift), (next_ahead_ms, next_drift) = corner, following
                kept.append((ahead_ms + share * (next_ahead_ms - ahead_ms), drift + share * (next_drift - drift)))
        return kept


def _wandered_ms(age_ms: float) -> float:
    """Return how far a clock strays from a straight line in that time."""
    return WANDER_PER_MS * age_ms * age_ms / 2
