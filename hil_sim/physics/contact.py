r"""One-sided contact: rim nodes on the ground with Coulomb friction, and the hub against the inside of the rim.

.. math::
    n = \max(0, k_n d - c(d) \dot d_n), \quad d > 0, \qquad
    t = -k_n u_t - c(d) \dot u_t, \quad |t| \le \mu n                                                    (C1)

d is the depth of a node in the ground, along the shortest way out (`terrain`); on a plane d = -y. Its way u_t along
the surface counts from an anchor, which is set where a node touches down and moves only while the node slips, so that
|t| = mu n (return mapping): what stands, stands, and does not creep as velocity-regularised friction does. The
damping grows with the depth over the first 10 um, so that forces are continuous. The hub is a disc; it is pushed off
every edge that comes nearer than its radius.

Source: return mapping is the standard treatment of elastic-plastic friction. A stiffer k_n changes where a jump goes
by about 3 %, and a crawl hardly: tests/test_physics_ring_crawl.py. Corners of the ground between two nodes are in
`corners`, the rim against itself is in `touch`; `crossings` is the guard of both.
"""

import numpy as np

from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.ring import DXX, DXY, DYY, Ring
from hil_sim.physics.spokes import couple
from hil_sim.physics.terrain import depth

# Rows of the array `ground`, one column per node: the anchor, the state of the contact and its normal, and what the
# ground as a whole pushes on the node, now and before the step.
ANCHOR_X, ANCHOR_Y, TOUCH, SLIP, NORMAL, FRICTION, DEPTH, NX, NY, PUSH_X, PUSH_Y, PUSH_X_BEFORE, PUSH_Y_BEFORE = range(
    13
)
GROUND_ROWS = 13
DEPTH_RAMP = 1e-5  # [m] ASSUMED: numerical, a quarter of what a standing ring sinks in


@lean
def ground_forces(ring: Ring, q0: Array, q: Array, v: Array, ground: Array, f: Array) -> None:
    """Add the pushes (C1) to f for a step that began at q0, and note them in ground [N]."""
    terrain, plane = ring.terrain, ring.terrain.x.size == 0
    for i in range(ring.nodes):
        deep, nx, ny = -q[2 * i + 1], 0.0, 1.0
        if not plane:
            deep, nx, ny = depth(terrain, q[2 * i], q[2 * i + 1])
        ground[DEPTH, i] = deep
        ground[NORMAL, i] = ground[PUSH_X, i] = ground[PUSH_Y, i] = 0.0
        if deep > 0.0:
            press(ring, q0, q, v, i, nx, ny, ground)
            f[2 * i] -= ground[PUSH_X, i]
            f[2 * i + 1] -= ground[PUSH_Y, i]


@lean
def press(ring: Ring, q0: Array, q: Array, v: Array, i: int, nx: float, ny: float, ground: Array) -> None:
    """Note in ground how the ground with that normal pushes on node i, which is in it [N]."""
    deep, held, slip = ground[DEPTH, i], ground[TOUCH, i] > 0.0, 0.0
    damping = ring.c_n * min(1.0, deep / DEPTH_RAMP)
    normal = max(0.0, ring.k_n * deep - damping * (nx * v[2 * i] + ny * v[2 * i + 1]))
    ux = q[2 * i] - (ground[ANCHOR_X, i] if held else q0[2 * i])
    uy = q[2 * i + 1] - (ground[ANCHOR_Y, i] if held else q0[2 * i + 1])
    friction = -ring.k_n * (ny * ux - nx * uy) - damping * (ny * v[2 * i] - nx * v[2 * i + 1])
    bound = ring.mu * normal
    if abs(friction) > bound:
        slip = 1.0
        friction = bound if friction > 0.0 else -bound
    ground[NX, i] = nx
    ground[NY, i] = ny
    ground[NORMAL, i] = normal
    ground[FRICTION, i] = friction
    ground[SLIP, i] = slip
    ground[PUSH_X, i] = normal * nx + friction * ny
    ground[PUSH_Y, i] = normal * ny - friction * nx


@lean
def ground_tangent(ring: Ring, v: Array, ground: Array, cv: float, blocks: Array) -> None:
    """Add the symmetric part of the derivative of `ground_forces`, from what that noted, to blocks [N/m]."""
    for i in range(ring.nodes):
        if ground[NORMAL, i] > 0.0:
            nx, ny = ground[NX, i], ground[NY, i]
            ramp = min(1.0, ground[DEPTH, i] / DEPTH_RAMP)
            along = across = ring.k_n + ring.c_n * ramp * cv
            if ramp < 1.0:
                across += max(0.0, -ring.c_n * (nx * v[2 * i] + ny * v[2 * i + 1]) / DEPTH_RAMP)
            along *= 1.0 - ground[SLIP, i]
            blocks[DXX, i] += across * nx * nx + along * ny * ny
            blocks[DXY, i] += (across - along) * nx * ny
            blocks[DYY, i] += across * ny * ny + along * nx * nx


@lean
def settle_anchors(ring: Ring, q0: Array, q: Array, ground: Array) -> None:
    """Commit the contact of an accepted step: anchors of new and of slipping nodes, none for those in the air."""
    for i in range(ring.nodes):
        if ground[DEPTH, i] > 0.0:
            if ground[SLIP, i] > 0.0:
                ground[ANCHOR_X, i] = q[2 * i] + ground[FRICTION, i] * ground[NY, i] / ring.k_n
                ground[ANCHOR_Y, i] = q[2 * i + 1] - ground[FRICTION, i] * ground[NX, i] / ring.k_n
            elif ground[TOUCH, i] == 0.0:
                ground[ANCHOR_X, i] = q0[2 * i]
                ground[ANCHOR_Y, i] = q0[2 * i + 1]
            ground[TOUCH, i] = 1.0
        else:
            ground[TOUCH, i] = 0.0


@lean
def between(q: Array, n: int, i: int, k: int) -> tuple[float, float, float, float]:
    """Return distance [m], unit vector from edge k to node i (n is the hub) and the nearest place on it, 0 to 1."""
    j = 2 * (k + 1) if k + 1 < n else 0
    ex, ey = q[j] - q[2 * k], q[j + 1] - q[2 * k + 1]
    px, py = q[2 * i] - q[2 * k], q[2 * i + 1] - q[2 * k + 1]
    s = min(1.0, max(0.0, (px * ex + py * ey) / (ex * ex + ey * ey)))
    dx, dy = px - s * ex, py - s * ey
    distance = np.sqrt(dx * dx + dy * dy)
    return distance, dx / distance, dy / distance, s


@lean
def hub_forces(ring: Ring, q: Array, f: Array) -> bool:
    """Add to f what edges push on a hub that comes too near [N]; return whether any does."""
    n, any_near = ring.nodes, False
    reach = ring.hub_radius + 2.0 * ring.l0
    for i in range(n):
        if abs(q[2 * i] - q[2 * n]) > reach or abs(q[2 * i + 1] - q[2 * n + 1]) > reach:
            continue
        distance, ux, uy, s = between(q, ring.nodes, ring.nodes, i)
        if distance < ring.hub_radius:
            any_near = True
            push = ring.k_n * (ring.hub_radius - distance)
            j = 2 * (i + 1) if i + 1 < n else 0
            f[2 * i] += (1.0 - s) * push * ux
            f[2 * i + 1] += (1.0 - s) * push * uy
            f[j] += s * push * ux
            f[j + 1] += s * push * uy
            f[2 * n] -= push * ux
            f[2 * n + 1] -= push * uy
    return any_near


@lean
def hub_tangent(ring: Ring, q: Array, blocks: Array, hub: Array) -> None:
    """Add the stiffness along the direction of each push of `hub_forces`, shared to the two nodes of the edge [N/m]."""
    for i in range(ring.nodes):
        distance, ux, uy, s = between(q, ring.nodes, ring.nodes, i)
        if distance < ring.hub_radius:
            j = i + 1 if i + 1 < ring.nodes else 0
            for node, share in ((i, 1.0 - s), (j, s)):
                stiffness = ring.k_n * share
                couple(blocks, hub, node, stiffness * ux * ux, stiffness * ux * uy, stiffness * uy * uy)


@lean
def crossings(ring: Ring, q: Array) -> int:
    """Return how many pairs of edges of the rim cut each other, plus one if the hub is outside the rim."""
    n, count, winding = ring.nodes, 0, 0
    for i in range(n):
        a, b = 2 * i, 2 * ((i + 1) % n)
        winding += half_turn(q, a, b, q[2 * n], q[2 * n + 1])
        for k in range(i + 2, n if i > 0 else n - 1):
            c, d = 2 * k, 2 * ((k + 1) % n)
            apart = (side(q, a, b, c) > 0.0) == (side(q, a, b, d) > 0.0)
            if not apart and (side(q, c, d, a) > 0.0) != (side(q, c, d, b) > 0.0):
                count += 1
    return count if winding != 0 else count + 1


@lean
def side(q: Array, a: int, b: int, c: int) -> float:
    """Return twice the signed area of the triangle of the points at a, b and c [m2]."""
    area: float = (q[b] - q[a]) * (q[c + 1] - q[a + 1]) - (q[b + 1] - q[a + 1]) * (q[c] - q[a])
    return area


@lean
def half_turn(q: Array, a: int, b: int, x: float, y: float) -> int:
    """Return the signed crossing of the edge from a to b with the ray from (x, y) to the right."""
    if (q[a + 1] > y) == (q[b + 1] > y):
        return 0
    cut = q[a] + (y - q[a + 1]) / (q[b + 1] - q[a + 1]) * (q[b] - q[a])
    if cut < x:
        return 0
    return 1 if q[b + 1] > q[a + 1] else -1
