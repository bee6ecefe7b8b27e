r"""Where the tips are, and how deep and tilted each meets a face of the object.

x points right and y up; angles are counter-clockwise. The joints stand at (+B, 0) and (-B, 0), links point up at
q = 0, and the middle of a tip's plate lies at the end of its link, e inward from the link's line. With s = +1 for the
right finger and -1 for the left, and R(q) the rotation by q,

.. math::  C = (s B, 0) + R(q) \, (-s e, L), \quad C' = R(q) \, (-L, -s e)                                        (G1)

The object has two parallel faces w apart, its pose is (x, y, psi), n = (cos psi, sin psi) is the normal of its faces,
t = (-sin psi, cos psi) runs along them, and r = C - (x, y):

.. math::  d = a + w / 2 - s \, n \cdot r, \quad \theta = \psi - q, \quad \sigma = t \cdot r                      (G2)

Source: Hirai, figures 10 and 12, which give no coordinates. ASSUMED: these axes, both fingers equal, rigid links.
Checked in tests/test_physics_hand_grasp.py.
"""

from math import cos, sin

from hil_sim.physics.compiled import lean
from hil_sim.physics.hand.numbers import Fingers


@lean
def centre(f: Fingers, s: float, q: float) -> tuple[float, float]:
    r"""Return the middle of a tip's plate, equation (G1).

    Parameters
    ----------
    f : Fingers
        Numbers of the fingers [SI]
    s : float
        +1 for the right finger, -1 for the left [1]
    q : float
        Angle of its joint [rad]

    Returns
    -------
    tuple of float
        x [m], y [m]
    """
    return s * (f.B - f.e * cos(q)) - f.L * sin(q), f.L * cos(q) - s * f.e * sin(q)


@lean
def sweep(f: Fingers, s: float, q: float) -> tuple[float, float]:
    r"""Return how the middle of a tip's plate moves with its joint, the second of (G1).

    Parameters
    ----------
    f : Fingers
        Numbers of the fingers [SI]
    s : float
        +1 for the right finger, -1 for the left [1]
    q : float
        Angle of its joint [rad]

    Returns
    -------
    tuple of float
        dx/dq [m], dy/dq [m]
    """
    return s * f.e * sin(q) - f.L * cos(q), -f.L * sin(q) - s * f.e * cos(q)


@lean
def meet(f: Fingers, s: float, q: float, x: float, y: float, psi: float) -> tuple[float, float, float]:
    r"""Return how a tip meets its face, equation (G2).

    Parameters
    ----------
    f : Fingers
        Numbers of the fingers [SI]
    s : float
        +1 for the right finger, -1 for the left [1]
    q : float
        Angle of its joint [rad]
    x : float
        Middle of the object [m]
    y : float
        Middle of the object [m]
    psi : float
        Orientation of the object [rad]

    Returns
    -------
    tuple of float
        Displacement d [m], relative orientation theta [rad], place along the face sigma [m]
    """
    cx, cy = centre(f, s, q)
    n_x, n_y = cos(psi), sin(psi)
    d = f.a + 0.5 * f.w - s * (n_x * (cx - x) + n_y * (cy - y))
    return d, psi - q, n_x * (cy - y) - n_y * (cx - x)
