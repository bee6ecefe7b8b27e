r"""The whole plant of a ring robot in one kernel: coils heat and transform, then the body moves, in turns.

In each turn the phase advances in steps of at most 1 ms at the length the body last had, and the body then moves for
the same time at frozen phase (`motion.march`). A turn is as long as the body's own step: 5 ms at rest, 0.1 ms in a
snap. Taking the length and not the force from the body keeps this stable: at given force the phase of a stressed coil
runs away.

Source: staggered scheme, derived here; that its step does not matter is checked in tests/test_physics_ring_crawl.py.
The plane is y = 0 with x along it, up the slope; gravity turns. It may be tilted while things lie on it, and is level
before, for ever where t_0 is infinite:

.. math::  \theta(t) = \theta_1 \, \mathrm{smooth}\left(\frac{t - t_0}{t_1}\right), \quad
           g = 9.81 \, (-\sin \theta, -\cos \theta)                                                              (B1)
"""

from typing import NamedTuple, cast

import numpy as np

from hil_sim.physics import coil
from hil_sim.physics.coilset import Coils, CoilState
from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.contact import PUSH_X, PUSH_Y
from hil_sim.physics.flight import watch_flight
from hil_sim.physics.gauge import centre, rim_energy, turned
from hil_sim.physics.motion import march
from hil_sim.physics.ring import Ring
from hil_sim.physics.spokes import LENGTH, freeze
from hil_sim.physics.state import Method, Motion
from hil_sim.physics.tally import APEX, CLEARANCE, PEAK_T, STEP, TILT_WORK, TIME, TURN
from hil_sim.physics.terrain import surface

COIL_STEP = 1e-3  # [s]


def packed(coils: Coils) -> Coils:
    """Return the same constants as one array of records: kernels take that in at a tenth of the cost of many arrays."""
    table = np.zeros(coils.T_amb.size, dtype=[(name, np.float64) for name in Coils._fields])
    for name in Coils._fields:
        table[name] = getattr(coils, name)
    return cast(Coils, table)


class World(NamedTuple):
    """Gravity [m/s2], final slope [rad], when the plane begins to tilt, or infinity, and for how long it does [s]."""

    gravity: float
    slope: float
    tilt_from: float
    tilt_for: float


@lean
def gravity(world: World, t: float) -> tuple[float, float]:
    """Return gravity along and across the plane at time t (B1) [m/s2]."""
    part = 1.0
    if world.tilt_for > 0.0:
        part = min(1.0, max(0.0, (t - world.tilt_from) / world.tilt_for))
    angle = world.slope * part * part * (3.0 - 2.0 * part)
    return -world.gravity * np.sin(angle), -world.gravity * np.cos(angle)


@lean
def advance(
    ring: Ring, coils: Coils, state: CoilState, world: World, method: Method, m: Motion, P: Array, duration: float
) -> None:
    """Advance coils and body by exactly `duration` [s] with power P [W] in each coil."""
    left = duration
    while left > 0.0:
        h = min(left, m.tally[STEP])
        if h < left < 2.0 * h:
            h = 0.5 * left
        turns = int(np.ceil(h / COIL_STEP - 1e-9))
        for _ in range(turns):
            coil.advance(state, h / turns, P, m.spokes[LENGTH], coils)
        freeze(coils, state.xi, m.spokes)
        gx, gy = gravity(world, m.tally[TIME] + h)
        tilt(ring, world, m, gx, gy)
        march(ring, gx, gy, method, m, h)
        watch_height(ring, m)
        left -= h
    watch(ring, state, m)


@lean
def tilt(ring: Ring, world: World, m: Motion, gx: float, gy: float) -> None:
    """Add to the tally what turning gravity to gx, gy does to the potential energy of the body."""
    before_x, before_y = gravity(world, m.tally[TIME])
    if before_x != gx:
        x, y = centre(ring, m.now[0])
        mass = ring.mass[0] * ring.nodes + ring.mass[2 * ring.nodes]
        m.tally[TILT_WORK] -= mass * ((gx - before_x) * x + (gy - before_y) * y)


@lean
def watch_height(ring: Ring, m: Motion) -> None:
    """Bring the greatest heights and the highest flight up to date."""
    q, tally, terrain = m.now[0], m.tally, ring.terrain
    _, height = centre(ring, q)
    _, rises = centre(ring, m.now[1])
    lowest, touches = np.inf, False
    for i in range(ring.nodes):
        lowest = min(lowest, q[2 * i + 1] - surface(terrain, q[2 * i]))
        touches = touches or m.ground[PUSH_X, i] != 0.0 or m.ground[PUSH_Y, i] != 0.0
    tally[APEX] = max(tally[APEX], height)
    tally[CLEARANCE] = max(tally[CLEARANCE], lowest)
    watch_flight(m.flight, tally[TIME], touches, lowest, height, rises, rim_energy(ring, q))


@lean
def watch(ring: Ring, state: CoilState, m: Motion) -> None:
    """Bring the greatest temperature and the unwrapped rotation up to date."""
    q, tally = m.now[0], m.tally
    change = turned(ring, q) - tally[TURN]
    tally[TURN] += change - 2.0 * np.pi * np.round(0.5 * change / np.pi)
    for i in range(state.T.size):
        tally[PEAK_T] = max(tally[PEAK_T], state.T[i])
