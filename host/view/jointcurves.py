"""The curves of a robot with joints over time: their angles and currents, and the angle of what they hold."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from host.recording import Recording
from host.view.curves import record_times
from host.view.hand import OBJECT, finger_colour
from host.view.instants import Numbers, scene_times
from host.view.style import INK, Style
from host.view.swings import object_deg

LEGEND: Style = {
    "loc": "upper right", "ncols": 3, "fontsize": 6.5, "borderaxespad": 0.0, "borderpad": 0.2,
    "facecolor": "white", "edgecolor": "none", "framealpha": 1.0,
}  # fmt: skip
LEAST_DEG = 0.5  # of an axis of angles, to either side


def joint_angles(recording: Recording, name: str) -> Numbers:
    """Return what each record tells of each joint; not a number where it is unknown."""
    rows = [getattr(row, name) for row in recording.telemetry]
    return np.array([[np.nan if value is None else value for value in row] for row in rows], dtype=float)


def has_joints(recording: Recording) -> bool:
    """Return whether the robot told of joints."""
    return bool(recording.telemetry and recording.telemetry[0].joint_position)


def draw_joints(axes: Axes, recording: Recording) -> None:
    """Draw each joint's angle as measured, and dashed where it is told to go."""
    times = record_times(recording)
    measured, commanded = joint_angles(recording, "joint_position"), joint_angles(recording, "commanded_position")
    for i, label in enumerate(recording.joints):
        axes.plot(times, measured[:, i], color=finger_colour(i), lw=1.1, label=label)
        axes.plot(times, commanded[:, i], color=INK, lw=0.7, ls=(0, (2, 2)))
    handles, names = axes.get_legend_handles_labels()
    handles.append(Line2D([], [], color=INK, lw=0.7, ls=(0, (2, 2))))
    axes.legend(handles, [*names, "commanded"], **LEGEND)
    _centre(axes, measured)
    axes.set_ylabel("joints [°]")


def draw_object(axes: Axes, recording: Recording) -> None:
    """Draw the object's angle as the camera tells it, and dotted as it is, where an observer knows it."""
    seen = np.array([np.nan if row.object_deg is None else row.object_deg for row in recording.telemetry], dtype=float)
    axes.plot(record_times(recording), seen, color=OBJECT, lw=1.1, label="camera")
    if recording.scenes:
        axes.plot(scene_times(recording), object_deg(recording), color=INK, lw=0.9, ls=":", label="true")
    axes.legend(**LEGEND)
    _centre(axes, seen)
    axes.set_ylabel("object [°]")


def draw_joint_currents(axes: Axes, recording: Recording) -> None:
    """Draw each joint's current."""
    current = joint_angles(recording, "joint_ma")
    for i, label in enumerate(recording.joints):
        axes.plot(record_times(recording), current[:, i], color=finger_colour(i), lw=0.9, label=label)
    axes.legend(**LEGEND)
    axes.set_ylim(0, max(100.0, float(current.max())) * 1.2)
    axes.set_ylabel("joints [mA]")


def _centre(axes: Axes, values: Numbers) -> None:
    """Show these values with some room above for the legend."""
    known = values[np.isfinite(values)]
    reach = max(LEAST_DEG, float(np.abs(known).max())) if len(known) else LEAST_DEG
    axes.set_ylim(-1.15 * reach, 1.45 * reach)
    axes.axhline(0.0, color="#dddddd", lw=0.5, zorder=0)
