"""A sphere along the ground, in space: one strip at one scale, and the frames of its fastest movement.

The counterpart of `film` for bodies in space: the same functions, whose lengths are shares of the body's width.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable

from host.recording import Recording, Scene
from host.view.body import slope_of
from host.view.camera import Points, on_paper
from host.view.film import Box, frame, strip_slope, together
from host.view.floor import Ends, draw_floor, floor_corners, grid_mm
from host.view.instants import apart, hub, resting
from host.view.solids import body_width
from host.view.sphere import draw_faint, draw_sphere, named, outline, write_names
from host.view.style import COILS, INK, Style

BESIDE = 0.42  # room for names beside a body, of its width
HEAD = 0.16  # room for the time above it
BELOW = 0.15  # room for the scale below the ground
ALONG = 0.3  # ground before the first and beyond the last body
ROOM, UPWARD = 1.25, 1.1  # from one body to the next, when both are drawn whole; upward less will do
ROW = 4  # frames
BEHIND = {"fc": "white", "ec": "none", "pad": 0.4}  # a time: the path does not strike it through
QUICK_MS = 100  # frames closer than this carry their milliseconds
STRIP_TICKS, FRAME_TICKS = 20, 5


def extent(scene: Scene, ends_mm: Ends, width_mm: float, slope_deg: float) -> Box:
    """Return left, right, bottom and top on paper of a scene with the ground from end to end, in mm."""
    shape, ground = outline(scene, slope_deg), floor_corners(ends_mm, width_mm, slope_deg)
    beside, (low, high) = BESIDE * width_mm, (shape.min(axis=0), shape.max(axis=0))
    left, right = min(low[0] - beside, ground[:, 0].min()), max(high[0] + beside, ground[:, 0].max())
    bottom = min(low[1], ground[:, 1].min()) - BELOW * width_mm
    return float(left), float(right), float(bottom), float(max(high[1] + HEAD * width_mm, ground[:, 1].max()))


def ground_of(scenes: Iterable[Scene], width_mm: float) -> Ends:
    """Return the ends of the ground that these scenes need."""
    along = np.concatenate([np.asarray(scene["nodes"], dtype=float)[:, 0] for scene in scenes])
    return float(along.min()) - ALONG * width_mm, float(along.max()) + ALONG * width_mm


def strip_extent(recording: Recording) -> Box:
    """Return the room of the strip."""
    scenes, slope, width = [recording.scenes[i] for i in resting(recording)], strip_slope(recording), _width(recording)
    ends = ground_of(scenes, width)
    return together(extent(scene, ends, width, slope) for scene in scenes)


def scale_told(recording: Recording) -> str:
    """Return the words about the scale."""
    return f"grid {grid_mm(_width(recording)):g} mm"


def frame_boxes(recording: Recording, indexes: Iterable[int]) -> list[Box]:
    """Return the room of each frame, all of one size and at the height of the ground."""
    scenes, width = [recording.scenes[i] for i in indexes], _width(recording)
    boxes = [extent(scene, _patch(scene, width), width, slope_of(scene)) for scene in scenes]
    wide = max(box[1] - box[0] for box in boxes)
    grounds = [float(on_paper([[hub(scene)[0], 0.0, 0.0]], slope_of(scene))[0, 1]) for scene in scenes]
    below = max(ground - box[2] for ground, box in zip(grounds, boxes, strict=True))
    above = max(box[3] - ground for ground, box in zip(grounds, boxes, strict=True))
    middles = [(box[0] + box[1]) / 2 for box in boxes]
    return [(x - wide / 2, x + wide / 2, y - below, y + above) for x, y in zip(middles, grounds, strict=True)]


def draw_strip(axes: Axes, recording: Recording, heat: ScalarMappable) -> None:
    """Draw the body where it was: whole where there is room, else one hoop; and the path of its core."""
    scenes, slope, width = recording.scenes, strip_slope(recording), _width(recording)
    shown = resting(recording)
    whole = apart(recording, shown, ROOM * width, UPWARD)
    draw_floor(axes, ground_of([scenes[i] for i in shown], width), width, scenes[0], slope, STRIP_TICKS)
    for index in set(shown) - set(whole):
        draw_faint(axes, scenes[index], slope)
    for scene in (scenes[i] for i in whole):
        _draw_named(axes, scene, slope, heat, recording, width)
        write_time(axes, scene, slope, recording)
    axes.plot(*_path(scenes, slope).T, color=COILS[0], lw=0.9, zorder=4.5)
    frame(axes, strip_extent(recording))


def draw_frames(axes: Sequence[Axes], recording: Recording, indexes: Sequence[int], heat: ScalarMappable) -> None:
    """Draw one scene in each of the axes, each with the ground about it."""
    chosen, width = [recording.scenes[index] for index in indexes], _width(recording)
    quick = (chosen[-1]["host_ms"] - chosen[0]["host_ms"]) / len(chosen) < QUICK_MS
    for each, scene, box in zip(axes, chosen, frame_boxes(recording, indexes), strict=True):
        slope = slope_of(scene)
        draw_floor(each, _patch(scene, width), width, scene, slope, FRAME_TICKS)
        _draw_named(each, scene, slope, heat, recording, width)
        write_time(each, scene, slope, recording, 3 if quick else 1)
        frame(each, box)


def write_time(axes: Axes, scene: Scene, slope_deg: float, recording: Recording, decimals: int = 1) -> None:
    """Write the scene's time above its body."""
    shape = outline(scene, slope_deg)
    place = (float(shape[:, 0].min() + shape[:, 0].max()) / 2, float(shape[:, 1].max()))
    time = f"{max(0.0, recording.seconds(scene['host_ms'])):.{decimals}f} s"
    style: Style = {"ha": "center", "va": "bottom", "fontsize": 6.5, "color": INK, "zorder": 6}
    axes.annotate(time, place, (0, 2), textcoords="offset points", bbox=BEHIND, **style)


def _draw_named(
    axes: Axes, scene: Scene, slope_deg: float, heat: ScalarMappable, recording: Recording, width_mm: float
) -> None:
    driven = recording.driven(scene["host_ms"])
    draw_sphere(axes, scene, slope_deg, heat, driven)
    write_names(axes, scene, named(scene, driven), slope_deg, width_mm)


def _path(scenes: Sequence[Scene], slope_deg: float) -> Points:
    path: Points = on_paper([hub(scene) for scene in scenes], slope_deg)
    return path


def _patch(scene: Scene, width_mm: float) -> Ends:
    """Return the ends of a piece of ground below one body."""
    x = float(hub(scene)[0])
    return x - 0.85 * width_mm, x + 0.85 * width_mm


def _width(recording: Recording) -> float:
    return body_width(recording.scenes[0])
