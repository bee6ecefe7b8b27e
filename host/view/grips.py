"""Two fingers in their poses (the paper's Figure 12): parallel, turned inward, and swung to either side.

What is drawn is to scale; only the wedge that shows the object's turn is enlarged, by a factor that the picture names.
"""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from host.errors import BadRequest
from host.recording import Recording, Scene
from host.view.film import Box, frame, together
from host.view.hand import ARROW_MM_PER_N, OBJECT, draw_hand, draw_turn, room
from host.view.sheet import LEFT_MM, NAME_MM, RIGHT_MM, TOP_MM, Sheet
from host.view.style import GROUND, INK, PAGE_MM, Style
from host.view.swings import grip_deg, phases, swing_deg

ENLARGED = 5.0  # the wedge of the object's turn
SMALL_DEG = 4.0  # turns that need it
EDGE_MM, HEAD_MM = 5.0, 14.0  # beside the fingers, and above them for the wedge and its words
CAPTION_MM, LINE_MM = 13.0, 3.6
RULER_MM, RULER_N = 20.0, 40.0


def grips_figure(recording: Recording) -> Figure:
    """Return the four poses; BadRequest when the fingers did not swing to both sides."""
    shown = phases(recording)[:4]
    if len(shown) < 4:
        raise BadRequest("the fingers did not swing to both sides in this run")
    scenes = [recording.scenes[i] for i in shown]
    left, right, bottom, top = together(room(scene) for scene in scenes)
    box = left - EDGE_MM, right + EDGE_MM, bottom - EDGE_MM, top + HEAD_MM
    each_mm = (PAGE_MM - LEFT_MM / 2 - RIGHT_MM) / len(scenes)
    panel_mm = each_mm * (box[3] - box[2]) / (box[1] - box[0])
    sheet = Sheet(TOP_MM + NAME_MM + panel_mm + CAPTION_MM, recording.title)
    times = enlarged(scenes)
    sheet.name("", f"to scale{_wedge_told(times)}; arrows: forces of the fingers on the object")
    words = zip("abcd", told(recording, shown), scenes, strict=True)
    for i, (letter, lines, scene) in enumerate(words):
        at_mm = LEFT_MM / 2 + i * each_mm
        axes = sheet.axes(at_mm, each_mm, panel_mm)
        draw_hand(axes, scene, forces=True)
        draw_turn(axes, scene, times)
        frame(axes, box)
        _write_lines(sheet, at_mm + each_mm / 2, panel_mm, [f"({letter}) {lines[0]}", *lines[1:]])
        if i == 0:
            _draw_rulers(axes, box)
    return sheet.figure


def enlarged(scenes: list[Scene]) -> float:
    """Return how many times as large as it is the object's turn is to be drawn, so that it is seen."""
    largest = max(abs(float(scene["object"]["deg"])) for scene in scenes)
    return ENLARGED if largest < SMALL_DEG else 1.0


def told(recording: Recording, shown: list[int]) -> list[list[str]]:
    """Return the words below each pose."""
    grip, swing = grip_deg(recording), swing_deg(recording)
    lines = []
    for i in shown:
        scene = recording.scenes[i]
        inward = f"{angle(grip[i], 1)} inward" if abs(grip[i]) >= 0.05 else "parallel"
        swung = f", swing {angle(swing[i], 1, '+')}" if abs(swing[i]) >= 0.05 else ""
        lines.append([inward + swung, f"object {angle(scene['object']['deg'], 2, '+')}", _depths(scene)])
    return lines


def angle(deg: float, decimals: int, sign: str = "") -> str:
    """Return an angle as it is printed, zero without a sign."""
    rounded = round(float(deg), decimals) + 0.0
    return f"{rounded:{sign if rounded else ''}.{decimals}f}°".replace("-", "\N{MINUS SIGN}")


def _depths(scene: Scene) -> str:
    depths = ", ".join(
        f"$d_{label.lower()}$ {max(0.0, finger['d_mm']):.2f}" for label, finger in scene["fingers"].items()
    )
    return f"{depths} mm"


def _wedge_told(times: float) -> str:
    return f"; green: the object's turn, drawn {times:g} times as large" if times > 1 else "; green: the object's turn"


def _write_lines(sheet: Sheet, middle_mm: float, panel_mm: float, lines: list[str]) -> None:
    """Write lines below a panel, the second in the object's colour."""
    for i, line in enumerate(lines):
        style: Style = {
            "ha": "center",
            "va": "top",
            "fontsize": 7.5 if i == 0 else 7,
            "color": OBJECT if i == 1 else INK,
        }
        sheet.write(middle_mm, panel_mm + 1.0 + i * LINE_MM, line, **style)


def _draw_rulers(axes: Axes, box: Box) -> None:
    """Draw the scales of lengths and of forces into the upper left corner."""
    x, y = box[0] + 2.0, box[3] - 4.0
    for length, text, colour in (
        (RULER_MM, f"{RULER_MM:g} mm", GROUND),
        (RULER_N * ARROW_MM_PER_N, f"{RULER_N:g} N", INK),
    ):
        axes.plot([x, x + length], [y, y], color=colour, lw=1.2, solid_capstyle="butt")
        axes.text(x + length + 1.5, y, text, ha="left", va="center", fontsize=6, color=colour)
        y -= 5.5
