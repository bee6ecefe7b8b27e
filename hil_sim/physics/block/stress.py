r"""What is read off the stress of a block: von Mises stress, values at nodes, means over cells.

    von_mises(state.stress)                                        # (T,) for a picture
    cells = Cells(mesh, [(0.040, 0.030), (0.020, 0.030)], 0.005)   # the force sensors inside
    pressure = -cells.mean(state.stress[1])

The stress of a triangle is constant. A cell is a square fixed in the undeformed block, and its mean is that over the
area, each triangle with the part of it inside the square: such means converge where the greatest stress, at a corner,
does not. A cell that reaches out of the block is refused.

.. math::  \sigma_v^2 = \tfrac12 \{ (\sigma_x - \sigma_y)^2 + (\sigma_y - \sigma_z)^2 + (\sigma_z - \sigma_x)^2 \}
                        + 3 \tau_{xy}^2                                                                            (B9)

Source: standard result. Checked in tests/test_physics_block_stress.py.
"""

from collections.abc import Sequence

import numpy as np

from hil_sim.physics.block.material import BlockError
from hil_sim.physics.block.mesh import Indices, Mesh
from hil_sim.physics.compiled import Array

COVERED = 1e-9  # share of a cell's area that may be missing, by rounding [1]


def von_mises(stress: Array) -> Array:
    r"""Return the von Mises stress, equation (B9).

    Parameters
    ----------
    stress : array (4, ...)
        x, y, z, xy [Pa]

    Returns
    -------
    array (...)
        Never negative [Pa]
    """
    x, y, z, xy = stress
    root: Array = np.sqrt(0.5 * ((x - y) ** 2 + (y - z) ** 2 + (z - x) ** 2) + 3.0 * xy**2)
    return root


def at_nodes(mesh: Mesh, values: Array) -> Array:
    r"""Return values at the nodes: means over the triangles around each, by area.

    Parameters
    ----------
    mesh : Mesh
        Mesh [SI]
    values : array (T,)
        One a triangle [any]

    Returns
    -------
    array (N,)
        One a node [any]
    """
    nodes = mesh.triangles.ravel()
    total = np.bincount(nodes, np.tile(mesh.area * values, 3), mesh.nodes)
    mean: Array = total / np.bincount(nodes, np.tile(mesh.area, 3), mesh.nodes)
    return mean


class Cells:
    """Square cells inside a block, over which stress is averaged as force sensors do."""

    def __init__(self, mesh: Mesh, centres: Sequence[tuple[float, float]], side: float) -> None:
        """Find the part of each triangle inside each cell; raise BlockError for a cell not all inside the block.

        Parameters
        ----------
        mesh : Mesh
            Mesh [SI]
        centres : sequence of (float, float)
            Middles of the cells [m]
        side : float
            Length of their sides [m]
        """
        if not 0.0 < side < np.inf:
            raise BlockError(f"side = {side:g} m of a cell, must be above 0 m and finite")
        self.parts = [_part(mesh, np.array(centre, float), side) for centre in centres]

    def mean(self, values: Array) -> Array:
        r"""Return the means over the cells.

        Parameters
        ----------
        values : array (T,)
            One a triangle, such as a row of the stress [any]

        Returns
        -------
        array (cells,)
            One a cell [any]
        """
        return np.array([share @ values[triangles] for triangles, share in self.parts])


def _part(mesh: Mesh, centre: Array, side: float) -> tuple[Indices, Array]:
    """Return the triangles that share area with a cell, and their shares of it."""
    corners = mesh.points[mesh.triangles] - centre  # (3, T, 2)
    half = 0.5 * side
    near = np.flatnonzero(((corners.min(axis=0) < half) & (corners.max(axis=0) > -half)).all(axis=1))
    share = np.array([_area(_clipped(corners[:, t], half)) for t in near]) / side**2
    if not abs(share.sum() - 1.0) < COVERED:
        x, y = centre
        raise BlockError(f"the cell of {side:g} m at ({x:g}, {y:g}) m is inside the block to {share.sum():.3%} only")
    return near, share


def _clipped(polygon: Array, half: float) -> Array:
    """Return what of a convex polygon (n, 2) is inside the square |x|, |y| <= half (Sutherland and Hodgman 1974)."""
    for axis in (0, 1):
        for sign in (1.0, -1.0):
            inside = half - sign * polygon[:, axis]
            kept = []
            for k in range(len(polygon)):
                before, here = inside[k - 1], inside[k]
                if (before < 0.0) != (here < 0.0):
                    kept.append(polygon[k - 1] + before / (before - here) * (polygon[k] - polygon[k - 1]))
                if here >= 0.0:
                    kept.append(polygon[k])
            if not kept:
                return np.zeros((0, 2))
            polygon = np.array(kept)
    return polygon


def _area(polygon: Array) -> float:
    """Return the area of a polygon (n, 2)."""
    x, y = polygon.T
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))
