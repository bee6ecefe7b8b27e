"""The ground under a sphere: a carpet with a grid and a scale in mm along its near edge, terrain, and the shadow."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.patches import PathPatch
from matplotlib.path import Path

from host.recording import Scene
from host.view.camera import Points, on_paper, plumb
from host.view.solids import edges
from host.view.style import GROUND, Style

CARPET, SIDE, GRID, SHADOW, CONTACT = "#f5f2ec", "#ddd6ca", "#dcd5c9", "#d9d2c6", "#6b6258"
HALF = 0.62  # width to either side of the robot's path, of the body's width
TOUCHING_MM = 0.5
Ends = tuple[float, float]  # left and right, along the plane [mm]
EVERY = (1, 2, 5, 10, 20, 50, 100, 1000, 10_000)  # lines of the grid from one number to the next
NICE = (1.0, 2.0, 5.0)


def draw_floor(axes: Axes, ends_mm: Ends, width_mm: float, scene: Scene, slope_deg: float, most_ticks: int) -> None:
    """Draw the ground from end to end under a body of that width; with a scale below, where it may have ticks."""
    left, right = ends_mm
    half, profile = HALF * width_mm, profile_of(scene, left, right)
    near, far = _at(profile, -half, slope_deg), _at(profile, half, slope_deg)
    axes.add_collection(PolyCollection([np.vstack([near, far[::-1]])], fc=CARPET, ec=GRID, lw=0.5, zorder=0.5))
    step = grid_mm(width_mm)
    places = multiples(left, right, step)
    heights = np.interp(places, *profile.T)
    lines = np.column_stack([places, heights])
    across = list(np.stack([_at(lines, y, slope_deg) for y in (-half, half)], axis=1)) if len(places) else []
    along = [_at(profile, y, slope_deg) for y in multiples(-half, half, step)]
    axes.add_collection(LineCollection([*across, *along], colors=GRID, lw=0.4, zorder=0.6))
    _draw_section(axes, profile, near, half, slope_deg)
    axes.plot(*near.T, color=GROUND, lw=0.9, zorder=0.8, solid_capstyle="butt")
    if most_ticks:
        _draw_scale(axes, profile, half, step, slope_deg, most_ticks)


def draw_shadow(axes: Axes, scene: Scene, slope_deg: float) -> None:
    """Draw what lies straight below the hoops, and darkly where they touch the ground."""
    profile = profile_of(scene, -np.inf, np.inf)
    shade, touching = [], []
    for left, right in edges(scene):
        height = np.interp(left[:, 0], *profile.T) if len(profile) else np.zeros(len(left))
        low = np.minimum(left[:, 2], right[:, 2]) - height < TOUCHING_MM
        below = [on_paper(plumb(edge, slope_deg) + np.outer(height, (0, 0, 1)), slope_deg) for edge in (left, right)]
        quads = [_wound(np.array([*below[0][i : i + 2], *below[1][i : i + 2][::-1]])) for i in range(len(left) - 1)]
        shade += quads
        touching += [quad for i, quad in enumerate(quads) if low[i] or low[i + 1]]
    for quads, colour, zorder in ((shade, SHADOW, 0.7), (touching, CONTACT, 0.75)):
        if quads:
            area = Path.make_compound_path(*(Path(np.vstack([quad, quad[:1]]), closed=True) for quad in quads))
            axes.add_patch(PathPatch(area, fc=colour, ec=colour, lw=0.5, zorder=zorder, clip_on=False))


def profile_of(scene: Scene, left_mm: float, right_mm: float) -> Points:
    """Return the ground's height along the plane from end to end, as x and z in mm."""
    given = np.array(scene.get("terrain_mm") or [], dtype=float).reshape(-1, 2)
    if not np.isfinite(left_mm):
        return given
    inside = given[(given[:, 0] > left_mm) & (given[:, 0] < right_mm)]
    ends = np.interp([left_mm, right_mm], *given.T) if len(given) else np.zeros(2)
    return np.vstack([[left_mm, ends[0]], inside, [right_mm, ends[1]]])


def floor_corners(ends_mm: Ends, width_mm: float, slope_deg: float) -> Points:
    """Return the corners of the ground on paper."""
    half = HALF * width_mm
    corners: Points = on_paper([[x, y, 0.0] for x in ends_mm for y in (-half, half)], slope_deg)
    return corners


def grid_mm(width_mm: float) -> float:
    """Return a round length of about a fifth of the body's width."""
    scale = 10.0 ** np.floor(np.log10(width_mm / 5))
    return float(min((share * scale for share in (*NICE, 10.0)), key=lambda step: abs(step - width_mm / 5)))


def multiples(left_mm: float, right_mm: float, step_mm: float) -> Points:
    """Return the multiples of a step between two places."""
    found: Points = np.arange(np.ceil(left_mm / step_mm), np.floor(right_mm / step_mm) + 1) * step_mm
    return found


def _wound(quad: Points) -> Points:
    """Return a quadrangle wound to the left, so that overlapping ones do not cancel."""
    x, y = quad.T
    return quad if float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) > 0 else quad[::-1]


def _draw_section(axes: Axes, profile: Points, near: Points, half: float, slope_deg: float) -> None:
    """Draw the cut through uneven ground along its near edge."""
    if len(profile) > 2:
        base = _at([[x, min(0.0, profile[:, 1].min())] for x in profile[[0, -1], 0]], -half, slope_deg)
        axes.add_collection(PolyCollection([np.vstack([near, base[::-1]])], fc=SIDE, ec=SIDE, lw=0.4, zorder=0.7))


def _draw_scale(axes: Axes, profile: Points, half: float, step: float, slope_deg: float, most_ticks: int) -> None:
    """Write the scale: as many multiples of the grid as there is room for, and the unit in place of the last."""
    span = float(profile[-1, 0] - profile[0, 0]) / step
    every = next(n for n in EVERY if span / n <= most_ticks)
    shown = multiples(profile[0, 0], profile[-1, 0], step * every)
    base = min(0.0, float(profile[:, 1].min()))
    for x in shown:
        place = tuple(_at([[x, base]], -half, slope_deg)[0])
        text = "mm" if x == shown[-1] else f"{x + 0.0:g}"
        style: Style = {"ha": "center", "va": "top", "fontsize": 6, "color": GROUND, "rotation": slope_deg}
        axes.annotate(text, place, (0, -2.5), textcoords="offset points", **style)


def _at(profile: Sequence[Sequence[float]] | Points, y_mm: float, slope_deg: float) -> Points:
    x, z = np.asarray(profile, dtype=float).T
    paper: Points = on_paper(np.column_stack([x, np.full_like(x, y_mm), z]), slope_deg)
    return paper
