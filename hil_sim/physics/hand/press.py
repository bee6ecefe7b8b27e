r"""What two tips do to the object and to their joints where they are.

A tip that does not touch does nothing, nor does one that has gone over an end of its face until it has withdrawn from
it: no tip comes back on a face from its side (ASSUMED). The finger exerts on its joint, by the virtual work of (F3) of
`fingertip` over the depth, the tilt and the rolled way,

.. math::  \tau = N s \, n \cdot C' + M - T \{ s \, t \cdot C' - (a - d) \}                                       (L1)

Derived here. Checked in tests/test_physics_hand_grasp.py, tests/test_physics_hand_tangential.py and
tests/test_physics_hand_ends.py.
"""

from math import cos, sin

from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.hand.fingertip import springs
from hil_sim.physics.hand.geometry import meet, sweep
from hil_sim.physics.hand.numbers import FRICTIONLESS, Fingers
from hil_sim.physics.hand.state import (
    ALONG,
    ENERGY,
    LOAD,
    MOMENT,
    NORMAL,
    PAST_R,
    PSI,
    Q_R,
    SLIDE_R,
    THETA,
    D,
    X,
    Y,
)


@lean
def press(f: Fingers, state: Array, read: Array) -> bool:
    r"""Read depths, forces, loads and energy of the tips; return whether both touch the object.

    Parameters
    ----------
    f : Fingers
        Numbers of the fingers [SI]
    state : array (19,)
        State of the hand [SI]
    read : array (16,)
        What is read, in the order of `state` [SI]

    Returns
    -------
    bool
        Whether both tips touch [1]
    """
    read[ENERGY] = 0.0
    for i in range(2):
        s, q = 1.0 - 2.0 * i, state[Q_R + i]
        d, theta, _ = meet(f, s, q, state[X], state[Y], state[PSI])
        d = min(d, 0.0) if state[PAST_R + i] > 0.0 else d
        d_t = 0.0 if f.contact == FRICTIONLESS or not d > 0.0 else state[SLIDE_R + i]
        U, N, M, T, _, _, _, _, _, _ = springs(f.b, f.E, f.k, max(d, 0.0), theta, d_t)
        if f.contact == FRICTIONLESS:
            T = 0.0  # the springs are guided: what (F3) has here is carried by the plate
        read[D + i], read[THETA + i], read[NORMAL + i], read[MOMENT + i], read[ALONG + i] = d, theta, N, M, T
        read[LOAD + i] = torque(f, s, q, state[PSI], d, N, M, T)
        read[ENERGY] += U
    return bool(read[D] > 0.0 and read[D + 1] > 0.0)


@lean
def passed(f: Fingers, i: int, d: float, sigma: float, state: Array) -> bool:
    r"""Return whether a tip has gone over an end of its face and not withdrawn since, and note it in the state.

    Parameters
    ----------
    f : Fingers
        Numbers of the fingers [SI]
    i : int
        0 for the right tip, 1 for the left one [1]
    d : float
        Displacement of the tip where its face is [m]
    sigma : float
        Place of the tip along the face, from its middle [m]
    state : array (19,)
        State of the hand [SI]

    Returns
    -------
    bool
        Whether it touches nothing though d may be above 0 [1]
    """
    if not d > 0.0:
        state[PAST_R + i] = 0.0
    elif f.h > 0.0 and abs(sigma) > 0.5 * f.h:
        state[PAST_R + i] = 1.0
    return bool(state[PAST_R + i] > 0.0)


@lean
def torque(f: Fingers, s: float, q: float, psi: float, d: float, N: float, M: float, T: float) -> float:
    r"""Return the torque that a finger exerts on its joint, equation (L1).

    Parameters
    ----------
    f : Fingers
        Numbers of the fingers [SI]
    s : float
        +1 for the right finger, -1 for the left [1]
    q : float
        Angle of its joint [rad]
    psi : float
        Orientation of the object [rad]
    d : float
        Displacement of the tip [m]
    N : float
        Normal force [N]
    M : float
        Moment [N m]
    T : float
        Force along the face [N]

    Returns
    -------
    float
        Torque, counter-clockwise [N m]
    """
    x, y = sweep(f, s, q)
    across, along = cos(psi) * x + sin(psi) * y, cos(psi) * y - sin(psi) * x
    return N * s * across + M - T * (s * along - (f.a - d))
