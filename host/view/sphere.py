"""Draws one scene of a sphere in space: hoops, coils coloured by their temperature, core, shadow and labels.

Lengths that only arrange the picture are shares of the body's width, so a sphere of any size looks alike.
"""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.patheffects import Normal, Stroke

from host.recording import Scene
from host.view.camera import Points, on_paper
from host.view.floor import draw_shadow
from host.view.solids import core, curved, edges, paint, springs, strips
from host.view.style import FAINT, INK, Style

HOT_DEGC = 60.0  # a coil that is hotter is named also when it is no longer driven
MOST_NAMES = 5
LEFTWARD = 0.15  # of the body's width: nearer to the middle than this a coil's name stands on the left
ASIDE = 0.07  # from the body to the names, of its width
APART = 0.1  # between two names, of the body's width
HALO = [Stroke(linewidth=1.6, foreground="white"), Normal()]


def outline(scene: Scene, slope_deg: float) -> Points:
    """Return the edges of all hoops on paper."""
    return np.vstack([on_paper(edge, slope_deg) for pair in edges(scene) for edge in pair])


def draw_sphere(axes: Axes, scene: Scene, slope_deg: float, heat: ScalarMappable, driven: Collection[str]) -> None:
    """Draw the body above its shadow; driven coils have a dot."""
    draw_shadow(axes, scene, slope_deg)
    pieces = [*strips(scene, slope_deg), *springs(scene, slope_deg, heat, driven), *core(scene, slope_deg)]
    paint(axes, pieces, zorder=3)


def draw_faint(axes: Axes, scene: Scene, slope_deg: float) -> None:
    """Draw faintly the hoop that looks largest: the one it rolls on."""
    nodes = np.asarray(scene["nodes"], dtype=float)
    lines = [curved(nodes[hoop]) for hoop in scene["hoops"]]
    hoops = [on_paper(np.vstack([line, line[:1]]), slope_deg) for line in lines]
    widest = max(hoops, key=lambda line: float(np.ptp(line, axis=0).prod()))
    axes.plot(*widest.T, color=FAINT, lw=0.7, zorder=1)


def named(scene: Scene, driven: Collection[str]) -> list[str]:
    """Return which coils are named: those driven or hot; the driven alone when they are many, none beyond a few."""
    warm = [label for label, coil in scene["coils"].items() if label in driven or coil["degc"] > HOT_DEGC]
    names = warm if len(warm) <= MOST_NAMES else [label for label in warm if label in driven]
    return names if len(names) <= MOST_NAMES else []


def write_names(axes: Axes, scene: Scene, names: list[str], slope_deg: float, width_mm: float) -> None:
    """Write names of coils beside the body, on either side in the order of their heights, each led to by a line."""
    shape = outline(scene, slope_deg)
    middle = float(shape[:, 0].min() + shape[:, 0].max()) / 2 + LEFTWARD * width_mm
    points = {label: _pulling(scene, label, slope_deg) for label in names}
    rising = sorted(names, key=lambda label: float(points[label][1]))
    for side, edge in ((-1, shape[:, 0].min()), (1, shape[:, 0].max())):
        column = [label for label in rising if (points[label][0] >= middle) == (side > 0)]
        places = spread([points[label][1] for label in column], APART * width_mm)
        x = float(edge) + side * ASIDE * width_mm
        for label, y in zip(column, places, strict=True):
            axes.plot([points[label][0], x], [points[label][1], y], color=INK, lw=0.35, zorder=4)
            align = "left" if side > 0 else "right"
            style: Style = {"ha": align, "va": "center", "fontsize": 5.5, "path_effects": HALO, "zorder": 5}
            axes.annotate(label, (x, y), (side, 0), textcoords="offset points", **style)


def spread(heights: list[float], gap: float) -> list[float]:
    """Return rising heights moved apart until there is a gap between each two, about the same middle."""
    if not heights:
        return []
    moved = [heights[0]]
    for height in heights[1:]:
        moved.append(max(height, moved[-1] + gap))
    down = (sum(moved) - sum(heights)) / len(heights)
    return [height - down for height in moved]


def _pulling(scene: Scene, label: str, slope_deg: float) -> Points:
    """Return on paper where a coil pulls the hoop; of one between two hoop points its middle."""
    coil = scene["coils"][label]
    start, end = np.array(coil["from"], dtype=float), np.array(coil["to"], dtype=float)
    hub = np.array(scene["hub"], dtype=float)
    outer = np.linalg.norm(start - hub) > 0.6 * np.linalg.norm(end - hub)
    place: Points = on_paper((start + end) / 2 if outer else end, slope_deg)[0]
    return place
