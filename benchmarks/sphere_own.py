"""Runs the sphere in softrig's own solver: the same jump and the same spoke as `sphere_peers` runs in MuJoCo."""

from collections.abc import Callable
from dataclasses import replace
from itertools import product
from time import process_time

import numpy as np

from benchmarks.sphere_peers import BODY, COLD_M, END, GROUND, HOT_M, JUMP_S, LOOK_S, RAMP_S, SPRING_N_PER_M, Figures, G
from hil_sim.physics.compiled import bound
from hil_sim.physics.flight import no_flight
from hil_sim.physics.net.gauge import centre, rise_rate
from hil_sim.physics.net.mesh import SPHERE, Net, net_of, node_at
from hil_sim.physics.net.motion import begin, march
from hil_sim.physics.net.pulls import FREE, LENGTH, LENGTH_BEFORE, SOFT, measure
from hil_sim.physics.net.state import Motion, motion_of
from hil_sim.physics.state import method_of
from hil_sim.physics.tally import ITERATIONS, STEPS
from hil_sim.physics.terrain import terrain_of
from tests.net_rest import BOTTOM, TOP, NetRest

PLANE = terrain_of(GROUND, 0)
LONGEST_S = 1e-2
SPOKES = sorted(
    (way for way in product((-1, 0, 1), repeat=3) if 0 < np.abs(way).sum() < 3), key=lambda way: way != BOTTOM
)


def own_jump(nodes: int, tolerance: float, squash_m: float) -> tuple[float, float]:
    """Let go of a squash and return how far the centre of mass will rise [m], and the wall seconds a second."""
    rest, load_n, more_n = NetRest(BODY, nodes), 0.0, 0.05
    while more_n > 1e-6:  # the load that squashes as much
        squash = 2 * BODY.R - rest.settle(load_n + more_n)
        load_n, more_n = (load_n, 0.5 * more_n) if squash > squash_m else (load_n + more_n, more_n)
    rest.motion.coils[SOFT], rest.motion.coils[FREE] = 0.0, 1.0
    rest.motion.now.x[:, 2] -= lowest(rest.net, rest.motion)
    low = centre(rest.net, rest.motion.now.x, 2)
    wall = run(rest.net, rest.motion, tolerance, JUMP_S)
    rise = rise_rate(rest.net, rest.motion.now.v)
    return centre(rest.net, rest.motion.now.x, 2) - low + rise * abs(rise) / (2 * G), wall / JUMP_S


def lowest(net: Net, m: Motion) -> float:
    """Return the height of the lowest contact point [m]."""
    return float((m.now.x[net.feet, 2] + np.einsum("pj,pj->p", m.now.R[net.feet, 2], net.offsets)).min())


def run(
    net: Net, m: Motion, tolerance: float, seconds: float, look: Callable[[float], None] = lambda share: None
) -> float:
    """Move the body for a time, and return the processor time it took [s]; look is called before each part of it."""
    begin(net, PLANE, (0.0, -G), m)
    parts = (net, PLANE, (0.0, -G), method_of(0.5, tolerance, LONGEST_S), m, no_flight())
    step, wall = bound(march, *parts, 0.0), 0.0
    for part in range(1, round(seconds / LOOK_S) + 1):
        look(part * LOOK_S / seconds)
        start = process_time()
        step(*parts, LOOK_S)
        wall += process_time() - start
    return wall


def own_tighten(nodes: int, tolerance: float) -> tuple[Figures, float]:
    """Tighten the spoke to the ground; return mean squash and height at the end [m], and the wall seconds a second."""
    net = net_of(replace(BODY, nodes=nodes), GROUND, SPHERE, SPOKES)
    places = np.vstack([BODY.R * net.directions, np.zeros((1, 3))]) + np.array([0.0, 0.0, BODY.R])
    m, seen = motion_of(net, places, np.tile(np.eye(3), (net.bodies, 1, 1))), []
    top, bottom = (node_at(net.directions, way) for way in (TOP, BOTTOM))
    m.coils[SOFT], m.coils[FREE] = SPRING_N_PER_M, COLD_M
    for coil in range(len(SPOKES)):
        measure(net, m.now.x, m.now.R, m.coils, coil)
    m.coils[LENGTH_BEFORE] = m.coils[LENGTH]

    def tighten(share: float) -> None:
        m.coils[FREE, 0] = COLD_M + (HOT_M - COLD_M) * share
        seen.append((2 * BODY.R - float(np.linalg.norm(m.now.x[top] - m.now.x[bottom])), centre(net, m.now.x, 2)))

    wall = run(net, m, tolerance, RAMP_S, tighten)
    tighten(1.0)
    return tuple(np.mean(seen[-END:], axis=0)), wall / RAMP_S


def own_step_us(nodes: int, hoops: int) -> tuple[float, float]:
    """Return the cost of one step and of one iteration of Newton's method, of hoops that touch nothing [us]."""
    net = net_of(replace(BODY, nodes=nodes, m_core=1e-6), GROUND, SPHERE[:hoops], [])
    places = np.vstack([BODY.R * net.directions, np.zeros((1, 3))]) + np.array([0.0, 0.0, 1.0])
    m = motion_of(net, places, np.tile(np.eye(3), (net.bodies, 1, 1)))
    m.now.v[node_at(net.directions, TOP), 2] = -1.0
    wall = run(net, m, 1e-7, 0.1)
    return 1e6 * wall / m.tally[STEPS], 1e6 * wall / m.tally[ITERATIONS]
