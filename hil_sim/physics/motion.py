r"""Moves the ring: implicit generalised-alpha steps whose length follows the local error.

.. math::
    M [(1 - a_m) a_1 + a_m a_0] + (1 - a_f) f_1 + a_f f_0 = 0,
    \quad q_1 = q_0 + h v_0 + h^2 [(\tfrac12 - \beta) a_0 + \beta a_1],
    \quad v_1 = v_0 + h [(1 - \gamma) a_0 + \gamma a_1]                                              (I1)

a_m = (2 r - 1)/(r + 1), a_f = r/(r + 1), beta = (1 - a_m + a_f)^2/4, gamma = 1/2 - a_m + a_f for the damping r of the
highest frequency (0 dissipates all, 1 nothing). Second order: backward Euler would take 28 % of a jump. Solved by
Newton's method with a line search; a step that does not converge, meets a pivot that is not positive, or errs more
than the tolerance |beta - 1/6| h^2 |a_1 - a_0| is halved. Standing still the steps grow to 5 ms, in a snap they
shrink to some 0.1 ms.

Source: Chung and Hulbert 1993 (standard result), error measure of Newmark's family (standard result). Order, energy
and repeatability: tests/test_physics_ring_motion.py.
"""

import numpy as np

from hil_sim.physics.banded import solve
from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.contact import (
    PUSH_X,
    PUSH_X_BEFORE,
    PUSH_Y,
    PUSH_Y_BEFORE,
    ground_forces,
    ground_tangent,
    hub_forces,
    hub_tangent,
    settle_anchors,
)
from hil_sim.physics.corners import corner_forces, corner_tangent, settle_corners
from hil_sim.physics.gauge import bend_loss
from hil_sim.physics.ring import Ring, rim_forces, rim_tangent
from hil_sim.physics.spokes import LENGTH, LENGTH_BEFORE, PULL, PULL_BEFORE, spoke_forces, spoke_tangent
from hil_sim.physics.state import TOLERANCE, Method, Motion
from hil_sim.physics.tally import (
    BEND_LOSS,
    BEND_RATE,
    COIL_WORK,
    DRAG_LOSS,
    DRAG_RATE,
    FORCED,
    GROUND_WORK,
    ITERATIONS,
    PEAK_FORCE,
    REJECTED,
    STEP,
    STEPS,
    TIME,
)
from hil_sim.physics.touch import leaps, list_pairs, touch_forces, touch_tangent

STEP_MIN = 2e-5  # [s] a shorter one is taken as it is: mass alone then makes the system definite
RESIDUAL = 1e-9  # [N] the least that is asked of Newton's method
ITERATIONS_MAX = 12
CUTS_MAX = 5


@lean
def forces(ring: Ring, gx: float, gy: float, m: Motion, q: Array, v: Array, cv: float, f: Array) -> bool:
    """Write the gradient of all forces at q, v to f [N]; return whether the hub touches the rim."""
    n = ring.nodes
    for i in range(2 * n, 2 * n + 3):
        f[i] = 0.0
    rim_forces(ring, q, v, cv, m.rim, f)
    spoke_forces(ring, q, v, f, m.spokes)
    ground_forces(ring, m.now[0], q, v, m.ground, f)
    if m.corners.shape[1]:
        corner_forces(ring, m.now[0], q, v, m.corners, m.ground, f)
    for i in range(n + 1):
        f[2 * i] += ring.mass[2 * i] * (ring.drag * v[2 * i] - gx)
        f[2 * i + 1] += ring.mass[2 * i + 1] * (ring.drag * v[2 * i + 1] - gy)
    f[2 * n + 2] += ring.mass[2 * n + 2] * ring.drag * v[2 * n + 2]
    touch_forces(ring, q, m.pairs, f)
    return hub_forces(ring, q, f)


@lean
def begin(ring: Ring, gx: float, gy: float, m: Motion) -> None:
    """Fill forces and accelerations of the present state: a body set down or let go has no past."""
    forces(ring, gx, gy, m, m.now[0], m.now[1], 0.0, m.now[3])
    for i in range(m.now.shape[1]):
        m.now[2, i] = -m.now[3, i] / ring.mass[i]


@lean
def correct(ring: Ring, m: Motion, q: Array, v: Array, cv: float, ca: float, near: bool, rhs: Array, x: Array) -> bool:
    """Write Newton's correction to x; return False if the system is not positive."""
    m.hub[:] = 0.0
    rim_tangent(ring, m.rim, m.blocks)
    spoke_tangent(ring, m.spokes, cv, m.blocks, m.hub)
    ground_tangent(ring, v, m.ground, cv, m.blocks)
    if m.corners.shape[1]:
        corner_tangent(ring, q, m.corners, cv, m.blocks)
    if near:
        hub_tangent(ring, q, m.blocks, m.hub)
    touch_tangent(ring, q, m.pairs, m.blocks)
    diagonal = m.vectors[2]
    for i in range(q.size):
        diagonal[i] = (ca + ring.drag * cv) * ring.mass[i]
    return solve(m.blocks, m.hub, diagonal, rhs, m.band, m.border, m.corner, x)


@lean
def residual(ring: Ring, method: Method, m: Motion, rhs: Array) -> float:
    """Write minus the error of (I1), divided by 1 - a_f, to rhs; return its greatest entry [N]."""
    inertia, old = 1.0 / (1.0 - method.a_f), method.a_f / (1.0 - method.a_f)
    a_0, a_1, f_0, f_1 = m.now[2], m.new[2], m.now[3], m.new[3]
    size = rhs.size
    for i in range(size):
        mean = (1.0 - method.a_m) * a_1[i] + method.a_m * a_0[i]
        rhs[i] = -(inertia * ring.mass[i] * mean + f_1[i] + old * f_0[i])
    greatest = abs(rhs[size - 1]) / ring.hub_radius
    for i in range(size - 1):
        greatest = max(greatest, abs(rhs[i]))
    return float(greatest)


@lean
def place(m: Motion, method: Method, h: float) -> None:
    """Fill velocity and acceleration of the new state from its position, (I1)."""
    ca, cv = 1.0 / (method.beta * h * h), method.gamma / (method.beta * h)
    kv, ka = 1.0 - method.gamma / method.beta, h * (1.0 - 0.5 * method.gamma / method.beta)
    now, new = m.now, m.new
    for i in range(now.shape[1]):
        change = new[0, i] - now[0, i]
        new[1, i] = cv * change + kv * now[1, i] + ka * now[2, i]
        new[2, i] = ca * (change - h * now[1, i]) - (0.5 / method.beta - 1.0) * now[2, i]


@lean
def attempt(ring: Ring, gx: float, gy: float, method: Method, m: Motion, h: float) -> bool:
    """Solve one step of length h for the new state; return False if it must be shorter."""
    ca = (1.0 - method.a_m) / ((1.0 - method.a_f) * method.beta * h * h)
    cv = method.gamma / (method.beta * h)
    rhs, x, q, v = m.vectors[0], m.vectors[1], m.new[0], m.new[1]
    list_pairs(ring, m.now[0], m.pairs)
    for i in range(q.size):
        q[i] = m.now[0, i] + h * m.now[1, i] + 0.5 * h * h * m.now[2, i]
        x[i] = 0.0
    enough = max(RESIDUAL, method.share * min(method.tolerance, TOLERANCE) * ca * ring.mass[0])
    before, cuts = np.inf, 0
    for _ in range(ITERATIONS_MAX):
        place(m, method, h)
        near = forces(ring, gx, gy, m, q, v, cv, m.new[3])
        error = residual(ring, method, m, rhs)
        m.tally[ITERATIONS] += 1.0
        if error < enough:
            return True
        if not error < before and cuts < CUTS_MAX:
            cuts += 1
            for i in range(q.size):
                x[i] *= 0.5
                q[i] -= x[i]
            continue
        before, cuts = error, 0
        if not correct(ring, m, q, v, cv, ca, near, rhs, x):
            return False
        for i in range(q.size):
            q[i] += x[i]
    return False


@lean
def local_error(method: Method, m: Motion, h: float) -> float:
    """Return the estimated error of the new positions [m]."""
    greatest = 0.0
    for i in range(m.now.shape[1] - 1):
        greatest = max(greatest, abs(m.new[2, i] - m.now[2, i]))
    return float(abs(method.beta - 1.0 / 6.0) * h * h * greatest)


@lean
def accept(ring: Ring, m: Motion, h: float) -> None:
    """Make the new state the present one and add the work of the step to the tallies."""
    tally, ground, spokes = m.tally, m.ground, m.spokes
    for i in range(ring.nodes):
        dx, dy = m.new[0, 2 * i] - m.now[0, 2 * i], m.new[0, 2 * i + 1] - m.now[0, 2 * i + 1]
        along = ground[PUSH_X, i] + ground[PUSH_X_BEFORE, i]
        across = ground[PUSH_Y, i] + ground[PUSH_Y_BEFORE, i]
        tally[GROUND_WORK] += 0.5 * (along * dx + across * dy)
    for s in range(ring.feet.size):
        shortening = spokes[LENGTH_BEFORE, s] - spokes[LENGTH, s]
        tally[COIL_WORK] += 0.5 * (spokes[PULL, s] + spokes[PULL_BEFORE, s]) * shortening
        tally[PEAK_FORCE] = max(tally[PEAK_FORCE], spokes[PULL, s])
    bend, drag = bend_loss(ring, m.rim), drag_loss(ring, m.new[1])
    tally[BEND_LOSS] += 0.5 * h * (bend + tally[BEND_RATE])
    tally[DRAG_LOSS] += 0.5 * h * (drag + tally[DRAG_RATE])
    tally[BEND_RATE] = bend
    tally[DRAG_RATE] = drag
    tally[TIME] += h
    tally[STEPS] += 1.0
    settle_anchors(ring, m.now[0], m.new[0], ground)
    if m.corners.shape[1]:
        settle_corners(ring, m.new[0], m.corners)
    for i in range(ring.nodes):
        ground[PUSH_X_BEFORE, i] = ground[PUSH_X, i]
        ground[PUSH_Y_BEFORE, i] = ground[PUSH_Y, i]
    for s in range(ring.feet.size):
        spokes[LENGTH_BEFORE, s] = spokes[LENGTH, s]
        spokes[PULL_BEFORE, s] = spokes[PULL, s]
    for row in range(4):
        for i in range(m.now.shape[1]):
            m.now[row, i] = m.new[row, i]


@lean
def drag_loss(ring: Ring, v: Array) -> float:
    """Return the power that the air takes [W]."""
    power = 0.0
    for i in range(v.size):
        power += ring.drag * ring.mass[i] * v[i] * v[i]
    return power


@lean
def march(ring: Ring, gx: float, gy: float, method: Method, m: Motion, duration: float) -> None:
    """Advance the body by exactly `duration` [s] at frozen phase of the coils, in as many steps as it takes."""
    left = duration
    while left > 0.0:
        h = min(left, m.tally[STEP])
        if h < left < 2.0 * h:
            h = 0.5 * left
        solved = attempt(ring, gx, gy, method, m, h)
        error = local_error(method, m, h) if solved else np.inf
        good = error < 2.0 * method.tolerance and not leaps(m.now[0], m.new[0], m.pairs)
        if h > STEP_MIN and not good:
            m.tally[REJECTED] += 1.0
            m.tally[STEP] = 0.5 * h
            continue
        m.tally[FORCED] += 0.0 if solved else 1.0
        accept(ring, m, h)
        left -= h
        growth = min(2.0, 0.9 * (method.tolerance / max(error, 1e-12)) ** (1.0 / 3.0))
        if growth < 1.0 or h > 0.5 * m.tally[STEP]:
            m.tally[STEP] = min(method.longest, max(STEP_MIN, growth * h))
