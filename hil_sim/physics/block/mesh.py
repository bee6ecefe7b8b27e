"""Meshes of linear triangles: a structured rectangle, or any conforming mesh given as arrays.

    mesh = rectangle(0.080, 0.040, 64, 32)
    mesh = mesh_of(points, triangles)            # counterclockwise, checked
    bottom = mesh.where(mesh.points[:, 1] == 0.0)

`mesh_of` refuses by number what would give wrong results silently: a triangle without area or running clockwise, a
node that no triangle uses or that coincides with another, an edge with more than two triangles or with two on the
same side, and a node that hangs on somebody's edge. Pieces that do not touch are accepted: each needs supports.
"""

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hil_sim.physics.block.material import BlockError
from hil_sim.physics.compiled import Array

Indices = NDArray[np.int64]
FLAT = 1e-10  # area over the square of the longest edge below which a triangle is none [1]
NEAR = 1e-9  # distance over the size of the mesh within which nodes coincide [1]


class Mesh(NamedTuple):
    """Nodes and triangles with what follows from them; a (3, T) array has one row for each corner."""

    points: Array  # (N, 2) nodes [m]
    triangles: Indices  # (3, T) nodes of each triangle, counterclockwise
    area: Array  # (T,) [m^2]
    slope: Array  # (2, 3, T) derivatives of the shape functions by x and y [1/m]
    edges: Indices  # (boundary edges, 2) with the material on the left

    @property
    def nodes(self) -> int:
        """Number of nodes."""
        return len(self.points)

    @property
    def boundary(self) -> Indices:
        """Nodes on the boundary, ascending."""
        return np.unique(self.edges)

    @staticmethod
    def where(chosen: Any) -> Indices:
        """Return the nodes for which a condition, one truth value a node, holds."""
        return np.flatnonzero(chosen)


def rectangle(width: float, height: float, columns: int, rows: int, lines: Iterable[float] = ()) -> Mesh:
    r"""Return a rectangle from (0, 0) on, cut into cells of two triangles each with alternating diagonals.

    The diagonals of cells that share a side meet on it: the first cell's, at (0, 0), rises, its neighbours' fall.

    Parameters
    ----------
    width : float
        Extent along x [m]
    height : float
        Extent along y [m]
    columns : int
        Cells along x [1]
    rows : int
        Cells along y [1]
    lines : iterable of float, optional
        Where lines of nodes are to be; the nearest go there, the others divide what is between evenly [m]

    Returns
    -------
    Mesh
        With (columns + 1) (rows + 1) nodes, counted upwards column by column [SI]

    Raises
    ------
    BlockError
        An extent that is not positive [m], less than one cell, or lines nearer to each other than a cell
    """
    for name, extent in (("width", width), ("height", height)):
        if not 0.0 < extent < np.inf:
            raise BlockError(f"{name} = {extent:g} m, must be above 0 m and finite")
    for name, count in (("columns", columns), ("rows", rows)):
        if count < 1:
            raise BlockError(f"{name} = {count}, at least 1")
    x, y = _across(width, columns, sorted(set(lines))), np.linspace(0.0, height, rows + 1)
    points = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    i, j = (each.ravel() for each in np.meshgrid(np.arange(columns), np.arange(rows), indexing="ij"))
    a = i * (rows + 1) + j
    b, c, d = a + rows + 1, a + rows + 2, a + 1
    rising = (i + j) % 2 == 0
    first = np.where(rising, [a, b, c], [a, b, d])
    second = np.where(rising, [a, c, d], [b, c, d])
    return mesh_of(points, np.stack([first, second], axis=-1).reshape(3, -1).T)


def _across(width: float, columns: int, lines: list[float]) -> Array:
    """Return the places (columns + 1,) of the lines of nodes [m], or raise BlockError where those wanted clash."""
    even = np.linspace(0.0, width, columns + 1)
    wanted = np.array([line for line in lines if NEAR * width < line < (1.0 - NEAR) * width])
    number = np.clip(np.rint(wanted / width * columns), 1, columns - 1).astype(np.int64)
    for wrong in np.flatnonzero(np.diff(number) <= 0)[:1]:
        raise BlockError(f"columns = {columns}, too few to part x = {wanted[wrong]:g} and {wanted[wrong + 1]:g} m")
    if np.abs(even[number] - wanted).max(initial=0.0) <= NEAR * width:
        return even
    x: Array = np.interp(np.arange(columns + 1), [0, *number, columns], [0.0, *wanted, width])
    return x


def mesh_of(points: Any, triangles: Any) -> Mesh:
    r"""Return the mesh of these nodes and triangles.

    Parameters
    ----------
    points : array_like (N, 2)
        Nodes [m]
    triangles : array_like (T, 3)
        Numbers of each triangle's nodes, counterclockwise [1]

    Returns
    -------
    Mesh
        Checked [SI]

    Raises
    ------
    BlockError
        What the module's docstring lists, with the number of the first node, edge or triangle at fault
    """
    points, corners = _arrays(points, triangles)
    area, slope = _gradients(points, corners.T)
    _check_triangles(points, corners, area)
    _check_nodes(points, corners)
    edges = _check_edges(corners)
    _check_hanging(points, edges)
    return Mesh(points, np.ascontiguousarray(corners.T), area, slope, edges)


def counterclockwise(points: Any, triangles: Any) -> Indices:
    """Return the triangles, (T, 3), with two nodes exchanged in those that run clockwise."""
    points, corners = _arrays(points, triangles)
    area, _ = _gradients(points, corners.T)
    return np.where(area[:, None] < 0.0, corners[:, ::-1], corners)


def _arrays(points: Any, triangles: Any) -> tuple[Array, Indices]:
    """Return both as arrays, or raise BlockError where they have not the shape or the numbers of a mesh."""
    points, given = np.array(points, float), np.asarray(triangles)
    if points.ndim != 2 or points.shape[1] != 2:
        raise BlockError(f"points have the shape {points.shape}, must be (N, 2)")
    if given.ndim != 2 or given.shape[1] != 3 or not len(given) or not np.issubdtype(given.dtype, np.integer):
        raise BlockError(f"triangles are {given.dtype} of the shape {given.shape}, must be integers (T, 3), T > 0")
    corners = given.astype(np.int64)
    for wrong in np.flatnonzero(~np.isfinite(points).all(axis=1))[:1]:
        raise BlockError(f"node {wrong} is at {tuple(points[wrong].tolist())} m, must be finite")
    for wrong in np.flatnonzero(((corners < 0) | (corners >= len(points))).any(axis=1))[:1]:
        raise BlockError(f"triangle {wrong} has nodes {corners[wrong].tolist()}, must be 0 to {len(points) - 1}")
    return points, corners


def _gradients(points: Array, triangles: Indices) -> tuple[Array, Array]:
    """Return signed areas (T,) and derivatives of the shape functions (2, 3, T), 0 where there is no area."""
    x, y = points[triangles, 0], points[triangles, 1]
    opposite = np.roll(np.array([x, y]), -2, axis=1) - np.roll(np.array([x, y]), -1, axis=1)
    area = 0.5 * (opposite[0, 0] * opposite[1, 1] - opposite[1, 0] * opposite[0, 1])
    double = np.where(area == 0.0, np.inf, 2.0 * area)
    return area, np.array([-opposite[1], opposite[0]]) / double


def _check_triangles(points: Array, corners: Indices, area: Array) -> None:
    """Raise BlockError for the first triangle without area or running clockwise."""
    sides = points[corners] - points[np.roll(corners, 1, axis=1)]
    longest = (sides**2).sum(axis=2).max(axis=1)
    for wrong in np.flatnonzero(np.abs(area) <= FLAT * longest)[:1]:
        raise BlockError(f"triangle {wrong} (nodes {corners[wrong].tolist()}) has no area: {area[wrong]:g} m^2")
    for wrong in np.flatnonzero(area < 0.0)[:1]:
        raise BlockError(f"triangle {wrong} (nodes {corners[wrong].tolist()}) runs clockwise, must be counterclockwise")


def _check_nodes(points: Array, corners: Indices) -> None:
    """Raise BlockError for the first node that no triangle uses or that coincides with another."""
    used = np.bincount(corners.ravel(), minlength=len(points))
    for wrong in np.flatnonzero(used == 0)[:1]:
        raise BlockError(f"node {wrong} belongs to no triangle")
    size = np.ptp(points, axis=0).max()
    for shift in (0.0, 0.5):  # neighbours that one rounding parts are together in the other
        grid = np.floor((points - points.min(axis=0)) / (NEAR * size) + shift)
        order = np.lexsort((np.arange(len(points)), grid[:, 1], grid[:, 0]))
        for same in np.flatnonzero((np.diff(grid[order], axis=0) == 0.0).all(axis=1))[:1]:
            raise BlockError(f"nodes {order[same]} and {order[same + 1]} coincide: the mesh is torn there")


def _check_edges(corners: Indices) -> Indices:
    """Return the boundary edges, material on the left; raise BlockError for an edge that parts no two sides."""
    directed = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    low, high = directed.min(axis=1), directed.max(axis=1)
    _, first, inverse, count = np.unique(
        low * (corners.max() + 1) + high, return_index=True, return_inverse=True, return_counts=True
    )
    for wrong in np.flatnonzero(count > 2)[:1]:
        raise BlockError(f"edge {_edge(directed, first[wrong])} has {count[wrong]} triangles, at most 2")
    rising = np.bincount(inverse, weights=directed[:, 0] == low)
    for wrong in np.flatnonzero((count == 2) & (rising != 1))[:1]:
        raise BlockError(f"edge {_edge(directed, first[wrong])} has two triangles on the same side")
    edges: Indices = directed[first[count == 1]]
    return edges


def _edge(directed: Indices, which: int) -> list[int]:
    """Return the nodes of an edge, ascending."""
    return sorted(directed[which].tolist())


def _check_hanging(points: Array, edges: Indices) -> None:
    """Raise BlockError for the first boundary node that lies within a boundary edge of others."""
    nodes = np.unique(edges)
    for a, b in edges:
        along, off = points[b] - points[a], points[nodes] - points[a]
        length = float(along @ along)
        share, aside = off @ along / length, off @ np.array([-along[1], along[0]]) / length
        for wrong in np.flatnonzero((np.abs(aside) < NEAR) & (share > NEAR) & (share < 1.0 - NEAR))[:1]:
            raise BlockError(f"node {nodes[wrong]} hangs on the edge [{a}, {b}]: the mesh does not conform there")
