"""What stands above and below the lanes of a picture: lines of the script, notes and labels, waits, the time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from host.gait.compiler import Compiled
from host.gait.model.course import Course, Pause
from host.gait.plan import Label, Note, walk
from host.preview.drawing import Drawing, shortened, wide
from host.preview.lanes import LEFT, SMALL
from host.preview.scale import Times, instants

ROW = 14.0
APART = 4.0  # lines through all lanes, at least
FLAG_MOST = 220.0
NOTED = 40  # flags at most


def draw_lines(
    drawing: Drawing, times: Times, y: float, foot: float, compiled: Compiled, course: Course, name: str = "line"
) -> float:
    """Draw a faint line down to the foot where a step begins, with the number of its line where there is room."""
    drawing.text(8, y + 9, name, "quiet", 9.5)
    free, last = -1e9, -1e9
    for mark in course.marks:
        step, x = compiled.step(mark.step), times.x(mark.at_ms, course.gaps)
        if step is None:
            continue
        if x - last >= APART:
            drawing.line("faint", x, y + 12, x, foot)
            last = x
        text = str(step.outer.line)
        if x >= free:
            drawing.text(x + 1, y + 9, text, "quiet", 9)
            free = x + 1 + wide(text, 9) + 4
    return y + ROW


def flags_of(compiled: Compiled, course: Course) -> list[tuple[int, str, str]]:
    """Return time, kind and text of each note and label that the script comes by, in their order."""
    notes = {op.step: op.node.text for op in walk(compiled.plan) if isinstance(op, Note)}
    labels = {op.step: op.node.name.text for op in walk(compiled.plan) if isinstance(op, Label)}
    found = []
    for mark in course.marks:
        step = compiled.step(mark.step)
        if mark.step in notes:
            found.append((mark.at_ms, "note", (step.note if step and step.note else notes[mark.step])))
        elif mark.step in labels:
            found.append((mark.at_ms, "label", labels[mark.step]))
    return found[:NOTED]


class Flag(NamedTuple):
    """A note or a label on its place in one of the rows above the lanes."""

    row: int
    x: float
    begin: float
    shown: str


def laid_flags(times: Times, compiled: Compiled, course: Course) -> list[Flag]:
    """Return notes and labels, each in the first row that has room."""
    rows: list[float] = []
    right, flags = LEFT + times.width, []
    for at_ms, kind, text in flags_of(compiled, course):
        x = times.x(at_ms, course.gaps)
        shown = shortened(text, FLAG_MOST, 10) if kind == "note" else f"label {text}"
        begin = min(x + 4, right - wide(shown, 10))
        row = next((i for i, free in enumerate(rows) if begin >= free), len(rows))
        rows += [0.0] if row == len(rows) else []
        rows[row] = begin + wide(shown, 10) + 8
        flags.append(Flag(row, x, begin, shown))
    return flags


def draw_flags(drawing: Drawing, flags: Sequence[Flag], y: float, foot: float) -> float:
    """Draw notes and labels above the lanes; return where the next strip begins."""
    if not flags:
        return y
    drawing.text(8, y + 10, "notes", "quiet", 9.5)
    for flag in flags:
        drawing.line("flag", flag.x, y + flag.row * ROW + 2, flag.x, foot)
        drawing.text(flag.begin, y + flag.row * ROW + 10, flag.shown, "note", 10)
    return y + (1 + max(flag.row for flag in flags)) * ROW


def draw_waits(drawing: Drawing, times: Times, y: float, foot: float, course: Course) -> float:
    """Draw each wait from its begin to its end, and open where it may be over at any time until then."""
    if not course.pauses:
        return y
    drawing.text(8, y + 9, "wait", "quiet", 9.5)
    for pause in course.pauses:
        x, end = times.x(pause.begin_ms, course.gaps), times.x(pause.end_ms, course.gaps)
        if end - x < 0.5:
            drawing.rect("wait", x - 0.5, y + 2, 1, 8)
            continue
        drawing.rect("open", x, y + 2, end - x, foot - y - 2)
        if pause.known:
            drawing.rect("wait", x, y + 2, end - x, 8, 2)
        else:
            drawing.line("range", x, y + 6, end, y + 6)
            for at in (x, end):
                drawing.line("range", at, y + 2, at, y + 10)
        told = _told(pause)
        if wide(told, SMALL) + 6 < end - x and not pause.known:
            middle = (x + end) / 2
            drawing.rect("paper", middle - wide(told, SMALL) / 2 - 2, y + 1, wide(told, SMALL) + 4, 10)
            drawing.text(middle, y + 9, told, "waits", SMALL, "middle")
    return y + ROW


def draw_time(drawing: Drawing, times: Times, y: float, course: Course) -> float:
    """Draw the axis of time below the lanes; return where the next strip begins."""
    right = LEFT + times.width
    drawing.line("axis", LEFT, y, right, y)
    for at in instants(course, max(course.end_ms, 1) if course.gaps else times.told_ms, 12):
        x = times.x(1000 * at, course.gaps)
        drawing.line("axis", x, y, x, y + 4)
        drawing.text(x, y + 15, f"{at:g}", "quiet", 9.5, "middle")
    drawing.text(right + 16, y + 15, "time [s]", "quiet", 9.5)
    return y + 22


def draw_gaps(drawing: Drawing, times: Times, y: float, foot: float, course: Course) -> None:
    """Draw what is left out: turns of a loop that are as the one before."""
    for gap in course.gaps:
        x, end = times.x(gap.begin_ms, course.gaps), times.x(gap.end_ms, course.gaps)
        drawing.rect("paper", x, y, end - x, foot - y)
        middle = (x + end) / 2
        drawing.text(middle, (y + foot) / 2 - 4, f"{gap.turns} more", "quiet", 9, "middle")
        drawing.text(middle, (y + foot) / 2 + 8, "turns", "quiet", 9, "middle")


def _told(pause: Pause) -> str:
    return f"up to {(pause.end_ms - pause.begin_ms) / 1000:g} s"
