"""A body that does not move: its coils heat, transform, change their resistance and cool at the lengths they had.

Heat and phase are those of every other body; only the shell is not solved, which is nearly all of the time that a
bench takes. For what asks about firmware, line and supply and not about motion: `body=still` in an address.

    plant = still(RingPlant(load("circular")))
    plant.advance(5000, power_w)
    plant.observe()["travel_mm"]           # 0.0, for ever
"""

from typing import TypeVar

import numpy as np

from hil_sim.bodies.coilbody import CoilBody
from hil_sim.physics import coil
from hil_sim.physics.body import COIL_STEP
from hil_sim.physics.coilset import Coils, CoilState
from hil_sim.physics.compiled import Array, lean, prepare
from hil_sim.physics.tally import PEAK_FORCE, PEAK_T, TIME

Body = TypeVar("Body", bound=CoilBody)


def still(body: Body) -> Body:
    """Return the same body, which from here on keeps the shape that it has."""
    prepare(advance, coil.advance)
    body.hold(advance)
    return body


@lean
def advance(coils: Coils, state: CoilState, lengths: Array, pulls: Array, tally: Array, P: Array, dt: float) -> None:
    """Heat and cool the coils for dt [s] with power P [W] in each, at fixed lengths [m]; bring pulls [N] up to date."""
    steps = int(np.ceil(dt / COIL_STEP - 1e-9))
    for _ in range(steps):
        coil.advance(state, dt / steps, P, lengths, coils)
    tally[TIME] += dt
    for i in range(state.T.size):
        pulls[i] = state.F[i]
        tally[PEAK_T] = max(tally[PEAK_T], state.T[i])
        tally[PEAK_FORCE] = max(tally[PEAK_FORCE], pulls[i])
