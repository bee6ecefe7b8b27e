r"""Coils between two bodies: pulls from lengths at frozen phase, and their exact tangent, rotations included.

.. math::
    d = x_f - x_n - r, \quad r = R_n \rho, \quad L = |d|, \quad u = d / L, \qquad
    F = k(\xi) \max(0, L - L_0(\xi)) + c \, \dot L                                                               (P1)

.. math::
    K_d = \left(\frac{\partial F}{\partial L} + c \, c_v\right) u u^T + \frac{F}{L} (1 - u u^T)                  (P2)

The near end is fixed to its body at rho from its centre, the far end to the middle of a node. Damping acts only while
the coil is taut and grows from zero, so that the force is continuous; below its solid height a coil pushes a little
(see `spring`). The near body's spin adds the second derivative of its arm. The tangent leaves out the growth of the
damping, as (P2) does. Derived here; held against finite differences in tests/test_physics_net_forces.py.
"""

import numpy as np

from hil_sim.physics.coilset import Coils
from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.net.mesh import Net

# Rows of the scratch `coils`: length, force, tangent, unit vector, arm; the frozen coil; length and force before.
LENGTH, PULL, RATE, UNIT, ARM = 0, 1, 2, 3, 6
SOFT, FREE, SOLID, HARD, LENGTH_BEFORE, PULL_BEFORE = range(9, 15)
COIL_ROWS = 15
DAMPING_RAMP = 5e-5  # [m] ASSUMED: numerical, short against the stretch of a hot coil that pulls


@lean
def freeze(coils: Coils, xi: Array, c: Array) -> None:
    """Write stiffness, free length, solid height and stiffness below it of coils at phase xi [N/m, m]."""
    for s in range(xi.size):
        c[SOFT, s] = coils.k_A[s] + xi[s] * (coils.k_M[s] - coils.k_A[s])
        c[FREE, s] = coils.L_A[s] + xi[s] * coils.dL[s]
        c[SOLID, s] = coils.L_s[s]
        c[HARD, s] = coils.k_s[s]


@lean
def tension(c: Array, s: int, length: float, rate: float, damping: float) -> tuple[float, float]:
    """Return force [N] and stiffness [N/m] of frozen coil s, (P1)."""
    F = k = 0.0
    stretch, pressed = length - c[FREE, s], c[SOLID, s] - length
    if stretch > 0.0:
        k = c[SOFT, s]
        F = max(0.0, k * stretch + damping * min(1.0, stretch / DAMPING_RAMP) * rate)
    if pressed > 0.0:
        k += c[HARD, s]
        F -= c[HARD, s] * pressed
    return F, k


@lean
def measure(net: Net, x: Array, R: Array, c: Array, s: int) -> None:
    """Write length, unit vector and arm of coil s."""
    near, far = net.near[s], net.far[s]
    square = 0.0
    for p in range(3):
        arm = R[near, p, 0] * net.arms[s, 0] + R[near, p, 1] * net.arms[s, 1] + R[near, p, 2] * net.arms[s, 2]
        reach = x[far, p] - x[near, p] - arm
        c[ARM + p, s] = arm
        c[UNIT + p, s] = reach
        square += reach * reach
    c[LENGTH, s] = np.sqrt(square)
    for p in range(3):
        c[UNIT + p, s] /= c[LENGTH, s]


@lean
def coil_forces(net: Net, x: Array, R: Array, v: Array, c: Array, f: Array) -> None:
    """Add the pull (P1) of every coil to f; note lengths, forces and directions in c."""
    for s in range(net.near.size):
        near, far = net.near[s], net.far[s]
        measure(net, x, R, c, s)
        ux, uy, uz = c[UNIT, s], c[UNIT + 1, s], c[UNIT + 2, s]
        ax, ay, az = c[ARM, s], c[ARM + 1, s], c[ARM + 2, s]
        mx, my, mz = ay * uz - az * uy, az * ux - ax * uz, ax * uy - ay * ux
        rate = ux * (v[far, 0] - v[near, 0]) + uy * (v[far, 1] - v[near, 1]) + uz * (v[far, 2] - v[near, 2])
        rate -= mx * v[near, 3] + my * v[near, 4] + mz * v[near, 5]
        F, k = tension(c, s, c[LENGTH, s], rate, net.coil_damping)
        c[PULL, s], c[RATE, s] = F, k
        f[far, 0] += F * ux
        f[far, 1] += F * uy
        f[far, 2] += F * uz
        f[near, 0] -= F * ux
        f[near, 1] -= F * uy
        f[near, 2] -= F * uz
        f[near, 3] -= F * mx
        f[near, 4] -= F * my
        f[near, 5] -= F * mz


@lean
def coil_tangent(net: Net, cv: float, c: Array, blocks: Array) -> None:
    """Add the derivative of `coil_forces`, from what that noted, to blocks."""
    for s in range(net.near.size):
        F = c[PULL, s]
        if F == 0.0:
            continue
        near, far, pair = net.pattern.diagonal[net.near[s]], net.pattern.diagonal[net.far[s]], net.pulls[s]
        across = F / c[LENGTH, s]
        along = c[RATE, s] - across + (cv * net.coil_damping if F > 0.0 else 0.0)
        for p in range(3):
            for q in range(3):
                K = along * c[UNIT + p, s] * c[UNIT + q, s] + (across if p == q else 0.0)
                blocks[near, p, q] += K
                blocks[far, p, q] += K
                blocks[pair, p, q] -= K
        turn_near(net, c, s, along, across, blocks, near, pair)


@lean
def turn_near(net: Net, c: Array, s: int, along: float, across: float, blocks: Array, near: int, pair: int) -> None:
    r"""Add what the spin of the near body gives: K_d [r]_x and [r]_x^T K_d [r]_x, and the bending of its arm."""
    a, u = (c[ARM, s], c[ARM + 1, s], c[ARM + 2, s]), (c[UNIT, s], c[UNIT + 1, s], c[UNIT + 2, s])
    if a[0] == 0.0 and a[1] == 0.0 and a[2] == 0.0:
        return
    m = (a[1] * u[2] - a[2] * u[1], a[2] * u[0] - a[0] * u[2], a[0] * u[1] - a[1] * u[0])
    cross = ((0.0, -a[2], a[1]), (a[2], 0.0, -a[0]), (-a[1], a[0], 0.0))
    F, inner, square = c[PULL, s], a[0] * u[0] + a[1] * u[1] + a[2] * u[2], a[0] ** 2 + a[1] ** 2 + a[2] ** 2
    for p in range(3):
        for q in range(3):
            mixed = along * m[p] * u[q] + across * cross[p][q]
            blocks[near, 3 + p, q] += mixed
            if net.near_last[s]:
                blocks[pair, 3 + p, q] -= mixed
            else:
                blocks[pair, q, 3 + p] -= mixed
            turning = along * m[p] * m[q] - across * a[p] * a[q] - 0.5 * F * (a[p] * u[q] + u[p] * a[q])
            if p == q:
                turning += across * square + F * inner
            blocks[near, 3 + p, 3 + q] += turning
