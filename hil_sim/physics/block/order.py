"""An order of the nodes in which the stiffness stays close to its diagonal.

Three orders are tried and the one with the smallest profile is taken: by x and y, by y and x, which is best for long
rectangles, and reverse Cuthill-McKee from a node at the far end of the mesh (E. Cuthill and J. McKee 1969, A. George
1971; standard result), which is best for meshes of any shape. Nested dissection would not help: for meshes of 16,000
triangles twice as long as high it leaves a quarter of these entries, but scattered ones, and scipy's factor of that
kind takes longer to solve with (`skyline`).
"""

from itertools import pairwise

import numpy as np

from hil_sim.physics.block.mesh import Indices, Mesh
from hil_sim.physics.compiled import Array


def pairs_of(mesh: Mesh) -> tuple[Indices, Indices]:
    """Return the pairs (i, j) of nodes that share a triangle, i = j too, ascending by i and then j."""
    i, j = np.repeat(mesh.triangles, 3, axis=0), np.tile(mesh.triangles, (3, 1))
    keys = np.unique(i * mesh.nodes + j)
    return keys // mesh.nodes, keys % mesh.nodes


def order_of(points: Array, i: Indices, j: Indices) -> Indices:
    r"""Return the place of each node in the order of the smallest profile found.

    Parameters
    ----------
    points : array (N, 2)
        Nodes [m]
    i, j : array (pairs,)
        Pairs of `pairs_of` [1]

    Returns
    -------
    array (N,)
        A permutation [1]
    """
    x, y = points.T
    tried = (np.lexsort((y, x)), np.lexsort((x, y)), cuthill_mckee(i, j))
    places = [np.argsort(each) for each in tried]
    return min(places, key=lambda place: profile(place, i, j))


def profile(place: Indices, i: Indices, j: Indices) -> int:
    """Return how many pairs of nodes lie between the first that each node meets and itself."""
    lowest = place.copy()
    np.minimum.at(lowest, i, place[j])
    return int((place - lowest + 1).sum())


def cuthill_mckee(i: Indices, j: Indices) -> Indices:
    """Return the nodes in reverse Cuthill-McKee order, piece by piece, each from a node at its far end."""
    start = np.searchsorted(i, np.arange(i[-1] + 2))
    degree = np.diff(start)
    near = [sorted(j[a:b].tolist(), key=degree.__getitem__) for a, b in pairwise(start)]
    seen, order = np.zeros(degree.size, bool), []
    for seed in np.argsort(degree, kind="stable").tolist():
        if not seen[seed]:
            piece = _spread(near, _spread(near, _spread(near, seed)[-1])[-1])
            seen[piece] = True
            order += piece
    return np.array(order[::-1])


def _spread(near: list[list[int]], seed: int) -> list[int]:
    """Return the nodes of a piece in the order in which they are reached, neighbours of low degree first."""
    reached, known = [seed], {seed}
    for node in reached:
        fresh = [other for other in near[node] if other not in known]
        reached += fresh
        known.update(fresh)
    return reached
