"""A grasp over time (the paper's Figure 13): energy of both tips, their displacements, joint angles, object's angle."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from host.recording import Recording
from host.view.curves import label_time
from host.view.energy import energies_mj
from host.view.hand import finger_colour
from host.view.instants import Numbers, scene_times
from host.view.jointcurves import LEGEND, draw_joints, draw_object
from host.view.sheet import BOTTOM_MM, GAP_MM, LEFT_MM, NAME_MM, RIGHT_MM, TOP_MM, Sheet
from host.view.style import COILS, FAINT, INK, PAGE_MM, Style
from host.view.swings import of_fingers, phase_names, phases

Panel = tuple[str, Callable[[Axes, Recording], None], float]
HEAD_MM = 4.0  # for the numbers of the phases
LAST = 0.9  # of the time: values beyond are written to the left of their point


def grasp_figure(recording: Recording) -> Figure:
    """Return the four panels over one time; BadRequest when the fingers never swung."""
    marked = phases(recording)
    panels: list[Panel] = [
        ("elastic energy of both tips", draw_energy, 34.0),
        ("greatest displacement of each tip", draw_depths, 34.0),
        ("joint angles, counter-clockwise positive", draw_joints, 28.0),
        ("angle of the object", draw_object, 26.0),
    ]
    height = TOP_MM + HEAD_MM + sum(mm + NAME_MM + GAP_MM for _, _, mm in panels) - GAP_MM + BOTTOM_MM
    sheet, first = Sheet(height, recording.title), None
    times = scene_times(recording)[marked]
    for letter, (what, draw, height_mm) in zip("abcd", panels, strict=True):
        sheet.name(letter, what)
        sheet.y_mm -= HEAD_MM * (first is None)
        axes = sheet.axes(LEFT_MM, PAGE_MM - LEFT_MM - RIGHT_MM, height_mm, first)
        draw(axes, recording)
        mark_phases(axes, times, phase_names(recording) if first is None else [])
        axes.tick_params(labelbottom=False)
        axes.yaxis.set_label_coords(-10.0 / (PAGE_MM - LEFT_MM - RIGHT_MM), 0.5)
        first = first or axes
        sheet.y_mm -= height_mm + GAP_MM
    label_time(axes, scene_times(recording))
    return sheet.figure


def mark_phases(axes: Axes, times: Numbers, names: list[str]) -> None:
    """Draw a line at the end of each phase, with its number where names are given."""
    for t in times:
        axes.axvline(float(t), color=FAINT, lw=0.7, ls=(0, (4, 2)), zorder=0)
    for t, name in zip(times, names, strict=False):
        style: Style = {"ha": "center", "va": "bottom", "fontsize": 6.5, "color": INK, "annotation_clip": False}
        text = f"phase {name}" if name == "0" else name
        place = (float(t), 1.0)
        axes.annotate(text, place, (0, 2), xycoords=axes.get_xaxis_transform(), textcoords="offset points", **style)


def draw_energy(axes: Axes, recording: Recording) -> None:
    """Draw the elastic energy of both tips, with its value at the end of each phase."""
    times, energy = scene_times(recording), energies_mj(recording, "elastic")
    axes.plot(times, energy, color=COILS[1], lw=1.2)
    for i in phases(recording)[:4]:
        write_value(axes, float(times[i]), float(energy[i]), f"{energy[i]:.1f}")
    axes.set_ylim(-0.05 * energy.max(), 1.22 * energy.max())
    axes.set_ylabel("energy [mJ]")


def draw_depths(axes: Axes, recording: Recording) -> None:
    """Draw both displacements, the left one dashed, so that both are seen where they are equal."""
    times, depths = scene_times(recording), np.maximum(0.0, of_fingers(recording, "d_mm"))
    for i, (name, dash) in enumerate((("right, $d_r$", "-"), ("left, $d_l$", (0, (3, 1.5))))):
        axes.plot(times, depths[:, i], color=finger_colour(i), lw=1.2, ls=dash, label=name)
    axes.set_ylim(-0.05 * depths.max(), 1.25 * depths.max())
    axes.set_ylabel("d [mm]")
    axes.legend(**LEGEND)


def write_value(axes: Axes, x: float, y: float, text: str) -> None:
    """Mark a point of a curve and write its value above it."""
    axes.plot([x], [y], ".", color=INK, ms=4, zorder=5)
    last = x > LAST * axes.dataLim.x1
    style: Style = {"ha": "right" if last else "left", "va": "bottom", "fontsize": 6.5, "color": INK}
    axes.annotate(text, (x, y), (-2 if last else 2, 2), textcoords="offset points", **style)
