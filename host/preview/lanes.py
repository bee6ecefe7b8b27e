"""The lanes of a picture, one below the other: a coil with its duties and temperatures, a joint, the force.

Two ways can be on one lane: the first is drawn solid, the second dashed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from host.gait.model.course import Bar, Course, Track
from host.preview.drawing import Drawing, thinned
from host.preview.joints import Targets
from host.preview.scale import Times, Values, ticks

LANE, JOINT_LANE, BETWEEN = 46.0, 40.0, 7.0
LEFT, RIGHT = 96.0, 108.0
SMALL = 8.5
COLD_DEGC = 20.0
Line = list[tuple[float, float]]


@dataclass(frozen=True)
class Lanes:
    """Draws lanes on one scale of time."""

    drawing: Drawing
    times: Times
    first: Course  # drawn solid
    trip_degc: float  # 0: no temperatures are known
    hottest_degc: float

    def coil(
        self, y: float, label: str, under: str, ways: Sequence[tuple[Course, Track]], right: Sequence[str]
    ) -> None:
        """Draw a coil whose lane begins at y: its duties from the foot up, its temperatures over them."""
        drawing = self.drawing
        self._ground(y, LANE, label, under, right)
        for course, track in ways:
            for bar in track.bars:
                self._bar(y + LANE, bar, course, "duty" if course is self.first else "edge")
        if not self.trip_degc:
            return
        values = Values(y + LANE, LANE, COLD_DEGC, max(self.trip_degc, self.hottest_degc) + 6)
        for degc in ticks(COLD_DEGC, self.trip_degc - 24, 3):
            drawing.text(LEFT - 5, values.y(degc) + 3, f"{degc:g}", "quiet", SMALL, "end")
        trip = values.y(self.trip_degc)
        drawing.line("trip", LEFT, trip, LEFT + self.times.width, trip)
        drawing.text(LEFT - 5, trip + 3, f"{self.trip_degc:g}", "tripped", SMALL, "end")
        lines = [self._curve(course, track, values) for course, track in ways]
        if len(lines) == 2 and all(lines):
            drawing.curve("band", band(*lines), closed=True)
        for line, (course, _) in reversed(list(zip(lines, ways, strict=True))):
            drawing.curve("heat" if course is self.first else "other", thinned(line))

    def joint(self, y: float, ways: Sequence[tuple[Course, Targets]], low: float, high: float) -> None:
        """Draw what is asked of a joint, or of what joints hold, in its own unit."""
        targets = ways[0][1]
        asked = sorted({value for _, each in ways for value in each.values})
        ends = " .. ".join(f"{value:g}" for value in dict.fromkeys((asked[0], asked[-1]))) if asked else ""
        right = [f"{ends} {targets.unit}", "targets"] if asked else ["regulated"]
        self._ground(y, JOINT_LANE, targets.label, targets.unit, right)
        values = Values(y + JOINT_LANE - 4, JOINT_LANE - 8, low, high)
        for value in ticks(low, high, 3):
            self.drawing.text(LEFT - 5, values.y(value) + 3, f"{value:g}", "quiet", SMALL, "end")
            self.drawing.line("faint", LEFT, values.y(value), LEFT + self.times.width, values.y(value))
        for course, targets in ways:
            for begin, end in targets.spans:
                x = self.times.x(begin, course.gaps)
                self.drawing.rect("held", x, y, self.times.x(end, course.gaps) - x, JOINT_LANE)
            kinds = [("guess", targets.guesses), ("joint" if course is self.first else "joint2", targets.lines)]
            for kind, line in [(kind, line) for kind, lines in kinds for line in lines]:
                self.drawing.curve(kind, [(self.times.x(ms, course.gaps), values.y(value)) for ms, value in line])

    def _ground(self, y: float, height: float, label: str, under: str, right: Sequence[str]) -> None:
        self.drawing.rect("lane", LEFT, y, self.times.width, height)
        self.drawing.text(8, y + height / 2 + (0 if under else 4), label, size=12, bold=True)
        if under:
            self.drawing.text(8, y + height / 2 + 12, under, "quiet", SMALL)
        x, first = LEFT + self.times.width + 8, y + height / 2 + (4 if len(right) < 2 else -1 if len(right) < 3 else -7)
        for i, text in enumerate(right):
            self.drawing.text(x, first + 12 * i, text, "quiet" if i else "", 9 if i else 12, bold=not i)

    def _bar(self, foot: float, bar: Bar, course: Course, kind: str) -> None:
        """Draw an order as high as its duty; with a ramp it rises, and where it only keeps a coil warm it is hollow."""
        x, end = self.times.x(bar.begin_ms, course.gaps), self.times.x(bar.end_ms, course.gaps)
        top = foot - LANE * bar.duty_permille / 1000
        risen = min(self.times.x(bar.begin_ms + bar.ramp_ms, course.gaps), end)
        share = min(1.0, (bar.end_ms - bar.begin_ms) / bar.ramp_ms) if bar.ramp_ms else 1.0
        points = [(x, foot), (risen, foot + (top - foot) * share), (end, foot + (top - foot) * share), (end, foot)]
        self.drawing.curve("kept" if bar.keep_decidegc and kind == "duty" else kind, points, closed=True)

    def _curve(self, course: Course, track: Track, values: Values) -> Line:
        return [(self.times.x(ms, course.gaps), values.y(degc)) for ms, degc in track.curve]


def band(first: Line, second: Line) -> Line:
    """Return the outline of what lies between two curves, where there are both, and along the longer one."""
    ends = np.array(first), np.array(second)
    x = np.unique(np.concatenate([each[:, 0] for each in ends]))
    heights = [np.interp(x, each[:, 0], each[:, 1]) for each in ends]
    for each, height in zip(ends, heights, strict=True):
        height[x > each[-1, 0]] = np.nan  # it is over: only the other is left
    upper, lower = np.fmin(*heights).tolist(), np.fmax(*heights).tolist()
    places = x.tolist()
    return thinned(list(zip(places, upper, strict=True))) + thinned(list(zip(places, lower, strict=True)))[::-1]
