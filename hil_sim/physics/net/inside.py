r"""The core inside the hoops: a ball that an element pushes off when it comes nearer than the ball's radius.

.. math::  F = k_n \max(0, r_c - d)                                                                               (W2)

with the distance d of the ball's centre from the chord of the element; no friction. Its stiffness is added along the
direction of the push, half of it as a bound on the diagonal, as most nodes have no block with the core: Newton's
method is slower there, and never wrong. Without it a jump could store energy in shapes that cannot be. Checked in
tests/test_physics_net_contact.py; hoops against each other are in `apart`.
"""

import numpy as np

from hil_sim.physics.compiled import Array, kernel
from hil_sim.physics.net.mesh import Net


@kernel
def nearest(x: Array, a: int, b: int, px: float, py: float, pz: float) -> tuple[float, float, float, float, float]:
    """Return distance of a point from the chord between two nodes [m], unit vector to the point, and the share of b."""
    ex, ey, ez = x[b, 0] - x[a, 0], x[b, 1] - x[a, 1], x[b, 2] - x[a, 2]
    dx, dy, dz = px - x[a, 0], py - x[a, 1], pz - x[a, 2]
    s = min(1.0, max(0.0, (dx * ex + dy * ey + dz * ez) / (ex * ex + ey * ey + ez * ez)))
    dx, dy, dz = dx - s * ex, dy - s * ey, dz - s * ez
    distance = np.sqrt(dx * dx + dy * dy + dz * dz)
    return distance, dx / distance, dy / distance, dz / distance, s


@kernel
def core_forces(net: Net, x: Array, f: Array) -> bool:
    """Add to f what elements push on a core that comes too near [N]; return whether any does."""
    core, near = net.bodies - 1, False
    reach = net.core_radius + net.length
    for k in range(net.beams.size):
        a, b = net.ends[k, 0], net.ends[k, 1]
        dx, dy, dz = x[a, 0] - x[core, 0], x[a, 1] - x[core, 1], x[a, 2] - x[core, 2]
        if dx * dx + dy * dy + dz * dz > reach * reach:
            continue
        distance, ux, uy, uz, s = nearest(x, a, b, x[core, 0], x[core, 1], x[core, 2])
        if distance < net.core_radius:
            near = True
            push = net.k_n * (net.core_radius - distance)
            for body, share in ((a, 1.0 - s), (b, s), (core, -1.0)):
                f[body, 0] += share * push * ux
                f[body, 1] += share * push * uy
                f[body, 2] += share * push * uz
    return near


@kernel
def core_tangent(net: Net, x: Array, blocks: Array) -> None:
    """Add a bound of the derivative of `core_forces` to the blocks of the bodies."""
    core = net.bodies - 1
    for k in range(net.beams.size):
        a, b = net.ends[k, 0], net.ends[k, 1]
        distance, ux, uy, uz, s = nearest(x, a, b, x[core, 0], x[core, 1], x[core, 2])
        if distance < net.core_radius:
            u = (ux, uy, uz)
            for body, share in ((a, 1.0 - s), (b, s), (core, 1.0)):
                block = net.pattern.diagonal[body]
                for p in range(3):
                    for q in range(3):
                        blocks[block, p, q] += 2.0 * net.k_n * share * u[p] * u[q]
