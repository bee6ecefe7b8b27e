"""Draws a block as its mesh was deformed, the shape that presses on it, and the scales, in mm and to scale.

Displacements are drawn as large as they are. A mesh is one line that passes each edge once, so that a picture of
thousands of triangles stays small.
"""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import PathPatch, Polygon
from matplotlib.path import Path
from numpy.typing import ArrayLike, NDArray

from host.fields import Mesh, Slice
from host.recording import Recording
from host.view.film import Box
from host.view.pressing import at_slice, nearest
from host.view.style import GROUND, INK, Style

Points = NDArray[np.float64]
Edges = NDArray[np.int64]
FLESH, TOOL = "#f3e9d8", "#c3cad3"  # the block, and what presses on it
EDGE_MM, HEAD_MM, BELOW_MM = 2.0, 13.0, 3.0  # around the block; above it for what presses
RULER_MM = 20.0
ALIKE_MM = 1e-3


def deformed(mesh: Mesh, each: Slice) -> Points:
    """Return where the nodes are, in mm."""
    there: Points = np.asarray(mesh.points_mm, dtype=float) + np.asarray(each.displacement_mm, dtype=float)
    return there


def dent_mm(each: Slice) -> float:
    """Return how far the block is pressed in where it is most."""
    return max(0.0, -float(each.displacement_mm[:, 1].min()))


def edges_of(mesh: Mesh) -> tuple[Edges, Edges]:
    """Return all edges of a mesh, and those on its rim, each as two nodes."""
    corners = np.asarray(mesh.triangles, dtype=np.int64)
    sides = np.sort(np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), axis=1)
    edges, count = np.unique(sides, axis=0, return_counts=True)
    return edges, edges[count == 1]


def trails(edges: Edges) -> list[list[int]]:
    """Return walks along the edges that pass each of them once; of a rim its loops."""
    ways: dict[int, list[int]] = {}
    for a, b in edges.tolist():
        ways.setdefault(a, []).append(b)
        ways.setdefault(b, []).append(a)
    odd = [node for node, others in ways.items() if len(others) % 2]
    walks = []
    for start in [*odd, *ways]:
        while ways[start]:
            walk = [start]
            while ways[walk[-1]]:
                here = walk[-1]
                walk.append(ways[here].pop())
                ways[walk[-1]].remove(here)
            walks.append(walk)
    return walks


def block_box(recording: Recording, slices: list[Slice]) -> Box:
    """Return the room that the block needs at these instants, with what presses on it."""
    assert recording.mesh is not None
    points = np.vstack([recording.mesh.points_mm, *(deformed(recording.mesh, each) for each in slices)])
    (left, bottom), (right, top) = points.min(axis=0), points.max(axis=0)
    return float(left) - EDGE_MM, float(right) + EDGE_MM, float(bottom) - BELOW_MM, float(top) + HEAD_MM


def draw_mesh(axes: Axes, mesh: Mesh, each: Slice) -> None:
    """Draw the deformed mesh, and dashed where the surface was before."""
    points, (edges, rim) = deformed(mesh, each), edges_of(mesh)
    axes.add_patch(PathPatch(path_of(points, trails(rim)), fc=FLESH, ec=INK, lw=0.6, zorder=2))
    axes.add_patch(PathPatch(path_of(points, trails(edges)), fc="none", ec=GROUND, lw=0.18, zorder=3))


def draw_before(axes: Axes, mesh: Mesh) -> None:
    """Draw dashed where the rim of the block was before anything pressed on it."""
    rim = path_of(np.asarray(mesh.points_mm, dtype=float), trails(edges_of(mesh)[1]))
    axes.add_patch(PathPatch(rim, fc="none", ec=INK, lw=0.5, ls=(0, (4, 2)), zorder=4))


def draw_tool(axes: Axes, recording: Recording, each: Slice) -> None:
    """Draw what presses on the block, where it was at that instant."""
    scene = recording.scenes[nearest(recording.scenes, each.host_ms)]
    lower = at_slice(recording, each, "depth_mm") - scene["depth_mm"]
    fill_tool(axes, np.array(scene["indenter"]["outline_mm"], dtype=float) - [0.0, lower])


def fill_tool(axes: Axes, outline_mm: ArrayLike) -> None:
    """Fill the outline of what presses on the block."""
    axes.add_patch(Polygon(np.asarray(outline_mm), fc=TOOL, ec=INK, lw=0.6, zorder=5))


def draw_ruler(axes: Axes, box: Box) -> None:
    """Draw the scale of lengths into the upper left corner."""
    x, y = box[0] + EDGE_MM, box[3] - 4.0
    axes.plot([x, x + RULER_MM], [y, y], color=GROUND, lw=1.4, solid_capstyle="butt")
    axes.text(x + RULER_MM / 2, y - 1.2, f"{RULER_MM:g} mm", ha="center", va="top", fontsize=6.5, color=GROUND)


def lowest(mesh: Mesh, each: Slice) -> int:
    """Return the node that is pressed in most; of several alike, below a flat punch, the one in their middle."""
    down = -each.displacement_mm[:, 1]
    alike = np.flatnonzero(down >= down.max() - ALIKE_MM)
    return int(alike[np.argsort(mesh.points_mm[alike, 0], kind="stable")][len(alike) // 2])


def draw_dent(axes: Axes, mesh: Mesh, each: Slice) -> None:
    """Draw how deep the block is pressed in where it is most, from the surface as it was."""
    deepest = lowest(mesh, each)
    x, before = np.asarray(mesh.points_mm, dtype=float)[deepest]
    low = float(deformed(mesh, each)[deepest, 1])
    for y in (before, low):
        axes.plot([x - 3.0, x + 3.0], [y, y], color=INK, lw=0.6, zorder=6)
    axes.annotate("", (x, low), (x, before + 4.0), arrowprops={"arrowstyle": "-|>", "lw": 0.6, "color": INK}, zorder=6)
    style: Style = {"ha": "center", "va": "top", "fontsize": 7, "color": INK, "zorder": 6}
    axes.text(x, low - 2.5, f"{dent_mm(each):.2f} mm", bbox={"fc": "white", "ec": "none", "pad": 1.2}, **style)


def path_of(points: Points, walks: list[list[int]]) -> Path:
    """Return walks from node to node as one path."""
    places = np.concatenate([points[walk] for walk in walks])
    codes = np.full(len(places), Path.LINETO, dtype=Path.code_type)
    codes[np.cumsum([0, *(len(walk) for walk in walks[:-1])])] = Path.MOVETO
    return Path(places, codes)


def height_of(box: Box, wide_mm: float) -> float:
    """Return how high a panel is that shows a box on so much width."""
    return wide_mm * (box[3] - box[2]) / (box[1] - box[0])
