"""The experiment with a cube (the paper's Figure 14): eight instants, (a) to (h), and the angles over time.

The paper's own eight are photographs without times; here they are the parallel start, the grip, and the ends of the
swings; where there are fewer than six swings, instants between.
"""

from __future__ import annotations

from collections.abc import Sequence
from string import ascii_lowercase

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from host.recording import Recording
from host.view.curves import label_time
from host.view.film import frame, together
from host.view.grips import angle
from host.view.hand import OBJECT, draw_hand, draw_turn, room
from host.view.instants import scene_times
from host.view.sheet import BOTTOM_MM, GAP_MM, LEFT_MM, NAME_MM, RIGHT_MM, TOP_MM, Sheet
from host.view.style import FAINT, INK, PAGE_MM, Style
from host.view.swings import filled, object_deg, phases, swing_deg

FRAMES, ROW = 8, 4
EDGE_MM, HEAD_MM, WORDS_MM, LINE_MM = 8.0, 14.0, 10.0, 3.4
SWING_MM, OBJECT_MM = 28.0, 28.0


def tilting_figure(recording: Recording) -> Figure:
    """Return the picture; BadRequest when the fingers never swung."""
    shown = sequence(recording)
    row_mm = frame_height(recording, shown) + WORDS_MM
    rows = (len(shown) + ROW - 1) // ROW
    curves_mm = SWING_MM + OBJECT_MM + GAP_MM + NAME_MM
    sheet = Sheet(TOP_MM + NAME_MM + rows * row_mm + curves_mm + BOTTOM_MM, recording.title)
    sheet.name("", "to scale; green: the object's turn from the upright, as large as it is")
    for start in range(0, len(shown), ROW):
        draw_row(sheet, recording, shown[start : start + ROW], ascii_lowercase[start:], row_mm - WORDS_MM)
        sheet.y_mm -= row_mm
    sheet.name("", "the swing of both fingers and the angle of the object")
    label_time(draw_angles(sheet, recording, shown), scene_times(recording))
    return sheet.figure


def sequence(recording: Recording) -> list[int]:
    """Return the scenes of (a) to (h)."""
    return filled(phases(recording)[:FRAMES], FRAMES)


def frame_height(recording: Recording, shown: Sequence[int]) -> float:
    """Return the height of a frame in mm."""
    box = _box(recording, shown)
    return (PAGE_MM - LEFT_MM - RIGHT_MM) / ROW * (box[3] - box[2]) / (box[1] - box[0])


def draw_row(sheet: Sheet, recording: Recording, shown: Sequence[int], letters: str, height_mm: float) -> None:
    """Draw frames side by side, with letter, time and angles below each."""
    each = (PAGE_MM - LEFT_MM - RIGHT_MM) / ROW
    times, swing, turned = scene_times(recording), swing_deg(recording), object_deg(recording)
    for i, (letter, index) in enumerate(zip(letters, shown, strict=False)):
        axes = sheet.axes(LEFT_MM + i * each, each, height_mm)
        draw_turn(axes, recording.scenes[index])
        draw_hand(axes, recording.scenes[index])
        frame(axes, _box(recording, sequence(recording)))
        words = f"({letter}) {max(0.0, times[index]):.1f} s, swing {angle(swing[index], 1, '+')}"
        middle, style = LEFT_MM + (i + 0.5) * each, Style({"ha": "center", "va": "top"})
        sheet.write(middle, height_mm + 0.5, words, fontsize=7, color=INK, **style)
        object_words = f"object {angle(turned[index], 1, '+')}"
        sheet.write(middle, height_mm + 0.5 + LINE_MM, object_words, fontsize=7, color=OBJECT, **style)


def draw_angles(sheet: Sheet, recording: Recording, shown: Sequence[int]) -> Axes:
    """Draw swing and object's angle over time, with the letters of the frames."""
    wide, times = PAGE_MM - LEFT_MM - RIGHT_MM, scene_times(recording)
    upper = sheet.axes(LEFT_MM, wide, SWING_MM)
    upper.plot(times, swing_deg(recording), color=INK, lw=1.1)
    upper.set_ylabel("swing [°]")
    upper.tick_params(labelbottom=False)
    sheet.y_mm -= SWING_MM + GAP_MM
    lower = sheet.axes(LEFT_MM, wide, OBJECT_MM, upper)
    lower.plot(times, object_deg(recording), color=OBJECT, lw=1.1)
    lower.set_ylabel("object [°]")
    for axes in (upper, lower):
        axes.axhline(0.0, color="#dddddd", lw=0.5, zorder=0)
        axes.yaxis.set_label_coords(-10.0 / wide, 0.5)
        axes.margins(y=0.2)
        for index in shown:
            axes.axvline(float(times[index]), color=FAINT, lw=0.6, ls=(0, (4, 2)), zorder=0)
    for letter, index in zip(ascii_lowercase, shown, strict=False):
        style: Style = {"ha": "left", "va": "top", "fontsize": 6.5, "color": INK}
        place = (float(times[index]), 1.0)
        upper.annotate(letter, place, (2, 0), xycoords=upper.get_xaxis_transform(), textcoords="offset points", **style)
    return lower


def _box(recording: Recording, shown: Sequence[int]) -> tuple[float, float, float, float]:
    left, right, bottom, top = together(room(recording.scenes[i]) for i in shown)
    return left - EDGE_MM, right + EDGE_MM, bottom - EDGE_MM / 2, top + HEAD_MM
