r"""Coils as spokes between hub and rim: forces and exact tangents.

A spoke of length L between its rim node and the hub has the force of its coil (`spring`, S1) at a
phase frozen for the step, and while taut a damping d that never makes it push; closed, the winding resists:

.. math::  F = \max(0, k (L - L_0) + d \dot L)_{L > L_0} - k_s \max(0, L_s - L)                       (R2)

The tangent takes in the turning of the attachment with the hub. Source: geometry, derived here; held against finite
differences in tests/test_physics_ring_forces.py.
"""

import numpy as np

from hil_sim.physics.coilset import Coils
from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.ring import DXX, DXY, DYY, HXP, HXX, HXY, HYP, HYX, HYY, Ring

# Rows of the scratch `spokes`: length, force, tangent, direction, twist and arm of the attachment; the frozen coils;
# length and force before the step.
LENGTH, PULL, RATE, UX, UY, TWIST, ARM, SOFT, FREE, SOLID, HARD = range(11)
LENGTH_BEFORE, PULL_BEFORE = range(11, 13)
SPOKE_ROWS = 13
# The damping of a spoke grows from zero over this stretch, so that the force is continuous.
DAMPING_RAMP = 5e-5  # [m] ASSUMED: numerical, short against the stretch of a hot coil that pulls, up to 1 mm


@lean
def freeze(coils: Coils, xi: Array, spokes: Array) -> None:
    """Write stiffness, free length, solid height and stiffness below it of coils at phase xi to spokes [N/m, m]."""
    for s in range(xi.size):
        spokes[SOFT, s] = coils.k_A[s] + xi[s] * (coils.k_M[s] - coils.k_A[s])
        spokes[FREE, s] = coils.L_A[s] + xi[s] * coils.dL[s]
        spokes[SOLID, s] = coils.L_s[s]
        spokes[HARD, s] = coils.k_s[s]


@lean
def spoke_forces(ring: Ring, q: Array, v: Array, f: Array, spokes: Array) -> None:
    """Add the force (R2) of every spoke to f; note lengths, forces and directions in spokes."""
    hub = 2 * ring.nodes
    cosine, sine = np.cos(q[hub + 2]), np.sin(q[hub + 2])
    for s in range(ring.feet.size):
        i = 2 * ring.feet[s]
        rx = cosine * ring.arms[0, s] - sine * ring.arms[1, s]
        ry = sine * ring.arms[0, s] + cosine * ring.arms[1, s]
        dx, dy = q[i] - q[hub] - rx, q[i + 1] - q[hub + 1] - ry
        length = np.sqrt(dx * dx + dy * dy)
        ux, uy = dx / length, dy / length
        twist = uy * rx - ux * ry
        rate = ux * (v[i] - v[hub]) + uy * (v[i + 1] - v[hub + 1]) - twist * v[hub + 2]
        F = k = 0.0
        stretch, pressed = length - spokes[FREE, s], spokes[SOLID, s] - length
        if stretch > 0.0:
            k = spokes[SOFT, s]
            F = max(0.0, k * stretch + ring.coil_damping * min(1.0, stretch / DAMPING_RAMP) * rate)
        if pressed > 0.0:
            k += spokes[HARD, s]
            F -= spokes[HARD, s] * pressed
        spokes[LENGTH, s] = length
        spokes[PULL, s] = F
        spokes[RATE, s] = k
        spokes[UX, s] = ux
        spokes[UY, s] = uy
        spokes[TWIST, s] = twist
        spokes[ARM, s] = ux * rx + uy * ry
        f[i] += F * ux
        f[i + 1] += F * uy
        f[hub] -= F * ux
        f[hub + 1] -= F * uy
        f[hub + 2] -= F * twist


@lean
def spoke_tangent(ring: Ring, spokes: Array, cv: float, blocks: Array, hub: Array) -> None:
    """Add the derivative of `spoke_forces`, from what that noted, to blocks and to hub (3, 3) [N/m]."""
    for s in range(ring.feet.size):
        F, i = spokes[PULL, s], ring.feet[s]
        if F == 0.0:
            continue
        ux, uy, twist, arm = spokes[UX, s], spokes[UY, s], spokes[TWIST, s], spokes[ARM, s]
        along = spokes[RATE, s] + (cv * ring.coil_damping if F > 0.0 else 0.0)
        across = F / spokes[LENGTH, s]
        kxx = along * ux * ux + across * uy * uy
        kxy = (along - across) * ux * uy
        kyy = along * uy * uy + across * ux * ux
        kxp = -along * twist * ux + across * arm * uy
        kyp = -along * twist * uy - across * arm * ux
        couple(blocks, hub, i, kxx, kxy, kyy)
        blocks[HXP, i] += kxp
        blocks[HYP, i] += kyp
        hub[2, 0] -= kxp
        hub[2, 1] -= kyp
        hub[2, 2] += along * twist * twist + across * arm * arm + F * arm


@lean
def couple(blocks: Array, hub: Array, i: int, kxx: float, kxy: float, kyy: float) -> None:
    """Add a stiffness between node i and the centre of the hub [N/m]; the lower half of hub is enough."""
    blocks[DXX, i] += kxx
    blocks[DXY, i] += kxy
    blocks[DYY, i] += kyy
    blocks[HXX, i] -= kxx
    blocks[HXY, i] -= kxy
    blocks[HYX, i] -= kxy
    blocks[HYY, i] -= kyy
    hub[0, 0] += kxx
    hub[1, 0] += kxy
    hub[1, 1] += kyy
