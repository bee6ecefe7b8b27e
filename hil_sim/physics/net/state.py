"""The state of a moving net, the scratch of its solver, and what is counted on the way."""

from typing import NamedTuple

import numpy as np

from hil_sim.physics.compiled import Array
from hil_sim.physics.net.apart import none_close
from hil_sim.physics.net.beam import WORK_COLUMNS
from hil_sim.physics.net.ground import TOUCH_COLUMNS
from hil_sim.physics.net.inside import NEAR_COLUMNS
from hil_sim.physics.net.mesh import Ints, Net
from hil_sim.physics.net.pulls import COIL_ROWS
from hil_sim.physics.tally import STEP, TALLIES


class State(NamedTuple):
    """Places, rotations, velocities with spins, accelerations and force gradients of all bodies."""

    x: Array  # (B, 3) [m]
    R: Array  # (B, 3, 3) [1]
    v: Array  # (B, 6) [m/s, rad/s]
    a: Array  # (B, 6) [m/s2, rad/s2]
    f: Array  # (B, 6) [N, N m]


class Motion(NamedTuple):
    """State and scratch of one body."""

    now: State
    new: State
    change: Array  # displacement and rotation vector of the step (B, 6) [m, rad]
    touch: Array  # (P, TOUCH_COLUMNS)
    coils: Array  # (COIL_ROWS, S)
    tally: Array
    work: Array  # (E, WORK_COLUMNS)
    near: Array  # (E, NEAR_COLUMNS)
    close: Ints  # pairs of elements that may touch, see `apart`
    blocks: Array  # (slots, 6, 6)
    rhs: Array  # (B, 6)
    correction: Array  # (B, 6)
    attitude: Array  # of the hoops at last look (3, 3) [1]
    seen: Array  # room for the next (3, 3) [1]


def state_of(bodies: int) -> State:
    """Return a state at rest with all bodies at the origin."""
    turns = np.tile(np.eye(3), (bodies, 1, 1))
    return State(np.zeros((bodies, 3)), turns, *(np.zeros((bodies, 6)) for _ in range(3)))


def motion_of(net: Net, x: Array, R: Array) -> Motion:
    """Return the state of a body at rest at places x (B, 3) turned by R (3, 3), not yet touching anything."""
    count, points = net.bodies, net.feet.size
    now = state_of(count)
    now.x[:] = x
    now.R[:] = R
    tally = np.zeros(TALLIES)
    tally[STEP] = 1e-4
    return Motion(
        now, state_of(count), np.zeros((count, 6)), np.zeros((points, TOUCH_COLUMNS)),
        np.zeros((COIL_ROWS, net.near.size)), tally,
        np.zeros((net.beams.size, WORK_COLUMNS)), np.zeros((net.beams.size, NEAR_COLUMNS)), none_close(),
        np.zeros((net.pattern.slots, 6, 6)), np.zeros((count, 6)), np.zeros((count, 6)), np.array(R), np.array(R),
    )  # fmt: skip
