"""Draws one scene: rim, hub, coils coloured by their temperature, and the ground, all in mm.

The plane's own axes (x along the ground) are turned by a slope, so that up is up on paper.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.patheffects import Normal, Stroke
from numpy.typing import ArrayLike, NDArray

from host.recording import Scene
from host.view.style import FAINT, GROUND, INK

Points = NDArray[np.float64]
TURNS = 9
COIL_WIDTH_MM = 1.5
LETTER_MM = 2.7  # of a coil's letter from the rim, where a millimetre of the body is one on paper
EDGED = [Stroke(linewidth=1.7, foreground=INK), Normal()]


def slope_of(scene: Scene) -> float:
    """Return the ground's slope in degrees, 0 where the scene does not say."""
    return float(scene.get("slope_deg", 0.0))


def on_paper(points: ArrayLike, slope_deg: float) -> Points:
    """Return points of the plane as they lie on paper."""
    slope = np.radians(slope_deg)
    turn = np.array([[np.cos(slope), np.sin(slope)], [-np.sin(slope), np.cos(slope)]])
    turned: Points = np.atleast_2d(np.asarray(points, dtype=float)) @ turn
    return turned


def outline(scene: Scene, slope_deg: float) -> Points:
    """Return the closed rim on paper."""
    nodes = np.asarray(scene["nodes"], dtype=float)
    return on_paper(np.vstack([nodes, nodes[:1]]), slope_deg)


def draw_body(
    axes: Axes,
    scene: Scene,
    slope_deg: float,
    heat: ScalarMappable,
    driven: Collection[str],
    letter_mm: float = LETTER_MM,
) -> None:
    """Draw rim, hub and coils, their letters so far from the rim; a driven coil has a dot where it pulls the rim."""
    axes.plot(*outline(scene, slope_deg).T, color=INK, lw=1.3, solid_joinstyle="round", zorder=3)
    for label, coil in scene["coils"].items():
        start, end = on_paper([coil["from"], coil["to"]], slope_deg)
        colour = heat.to_rgba(coil["degc"])
        axes.plot(*spring(start, end).T, color=colour, lw=0.9, path_effects=EDGED, zorder=4)
        if label in driven:
            axes.plot(*end, "o", color=colour, ms=4.2, mec=INK, mew=0.6, zorder=6)
        x, y = on_paper(letter_place(np.array(coil["from"]), np.array(coil["to"]), letter_mm), slope_deg)[0]
        axes.text(x, y, label, ha="center", va="center", fontsize=6, color=INK, zorder=7)
    axes.plot(*on_paper(scene["hub"][:2], slope_deg)[0], "o", color="white", ms=3.2, mec=INK, mew=0.8, zorder=8)


def draw_outline(axes: Axes, scene: Scene, slope_deg: float) -> None:
    """Draw the rim alone, faintly."""
    axes.plot(*outline(scene, slope_deg).T, color=FAINT, lw=0.7, zorder=1)


def draw_ground(axes: Axes, left_mm: float, right_mm: float, slope_deg: float, ticks_mm: Sequence[float]) -> None:
    """Draw the ground from left to right along the plane, with its scale below it."""
    line = on_paper([[left_mm, 0.0], [right_mm, 0.0]], slope_deg)
    axes.plot(*line.T, color=GROUND, lw=1.2, zorder=2, solid_capstyle="butt")
    for x in ticks_mm:
        foot, tip, (text_x, text_y) = on_paper([[x, 0.0], [x, -1.2], [x, -2.0]], slope_deg)
        axes.plot(*np.array([foot, tip]).T, color=GROUND, lw=0.6, zorder=2)
        axes.text(text_x, text_y, f"{x:g}", ha="center", va="top", fontsize=6, color=GROUND, rotation=slope_deg)


def spring(start: Points, end: Points) -> Points:
    """Return a zigzag of a fixed number of turns from start to end: the shorter the coil, the closer its turns."""
    along = end - start
    across = np.array([-along[1], along[0]]) / max(float(np.hypot(*along)), 1e-9) * COIL_WIDTH_MM / 2
    places = np.linspace(0.12, 0.92, 2 * TURNS + 1)
    sides = np.concatenate([[0.0], np.tile([1.0, -1.0], TURNS - 1), [1.0, 0.0]])
    middle = start + places[:, None] * along + sides[:, None] * across
    return np.vstack([start, middle, end])


def letter_place(start: Points, end: Points, letter_mm: float) -> Points:
    """Return where a coil's letter stands in the plane: beyond the rim, or inside when the ground is there."""
    along = (end - start) / max(float(np.hypot(*(end - start))), 1e-9)
    place: Points = end + letter_mm * along
    if place[1] < letter_mm / 2:
        place = end - 2.0 * LETTER_MM * along + letter_mm * np.array([-along[1], along[0]])
    return place
