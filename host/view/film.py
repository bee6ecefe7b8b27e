"""The body along the ground: one strip at one scale, and the frames of its fastest movement."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable

from host.recording import Recording, Scene
from host.view.body import LETTER_MM, draw_body, draw_ground, draw_outline, on_paper, outline, slope_of
from host.view.instants import apart, resting, width_mm
from host.view.style import COILS, GROUND, INK

Box = tuple[float, float, float, float]  # left, right, bottom, top [mm]
EDGE_MM = 1.5  # so that no line is cut at the edge
MARGIN_MM = 5.0
LETTERS_TO_SCALE_MM = 170.0  # a longer strip is drawn smaller, and its letters stand farther off
QUICK_MS = 100  # frames closer than this carry their milliseconds
FRAME_LETTER_MM = 3.8  # frames are drawn at about half size
COMMON_MM = 100.0  # frames show the same ground when all of it is no wider
ROW = 5  # frames
HEAD_MM = 10.0  # room for letters and time above the body
BELOW_MM = 7.0  # room for the scale below the ground


def extent(scene: Scene, slope_deg: float, head_mm: float = HEAD_MM) -> Box:
    """Return left, right, bottom and top on paper of a scene with its ground, in mm."""
    left, right = ground_of([scene])
    ends = on_paper([[left, -BELOW_MM], [right, -BELOW_MM], [left, 0.0], [right, 0.0]], slope_deg)
    rim = outline(scene, slope_deg)
    low, high = np.vstack([rim, ends]).min(axis=0), np.vstack([rim, ends]).max(axis=0)
    return low[0] - EDGE_MM, high[0] + EDGE_MM, low[1], max(high[1], rim[:, 1].max() + head_mm)


def together(boxes: Iterable[Box]) -> Box:
    """Return the box around boxes."""
    left, right, bottom, top = zip(*boxes, strict=True)
    return min(left), max(right), min(bottom), max(top)


def strip_slope(recording: Recording) -> float:
    """Return the slope that the strip is drawn at: a plane that is tilted under the robot is drawn as it ended."""
    return slope_of(recording.scenes[-1])


def strip_extent(recording: Recording) -> Box:
    """Return the room of the strip."""
    return together(extent(recording.scenes[i], strip_slope(recording)) for i in resting(recording))


def scale_told(_: Recording) -> str:
    """Return the words about the scale."""
    return "scale in mm"


def frame_boxes(recording: Recording, indexes: Iterable[int]) -> list[Box]:
    """Return the room of each frame, all of one size: of the same piece of ground unless the body went far."""
    boxes = [extent(scene, slope_of(scene)) for scene in (recording.scenes[i] for i in indexes)]
    left, right, bottom, top = together(boxes)
    if right - left <= COMMON_MM:
        return [(left, right, bottom, top)] * len(boxes)
    wide, high = max(box[1] - box[0] for box in boxes), max(box[3] - box[2] for box in boxes)
    middles = [((box[0] + box[1]) / 2, box[2]) for box in boxes]
    return [(x - wide / 2, x + wide / 2, y, y + high) for x, y in middles]


def ground_of(scenes: Sequence[Scene]) -> tuple[float, float]:
    """Return the ends of the ground that these scenes need, along the plane in mm."""
    along = np.concatenate([np.asarray(scene["nodes"], dtype=float)[:, 0] for scene in scenes])
    return float(along.min()) - MARGIN_MM, float(along.max()) + MARGIN_MM


def draw_strip(axes: Axes, recording: Recording, heat: ScalarMappable) -> None:
    """Draw the body where it was: whole where there is room, else its outline; and the path of its hub."""
    scenes, slope = recording.scenes, strip_slope(recording)
    shown = resting(recording)
    left, right = ground_of([scenes[index] for index in shown])
    letter_mm = LETTER_MM * max(1.0, (right - left) / LETTERS_TO_SCALE_MM)
    whole = apart(recording, shown, width_mm(scenes[0]) * 1.08)
    for index in set(shown) - set(whole):
        draw_outline(axes, scenes[index], slope)
    for index in whole:
        draw_body(axes, scenes[index], slope, heat, recording.driven(scenes[index]["host_ms"]), letter_mm)
        write_time(axes, scenes[index], slope, recording, letter_mm)
    axes.plot(*on_paper([scene["hub"][:2] for scene in scenes], slope).T, color=COILS[0], lw=0.8, zorder=5)
    draw_ground(axes, left, right, slope, scale(left, right - 6.0, 10 if right - left < 250 else 50))
    x, y = on_paper([[right, -2.0]], slope)[0]
    axes.text(x, y, "mm", ha="right", va="top", fontsize=6, color=GROUND, rotation=slope)
    frame(axes, strip_extent(recording))


def draw_frames(axes: Sequence[Axes], recording: Recording, indexes: Sequence[int], heat: ScalarMappable) -> None:
    """Draw one scene in each of the axes, above the same piece of ground unless the body went far."""
    chosen, boxes = [recording.scenes[index] for index in indexes], frame_boxes(recording, indexes)
    apart = len(set(boxes)) > 1
    quick = (chosen[-1]["host_ms"] - chosen[0]["host_ms"]) / len(chosen) < QUICK_MS
    for each, scene, box in zip(axes, chosen, boxes, strict=True):
        slope = slope_of(scene)
        left, right = ground_of([scene] if apart else chosen)
        draw_body(each, scene, slope, heat, recording.driven(scene["host_ms"]), FRAME_LETTER_MM)
        write_time(each, scene, slope, recording, FRAME_LETTER_MM, 3 if quick else 1)
        draw_ground(each, left, right, slope, scale(left, right, 20))
        frame(each, box)


def scale(left_mm: float, right_mm: float, step_mm: int) -> list[float]:
    """Return the multiples of a step between two places."""
    ticks: list[float] = np.arange(np.ceil(left_mm / step_mm) * step_mm, right_mm, step_mm).tolist()
    return ticks


def write_time(
    axes: Axes, scene: Scene, slope_deg: float, recording: Recording, letter_mm: float, decimals: int = 1
) -> None:
    """Write the scene's time above its body and letters."""
    points = outline(scene, slope_deg)
    x, y = float(points[:, 0].min() + points[:, 0].max()) / 2, float(points[:, 1].max()) + 1.8 * letter_mm
    time = f"{max(0.0, recording.seconds(scene['host_ms'])):.{decimals}f}"
    axes.text(x, y, f"{time} s", ha="center", va="bottom", fontsize=6.5, color=INK)


def frame(axes: Axes, box: Box) -> None:
    """Show just this box, without its lines, one millimetre the same both ways."""
    axes.set(xlim=box[:2], ylim=box[2:], aspect="equal")
    axes.set_axis_off()
