"""The timeline of a script in the terminal: coils as rows, duty as shades in the colour of their temperature.

Every column is a stretch of time. A shade says how long and how much a coil is on in it; to the right stand the
predicted peak and the line that leads to it.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from rich.console import Console
from rich.table import Table
from rich.text import Text

from host.cli.output import printable
from host.gait.forecast import Forecast
from host.gait.model.course import Bar, Course, Track
from host.preview.compare import Changes, Pair
from host.preview.joints import Targets, targets_of
from host.preview.scale import Times, instants, times_of

SHADES, PLAIN_SHADES = " ░▒▓█", " .:x#"
STEPS, PLAIN_STEPS = "▁▂▃▄▅▆▇█", "12345678"
WARMTH = ((50, "blue"), (75, "yellow"), (100, "dark_orange"), (1e9, "red"))
LEFT, RIGHT, NARROW = 9, 24, 20


def print_timeline(forecast: Forecast, console: Console | None = None) -> None:
    """Print each way through a script."""
    console = console or Console(highlight=False, soft_wrap=True)
    name = forecast.compiled.script.main.name
    console.print(Text(printable(f"{name} on {forecast.compiled.profile.robot}"), style="bold"))
    for way, course in forecast.ways.items():
        if way:
            told = "if every other wait is over at once" if way == "early" else "if every other wait runs out"
            console.print(Text(f"{way}: {told}", style="bold"))
        for line in Timeline(forecast, course, console).lines():
            console.print(line, no_wrap=True, overflow="crop")
        for gap in course.gaps:
            console.print(Text(f"not shown: {gap.turns} more turns of a repeat after {gap.begin_ms / 1000:.1f} s"))
    unknown = [forecast.why_not] if forecast.compiled.profile.coil_labels and forecast.why_not else []
    for remark in [*unknown, *forecast.remarks()]:
        console.print(Text(printable(remark.strip())))


class Timeline:
    """The rows of one way."""

    def __init__(self, forecast: Forecast, course: Course, console: Console) -> None:
        self._forecast, self._course = forecast, course
        self._columns = max(NARROW, console.width - LEFT - RIGHT)
        self._times: Times = times_of([course], 0, self._columns)
        plain = not _shows(console)
        self._shades, self._steps = (PLAIN_SHADES, PLAIN_STEPS) if plain else (SHADES, STEPS)
        self._wait, self._open = ("-", "~") if plain else ("─", "┄")

    def lines(self) -> list[Text]:
        """Return the rows: lines of the script, coils, joints, waits, time."""
        rows = [self._numbers()]
        rows += [self._coil(track) for track in self._course.driven]
        rows += [self._joint(each) for each in targets_of(self._course, self._forecast.compiled.profile)]
        rows += [self._waits()] if self._course.pauses else []
        return [*rows, self._axis()]

    def _numbers(self) -> Text:
        cells = [" "] * self._columns
        free = 0
        for mark in self._course.marks:
            step, at = self._forecast.compiled.step(mark.step), self._column(mark.at_ms)
            text = str(step.outer.line) if step else ""
            if at >= free and at + len(text) <= self._columns:
                cells[at : at + len(text)] = text
                free = at + len(text) + 1
        return Text(f"{'line':<{LEFT}}{''.join(cells)}", style="dim")

    def _coil(self, track: Track) -> Text:
        row = Text(f"{printable(track.label):<{LEFT}}"[:LEFT])
        for column in range(self._columns):
            share, degc = self._share(track.bars, column), self._degc(track, column)
            shade = self._shades[min(len(self._shades) - 1, -int(-share * (len(self._shades) - 1) // 1))]
            row.append(shade, style=next(colour for most, colour in WARMTH if degc < most))
        if self._forecast.why_not:
            return row.append(f"  on {track.on_ms / 1000:.2f} s")
        step = self._forecast.compiled.step(track.peak_step)
        line = f" line {step.outer.line}" if step else ""
        hot = track.peak_degc >= self._forecast.compiled.profile.coil.trip_degc
        return row.append(f" {track.peak_degc:4.0f} C {track.peak_ms / 1000:6.1f} s{line}", "bold red" if hot else "")

    def _share(self, bars: Sequence[Bar], column: int) -> float:
        """Return the mean duty of a coil within a column."""
        on = 0.0
        for bar in bars:
            begin, end = (self._times.x(ms, self._course.gaps) for ms in (bar.begin_ms, bar.end_ms))
            on += max(0.0, min(end, column + 1) - max(begin, column)) * bar.duty_permille / 1000
        return min(1.0, on)

    def _degc(self, track: Track, column: int) -> float:
        inside = [degc for ms, degc in track.curve if column <= self._times.x(ms, self._course.gaps) < column + 1]
        return max(inside, default=0.0)

    def _joint(self, targets: Targets) -> Text:
        """Return what is asked of a joint, as high as it is among all that is asked of it."""
        values = targets.values or [0.0]
        low, high = min(values), max(values)
        row = Text(f"{printable(targets.label):<{LEFT}}"[:LEFT])
        for column in range(self._columns):
            value = self._target(targets, column + 0.5)
            share = 0.0 if value is None or high == low else (value - low) / (high - low)
            row.append(" " if value is None else self._steps[round(share * (len(self._steps) - 1))], style="green")
        return row.append(f" {low:g} .. {high:g} {targets.unit}")

    def _target(self, targets: Targets, place: float) -> float | None:
        """Return what is asked for at a place of the row."""
        for line in [*targets.lines, *targets.guesses]:
            points = [(self._times.x(ms, self._course.gaps), value) for ms, value in line]
            for (x, value), (x_next, next_value) in pairwise(points):
                if x <= place < x_next:
                    return value + (next_value - value) * (place - x) / (x_next - x)
        return None

    def _waits(self) -> Text:
        cells = [" "] * self._columns
        for pause in self._course.pauses:
            begin, end = self._column(pause.begin_ms), self._column(pause.end_ms)
            for at in range(begin, max(end, begin + 1)):
                cells[at] = self._wait if pause.known else self._open
        return Text(f"{'wait':<{LEFT}}{''.join(cells)}", style="yellow")

    def _axis(self) -> Text:
        cells = [" "] * (self._columns + 4)
        free = 0
        for at in instants(self._course, max(self._course.end_ms, 1), max(2, self._columns // 10)):
            text, place = f"{at:g}", self._column(1000 * at)
            if place >= free:
                cells[place : place + len(text)] = text
                free = place + len(text) + 1
        return Text(f"{'time [s]':<{LEFT}}{''.join(cells)[: self._columns + 4]}", style="dim")

    def _column(self, at_ms: float) -> int:
        return min(self._columns - 1, int(self._times.x(at_ms, self._course.gaps)))


def print_changes(changes: Changes, console: Console | None = None) -> None:
    """Print what changed from one script to another."""
    console = console or Console(highlight=False)
    names = [forecast.compiled.script.main.name for forecast in (changes.old, changes.new)]
    console.print(Text(printable(f"{names[0]} -> {names[1]}: {changes.summary}"), style="bold"))
    table = Table(box=None, pad_edge=False)
    for head in ("coil", "on time [s]", "energy [mJ]", "peak [C]"):
        table.add_column(head, justify="left" if head == "coil" else "right")
    for coil in changes.coils:
        style = "dim" if coil.same else ""
        peak = _pair(coil.peak_degc, 1, 0) if not changes.new.why_not else "?"
        energy = _pair(coil.energy_mj, 1, 0) if not changes.new.why_not else "?"
        table.add_row(printable(coil.label), _pair(coil.on_ms, 1000, 2), energy, peak, style=style)
    console.print(table)
    for sign, style, lines in (("+", "green", changes.added), ("-", "red", changes.removed)):
        for number, text in lines:
            console.print(Text(printable(f"{sign} {number:>4}  {text}"), style=style))


def _pair(pair: Pair, parts: int, digits: int) -> str:
    old, new = f"{pair.old / parts:.{digits}f}", f"{pair.new / parts:.{digits}f}"
    return new if old == new else f"{old} -> {new}"


def _shows(console: Console) -> bool:
    """Return whether the terminal's encoding has the shades."""
    try:
        (SHADES + STEPS).encode(console.encoding)
    except (UnicodeEncodeError, LookupError):
        return False
    return True
