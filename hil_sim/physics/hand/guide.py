r"""The guide of an object that moves without friction: along its faces nothing else holds it (ASSUMED).

It keeps the object's middle level with the middle of the two tips' centres X_m, so that only its place c across the
faces and psi are left,

.. math::  X = X_m + c \, n, \quad \dot X = \dot X_m + \dot c \, n + c \, \dot\psi \, t                             (D3)

and a state between `enter` and `leave` holds c and n . X' in the places of x and its speed. The guide takes gravity
and the inertia that acts along the faces. Derived here; checked in tests/test_physics_hand_motion.py.
"""

from math import cos, sin

from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.hand.geometry import centre, sweep
from hil_sim.physics.hand.numbers import Fingers
from hil_sim.physics.hand.state import PSI, Q_R, RATES, X, Y


@lean
def enter(f: Fingers, state: Array) -> None:
    """Replace x and y of a guided object by its place across the faces from the tips' middle [m], so its speed."""
    x, y, _, _ = middle(f, state)
    n_x, n_y = cos(state[PSI]), sin(state[PSI])
    state[X], state[Y] = n_x * (state[X] - x) + n_y * (state[Y] - y), 0.0
    state[RATES + X], state[RATES + Y] = n_x * state[RATES + X] + n_y * state[RATES + Y], 0.0


@lean
def leave(f: Fingers, state: Array) -> None:
    """Replace the place of a guided object across its faces by x and y again."""
    x, y, v_x, v_y = middle(f, state)
    n_x, n_y, c = cos(state[PSI]), sin(state[PSI]), state[X]
    across, along = state[RATES + X], n_x * v_y - n_y * v_x + c * state[RATES + PSI]
    state[X], state[Y] = x + c * n_x, y + c * n_y
    state[RATES + X], state[RATES + Y] = across * n_x - along * n_y, across * n_y + along * n_x


@lean
def middle(f: Fingers, state: Array) -> tuple[float, float, float, float]:
    r"""Return the middle of the two tips' centres and its speed.

    Parameters
    ----------
    f : Fingers
        Numbers of the fingers [SI]
    state : array (19,)
        State of the hand [SI]

    Returns
    -------
    tuple of float
        x [m], y [m], dx/dt [m/s], dy/dt [m/s]
    """
    x = y = v_x = v_y = 0.0
    for i in range(2):
        c_x, c_y = centre(f, 1.0 - 2.0 * i, state[Q_R + i])
        to_x, to_y = sweep(f, 1.0 - 2.0 * i, state[Q_R + i])
        x, y = x + 0.5 * c_x, y + 0.5 * c_y
        v_x, v_y = v_x + 0.5 * to_x * state[RATES + Q_R + i], v_y + 0.5 * to_y * state[RATES + Q_R + i]
    return x, y, v_x, v_y
