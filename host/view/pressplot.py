"""The picture of a run of a press: (a) block and indenter at a few instants, (b) force, depth and cells over time.

Without scenes (a real robot, a plain log) only the curves are drawn.
"""

from __future__ import annotations

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch, Rectangle
from matplotlib.path import Path

from host.errors import BadRequest
from host.recording import Recording, Scene
from host.view.film import Box, frame
from host.view.instants import scene_times
from host.view.meshes import (
    EDGE_MM,
    FLESH,
    deformed,
    draw_ruler,
    edges_of,
    fill_tool,
    height_of,
    path_of,
    trails,
)
from host.view.panels import Panel, draw_panels, lines_at, stacked_mm
from host.view.presscurves import draw_cells, draw_depth, draw_force, draw_joint_current
from host.view.pressing import nearest, press_of, slices_of
from host.view.sheet import BOTTOM_MM, GAP_MM, LEFT_MM, NAME_MM, RIGHT_MM, TOP_MM, Sheet
from host.view.style import INK, PAGE_MM, Style

SHOWN, WORDS_MM, LINE_MM, HEAD_MM = 4, 8.5, 3.4, 14.0
CELLS, DARKEST = "magma_r", 0.9  # colours of the cells, from no pressure to the greatest shown
FORCE, DEPTH, PRESSURE, CURRENT = (draw_force, 36.0), (draw_depth, 28.0), (draw_cells, 34.0), (draw_joint_current, 20.0)


def press_figure(recording: Recording) -> Figure:
    """Return the picture."""
    shown = telling(recording) if len(recording.scenes) > 1 else []
    box = strip_box(recording, shown) if shown else None
    each = (PAGE_MM - LEFT_MM - RIGHT_MM) / SHOWN
    strip_mm = height_of(box, each) + WORDS_MM + GAP_MM + NAME_MM if box else 0.0
    loaded = recording.telemetry[0].load_n is not None
    panels: list[Panel] = [*[FORCE] * loaded, DEPTH, *[PRESSURE] * bool(recording.cells), CURRENT]
    curves_mm = NAME_MM + stacked_mm(panels)
    sheet = Sheet(TOP_MM + strip_mm + curves_mm + BOTTOM_MM, recording.title)
    if box:
        sheet.name("a", "block and indenter, to scale; squares: force cells, darker where more presses on them [kPa]")
        draw_strip(sheet, recording, shown, box)
    sheet.name("b" if box else "", "what the robot measured" + ", and what was true" * bool(box))
    draw_panels(sheet, recording, panels, lines_at(scene_times(recording)[shown]))
    return sheet.figure


def telling(recording: Recording) -> list[int]:
    """Return the scenes that tell a run: push, hold, release and long after, or evenly when there was no such press.

    A press without a hold is shown with the block as it was before it.
    """
    try:
        press = press_of(recording)
        told = [nearest(recording.scenes, each.host_ms) for each in slices_of(recording)] if recording.slices else []
        return sorted({press.before, *(told or press)})[-SHOWN:]
    except BadRequest:
        return [round(i) for i in np.linspace(0, len(recording.scenes) - 1, SHOWN)]


def strip_box(recording: Recording, shown: list[int]) -> Box:
    """Return the room that the block needs in these scenes, with what presses on it."""
    points = np.vstack([body(recording, recording.scenes[i]).vertices for i in shown])
    (left, bottom), (right, top) = points.min(axis=0), points.max(axis=0)
    return float(left) - EDGE_MM, float(right) + EDGE_MM, float(bottom) - EDGE_MM, float(top) + HEAD_MM


def draw_strip(sheet: Sheet, recording: Recording, shown: list[int], box: Box) -> None:
    """Draw the block side by side at these scenes, with time, force and dent below each."""
    each, times = (PAGE_MM - LEFT_MM - RIGHT_MM) / SHOWN, scene_times(recording)
    high = height_of(box, each)
    pressures = [cell["pressure_kpa"] for i in shown for cell in recording.scenes[i]["cells"].values()]
    for i, index in enumerate(shown):
        axes, scene = sheet.axes(LEFT_MM + i * each, each, high), recording.scenes[index]
        axes.add_patch(PathPatch(body(recording, scene), fc=FLESH, ec=INK, lw=0.6, zorder=2))
        draw_cells_of(axes, scene, max([1.0, *pressures]))
        fill_tool(axes, scene["indenter"]["outline_mm"])
        if i == 0:
            draw_ruler(axes, box)
        frame(axes, box)
        style: Style = {"ha": "center", "va": "top", "fontsize": 6.5, "color": INK}
        middle = LEFT_MM + (i + 0.5) * each
        sheet.write(middle, high + 0.5, f"{max(0.0, times[index]):.2f} s, {scene['force_n']:.2f} N", **style)
        words = f"depth {scene['depth_mm']:.2f}, dent {scene['observed']['dent_mm']:.2f} mm"
        sheet.write(middle, high + 0.5 + LINE_MM, words.replace("-", "\N{MINUS SIGN}"), **style)
    sheet.y_mm -= high + WORDS_MM + GAP_MM


def body(recording: Recording, scene: Scene) -> Path:
    """Return the outline of the block: of its mesh at that time, or without one its surface between upright sides."""
    if recording.mesh is not None and recording.slices:
        taken = recording.slices[nearest(recording.slices, scene["host_ms"])]
        return path_of(deformed(recording.mesh, taken), trails(edges_of(recording.mesh)[1]))
    surface, (x, y) = np.array(scene["surface_mm"], dtype=float), scene["block"].get("corner_mm", (0.0, 0.0))
    corners = [[x + scene["block"]["width_mm"], y], [x, y]]
    return Path(np.vstack([surface, corners, surface[:1]]), closed=True)


def draw_cells_of(axes: Axes, scene: Scene, most_kpa: float) -> None:
    """Draw the force cells where they were put, with what presses on each."""
    for cell in scene["cells"].values():
        side, (x, y), pressure = cell["side_mm"], cell["centre_mm"], float(cell["pressure_kpa"])
        shade = colormaps[CELLS](DARKEST * min(1.0, max(0.0, pressure / most_kpa)))
        axes.add_patch(Rectangle((x - side / 2, y - side / 2), side, side, fc=shade, ec=INK, lw=0.3, zorder=3))
        text = f"{pressure:.1f}" if abs(pressure) >= 0.05 else "0"
        axes.text(x, y - side / 2 - 0.6, text, ha="center", va="top", fontsize=5, color=INK, zorder=4)
