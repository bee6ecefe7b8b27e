r"""The core inside the hoops: a ball that the strips push off when it comes nearer than its radius.

.. math::
    F = k_n \max(0, r_c - d), \qquad p = (1 - s) \, x_a + s \, x_b + c \, t_3, \quad d = |x_c - p|                (W2)

with the place p of an element's strip that is nearest to the centre of the ball: s along the chord from 0 to 1, c
across, at most half the width either way. No friction, no thickness. Of the derivative the part along the push is
taken, J^T k_n J, exact but for the turning of the push; for a node that has no coil to the core, and so no block with
it, a bound of it on the diagonals. Without this contact a jump could store energy in shapes that cannot be. Derived
here; checked in tests/test_physics_net_contact.py.
"""

import numpy as np

from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.net.beam import AXES_A, AXES_B
from hil_sim.physics.net.mesh import Net

# Columns of the scratch `near`, one row for each element: push [N], its direction, lever of the push, share of b.
PUSH, UNIT, LEVER, SHARE = 0, 1, 4, 7
NEAR_COLUMNS = 8


@lean
def core_forces(net: Net, x: Array, work: Array, near: Array, f: Array) -> bool:
    """Add to f what strips push on a core that comes too near; return whether any does. Needs `beam_forces` before."""
    core, touched = net.bodies - 1, False
    reach = net.core_radius + net.length + net.width
    for k in range(net.beams.size):
        near[k, PUSH] = 0.0
        a = net.ends[k, 0]
        dx, dy, dz = x[a, 0] - x[core, 0], x[a, 1] - x[core, 1], x[a, 2] - x[core, 2]
        if dx * dx + dy * dy + dz * dz > reach * reach:
            continue
        measure(net, x, work, k, near)
        if near[k, PUSH] > 0.0:
            touched = True
            give(net, k, core, near, f)
    return touched


@lean
def measure(net: Net, x: Array, work: Array, k: int, near: Array) -> None:
    """Find the place of strip k that is nearest to the core, and the push there."""
    a, b, core = net.ends[k, 0], net.ends[k, 1], net.bodies - 1
    ex, ey, ez = x[b, 0] - x[a, 0], x[b, 1] - x[a, 1], x[b, 2] - x[a, 2]
    dx, dy, dz = x[core, 0] - x[a, 0], x[core, 1] - x[a, 1], x[core, 2] - x[a, 2]
    s = min(1.0, max(0.0, (dx * ex + dy * ey + dz * ez) / (ex * ex + ey * ey + ez * ez)))
    wx = 0.5 * (work[k, AXES_A + 6] + work[k, AXES_B + 6])
    wy = 0.5 * (work[k, AXES_A + 7] + work[k, AXES_B + 7])
    wz = 0.5 * (work[k, AXES_A + 8] + work[k, AXES_B + 8])
    dx, dy, dz = dx - s * ex, dy - s * ey, dz - s * ez
    c = min(0.5 * net.width, max(-0.5 * net.width, dx * wx + dy * wy + dz * wz))
    dx, dy, dz = dx - c * wx, dy - c * wy, dz - c * wz
    distance = np.sqrt(dx * dx + dy * dy + dz * dz)
    ux, uy, uz = dx / distance, dy / distance, dz / distance
    near[k, PUSH] = net.k_n * max(0.0, net.core_radius - distance)
    near[k, UNIT], near[k, UNIT + 1], near[k, UNIT + 2] = ux, uy, uz
    near[k, LEVER] = c * (wy * uz - wz * uy)
    near[k, LEVER + 1] = c * (wz * ux - wx * uz)
    near[k, LEVER + 2] = c * (wx * uy - wy * ux)
    near[k, SHARE] = s


@lean
def give(net: Net, k: int, core: int, near: Array, f: Array) -> None:
    """Add the push of strip k to f."""
    push, s = near[k, PUSH], near[k, SHARE]
    for p in range(3):
        f[core, p] -= push * near[k, UNIT + p]
    for body, share in ((net.ends[k, 0], 1.0 - s), (net.ends[k, 1], s)):
        for p in range(3):
            f[body, p] += share * push * near[k, UNIT + p]
            f[body, 3 + p] += share * push * near[k, LEVER + p]


@lean
def core_tangent(net: Net, near: Array, blocks: Array) -> None:
    """Add the derivative of `core_forces` along the pushes, from what that noted, to blocks."""
    core = net.pattern.diagonal[net.bodies - 1]
    for k in range(net.beams.size):
        if near[k, PUSH] <= 0.0:
            continue
        a, b, s = net.ends[k, 0], net.ends[k, 1], near[k, SHARE]
        add(near, k, net.k_n, blocks, core, 3, 3)
        add(near, k, net.k_n * s * (1.0 - s), blocks, net.beams[k], 6, 6)
        for body, share in ((a, 1.0 - s), (b, s)):
            add(near, k, net.k_n * share * share, blocks, net.pattern.diagonal[body], 6, 6)
            if net.to_core[body] >= 0:
                add(near, k, -net.k_n * share, blocks, net.to_core[body], 3, 6)
            else:
                add(near, k, net.k_n * share, blocks, core, 3, 3)
                add(near, k, net.k_n * share, blocks, net.pattern.diagonal[body], 6, 6)


@lean
def add(near: Array, k: int, stiffness: float, blocks: Array, block: int, rows: int, columns: int) -> None:
    """Add stiffness times J J^T of push k to the first rows and columns of a block."""
    for p in range(rows):
        for q in range(columns):
            blocks[block, p, q] += stiffness * near[k, UNIT + p] * near[k, UNIT + q]
