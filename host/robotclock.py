"""The robot's clock as the host reckons it: offset, drift and how far off at most, from what cannot be otherwise.

A robot time that has arrived was told earlier: the robot's clock is at least that far now. A robot time told in answer
to a question was read after the question left: the clock was at most that far then. Every line through both kinds of
bounds that drifts by 500 ppm or less is possible; `earliest` is the least of them, `at` the middle, `bound_ms` half of
what lies between. Bounds that no such line goes through are those of a clock that jumped, stood still or runs at
another speed, as that of a bench on a busy machine may: then the newest counts, and nothing is called known until the
clock has kept its pace for a while. Robot times are 32 bits and wrap; they are whole milliseconds, so one rounded down
stands for any time of the next millisecond.

    clock.read(telemetry.now_ms, now_ms)
    clock.answered(asked_ms, reply.received_ms)
    clock.at(now_ms), clock.figures(now_ms).bound_ms
"""

from __future__ import annotations

from math import inf
from typing import NamedTuple

from host.clockbounds import Bound, Lines

WRAP = 1 << 32
TICK_MS = 1.0  # a time of the robot is rounded down to it
READ_MS = 0.2  # ASSUMED: from the robot's look at its clock until it has read the bytes that wait
SETTLE_MS = 2000  # without a contradiction, before anything is known of the clock: four answers
STRETCH_MS = 5000  # of these, only the last bound of each kind is kept
STRETCHES = 24


class ClockFigures(NamedTuple):
    """What is known of the robot's clock: robot minus host, how fast that grows, and how far off at most."""

    offset_ms: float
    drift_ppm: float
    bound_ms: float


class RobotClock:
    """The robot's clock on the host's, which must never jump; both in milliseconds."""

    def __init__(self) -> None:
        self._bounds: dict[int, list[Bound]] = {1: [], -1: []}  # by side, oldest first
        self._lines: Lines | None = None
        self._contradicted_ms = -inf

    def read(self, robot_ms: int, now_ms: float, line_ms: float = 0.0) -> None:
        """Take a robot time that had arrived by the host's `now_ms`, after at least `line_ms` on the line."""
        self._take(Bound(now_ms, self._unwrapped(robot_ms, now_ms) + line_ms - now_ms, -1))

    def answered(self, asked_ms: float, robot_ms: int, line_ms: float = 0.0) -> None:
        """Take the robot time at which a question had come that left at `asked_ms`, after `line_ms` on the line."""
        latest_ms = self._unwrapped(robot_ms, asked_ms) + TICK_MS + READ_MS - line_ms
        self._take(Bound(asked_ms, latest_ms - asked_ms, 1))

    def at(self, now_ms: float) -> int | None:
        """Return the robot's clock at the host's `now_ms`, or None before any robot time was read."""
        return None if self._lines is None else round(now_ms + self._middle_ms(self._lines, now_ms)) % WRAP

    def earliest(self, now_ms: float) -> int | None:
        """Return what the robot's clock shows at least, unless it has begun anew."""
        return None if self._lines is None else int(now_ms + self._lines.ahead_ms(now_ms)[0]) % WRAP

    def figures(self, now_ms: float) -> ClockFigures | None:
        """Return offset, drift and bound at the host's `now_ms`, or None before bounds on both sides agree."""
        if self._lines is None or not (self._bounds[1] and self._bounds[-1]):
            return None
        if now_ms - self._contradicted_ms < SETTLE_MS:
            return None
        low_ms, high_ms = self._lines.ahead_ms(now_ms)
        return ClockFigures((low_ms + high_ms) / 2, self._lines.drift_ppm(), (high_ms - low_ms) / 2)

    def _middle_ms(self, lines: Lines, now_ms: float) -> float:
        """Return how far the robot's clock is ahead: the middle, or the only bound there is."""
        low_ms, high_ms = lines.ahead_ms(now_ms)
        if not self._bounds[1]:
            return low_ms
        return (low_ms + high_ms) / 2 if self._bounds[-1] else high_ms

    def _unwrapped(self, robot_ms: int, now_ms: float) -> float:
        """Return the robot time that goes on growing where its 32 bits begin again."""
        if self._lines is None:
            return robot_ms
        expected_ms = int(now_ms + self._middle_ms(self._lines, now_ms))
        return expected_ms + since(robot_ms, expected_ms)

    def _take(self, bound: Bound) -> None:
        """Keep a bound that says more than all before it; forget those that contradict it."""
        if self._lines is not None and not self._lines.narrowed_by(bound):
            return
        side = self._bounds[bound.side]
        if side and side[-1].now_ms // STRETCH_MS == bound.now_ms // STRETCH_MS:
            side.pop()
        side.append(bound)
        del side[:-STRETCHES]
        newest_first = sorted(self._bounds[1] + self._bounds[-1], key=lambda each: -each.now_ms)
        self._lines, agreeing = Lines.through(bound, newest_first)
        if len(agreeing) < len(newest_first):
            self._contradicted_ms = bound.now_ms
        self._bounds = {sign: [each for each in reversed(agreeing) if each.side == sign] for sign in (1, -1)}


def since(later_ms: int, earlier_ms: int) -> int:
    """Return the time between two robot times, negative when `later_ms` is the earlier one."""
    return (later_ms - earlier_ms + WRAP // 2) % WRAP - WRAP // 2
