"""The poses of the circular robot: at rest, and with one coil at a time at its shortest (the paper's Figure 3)."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure

from host.errors import BadRequest
from host.recording import Recording, Scene
from host.view.body import draw_body, draw_ground, slope_of
from host.view.film import extent, ground_of, scale, together
from host.view.style import PAGE_MM, heat_scale, page

TITLE_MM, BAR_MM, CAPTION_MM, EDGE_MM = 7.0, 16.0, 5.0, 3.0
LETTERS_MM = 5.0  # room for the letters above the body


def poses_figure(recording: Recording, coils: Sequence[str]) -> Figure:
    """Return one panel at rest and one for each coil, all at one scale; BadRequest when a coil never pulled."""
    scenes = [recording.scenes[0], *(shortest(recording, label) for label in coils)]
    captions = ["at rest", *(f"coil {label}" for label in coils)]
    boxes = [extent(scene, slope_of(scene), LETTERS_MM) for scene in scenes]
    wide_mm = max(box[1] - box[0] for box in boxes)
    _, _, low_mm, high_mm = together(boxes)
    each_mm = (PAGE_MM - BAR_MM - EDGE_MM) / len(scenes)
    panel_mm = each_mm * (high_mm - low_mm) / wide_mm
    total_mm = TITLE_MM + panel_mm + CAPTION_MM
    figure = page(total_mm)
    figure.text(EDGE_MM / PAGE_MM, 1 - 3.5 / total_mm, recording.title, va="center", fontsize=8.5, weight="bold")
    heat = heat_scale(max(coil["degc"] for scene in scenes for coil in scene["coils"].values()))
    for i, (scene, caption, box) in enumerate(zip(scenes, captions, boxes, strict=True)):
        left = (EDGE_MM + i * each_mm) / PAGE_MM
        axes = figure.add_axes((left, CAPTION_MM / total_mm, each_mm / PAGE_MM, panel_mm / total_mm))
        _draw_pose(axes, scene, recording.driven(scene["host_ms"]), heat)
        middle = (box[0] + box[1]) / 2
        axes.set(xlim=(middle - wide_mm / 2, middle + wide_mm / 2), ylim=(low_mm, high_mm), aspect="equal")
        figure.text(left + each_mm / 2 / PAGE_MM, 1.5 / total_mm, caption, ha="center", fontsize=7.5)
    bar_at = (1 - (BAR_MM - 4.0) / PAGE_MM, (CAPTION_MM + 4.0) / total_mm, 2.2 / PAGE_MM, (panel_mm - 10.0) / total_mm)
    _draw_bar(figure.add_axes(bar_at), figure, heat)
    figure.text(1 - EDGE_MM / PAGE_MM, 1.5 / total_mm, "scale in mm", ha="right", fontsize=6.5)
    return figure


def shortest(recording: Recording, label: str) -> Scene:
    """Return the scene in which the driven coil is at its shortest; BadRequest when it never was driven."""
    driven = [scene for scene in recording.scenes if label in recording.driven(scene["host_ms"])]
    if not driven:
        raise BadRequest(f"coil {label} was never driven in this run")
    return min(driven, key=lambda scene: coil_length_mm(scene, label))


def coil_length_mm(scene: Scene, label: str) -> float:
    """Return the distance between the ends of a coil."""
    (x_0, y_0), (x_1, y_1) = scene["coils"][label]["from"], scene["coils"][label]["to"]
    return hypot(x_1 - x_0, y_1 - y_0)


def _draw_pose(axes: Axes, scene: Scene, driven: Sequence[str], heat: ScalarMappable) -> None:
    draw_body(axes, scene, slope_of(scene), heat, driven)
    left, right = ground_of([scene])
    draw_ground(axes, left, right, slope_of(scene), scale(left, right, 20))
    axes.set_axis_off()


def _draw_bar(axes: Axes, figure: Figure, heat: ScalarMappable) -> None:
    figure.colorbar(heat, cax=axes).outline.set_linewidth(0.4)
    axes.set_title("coil [°C]", fontsize=6.5, pad=6)
