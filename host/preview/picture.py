"""The picture of a script: every coil's duty and predicted temperature over time, joints, waits, notes and lines."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from host.gait.forecast import Forecast
from host.gait.model.course import Course, Track
from host.preview.compare import CoilChange, Lines, changes
from host.preview.drawing import Drawing, shortened, wide
from host.preview.joints import Targets, targets_of
from host.preview.lanes import BETWEEN, JOINT_LANE, LANE, LEFT, RIGHT, Lanes
from host.preview.scale import times_of
from host.preview.strips import ROW, draw_flags, draw_gaps, draw_lines, draw_time, draw_waits, laid_flags

WIDTH = 960.0
WAYS = "solid: other waits are over at once; dashed: they run out"
DIFFERENCE = "solid: {new}; dashed: {old}"
STEPS_SHOWN = 12
LARGE_MJ, LARGE_MS = 10_000, 100_000
DOT = " · "


def picture(forecast: Forecast, theme: str = "auto") -> str:
    """Return the picture of one script."""
    sheet = Sheet(list(forecast.ways.values()), forecast)
    sheet.head(f"{_name(forecast)} on {forecast.compiled.profile.robot}", summary(forecast))
    sheet.body({track.label: right_of(track) for track in _driven(sheet.ways)})
    sheet.legend([WAYS] if forecast.forked else [])
    return sheet.svg(theme)


def difference(old: Forecast, new: Forecast, theme: str = "auto") -> str:
    """Return the picture of what changed from one script to another."""
    found = changes(old, new)
    sheet = Sheet([new.early, old.early], new, old)
    sheet.head(f"{_name(old)} → {_name(new)} on {new.compiled.profile.robot}", found.summary)
    sheet.body({row.label: _changed(row) for row in found.coils})
    sheet.legend([DIFFERENCE.format(new=_name(new), old=_name(old))])
    sheet.steps("added", "add", "+", found.added)
    sheet.steps("removed", "drop", "−", found.removed)
    return sheet.svg(theme)


def summary(forecast: Forecast) -> str:
    """Return the whole in one line: how long it takes, and the hottest coil."""
    ends = " to ".join(dict.fromkeys(f"{course.end_ms / 1000:.1f}" for course in forecast.ways.values()))
    peaks = forecast.peaks()
    parts = [f"{ends} s"] + ([f"{len(peaks)} coils driven"] if peaks else [])
    if peaks and not forecast.why_not:
        hottest = max(peaks, key=lambda peak: peak.degc)
        line = f" ({hottest.step.where})" if hottest.step else ""
        parts.append(f"hottest {hottest.track.label}: {hottest.degc:.0f} °C after {hottest.at_ms / 1000:.1f} s{line}")
        parts.append(f"the robot trips at {forecast.compiled.profile.coil.trip_degc} °C")
    elif peaks:
        parts.append(forecast.why_not)
    return DOT.join(parts + [remark.strip() for remark in forecast.remarks()])


def right_of(track: Track) -> list[str]:
    """Return what stands to the right of a coil's lane."""
    on = f"on {_seconds(track.on_ms)} s"
    if not track.curve:
        return [on]
    energy = f"{track.energy_mj:.0f} mJ" if track.energy_mj < LARGE_MJ else f"{track.energy_mj / 1000:.4g} J"
    return [f"{track.peak_degc:.0f} °C", f"at {_seconds(track.peak_ms)} s", f"{on}, {energy}"]


class Sheet:
    """Fills a picture from the top down; the first of the ways is drawn solid."""

    def __init__(self, ways: Sequence[Course], forecast: Forecast, other: Forecast | None = None) -> None:
        self.ways, self._forecast, self._others = ways, forecast, (other or forecast).compiled
        self._compares = other is not None
        self._waiting = ways[0] if self._compares else ways[-1]  # whose waits are shown
        self._drawing = Drawing(WIDTH)
        self._times = times_of(ways, LEFT, WIDTH - LEFT - RIGHT)
        self._y = 0.0

    def head(self, title: str, under: str) -> None:
        """Write the title and what is to be said of the whole."""
        self._drawing.text(8, 22, shortened(title, WIDTH - 16, 15), size=15, bold=True)
        self._y = 39.0
        for line in wrapped(under, WIDTH - 16, 10.5):
            self._drawing.text(8, self._y, line, "quiet", 10.5)
            self._y += 14
        self._y += 4

    def body(self, rights: dict[str, list[str]]) -> None:
        """Draw lanes, and the strips above and below them."""
        drawing, times, compiled = self._drawing, self._times, self._forecast.compiled
        flags = laid_flags(times, compiled, self.ways[0])
        rows = len(self.ways) + (1 + max(flag.row for flag in flags) if flags else 0) + bool(self._waiting.pauses)
        top = self._y + rows * ROW
        foot = self._lanes(top, rights)
        strip = draw_flags(drawing, flags, self._y, foot)
        if len(self.ways) > 1:
            strip = draw_lines(drawing, times, strip, strip + ROW, self._others, self.ways[1], "line, dashed")
        strip = draw_waits(drawing, times, strip, foot, self._waiting)
        draw_lines(drawing, times, strip, foot, compiled, self.ways[0])
        draw_gaps(drawing, times, top, foot, self.ways[-1])
        self._y = draw_time(drawing, times, foot + 2, self.ways[-1])

    def legend(self, told: Sequence[str]) -> None:
        """Draw what the marks mean that are in this picture, then say what stands for what."""
        x, y = LEFT, self._y + 14
        for kind, text in self._marks():
            room = 26 + wide(text, 9.5) + 14
            if x + room > WIDTH - 8:
                x, y = LEFT, y + 16
            _mark(self._drawing, kind, x, y)
            self._drawing.text(x + 26, y, text, "quiet", 9.5)
            x += room
        for text in told:
            y += 16
            self._drawing.text(LEFT, y, text, "quiet", 9.5)
        self._y = y + 12

    def steps(self, title: str, kind: str, sign: str, lines: Lines) -> None:
        """List steps that were added or removed."""
        if not lines:
            return
        self._y += 16
        self._drawing.text(8, self._y, title, size=11, bold=True)
        for number, text in lines[:STEPS_SHOWN]:
            shown = shortened(f"{sign} {number:>4}  {text}", WIDTH - LEFT - 16, 10)
            self._drawing.text(LEFT, self._y, shown, kind, 10)
            self._y += 14
        if len(lines) > STEPS_SHOWN:
            self._drawing.text(LEFT, self._y, f"and {len(lines) - STEPS_SHOWN} more", "quiet", 10)
            self._y += 14

    def svg(self, theme: str) -> str:
        """Return the picture."""
        return self._drawing.svg(self._y + 6, theme)

    def _lanes(self, y: float, rights: dict[str, list[str]]) -> float:
        """Draw a lane for each coil and joint from y down; return where the last one ends."""
        forecast, tracks = self._forecast, _driven(self.ways)
        hottest = max((track.peak_degc for course in self.ways for track in course.tracks), default=0.0)
        trip_degc = 0.0 if forecast.why_not else forecast.compiled.profile.coil.trip_degc
        lanes = Lanes(self._drawing, self._times, self.ways[0], trip_degc, hottest)
        for track in tracks:
            ways = [(course, each) for course in self.ways for each in course.tracks if each.label == track.label]
            under = f"one of {len(track.reach)}, °C" if track.reach else "°C" if trip_degc else ""
            lanes.coil(y, track.label, under, ways, rights[track.label])
            y += LANE + BETWEEN
        for targets in _moved(self.ways, forecast):
            values = [value for _, each in targets for value in each.values] or [0.0]
            low, high = min(0.0, *values), max(0.0, *values)
            lanes.joint(y, targets, low, high if high > low else low + 1)
            y += JOINT_LANE + BETWEEN
        return y - BETWEEN

    def _marks(self) -> list[tuple[str, str]]:
        """Return the kinds of marks in this picture, each with what it means."""
        bars = [bar for course in self.ways for track in course.tracks for bar in track.bars]
        pauses, motions = self._waiting.pauses, [motion for course in self.ways for motion in course.motions]
        modelled = bool(bars) and not self._forecast.why_not
        marks = [
            ("duty", "duty of a coil (full height: 100 %)", bool(bars)),
            ("kept", "kept near a temperature", any(bar.keep_decidegc for bar in bars)),
            ("heat", "predicted temperature", modelled),
            ("band", "difference" if self._compares else "between both ways", modelled and len(self.ways) > 1),
            ("trip", "the robot trips", modelled),
            ("joint", "target of a joint, an object or a force", bool(motions)),
            ("guess", "on its way from an unknown place", self._guessed()),
            ("held", "regulated by the robot", any(motion.kind != "move" for motion in motions)),
            ("wait", "wait, to its predicted end", any(pause.known for pause in pauses)),
            ("range", "wait that may be over at any time", any(not pause.known for pause in pauses)),
        ]
        return [(kind, text) for kind, text, present in marks if present]

    def _guessed(self) -> bool:
        moved = _moved(self.ways, self._forecast)
        return any(each.guesses for rows in moved for _, each in rows)


def wrapped(text: str, width: float, size: float) -> list[str]:
    """Return a text of parts with dots between them in lines that are no wider than that."""
    lines: list[str] = []
    for part in text.split(DOT):
        if lines and wide(lines[-1] + DOT + part, size) <= width:
            lines[-1] += DOT + part
        else:
            lines.append(part)
    return [shortened(line, width, size) for line in lines]


def _mark(drawing: Drawing, kind: str, x: float, y: float) -> None:
    """Draw the sample of a mark for the legend."""
    if kind in ("duty", "band", "held"):
        drawing.rect(kind, x, y - 8, 20, 9)
    elif kind == "wait":
        drawing.rect(kind, x, y - 7, 20, 8, 2)
    elif kind == "kept":
        drawing.curve(kind, [(x + 1, y + 1), (x + 1, y - 7), (x + 19, y - 7), (x + 19, y + 1)], closed=True)
    else:
        drawing.line(kind, x, y - 3, x + 20, y - 3)


def _driven(ways: Sequence[Course]) -> list[Track]:
    """Return the coils that have an order on any of the ways, each once."""
    found = {track.label: track for course in reversed(ways) for track in course.driven}
    order = [track.label for course in ways for track in course.tracks]
    return sorted(found.values(), key=lambda track: order.index(track.label))


def _moved(ways: Sequence[Course], forecast: Forecast) -> list[list[tuple[Course, Targets]]]:
    """Return the joints that are moved, the object and the force, each with its ways."""
    found: dict[str, list[tuple[Course, Targets]]] = {}
    for course in ways:
        for targets in targets_of(course, forecast.compiled.profile):
            found.setdefault(targets.label, []).append((course, targets))
    return list(found.values())


def _seconds(time_ms: float) -> str:
    """Return a time in seconds, as exactly as there is room for."""
    return f"{time_ms / 1000:.2f}" if time_ms < LARGE_MS else f"{time_ms / 1000:.0f}"


def _name(forecast: Forecast) -> str:
    return Path(forecast.compiled.script.main.name).name


def _changed(row: CoilChange) -> list[str]:
    """Return what stands to the right of a coil's lane in a comparison."""
    peak, on, energy = row.peak_degc, row.on_ms, row.energy_mj
    if row.same:
        return ["same", f"on {_seconds(on.new)} s"]
    return [
        f"{peak.old:.0f} → {peak.new:.0f} °C",
        f"on {_seconds(on.old)} → {_seconds(on.new)} s",
        f"{energy.old:.0f} → {energy.new:.0f} mJ",
    ]
