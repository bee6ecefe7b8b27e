r"""Contact of the strips' edges with the ground: pushed out along its normal, held by friction that sticks and slips.

.. math::
    n = \max(0, k_n d - c(d) \, \dot p \cdot N), \qquad
    t = (1 - N N^T) [-k_n (p - p_a) - c(d) \, \dot p], \quad |t| \le \mu n                                         (G2)

for a point p = x + R rho that lies d > 0 deep under the surface of normal N. The anchor p_a is set where the point
touches down and moves only while the point slips, so that |t| = mu n (return mapping): what stands, stands, and does
not creep. The damping grows with the depth over the first 10 um, so that forces are continuous.

Source: return mapping is the standard treatment of elastic-plastic friction. DEVIATION: the bound is mu times the
normal force at the begin of the step (of the step's end for a point that just came down), which keeps the tangent
symmetric and Newton's method quick; steps are short wherever normal forces change.
"""

import numpy as np

from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.net.mesh import Net
from hil_sim.physics.terrain import Terrain, depth

# Columns of the array `touch`, a row for each point: its place and the last one, its anchor, whether it stood on it,
# its depth, normal, normal force and force on the body, both before; the share of its spring's pull that friction
# bears, 1 while it sticks, and the direction in which it slips.
PLACE, PLACE_BEFORE, ANCHOR, TOUCHED, DEPTH, NORMAL_X, NORMAL_Z, PUSH, FORCE = 0, 3, 6, 9, 10, 11, 12, 13, 14
PUSH_BEFORE, FORCE_BEFORE, BORNE, WAY = 17, 18, 21, 22
TOUCH_COLUMNS = 25
Triple = tuple[float, float, float]
DEPTH_RAMP = 1e-5  # [m] ASSUMED: numerical, less than what a standing body sinks in


@lean
def ground_forces(net: Net, terrain: Terrain, x: Array, R: Array, v: Array, touch: Array, f: Array) -> None:
    """Add the pushes (G2) to f, and note them in touch [N]."""
    for k in range(net.feet.size):
        body = net.feet[k]
        for p in range(3):
            touch[k, PLACE + p] = (
                x[body, p]
                + R[body, p, 0] * net.offsets[k, 0]
                + R[body, p, 1] * net.offsets[k, 1]
                + R[body, p, 2] * net.offsets[k, 2]
            )
        deep, nx, nz = depth(terrain, touch[k, PLACE], touch[k, PLACE + 2])
        touch[k, DEPTH], touch[k, NORMAL_X], touch[k, NORMAL_Z] = deep, nx, nz
        if deep > 0.0:
            push(net, x, v, body, k, touch, f)
        else:
            touch[k, PUSH] = touch[k, FORCE] = touch[k, FORCE + 1] = touch[k, FORCE + 2] = 0.0
            touch[k, BORNE] = 1.0


@lean
def push(net: Net, x: Array, v: Array, body: int, k: int, touch: Array, f: Array) -> None:
    """Add the force on point k, which touches."""
    nx, nz, deep = touch[k, NORMAL_X], touch[k, NORMAL_Z], touch[k, DEPTH]
    ax, ay, az = touch[k, PLACE] - x[body, 0], touch[k, PLACE + 1] - x[body, 1], touch[k, PLACE + 2] - x[body, 2]
    wx, wy, wz = v[body, 3], v[body, 4], v[body, 5]
    vx = v[body, 0] + wy * az - wz * ay
    vy = v[body, 1] + wz * ax - wx * az
    vz = v[body, 2] + wx * ay - wy * ax
    damping = net.c_n * min(1.0, deep / DEPTH_RAMP)
    normal = max(0.0, net.k_n * deep - damping * (vx * nx + vz * nz))
    anchor = ANCHOR if touch[k, TOUCHED] > 0.0 else PLACE_BEFORE
    tx = -net.k_n * (touch[k, PLACE] - touch[k, anchor]) - damping * vx
    ty = -net.k_n * (touch[k, PLACE + 1] - touch[k, anchor + 1]) - damping * vy
    tz = -net.k_n * (touch[k, PLACE + 2] - touch[k, anchor + 2]) - damping * vz
    out = tx * nx + tz * nz
    tx, tz = tx - out * nx, tz - out * nz
    size = np.sqrt(tx * tx + ty * ty + tz * tz)
    bound = net.mu * (touch[k, PUSH_BEFORE] if touch[k, PUSH_BEFORE] > 0.0 else normal)
    touch[k, BORNE] = 1.0
    if size > bound:
        touch[k, BORNE] = bound / size
        touch[k, WAY], touch[k, WAY + 1], touch[k, WAY + 2] = tx / size, ty / size, tz / size
        tx, ty, tz = tx * bound / size, ty * bound / size, tz * bound / size
    fx, fy, fz = tx + normal * nx, ty, tz + normal * nz
    touch[k, PUSH], touch[k, FORCE], touch[k, FORCE + 1], touch[k, FORCE + 2] = normal, fx, fy, fz
    f[body, 0] -= fx
    f[body, 1] -= fy
    f[body, 2] -= fz
    f[body, 3] -= ay * fz - az * fy
    f[body, 4] -= az * fx - ax * fz
    f[body, 5] -= ax * fy - ay * fx


@lean
def ground_tangent(net: Net, x: Array, cv: float, touch: Array, blocks: Array) -> None:
    """Add the derivative of `ground_forces` at a given bound of friction to the blocks of the bodies."""
    for k in range(net.feet.size):
        if touch[k, PUSH] <= 0.0:
            continue
        body = net.feet[k]
        stiffness = net.k_n + net.c_n * min(1.0, touch[k, DEPTH] / DEPTH_RAMP) * cv
        held = stiffness * touch[k, BORNE]
        slipping = held if touch[k, BORNE] < 1.0 else 0.0
        a = (touch[k, PLACE] - x[body, 0], touch[k, PLACE + 1] - x[body, 1], touch[k, PLACE + 2] - x[body, 2])
        F = (touch[k, FORCE], touch[k, FORCE + 1], touch[k, FORCE + 2])
        n, way = (touch[k, NORMAL_X], 0.0, touch[k, NORMAL_Z]), (touch[k, WAY], touch[k, WAY + 1], touch[k, WAY + 2])
        lean, sway = cross(a, n), cross(a, way)
        spin = ((0.0, -a[2], a[1]), (a[2], 0.0, -a[0]), (-a[1], a[0], 0.0))
        square, inner = a[0] ** 2 + a[1] ** 2 + a[2] ** 2, a[0] * F[0] + a[1] * F[1] + a[2] * F[2]
        block, more = net.pattern.diagonal[body], stiffness - held
        for p in range(3):
            for q in range(3):
                same = 1.0 if p == q else 0.0
                blocks[block, p, q] += held * same + more * n[p] * n[q] - slipping * way[p] * way[q]
                blocks[block, 3 + p, q] += held * spin[p][q] + more * lean[p] * n[q] - slipping * sway[p] * way[q]
                blocks[block, 3 + p, 3 + q] += (
                    held * (square * same - a[p] * a[q])
                    + more * lean[p] * lean[q]
                    - slipping * sway[p] * sway[q]
                    - 0.5 * (a[p] * F[q] + F[p] * a[q])
                    + inner * same
                )


@lean
def cross(a: Triple, b: Triple) -> Triple:
    """Return the cross product of two vectors."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@lean
def settle_anchors(net: Net, touch: Array) -> int:
    """Commit the contact of an accepted step: anchors of new and of slipping points; return how many touch."""
    count = 0
    for k in range(net.feet.size):
        if touch[k, DEPTH] > 0.0:
            count += 1
            if touch[k, BORNE] < 1.0:
                slide(net, touch, k)
            elif touch[k, TOUCHED] == 0.0:
                for p in range(3):
                    touch[k, ANCHOR + p] = touch[k, PLACE_BEFORE + p]
            touch[k, TOUCHED] = 1.0
        else:
            touch[k, TOUCHED] = 0.0
        touch[k, PUSH_BEFORE] = touch[k, PUSH]
        for p in range(3):
            touch[k, PLACE_BEFORE + p] = touch[k, PLACE + p]
            touch[k, FORCE_BEFORE + p] = touch[k, FORCE + p]
    return count


@lean
def slide(net: Net, touch: Array, k: int) -> None:
    """Move the anchor of a slipping point so that its spring carries the bound of friction."""
    nx, nz, normal = touch[k, NORMAL_X], touch[k, NORMAL_Z], touch[k, PUSH]
    touch[k, ANCHOR] = touch[k, PLACE] + (touch[k, FORCE] - normal * nx) / net.k_n
    touch[k, ANCHOR + 1] = touch[k, PLACE + 1] + touch[k, FORCE + 1] / net.k_n
    touch[k, ANCHOR + 2] = touch[k, PLACE + 2] + (touch[k, FORCE + 2] - normal * nz) / net.k_n
