r"""The rim against itself: a node that comes nearer than the thickness of the rim to a far edge is pushed off.

.. math::  F = k_n \max(0, w - d)                                                                                 (W1)

with the distance d of the node from the edge and the thickness w. Near pairs are listed once a step, and most steps
have none. Their stiffness would reach across the band of the equations, so Newton's method gets a bound of it on the
diagonal: slower there, and never wrong. A step in which anything moves by more than a part of w is not taken while
there are pairs, so nothing jumps over. ASSUMED: w = 1 mm, no friction. Checked in tests/test_physics_ring_ground.py.
"""

import numpy as np
from numpy.typing import NDArray

from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.contact import between
from hil_sim.physics.ring import DXX, DXY, DYY, Ring

THICKNESS = 1e-3  # [m] ASSUMED: of a rubber rim of 1.6 g that is 10 mm wide it would be 1.2 mm
LEAP = 0.3 * THICKNESS  # [m] the longest way of a node in a step
REACH = THICKNESS + 2.0 * LEAP  # [m]
APART = 4  # nodes along the rim from which on two places may touch
PAIRS_MAX = 64

Pairs = NDArray[np.int64]


def no_pairs() -> Pairs:
    """Return room for the pairs of a node and an edge that are near each other; the count stands in the first row."""
    return np.zeros((PAIRS_MAX + 1, 2), dtype=np.int64)


@lean
def list_pairs(ring: Ring, q: Array, pairs: Pairs) -> None:
    """Fill pairs with the nodes and far edges that may touch within a step."""
    n, count = ring.nodes, 0
    pairs[0, 0] = 0
    if nearest_nodes(q, n) > REACH * REACH + 0.25 * ring.l0 * ring.l0:
        return
    for i in range(n):
        for step in range(APART - 1, n - APART + 1):
            k = (i + step) % n
            distance, _, _, _ = between(q, n, i, k)
            if distance < REACH and count < PAIRS_MAX:
                count += 1
                pairs[count, 0] = i
                pairs[count, 1] = k
    pairs[0, 0] = count


@lean
def nearest_nodes(q: Array, n: int) -> float:
    """Return the square of the least distance of two nodes that are far from each other along the rim [m2]."""
    least = np.inf
    for step in range(APART, n // 2 + 1):
        for i in range(n - step):
            dx, dy = q[2 * (i + step)] - q[2 * i], q[2 * (i + step) + 1] - q[2 * i + 1]
            least = min(least, dx * dx + dy * dy)
        for i in range(step):
            dx, dy = q[2 * (i + n - step)] - q[2 * i], q[2 * (i + n - step) + 1] - q[2 * i + 1]
            least = min(least, dx * dx + dy * dy)
    return least


@lean
def touch_forces(ring: Ring, q: Array, pairs: Pairs, f: Array) -> None:
    """Add the pushes (W1) of all pairs to f [N]."""
    for p in range(1, pairs[0, 0] + 1):
        i, k = pairs[p, 0], pairs[p, 1]
        distance, ux, uy, s = between(q, ring.nodes, i, k)
        push = ring.k_n * max(0.0, THICKNESS - distance)
        j = k + 1 if k + 1 < ring.nodes else 0
        for node, share in ((i, -1.0), (k, 1.0 - s), (j, s)):
            f[2 * node] += share * push * ux
            f[2 * node + 1] += share * push * uy


@lean
def touch_tangent(ring: Ring, q: Array, pairs: Pairs, blocks: Array) -> None:
    """Add a diagonal bound of the stiffness of all pairs to blocks [N/m]."""
    for p in range(1, pairs[0, 0] + 1):
        i, k = pairs[p, 0], pairs[p, 1]
        distance, ux, uy, s = between(q, ring.nodes, i, k)
        if distance < THICKNESS:
            j = k + 1 if k + 1 < ring.nodes else 0
            for node, share in ((i, 1.0), (k, 1.0 - s), (j, s)):
                stiffness = 2.0 * ring.k_n * share
                blocks[DXX, node] += stiffness * ux * ux
                blocks[DXY, node] += stiffness * ux * uy
                blocks[DYY, node] += stiffness * uy * uy


@lean
def leaps(q0: Array, q1: Array, pairs: Pairs) -> bool:
    """Return whether a node moved too far in a step that has pairs."""
    if pairs[0, 0] == 0:
        return False
    farthest = 0.0
    for i in range(q0.size - 3):
        farthest = max(farthest, abs(q1[i] - q0[i]))
    return farthest > LEAP
