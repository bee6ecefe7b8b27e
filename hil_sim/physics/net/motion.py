r"""Moves a net of strips: implicit generalised-alpha steps on places and rotations, their length by the local error.

.. math::
    M [(1 - a_m) a_1 + a_m a_0] + (1 - a_f) f_1 + a_f f_0 = 0,
    \quad d = h v_0 + h^2 [(\tfrac12 - \beta) a_0 + \beta a_1],
    \quad v_1 = v_0 + h [(1 - \gamma) a_0 + \gamma a_1]                                                           (I2)

for displacements and rotation vectors d alike, x_1 = x_0 + d and R_1 = exp([d]_x) R_0, with the factors of `motion`
(I1). As every moment of inertia is the same about all axes there is no gyroscopic term. Newton's method takes the
derivative of the rotation vector by the spin for 1: it converges to the same end for turns well below a radian. A
step that does not converge, meets a pivot that is not positive, or errs more than the tolerance |beta - 1/6| h^2
|a_1 - a_0| is halved.

Source: Chung and Hulbert 1993; on rotations Bruls and Cardona 2010 (standard results). Order, energy, momentum and
repeatability: tests/test_physics_net_motion.py.
"""

import numpy as np

from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.flight import watch_flight
from hil_sim.physics.net.apart import list_close, strip_forces, strip_tangent
from hil_sim.physics.net.beam import beam_forces, beam_tangent
from hil_sim.physics.net.factor import factor, solve
from hil_sim.physics.net.gauge import centre, lowest, rise_rate
from hil_sim.physics.net.ground import (
    FORCE,
    FORCE_BEFORE,
    PLACE,
    PLACE_BEFORE,
    ground_forces,
    ground_tangent,
    settle_anchors,
)
from hil_sim.physics.net.inside import core_forces, core_tangent
from hil_sim.physics.net.mesh import Net
from hil_sim.physics.net.pulls import LENGTH, LENGTH_BEFORE, PULL, PULL_BEFORE, coil_forces, coil_tangent
from hil_sim.physics.net.rotation import straighten, turned
from hil_sim.physics.net.state import Motion, State
from hil_sim.physics.state import Method
from hil_sim.physics.tally import (
    BEND_LOSS,
    BEND_RATE,
    COIL_WORK,
    CONTACTS,
    DRAG_LOSS,
    DRAG_RATE,
    ELASTIC,
    ELASTIC_NEXT,
    FORCED,
    GROUND_WORK,
    ITERATIONS,
    LOSS_NEXT,
    PEAK_FORCE,
    REJECTED,
    STEP,
    STEPS,
    TIME,
)
from hil_sim.physics.terrain import Terrain

STEP_MIN = 1e-5  # [s] a shorter one is taken as it is: mass alone then makes the system definite
RESIDUAL = 1e-9  # [N] the least that is asked of Newton's method
PART = 1e-3  # of the weight, the most that Newton's method may leave
ITERATIONS_MAX = 12
CUTS_MAX = 5


@lean
def forces(net: Net, terrain: Terrain, g: tuple[float, float], m: Motion, s: State) -> tuple[bool, float, float]:
    """Write the gradient of all forces in s to s.f; return if the core is touched, U [J] and what it loses [W]."""
    s.f[:] = 0.0
    energy, loss = beam_forces(net, s.x, s.R, s.v, m.work, s.f)
    coil_forces(net, s.x, s.R, s.v, m.coils, s.f)
    ground_forces(net, terrain, s.x, s.R, s.v, m.touch, s.f)
    for b in range(net.bodies):
        for p in range(3):
            s.f[b, p] += net.mass[b] * net.drag * s.v[b, p]
            s.f[b, 3 + p] += net.inertia[b] * net.drag * s.v[b, 3 + p]
        s.f[b, 0] -= net.mass[b] * g[0]
        s.f[b, 2] -= net.mass[b] * g[1]
    strip_forces(net, s.x, m.close, s.f)
    return core_forces(net, s.x, m.work, m.near, s.f), energy, loss


@lean
def begin(net: Net, terrain: Terrain, g: tuple[float, float], m: Motion) -> None:
    """Fill forces and accelerations of the present state: a body set down or let go has no past."""
    _, m.tally[ELASTIC], _ = forces(net, terrain, g, m, m.now)
    for b in range(net.bodies):
        for p in range(3):
            m.now.a[b, p] = -m.now.f[b, p] / net.mass[b]
            m.now.a[b, 3 + p] = -m.now.f[b, 3 + p] / net.inertia[b]
    for k in range(net.feet.size):
        for p in range(3):
            m.touch[k, PLACE_BEFORE + p] = m.touch[k, PLACE + p]


@lean
def correct(net: Net, m: Motion, cv: float, ca: float, near: bool) -> bool:
    """Write Newton's correction of places and spins; return False if the system is not positive."""
    m.blocks[:] = 0.0
    for b in range(net.bodies):
        block = net.pattern.diagonal[b]
        for p in range(3):
            m.blocks[block, p, p] = (ca + net.drag * cv) * net.mass[b]
            m.blocks[block, 3 + p, 3 + p] = (ca + net.drag * cv) * net.inertia[b]
    beam_tangent(net, cv, m.work, m.blocks)
    coil_tangent(net, cv, m.coils, m.blocks)
    ground_tangent(net, m.new.x, cv, m.touch, m.blocks)
    strip_tangent(net, m.new.x, m.close, m.blocks)
    if near:
        core_tangent(net, m.near, m.blocks)
    if not factor(net.pattern, m.blocks):
        return False
    solve(net.pattern, m.blocks, m.rhs, m.correction)
    return True


@lean
def residual(net: Net, method: Method, m: Motion) -> float:
    """Write minus the error of (I2), divided by 1 - a_f, to rhs; return its greatest entry [N]."""
    inertia, old = 1.0 / (1.0 - method.a_f), method.a_f / (1.0 - method.a_f)
    greatest = 0.0
    for b in range(net.bodies):
        for p in range(6):
            mass = net.mass[b] if p < 3 else net.inertia[b]
            mean = (1.0 - method.a_m) * m.new.a[b, p] + method.a_m * m.now.a[b, p]
            error = inertia * mass * mean + m.new.f[b, p] + old * m.now.f[b, p]
            m.rhs[b, p] = -error
            greatest = max(greatest, abs(error) if p < 3 else abs(error) / net.length)
    return greatest


@lean
def place(net: Net, m: Motion, method: Method, h: float) -> None:
    """Fill the new state from the change of the step, (I2)."""
    ca, cv = 1.0 / (method.beta * h * h), method.gamma / (method.beta * h)
    kv, ka = 1.0 - method.gamma / method.beta, h * (1.0 - 0.5 * method.gamma / method.beta)
    now, new = m.now, m.new
    for b in range(net.bodies):
        for p in range(6):
            change = m.change[b, p]
            new.v[b, p] = cv * change + kv * now.v[b, p] + ka * now.a[b, p]
            new.a[b, p] = ca * (change - h * now.v[b, p]) - (0.5 / method.beta - 1.0) * now.a[b, p]
        for p in range(3):
            new.x[b, p] = now.x[b, p] + m.change[b, p]
        turned(now.R, m.change, b, new.R)


@lean
def attempt(net: Net, terrain: Terrain, g: tuple[float, float], method: Method, m: Motion, h: float) -> bool:
    """Solve one step of length h for the new state; return False if it must be shorter."""
    ca = (1.0 - method.a_m) / ((1.0 - method.a_f) * method.beta * h * h)
    cv = method.gamma / (method.beta * h)
    for b in range(net.bodies):
        for p in range(6):
            m.change[b, p] = h * m.now.v[b, p] + 0.5 * h * h * m.now.a[b, p]
    list_close(net, m.now.x, m.now.v, h, m.close)
    enough = max(RESIDUAL, min(PART * net.weight, method.share * method.tolerance * ca * net.mass[0]))
    before, cuts = np.inf, 0
    for _ in range(ITERATIONS_MAX):
        place(net, m, method, h)
        near, energy, loss = forces(net, terrain, g, m, m.new)
        error = residual(net, method, m)
        m.tally[ITERATIONS] += 1.0
        if error < enough:
            m.tally[ELASTIC_NEXT], m.tally[LOSS_NEXT] = energy, loss
            return True
        if not error < before and cuts < CUTS_MAX:
            cuts += 1
            retreat(m)
            continue
        before, cuts = error, 0
        if not correct(net, m, cv, ca, near):
            return False
        for b in range(net.bodies):
            for p in range(6):
                m.change[b, p] += m.correction[b, p]
    return False


@lean
def retreat(m: Motion) -> None:
    """Take half of the last correction back."""
    for b in range(m.change.shape[0]):
        for p in range(6):
            m.correction[b, p] *= 0.5
            m.change[b, p] -= m.correction[b, p]


@lean
def local_error(net: Net, method: Method, m: Motion, h: float) -> float:
    """Return the estimated error of the new places [m]."""
    greatest = 0.0
    for b in range(net.bodies):
        for p in range(3):
            greatest = max(greatest, abs(m.new.a[b, p] - m.now.a[b, p]))
    return float(abs(method.beta - 1.0 / 6.0) * h * h * greatest)


@lean
def accept(net: Net, m: Motion, h: float) -> None:
    """Make the new state the present one and add the work of the step to the tallies."""
    tally, coils = m.tally, m.coils
    tally[GROUND_WORK] += ground_work(m)
    tally[CONTACTS] = settle_anchors(net, m.touch)
    for s in range(net.near.size):
        shortening = coils[LENGTH_BEFORE, s] - coils[LENGTH, s]
        tally[COIL_WORK] += 0.5 * (coils[PULL, s] + coils[PULL_BEFORE, s]) * shortening
        tally[PEAK_FORCE] = max(tally[PEAK_FORCE], coils[PULL, s])
        coils[LENGTH_BEFORE, s], coils[PULL_BEFORE, s] = coils[LENGTH, s], coils[PULL, s]
    drag = drag_loss(net, m.new)
    tally[BEND_LOSS] += 0.5 * h * (tally[LOSS_NEXT] + tally[BEND_RATE])
    tally[DRAG_LOSS] += 0.5 * h * (drag + tally[DRAG_RATE])
    tally[BEND_RATE], tally[DRAG_RATE], tally[ELASTIC] = tally[LOSS_NEXT], drag, tally[ELASTIC_NEXT]
    tally[TIME] += h
    tally[STEPS] += 1.0
    keep(m.now, m.new)


@lean
def keep(now: State, new: State) -> None:
    """Make the new state the present one."""
    for b in range(now.x.shape[0]):
        for p in range(3):
            now.x[b, p] = new.x[b, p]
            for q in range(3):
                now.R[b, p, q] = new.R[b, p, q]
        for p in range(6):
            now.v[b, p], now.a[b, p], now.f[b, p] = new.v[b, p], new.a[b, p], new.f[b, p]


@lean
def ground_work(m: Motion) -> float:
    """Return what the ground did on the body in the step [J]."""
    work, touch = 0.0, m.touch
    for k in range(touch.shape[0]):
        for p in range(3):
            mean = 0.5 * (touch[k, FORCE + p] + touch[k, FORCE_BEFORE + p])
            work += mean * (touch[k, PLACE + p] - touch[k, PLACE_BEFORE + p])
    return work


@lean
def drag_loss(net: Net, s: State) -> float:
    """Return the power that the air takes [W]."""
    power = 0.0
    for b in range(net.bodies):
        for p in range(3):
            power += net.drag * (net.mass[b] * s.v[b, p] ** 2 + net.inertia[b] * s.v[b, 3 + p] ** 2)
    return power


@lean
def march(
    net: Net, terrain: Terrain, g: tuple[float, float], method: Method, m: Motion, flight: Array, duration: float
) -> None:
    """Advance the body by exactly `duration` [s] at frozen phase of the coils, in as many steps as it takes."""
    left = duration
    while left > 0.0:
        h = min(left, m.tally[STEP])
        if h < left < 2.0 * h:
            h = 0.5 * left
        solved = attempt(net, terrain, g, method, m, h)
        error = local_error(net, method, m, h) if solved else np.inf
        if h > STEP_MIN and not error < 2.0 * method.tolerance:
            m.tally[REJECTED] += 1.0
            m.tally[STEP] = 0.5 * h
            continue
        m.tally[FORCED] += 0.0 if solved else 1.0
        accept(net, m, h)
        z, rises = centre(net, m.now.x, 2), rise_rate(net, m.now.v)
        watch_flight(flight, m.tally[TIME], m.tally[CONTACTS] > 0.0, lowest(m), z, rises, m.tally[ELASTIC])
        left -= h
        growth = min(2.0, 0.9 * (method.tolerance / max(error, 1e-12)) ** (1.0 / 3.0))
        if growth < 1.0 or h > 0.5 * m.tally[STEP]:
            m.tally[STEP] = min(method.longest, max(STEP_MIN, growth * h))
    straighten(m.now.R)
