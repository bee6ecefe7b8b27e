"""The curves of a press over time: force, depth, what presses on each force cell, currents; measured, and true."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from host.recording import Recording
from host.view.curves import record_times
from host.view.instants import Numbers, scene_times
from host.view.jointcurves import LEGEND, joint_angles
from host.view.pressing import of_scenes
from host.view.style import COILS, INK, Style, coil_colour, coil_dash

FORCE, DEPTH = COILS[1], COILS[0]
LEAST_N, LEAST_MM, LEAST_KPA = 0.5, 0.5, 0.5  # of an axis
DASHES = ("-", (0, (4, 1.5)))  # of every other cell: those to the left and to the right press alike


def presses(recording: Recording) -> bool:
    """Return whether the robot told of a load cell or of force cells, and whoever saw it of a block, if anybody did."""
    first = recording.telemetry[0]
    felt = first.load_n is not None or bool(first.cell_kpa)
    return felt and (not recording.scenes or "indenter" in recording.scenes[0])


def draw_force(axes: Axes, recording: Recording) -> None:
    """Draw the force as the load cell measures it, and dotted as it is, where an observer knows it."""
    force = np.array([np.nan if row.load_n is None else row.load_n for row in recording.telemetry], dtype=float)
    axes.plot(record_times(recording), force, color=FORCE, lw=1.1, label="load cell")
    if recording.scenes:
        axes.plot(scene_times(recording), of_scenes(recording, "force_n"), color=INK, lw=0.9, ls=":", label="true")
    _leave_room(axes, LEAST_N)
    axes.set_ylabel("force [N]")


def draw_depth(axes: Axes, recording: Recording) -> None:
    """Draw where the axis is measured, dashed where it is told to go, and dotted where the indenter is."""
    times = record_times(recording)
    for i, label in enumerate(recording.joints):
        measured, told = (joint_angles(recording, f"{name}_position")[:, i] for name in ("joint", "commanded"))
        axes.plot(times, measured, color=DEPTH, lw=1.1, label=f"{label}, measured")
        axes.plot(times, told, color=INK, lw=0.7, ls=(0, (4, 2)), label="commanded")
    if recording.scenes:
        depth = of_scenes(recording, "depth_mm")
        axes.plot(scene_times(recording), depth, color=INK, lw=0.9, ls=":", label="indenter, true")
    axes.axhline(0.0, color="#dddddd", lw=0.5, zorder=0)
    _leave_room(axes, LEAST_MM)
    axes.set_ylabel("depth [mm]")


def draw_cells(axes: Axes, recording: Recording) -> None:
    """Draw what presses on each force cell, as measured."""
    pressure = np.array([row.cell_kpa for row in recording.telemetry], dtype=float)
    for i, label in enumerate(recording.cells):
        style: Style = {"color": coil_colour(i), "ls": DASHES[i % 2], "zorder": 2 + i % 2, "lw": 1.0}
        axes.plot(record_times(recording), pressure[:, i], label=label, **style)
    _leave_room(axes, LEAST_KPA)
    axes.set_ylabel("cells [kPa]")


def draw_joint_current(axes: Axes, recording: Recording) -> None:
    """Draw the current of the servo, and that of all from the supply."""
    times, current = record_times(recording), joint_angles(recording, "joint_ma")
    for i, label in enumerate(recording.joints):
        axes.plot(times, current[:, i], color=DEPTH, lw=0.9, ls=coil_dash(i), label=label)
    supply = [row.current_ma for row in recording.telemetry]
    axes.plot(times, supply, color=INK, lw=0.7, ls=":", label="supply")
    axes.set_ylim(0, max([100.0, *supply, float(current.max(initial=0.0))]) * 1.3)
    axes.legend(**LEGEND)
    axes.set_ylabel("current [mA]")


def _leave_room(axes: Axes, least: float) -> None:
    """Show all curves with some room above for the legend."""
    seen: Numbers = np.concatenate([np.asarray(line.get_ydata(), dtype=float) for line in axes.get_lines()])
    known = np.append(seen[np.isfinite(seen)], [0.0, least])
    reach = float(np.ptp(known))
    axes.set_ylim(float(known.min()) - 0.06 * reach, float(known.max()) + 0.22 * reach)
    axes.legend(**{**LEGEND, "ncols": 6})
