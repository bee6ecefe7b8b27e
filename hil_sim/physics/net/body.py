r"""The whole plant of a net in one kernel: coils heat and transform, then the body moves, in turns.

As in `body` of the ring: in each turn the phase advances in steps of at most 1 ms at the length the body last had,
and the body then moves for the same time at frozen phase. Rolling is the rotation of the hoops as a whole about the
sideways axis of the plane, summed up from look to look.
"""

import numpy as np

from hil_sim.physics import coil
from hil_sim.physics.body import COIL_STEP, World, gravity
from hil_sim.physics.coilset import Coils, CoilState
from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.net.gauge import attitude, centre, lowest
from hil_sim.physics.net.mesh import Net
from hil_sim.physics.net.motion import march
from hil_sim.physics.net.pulls import LENGTH, freeze
from hil_sim.physics.net.state import Motion
from hil_sim.physics.state import Method
from hil_sim.physics.tally import APEX, CLEARANCE, PEAK_T, STEP, TILT_WORK, TIME, TURN
from hil_sim.physics.terrain import Terrain


@lean
def advance(
    net: Net, terrain: Terrain, coils: Coils, state: CoilState, world: World, method: Method, m: Motion,
    flight: Array, P: Array, duration: float,
) -> None:  # fmt: skip
    """Advance coils and body by exactly `duration` [s] with power P [W] in each coil."""
    left = duration
    while left > 0.0:
        h = min(left, m.tally[STEP])
        if h < left < 2.0 * h:
            h = 0.5 * left
        turns = int(np.ceil(h / COIL_STEP - 1e-9))
        for _ in range(turns):
            coil.advance(state, h / turns, P, m.coils[LENGTH], coils)
        freeze(coils, state.xi, m.coils)
        g = gravity(world, m.tally[TIME] + h)
        tilt(net, world, m, g)
        march(net, terrain, g, method, m, flight, h)
        left -= h
    watch(net, state, m)


@lean
def rolled(last: Array, seen: Array) -> float:
    """Return the part about the y axis of the small turn from the last attitude to that seen, now the last [rad]."""
    spin = 0.0
    for q in range(3):
        spin += last[2, q] * seen[0, q] - last[0, q] * seen[2, q]
    for p in range(3):
        for q in range(3):
            last[p, q] = seen[p, q]
    return 0.5 * spin


@lean
def tilt(net: Net, world: World, m: Motion, g: tuple[float, float]) -> None:
    """Add to the tally what turning gravity to g does to the potential energy of the body."""
    before = gravity(world, m.tally[TIME])
    if before[0] != g[0]:
        for b in range(net.bodies):
            way = (g[0] - before[0]) * m.now.x[b, 0] + (g[1] - before[1]) * m.now.x[b, 2]
            m.tally[TILT_WORK] -= net.mass[b] * way


@lean
def watch(net: Net, state: CoilState, m: Motion) -> None:
    """Bring rolling, greatest heights and the greatest temperature up to date."""
    tally = m.tally
    attitude(net, m.now.x, m.seen)
    tally[TURN] += rolled(m.attitude, m.seen)
    tally[APEX] = max(tally[APEX], centre(net, m.now.x, 2))
    tally[CLEARANCE] = max(tally[CLEARANCE], lowest(m))
    for i in range(state.T.size):
        tally[PEAK_T] = max(tally[PEAK_T], state.T[i])
