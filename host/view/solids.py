"""What a sphere is drawn of: small pieces of strip, coil and core, painted from the farthest to the nearest.

A hoop is a strip of its width, which lies across the hoop's own plane; between the nodes it is drawn smoothly curved.
The nearer a piece, the darker. A coil that is warm is a spring, one at rest a line.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PathCollection
from matplotlib.colors import to_rgb, to_rgba
from matplotlib.path import Path

from host.recording import Scene
from host.view.camera import Points, distance, on_paper, silhouette
from host.view.style import INK

Colour = tuple[float, float, float, float]
NEAR, FAR = np.array(to_rgb("#2f3640")), np.array(to_rgb("#d3d8de"))
CORE, CORE_LIGHT, EDGE = to_rgba("#c9ced6"), to_rgba("#eef0f3"), to_rgba(INK)
CLEAR: Colour = (0.0, 0.0, 0.0, 0.0)
PARTS = 2  # of the strip between two nodes
PIECES = 9  # of a warm coil
TURNS = 9
THREADS = 3  # pieces of a coil at rest
SPRING_SHARE = 0.035  # half width of a spring, of the body's width
WARM_K = 6.0  # above the coolest coil: drawn as a spring
IN_FRONT = 1e-3  # [mm] what is painted upon its own edging


class Piece(NamedTuple):
    """One stroke of the brush: an outline on paper (filled) or a line (with no filling)."""

    away: float  # [mm] along the line of sight
    points: Points
    filling: Colour
    line: Colour
    width: float  # of the line [pt]


def paint(axes: Axes, pieces: Iterable[Piece], zorder: float) -> None:
    """Draw the pieces, the farthest first."""
    ordered = sorted(pieces, key=lambda piece: -piece.away)
    paths = [Path(p.points, closed=False) if p.filling == CLEAR else _closed(p.points) for p in ordered]
    drawn = PathCollection(paths, zorder=zorder, joinstyle="round", capstyle="butt")
    drawn.set_facecolor([p.filling for p in ordered])
    drawn.set_edgecolor([p.line for p in ordered])
    drawn.set_linewidth([p.width for p in ordered])
    drawn.set_clip_on(False)  # the picture's box holds the whole body
    axes.add_collection(drawn, autolim=False)


def strips(scene: Scene, slope_deg: float) -> Iterator[Piece]:
    """Yield the hoops."""
    middle, reach = distance(scene["hub"], slope_deg)[0], body_width(scene) / 2
    for left, right in edges(scene):
        away = distance((left + right) / 2, slope_deg)
        near_left, near_right = on_paper(left, slope_deg), on_paper(right, slope_deg)
        for i in range(len(away) - 1):
            corners = np.array([near_left[i], near_left[i + 1], near_right[i + 1], near_right[i]])
            depth = (away[i] + away[i + 1]) / 2
            shade = shaded((depth - middle) / reach)
            yield Piece(depth, corners, shade, shade, 0.25)


def edges(scene: Scene) -> Iterator[tuple[Points, Points]]:
    """Yield the two edges of each hoop, closed: half the strip's width to either side of its centre line."""
    nodes = np.asarray(scene["nodes"], dtype=float)
    for hoop in scene["hoops"]:
        line = nodes[hoop]
        ahead = np.roll(line, -1, axis=0)
        plane = np.cross(line - line.mean(axis=0), ahead - line.mean(axis=0)).sum(axis=0)
        smooth = curved(line)
        along = np.roll(smooth, -1, axis=0) - np.roll(smooth, 1, axis=0)
        along /= np.linalg.norm(along, axis=1)[:, None]
        across = plane - (along @ plane)[:, None] * along
        across *= scene["strip_mm"] / 2 / np.linalg.norm(across, axis=1)[:, None]
        shut = np.arange(len(smooth) + 1) % len(smooth)
        yield (smooth - across)[shut], (smooth + across)[shut]


def curved(line: Points) -> Points:
    """Return a closed line with more points: a Catmull-Rom curve through the given ones."""
    before, after, beyond = (np.roll(line, -shift, axis=0) for shift in (-1, 1, 2))
    smooth = np.empty((PARTS * len(line), line.shape[1]))
    for part in range(PARTS):
        t = part / PARTS
        first, second = (-t + 2 * t**2 - t**3) / 2, (2 - 5 * t**2 + 3 * t**3) / 2
        third, fourth = (t + 4 * t**2 - 3 * t**3) / 2, (-(t**2) + t**3) / 2
        smooth[part::PARTS] = first * before + second * line + third * after + fourth * beyond
    return smooth


def springs(scene: Scene, slope_deg: float, heat: ScalarMappable, driven: Collection[str]) -> Iterator[Piece]:
    """Yield the coils: warm or driven ones as springs, those at rest as lines; a dot where a driven one pulls."""
    coils = scene["coils"]
    coolest = min(coil["degc"] for coil in coils.values())
    width = SPRING_SHARE * body_width(scene)
    hub, radius = np.array(scene["hub"], dtype=float), core_radius(scene)
    for label, coil in coils.items():
        start, end = np.array(coil["from"], dtype=float), np.array(coil["to"], dtype=float)
        start = start + max(0.0, radius - float(np.linalg.norm(start - hub))) * along(start, end)
        colour: Colour = tuple(heat.to_rgba(coil["degc"]))
        if label in driven or coil["degc"] > coolest + WARM_K:
            yield from _spring(start, end, slope_deg, colour, width)
        else:
            yield from _thread(start, end, slope_deg, colour)
        if label in driven:
            dot = silhouette(end, 0.8 * width, slope_deg, 16)
            yield Piece(distance(end, slope_deg)[0] - width, dot, colour, EDGE, 0.6)


def core(scene: Scene, slope_deg: float) -> Iterator[Piece]:
    """Yield the core, a ball as large as the coils' attachments on it say."""
    hub, radius = np.array(scene["hub"], dtype=float), core_radius(scene)
    away = float(distance(hub, slope_deg)[0])
    yield Piece(away, silhouette(hub, radius, slope_deg), CORE, EDGE, 0.6)
    light = on_paper(hub, slope_deg) + radius * np.array([-0.3, 0.35])
    angles = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    spot = light + 0.3 * radius * np.column_stack([np.cos(angles), np.sin(angles)])
    yield Piece(away - IN_FRONT, spot, CORE_LIGHT, CLEAR, 0.0)


def core_radius(scene: Scene) -> float:
    """Return the radius of the core [mm]: where the coils begin on it, and never too small to be seen."""
    hub = np.array(scene["hub"], dtype=float)
    starts = [np.linalg.norm(np.array(coil["from"]) - hub) for coil in scene["coils"].values()]
    return max(float(min(starts)), 0.045 * body_width(scene))


def body_width(scene: Scene) -> float:
    """Return the greatest extent of the body along an axis [mm]."""
    return float(np.ptp(np.asarray(scene["nodes"], dtype=float), axis=0).max())


def along(start: Points, end: Points) -> Points:
    """Return the unit direction from start to end."""
    direction: Points = (end - start) / max(float(np.linalg.norm(end - start)), 1e-9)
    return direction


def shaded(depth: float) -> Colour:
    """Return the colour of a strip at this depth: -1 nearest, 1 farthest."""
    share = float(np.clip((depth + 1) / 2, 0, 1))
    red, green, blue = (1 - share) * NEAR + share * FAR
    return float(red), float(green), float(blue), 1.0


def _spring(start: Points, end: Points, slope_deg: float, colour: Colour, width: float) -> Iterator[Piece]:
    """Yield a zigzag of a fixed number of turns, edged with ink, in pieces that are painted by their own depth."""
    (p, q), (near, far) = on_paper([start, end], slope_deg), distance([start, end], slope_deg)
    across = np.array([-(q - p)[1], (q - p)[0]]) / max(float(np.hypot(*(q - p))), 1e-9) * width
    places = np.concatenate([[0.0], np.linspace(0.08, 0.94, 2 * TURNS + 1), [1.0]])
    sides = np.concatenate([[0.0, 0.0], np.tile([1.0, -1.0], TURNS - 1), [1.0, 0.0, 0.0]])
    zigzag = p + places[:, None] * (q - p) + sides[:, None] * across
    for corners in np.array_split(np.arange(len(places) - 1), PIECES):
        part = slice(corners[0], corners[-1] + 2)
        away = near + float(places[part].mean()) * (far - near)
        yield Piece(away, zigzag[part], CLEAR, EDGE, 1.5)
        yield Piece(away - IN_FRONT, zigzag[part], CLEAR, colour, 0.85)


def _thread(start: Points, end: Points, slope_deg: float, colour: Colour) -> Iterator[Piece]:
    """Yield a line in pieces that are painted by their own depth."""
    places = np.linspace(0, 1, THREADS + 1)[:, None]
    line = start + places * (end - start)
    paper, away = on_paper(line, slope_deg), distance(line, slope_deg)
    for i in range(len(line) - 1):
        yield Piece((away[i] + away[i + 1]) / 2, paper[i : i + 2], CLEAR, colour, 0.8)


def _closed(points: Points) -> Path:
    return Path(np.vstack([points, points[:1]]), closed=True)
