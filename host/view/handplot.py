"""The picture of a run of fingers: (a) the hand at a few instants, (b) its curves over time.

Without scenes (a real robot, a plain log) only the curves are drawn.
"""

from __future__ import annotations

from matplotlib.figure import Figure

from host.recording import Recording
from host.view.curves import draw_current
from host.view.film import Box, frame, together
from host.view.grips import angle
from host.view.hand import OBJECT, draw_hand, room
from host.view.instants import scene_times
from host.view.jointcurves import draw_joint_currents, draw_joints, draw_object
from host.view.panels import Panel, draw_panels, lines_at, stacked_mm
from host.view.sheet import BOTTOM_MM, GAP_MM, LEFT_MM, NAME_MM, RIGHT_MM, TOP_MM, Sheet
from host.view.style import INK, PAGE_MM, Style
from host.view.swings import telling

SHOWN, EDGE_MM, WORDS_MM, LINE_MM = 6, 4.0, 9.0, 3.4
MEASURED: tuple[Panel, ...] = (
    (draw_joints, 32.0),
    (draw_object, 26.0),
    (draw_joint_currents, 24.0),
    (draw_current, 18.0),
)


def hand_figure(recording: Recording) -> Figure:
    """Return the picture."""
    shown = telling(recording, SHOWN) if len(recording.scenes) > 1 else []
    box = strip_box(recording, shown) if shown else None
    each = (PAGE_MM - LEFT_MM - RIGHT_MM) / SHOWN
    strip_mm = each * (box[3] - box[2]) / (box[1] - box[0]) + WORDS_MM + GAP_MM + NAME_MM if box else 0.0
    curves_mm = NAME_MM + stacked_mm(MEASURED)
    sheet = Sheet(TOP_MM + strip_mm + curves_mm + BOTTOM_MM, recording.title)
    if box:
        sheet.name("a", "the fingers and what they hold, to scale")
        draw_strip(sheet, recording, shown, box)
    sheet.name("b" if box else "", "what the robot measured" + ", and what was true" * bool(box))
    draw_panels(sheet, recording, MEASURED, lines_at(scene_times(recording)[shown]))
    return sheet.figure


def strip_box(recording: Recording, shown: list[int]) -> Box:
    """Return the room of each pose, the same for all."""
    left, right, bottom, top = together(room(recording.scenes[i]) for i in shown)
    return left - EDGE_MM, right + EDGE_MM, bottom - EDGE_MM / 2, top + EDGE_MM


def draw_strip(sheet: Sheet, recording: Recording, shown: list[int], box: Box) -> None:
    """Draw the hand side by side at these scenes, with time and object's angle below each."""
    each, times = (PAGE_MM - LEFT_MM - RIGHT_MM) / SHOWN, scene_times(recording)
    height_mm = each * (box[3] - box[2]) / (box[1] - box[0])
    for i, index in enumerate(shown):
        axes, scene = sheet.axes(LEFT_MM + i * each, each, height_mm), recording.scenes[index]
        draw_hand(axes, scene)
        frame(axes, box)
        style: Style = {"ha": "center", "va": "top", "fontsize": 6.5}
        middle = LEFT_MM + (i + 0.5) * each
        sheet.write(middle, height_mm + 0.5, f"{max(0.0, times[index]):.2f} s", color=INK, **style)
        turned = f"object {angle(scene['object']['deg'], 2, '+')}"
        sheet.write(middle, height_mm + 0.5 + LINE_MM, turned, color=OBJECT, **style)
    sheet.y_mm -= height_mm + WORDS_MM + GAP_MM
