"""Curves of a run one below the other, over one time."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from matplotlib.axes import Axes

from host.recording import Recording
from host.view.curves import label_time, record_times
from host.view.instants import Numbers
from host.view.sheet import GAP_MM, LEFT_MM, RIGHT_MM, Sheet
from host.view.style import FAINT, PAGE_MM

LABEL_MM = 10.0  # from the axis to its name
WIDE_MM = PAGE_MM - LEFT_MM - RIGHT_MM
Panel = tuple[Callable[[Axes, Recording], None], float]  # what draws it, and its height in mm
Mark = Callable[[Axes], None]


def stacked_mm(panels: Sequence[Panel]) -> float:
    """Return how high so many panels are, with the gaps between them."""
    return sum(mm + GAP_MM for _, mm in panels) - GAP_MM


def draw_panels(
    sheet: Sheet, recording: Recording, panels: Sequence[Panel], mark: Mark, label_mm: float = LABEL_MM
) -> None:
    """Draw the curves below the present height of the sheet, each with the marks of what is shown above."""
    first: Axes | None = None
    for draw, mm in panels:
        axes = sheet.axes(LEFT_MM, WIDE_MM, mm, first)
        first = first or axes
        draw(axes, recording)
        mark(axes)
        axes.yaxis.set_label_coords(-label_mm / WIDE_MM, 0.5)
        axes.tick_params(labelbottom=False)
        sheet.y_mm -= mm + GAP_MM
    label_time(axes, record_times(recording))


def lines_at(times_s: Numbers) -> Mark:
    """Return what marks instants: a dashed line at each."""

    def mark(axes: Axes) -> None:
        for t in times_s:
            axes.axvline(float(t), color=FAINT, lw=0.6, ls=(0, (4, 2)), zorder=0)

    return mark


def shade_over(times_s: Numbers) -> Mark:
    """Return what marks a span of time, from the first instant to the last: a shade; nothing where there is none."""

    def mark(axes: Axes) -> None:
        if len(times_s):
            axes.axvspan(times_s[0], times_s[-1], color=FAINT, alpha=0.25, lw=0, zorder=0)

    return mark
