"""Scales of a picture: time with its gaps, values on a lane, and round numbers to write beside them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, floor, log10

from host.gait.model.course import Course, Gap

GAP_SHARE = 0.06  # of all that is drawn, for turns that are not told


@dataclass(frozen=True)
class Times:
    """Where a time is drawn; a gap of any length takes the same room."""

    left: float
    width: float
    told_ms: float  # all that is drawn, gaps included

    def x(self, at_ms: float, gaps: Sequence[Gap]) -> float:
        """Return the place of a time of a course with these gaps."""
        told = at_ms
        for gap in gaps:
            room_ms = GAP_SHARE * self.told_ms
            if at_ms >= gap.end_ms:
                told += room_ms - (gap.end_ms - gap.begin_ms)
            elif at_ms > gap.begin_ms:
                told += (at_ms - gap.begin_ms) * (room_ms / (gap.end_ms - gap.begin_ms) - 1)
        return self.left + self.width * told / self.told_ms


def times_of(courses: Sequence[Course], left: float, width: float) -> Times:
    """Return the scale on which all of these courses have room."""
    told = 1.0
    for course in courses:
        told = max(told, course.told_ms / (1 - GAP_SHARE * len(course.gaps[:8])))
    return Times(left, width, told)


def ticks(low: float, high: float, most: int) -> list[float]:
    """Return at most so many round numbers, evenly spaced, from `low` to `high`."""
    span = max(high - low, 1e-9)
    size = 10 ** floor(log10(span / most))
    every = next(size * factor for factor in (1, 2, 5, 10, 20) if span / (size * factor) <= most)
    first = ceil(low / every - 1e-9)
    return [round(k * every, 9) for k in range(first, floor(high / every + 1e-9) + 1)]


def instants(course: Course, until_ms: float, most: int) -> list[float]:
    """Return round times [s] to write below what is drawn of a course, about so many, none within a gap."""
    marks = ticks(0, max(until_ms - (course.end_ms - course.told_ms), 1) / 1000, most)
    every = marks[1] - marks[0] if len(marks) > 1 else max(until_ms / 1000, 1e-3)
    stretches: list[tuple[float, float]] = []
    begin_ms = 0.0
    for gap in course.gaps:
        stretches.append((begin_ms, gap.begin_ms))
        begin_ms = gap.end_ms
    stretches.append((begin_ms, until_ms))
    found = []
    for first_ms, last_ms in stretches:
        numbers = range(ceil(first_ms / 1000 / every - 1e-9), floor(last_ms / 1000 / every + 1e-9) + 1)
        found += [round(number * every, 9) for number in numbers]
    return found


@dataclass(frozen=True)
class Values:
    """Where a value is drawn on a lane, from its foot up."""

    foot: float
    height: float
    low: float
    high: float

    def y(self, value: float) -> float:
        """Return the place of a value."""
        share = (value - self.low) / (self.high - self.low)
        return self.foot - self.height * min(1.0, max(0.0, share))
