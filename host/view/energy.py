"""The energies of a body over time, and its jump: stored in the shape, of motion, of height, each in mJ."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from host.recording import Recording
from host.view.instants import LEAP, Numbers, scene_times, width_mm
from host.view.style import COILS, INK, Style

KINDS = (("elastic", "stored in the shape", COILS[1]), ("kinetic", "motion", COILS[0]), ("gravity", "height", COILS[2]))
LETTER = 6.0
FULL = 0.95  # of the greatest energy: the shape still holds it


def jumps(recording: Recording) -> dict[str, Any] | None:
    """Return what the observer told last of a jump, or None when there was none, or only a hop of a crawl."""
    if not recording.scenes:
        return None
    told: dict[str, Any] | None = recording.scenes[-1]["observed"].get("jump")
    return told if told and told["apex_mm"] > LEAP * width_mm(recording.scenes[0]) else None


def energies_mj(recording: Recording, kind: str) -> Numbers:
    """Return one energy at each scene in mJ; that of height counts from where the body stood at first."""
    given = np.array([scene["energy_j"][kind] for scene in recording.scenes], dtype=float) * 1000
    return given - given[0] if kind == "gravity" else given


def draw_marked(axes: Axes, recording: Recording) -> None:
    """Draw the energies, with take-off and apex of the jump marked."""
    draw_energies(axes, recording)
    mark_jump(axes, recording)


def draw_energies(axes: Axes, recording: Recording) -> None:
    """Draw the energies over time."""
    times = scene_times(recording)
    for kind, name, colour in KINDS:
        axes.plot(times, energies_mj(recording, kind), color=colour, lw=1.1, label=name)
    axes.legend(loc="upper left", ncols=3, frameon=False, fontsize=6.5, borderaxespad=0.0)
    highest = max(float(energies_mj(recording, kind).max()) for kind, _, _ in KINDS)
    axes.set_ylim(-0.06 * highest, 1.25 * highest)
    axes.set_ylabel("energy [mJ]")


def mark_jump(axes: Axes, recording: Recording, sides: tuple[str, str] = ("right", "left")) -> None:
    """Mark take-off and apex of a jump by upright lines; `sides` say which end of each word is at its line."""
    instants = instants_of(recording)
    for name, side in zip(("take-off", "apex"), sides, strict=True):
        axes.axvline(instants[name], color=INK, lw=0.6, ls=(0, (4, 2)), zorder=1)
        style: Style = {"ha": side, "va": "top", "fontsize": LETTER, "color": INK, "annotation_clip": True}
        shift, place = (-2 if side == "right" else 2, -2), (instants[name], 1.0)
        axes.annotate(name, place, shift, xycoords=axes.get_xaxis_transform(), textcoords="offset points", **style)


def instants_of(recording: Recording) -> dict[str, float]:
    """Return the times of release, take-off and apex in seconds of the picture; none without a jump.

    The release begins when the shape last held nearly all that it ever stored.
    """
    jump = jumps(recording)
    if jump is None:
        return {}
    times = scene_times(recording)
    clock = times[-1] - recording.scenes[-1]["t_s"]  # from the observer's clock to that of the picture
    takeoff = float(jump["takeoff_s"] + clock)
    height = np.where(times >= takeoff, energies_mj(recording, "gravity"), -np.inf)
    stored = np.where(times < takeoff, energies_mj(recording, "elastic"), 0.0)
    release = int(np.flatnonzero(stored >= FULL * stored.max())[-1])
    return {"release": float(times[release]), "take-off": takeoff, "apex": float(times[int(height.argmax())])}
