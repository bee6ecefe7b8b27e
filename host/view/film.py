"""The body along the ground: one strip at one scale, and the frames of its fastest movement."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable

from host.recording import Recording, Scene
from host.view.body import draw_body, draw_ground, draw_outline, on_paper, outline, slope_of
from host.view.instants import apart, resting
from host.view.style import COILS, GROUND, INK

MARGIN_MM = 5.0
QUICK_MS = 100  # frames closer than this carry their milliseconds
HEAD_MM = 9.0  # room for letters and time above the body
BELOW_MM = 7.0  # room for the scale below the ground


def extent(scenes: Sequence[Scene], head_mm: float = HEAD_MM) -> tuple[float, float, float, float]:
    """Return left, right, bottom and top on paper of these scenes with their ground, in mm."""
    points = np.vstack([outline(scene) for scene in scenes])
    left, right = ground_of(scenes)
    ends = on_paper([[left, -BELOW_MM], [right, -BELOW_MM]], slope_of(scenes[0]))
    everything = np.vstack([points, ends])
    low, high = everything.min(axis=0), everything.max(axis=0)
    return low[0] - 1.0, high[0] + 1.0, low[1], high[1] + head_mm


def ground_of(scenes: Sequence[Scene]) -> tuple[float, float]:
    """Return the ends of the ground that these scenes need, along the plane in mm."""
    along = np.concatenate([np.asarray(scene["nodes"], dtype=float)[:, 0] for scene in scenes])
    return float(along.min()) - MARGIN_MM, float(along.max()) + MARGIN_MM


def draw_strip(axes: Axes, recording: Recording, heat: ScalarMappable) -> None:
    """Draw the body where it was: whole where there is room, else its outline; and the path of its hub."""
    scenes = recording.scenes
    shown = resting(recording)
    whole = apart(recording, shown, _width(scenes[0]) * 1.08)
    for index in set(shown) - set(whole):
        draw_outline(axes, scenes[index])
    for index in whole:
        draw_body(axes, scenes[index], heat, recording.driven(scenes[index]["host_ms"]))
        write_time(axes, scenes[index], recording)
    slope = slope_of(scenes[0])
    hubs = on_paper([scene["hub"][:2] for scene in scenes], slope)
    axes.plot(*hubs.T, color=COILS[0], lw=0.8, zorder=5)
    left, right = ground_of([scenes[index] for index in shown])
    draw_ground(axes, left, right, slope, scale(left, right - 4.0, 10))
    x, y = on_paper([[right, -2.0]], slope)[0]
    axes.text(x, y, "mm", ha="right", va="top", fontsize=6, color=GROUND, rotation=slope)
    frame(axes, [scenes[index] for index in shown])


def draw_frames(axes: Sequence[Axes], recording: Recording, indexes: Sequence[int], heat: ScalarMappable) -> None:
    """Draw one scene in each of the axes, all above the same piece of ground."""
    chosen = [recording.scenes[index] for index in indexes]
    left, right = ground_of(chosen)
    quick = (chosen[-1]["host_ms"] - chosen[0]["host_ms"]) / len(chosen) < QUICK_MS
    for each, scene in zip(axes, chosen, strict=True):
        draw_body(each, scene, heat, recording.driven(scene["host_ms"]), line=1.2)
        write_time(each, scene, recording, 3 if quick else 1)
        draw_ground(each, left, right, slope_of(scene), scale(left, right, 20))
        frame(each, chosen)


def scale(left_mm: float, right_mm: float, step_mm: int) -> list[float]:
    """Return the multiples of a step between two places."""
    ticks: list[float] = np.arange(np.ceil(left_mm / step_mm) * step_mm, right_mm, step_mm).tolist()
    return ticks


def write_time(axes: Axes, scene: Scene, recording: Recording, decimals: int = 1) -> None:
    """Write the scene's time above its body."""
    points = outline(scene)
    x = float(points[:, 0].min() + points[:, 0].max()) / 2
    time = f"{max(0.0, recording.seconds(scene['host_ms'])):.{decimals}f}"
    axes.text(x, float(points[:, 1].max()) + 4.8, f"{time} s", ha="center", va="bottom", fontsize=6.5, color=INK)


def frame(axes: Axes, scenes: Sequence[Scene]) -> None:
    """Show just these scenes, without the box, one millimetre the same both ways."""
    left, right, bottom, top = extent(scenes)
    axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal")
    axes.set_axis_off()


def _width(scene: Scene) -> float:
    along = np.asarray(scene["nodes"], dtype=float)[:, 0]
    return float(np.ptp(along))
