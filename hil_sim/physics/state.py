"""The state of a moving ring, the scratch of its solver, and the numbers of the time step."""

from typing import NamedTuple

import numpy as np

from hil_sim.physics.banded import BAND, BORDER
from hil_sim.physics.compiled import Array
from hil_sim.physics.contact import GROUND_ROWS
from hil_sim.physics.corners import CORNER_ROWS
from hil_sim.physics.flight import no_flight
from hil_sim.physics.ring import BLOCK_ROWS, RIM_ROWS, Ring
from hil_sim.physics.spokes import SPOKE_ROWS
from hil_sim.physics.tally import STEP, TALLIES
from hil_sim.physics.touch import Pairs, no_pairs

STEP_MAX = 5e-3  # [s]
TOLERANCE = 2e-6  # [m]


class Method(NamedTuple):
    """Numbers of the time step: factors of (I1), tolerance of a step [m], longest step [s], share left to Newton."""

    a_m: float
    a_f: float
    beta: float
    gamma: float
    tolerance: float
    longest: float
    share: float


class Motion(NamedTuple):
    """State and scratch of one body; rows of `now` and `new` are q, v, a and f over the unknowns."""

    now: Array
    new: Array
    ground: Array
    corners: Array
    spokes: Array
    tally: Array
    flight: Array
    rim: Array
    blocks: Array
    hub: Array
    vectors: Array
    band: Array
    border: Array
    corner: Array
    pairs: Pairs


def method_of(rho: float = 0.8, tolerance: float = TOLERANCE, longest: float = STEP_MAX, share: float = 1e-3) -> Method:
    """Return the factors of (I1) for the damping `rho` of the highest frequency, 0 <= rho <= 1.

    `share` of the tolerated error is what Newton's method may leave; 0 stands for the least that makes sense.
    """
    a_m, a_f = (2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0)
    return Method(a_m, a_f, 0.25 * (1.0 - a_m + a_f) ** 2, 0.5 - a_m + a_f, tolerance, longest, share)


def motion_of(ring: Ring, q: Array) -> Motion:
    """Return the state of a body at rest at q, not yet touching anything."""
    n, size = ring.nodes, 2 * ring.nodes + 3
    now = np.zeros((4, size))
    now[0] = q
    tally = np.zeros(TALLIES)
    tally[STEP] = 1e-4
    return Motion(
        now, np.zeros((4, size)), np.zeros((GROUND_ROWS, n)),
        np.zeros((CORNER_ROWS, ring.terrain.x.size)), np.zeros((SPOKE_ROWS, ring.feet.size)), tally, no_flight(),
        np.zeros((RIM_ROWS, n + 2)), np.zeros((BLOCK_ROWS, n)), np.zeros((3, 3)), np.zeros((4, size)),
        np.zeros((size, BAND)), np.zeros((size, BORDER)), np.zeros((7, BORDER)), no_pairs(),
    )  # fmt: skip
