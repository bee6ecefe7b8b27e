r"""Convex corners of the ground against the edges of the rim: the nodes alone would let a step slip in between them.

A corner that is inside the rim lies at the depth d behind the nearest edge, at the part s of it. The law of the nodes
(C1) holds along the edge's normal and its direction, with the way along the surface taken on the rim,

.. math::  u_t = \sigma_a - \sigma, \qquad \sigma = (i + s) \, l_0                                            (K1)

where the anchor sigma_a is the place on the rim that touched first, or to which it has slipped; what is pushed is
shared out to the two nodes of the edge. Derived here; checked in tests/test_physics_ring_terrain.py.
"""

import numpy as np

from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.contact import DEPTH_RAMP, PUSH_X, PUSH_Y, half_turn
from hil_sim.physics.ring import AXX, AXY, AYX, AYY, DXX, DXY, DYY, Ring
from hil_sim.physics.terrain import TINY, Terrain, under

# Rows of the array `corners`, one column per vertex of the ground.
ANCHOR, TOUCH, NORMAL, FRICTION, SLIP, DEPTH, WAY, EDGE, SHARE, UX, UY = range(11)
CORNER_ROWS = 11


@lean
def corner_forces(ring: Ring, q0: Array, q: Array, v: Array, corners: Array, ground: Array, f: Array) -> None:
    """Add the pushes of the corners to f for a step that began at q0, and note them in corners and ground [N]."""
    first, last, lowest = window(ring, q)
    for c in range(first, last):
        corners[DEPTH, c] = 0.0
        corners[NORMAL, c] = 0.0
        if ring.terrain.z[c] > lowest and convex(ring.terrain, c) and inside(ring, q, c):
            find_edge(ring, q, c, corners)
            push(ring, q0, q, v, c, corners, ground, f)


@lean
def push(ring: Ring, q0: Array, q: Array, v: Array, c: int, corners: Array, ground: Array, f: Array) -> None:
    """Add what one corner does to the edge that `find_edge` found to f [N]."""
    s, ux, uy = corners[SHARE, c], corners[UX, c], corners[UY, c]
    i = int(corners[EDGE, c])
    j = i + 1 if i + 1 < ring.nodes else 0
    vx, vy = (1.0 - s) * v[2 * i] + s * v[2 * j], (1.0 - s) * v[2 * i + 1] + s * v[2 * j + 1]
    damping = ring.c_n * min(1.0, corners[DEPTH, c] / DEPTH_RAMP)
    normal = max(0.0, ring.k_n * corners[DEPTH, c] - damping * (ux * vx + uy * vy))
    if corners[TOUCH, c] > 0.0:
        around = ring.nodes * ring.l0
        way = corners[ANCHOR, c] - (i + s) * ring.l0
        way -= around * np.round(way / around)
    else:
        dx = (1.0 - s) * (q[2 * i] - q0[2 * i]) + s * (q[2 * j] - q0[2 * j])
        dy = (1.0 - s) * (q[2 * i + 1] - q0[2 * i + 1]) + s * (q[2 * j + 1] - q0[2 * j + 1])
        way = uy * dx - ux * dy
    friction = -ring.k_n * way - damping * (uy * vx - ux * vy)
    bound = ring.mu * normal
    corners[SLIP, c] = 1.0 if abs(friction) > bound else 0.0
    friction = min(bound, max(-bound, friction))
    corners[NORMAL, c] = normal
    corners[FRICTION, c] = friction
    corners[WAY, c] = way
    px, py = normal * ux + friction * uy, normal * uy - friction * ux
    for node, share in ((i, 1.0 - s), (j, s)):
        f[2 * node] -= share * px
        f[2 * node + 1] -= share * py
        ground[PUSH_X, node] += share * px
        ground[PUSH_Y, node] += share * py


@lean
def corner_tangent(ring: Ring, q: Array, corners: Array, cv: float, blocks: Array) -> None:
    """Add the stiffness of what `corner_forces` noted, at a fixed place on the edge, to blocks [N/m]."""
    first, last, _ = window(ring, q)
    for c in range(first, last):
        if corners[NORMAL, c] == 0.0:
            continue
        s, ux, uy = corners[SHARE, c], corners[UX, c], corners[UY, c]
        i = int(corners[EDGE, c])
        j = i + 1 if i + 1 < ring.nodes else 0
        across = ring.k_n + ring.c_n * min(1.0, corners[DEPTH, c] / DEPTH_RAMP) * cv
        along = across * (1.0 - corners[SLIP, c])
        kxx = across * ux * ux + along * uy * uy
        kxy = (across - along) * ux * uy
        kyy = across * uy * uy + along * ux * ux
        for node, share in ((i, (1.0 - s) * (1.0 - s)), (j, s * s)):
            blocks[DXX, node] += share * kxx
            blocks[DXY, node] += share * kxy
            blocks[DYY, node] += share * kyy
        both = s * (1.0 - s)
        blocks[AXX, i] += both * kxx
        blocks[AXY, i] += both * kxy
        blocks[AYX, i] += both * kxy
        blocks[AYY, i] += both * kyy


@lean
def settle_corners(ring: Ring, q: Array, corners: Array) -> None:
    """Commit the corners of an accepted step that ended at q, as `contact.settle_anchors` does for nodes."""
    first, last, _ = window(ring, q)
    for c in range(corners.shape[1]):
        if c < first or c >= last or corners[DEPTH, c] == 0.0:
            corners[TOUCH, c] = 0.0
            continue
        place = (corners[EDGE, c] + corners[SHARE, c]) * ring.l0
        if corners[SLIP, c] > 0.0:
            corners[ANCHOR, c] = place - corners[FRICTION, c] / ring.k_n
        elif corners[TOUCH, c] == 0.0:
            corners[ANCHOR, c] = place + corners[WAY, c]
        corners[TOUCH, c] = 1.0


@lean
def window(ring: Ring, q: Array) -> tuple[int, int, float]:
    """Return the first vertex of the ground below the rim, the one after the last, and the rim's least height [m]."""
    low = high = q[0]
    lowest = q[1]
    for i in range(1, ring.nodes):
        low, high = min(low, q[2 * i]), max(high, q[2 * i])
        lowest = min(lowest, q[2 * i + 1])
    return under(ring.terrain, low) + 1, under(ring.terrain, high) + 1, lowest


@lean
def convex(terrain: Terrain, c: int) -> bool:
    """Return whether the ground sticks out at a vertex."""
    if c < 1 or c + 1 >= terrain.x.size:
        return False
    ax, az = terrain.x[c] - terrain.x[c - 1], terrain.z[c] - terrain.z[c - 1]
    bx, bz = terrain.x[c + 1] - terrain.x[c], terrain.z[c + 1] - terrain.z[c]
    return bool(ax * bz - az * bx < 0.0)


@lean
def inside(ring: Ring, q: Array, c: int) -> bool:
    """Return whether a vertex of the ground is inside the rim."""
    n, winding = ring.nodes, 0
    for i in range(n):
        winding += half_turn(q, 2 * i, 2 * ((i + 1) % n), ring.terrain.x[c], ring.terrain.z[c])
    return winding != 0


@lean
def find_edge(ring: Ring, q: Array, c: int, corners: Array) -> None:
    """Write the edge nearest to a corner inside the rim, the place on it, the depth and the way out to corners."""
    n, x, y = ring.nodes, ring.terrain.x[c], ring.terrain.z[c]
    corners[DEPTH, c] = np.inf
    for i in range(n):
        j = i + 1 if i + 1 < n else 0
        ex, ey = q[2 * j] - q[2 * i], q[2 * j + 1] - q[2 * i + 1]
        px, py = x - q[2 * i], y - q[2 * i + 1]
        square = ex * ex + ey * ey
        s = min(1.0, max(0.0, (px * ex + py * ey) / square))
        dx, dy = px - s * ex, py - s * ey
        d = np.sqrt(dx * dx + dy * dy)
        if d < corners[DEPTH, c]:
            length = np.sqrt(square)
            corners[DEPTH, c] = d
            corners[EDGE, c] = i
            corners[SHARE, c] = s
            corners[UX, c] = dx / d if d > TINY else -ey / length
            corners[UY, c] = dy / d if d > TINY else ex / length
