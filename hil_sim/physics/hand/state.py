"""The state of a hand, and what can be read of it, as the kernels keep them in two flat arrays."""

import numpy as np

from hil_sim.physics.compiled import Array

X, Y, PSI, SLIDE_R, SLIDE_L, Q_R, Q_L = range(7)  # the slides are d_t of the tips
RATES = 7  # here the speeds of the same begin
GRIPPED, JAM_R, JAM_L = range(14, 17)  # 0 or 1; an object that is not gripped stands on its stand
PAST_R, PAST_L = 17, 18  # 1: the tip has gone over an end of its face, and touches nothing until it has withdrawn
STATE = 19

# What is read: of the right finger here, of the left one in the next place.
D, THETA, NORMAL, MOMENT, ALONG, LOAD, MOTOR = range(0, 14, 2)
ENERGY, STIFFNESS = 14, 15
READ = 16


def lying(L: float, q_r: float, q_l: float) -> Array:
    r"""Return a hand at rest and its object on the stand, in the middle at the height of upright fingers.

    Parameters
    ----------
    L : float
        That height [m]
    q_r : float
        Angle of the right joint [rad]
    q_l : float
        Angle of the left joint [rad]

    Returns
    -------
    array (19,)
        The state [SI]
    """
    state = np.zeros(STATE)
    state[Y] = L
    state[[Q_R, Q_L]] = q_r, q_l
    return state
