r"""How far a tip's face can be displaced along itself before it slips.

With r = d_t / d and the tips of `fingertip` (F3), normal force and force along the face are, over pi E d^2,

.. math::  N = 1 + b \tan^2 \theta + 2 b r \tan \theta + k r^2, \quad T = 2 k r + b \tan \theta                    (C1)

so the bounds r_s of |T| = mu N in the directions s = +1 and -1 are the near roots of

.. math::  \mu k r_s^2 - 2 s (k - \mu s b \tan \theta) r_s + \mu (1 + b \tan^2 \theta) - s b \tan \theta = 0      (C2)

A displacement beyond is brought back to its bound (return mapping). Where the roots are not real, from mu = 1 on for a
level face, the normal force grows with the shear so fast that the tip never slips. With both tips slipping the forces
do not depend on where the object is along its faces: of what a displacement is beyond its bound 1e-3 is kept,
which makes both slip alike and errs in T by as little of what one step slips, however many there are (ASSUMED:
numerical).

Source: Coulomb's law and return mapping, standard; (C1) and (C2) are derived here. Checked in
tests/test_physics_hand_tangential.py.
"""

from math import inf, sqrt, tan

from hil_sim.physics.compiled import lean
from hil_sim.physics.hand.numbers import Fingers

KEPT = 1e-3
NEAR = 1e-12


@lean
def bound(f: Fingers, s: float, theta: float) -> tuple[float, float]:
    r"""Return the displacement at which a tip slips, over its depth, equation (C2), and its derivative by theta.

    Parameters
    ----------
    f : Fingers
        Numbers of the fingers [SI]
    s : float
        Direction, +1 or -1 [1]
    theta : float
        Orientation of the face relative to the tip [rad]

    Returns
    -------
    tuple of float
        s r_s, infinite where it never slips [1], and its derivative [1/rad]
    """
    t = tan(theta)
    half = f.k - f.mu * s * f.b * t
    last = f.mu * (1.0 + f.b * t * t) - s * f.b * t
    root = half * half - f.mu * f.k * last
    if root <= NEAR or half <= 0.0:
        return inf, 0.0
    reach = last / (half + sqrt(root))
    slope = f.b * (2.0 * f.mu * (s * reach + t) - s) / (2.0 * sqrt(root))
    return reach, slope * (1.0 + t * t)


@lean
def slipped(f: Fingers, d: float, theta: float, d_t: float) -> tuple[float, float, float, float]:
    r"""Return the displacement of a face after slip, and its derivatives by d, theta and that before.

    Parameters
    ----------
    f : Fingers
        Numbers of the fingers [SI]
    d : float
        Displacement of the tip [m]
    theta : float
        Orientation of the face relative to the tip [rad]
    d_t : float
        Displacement of the face along itself if it sticks [m]

    Returns
    -------
    tuple of float
        d_t [m], by d [1], by theta [m/rad], by d_t: 1 where it sticks [1]
    """
    if f.mu == inf:
        return d_t, 0.0, 0.0, 1.0
    for s in (1.0, -1.0):
        reach, slope = bound(f, s, theta)
        if s * d_t > d * reach:
            gone = 1.0 - KEPT
            return s * gone * d * reach + KEPT * d_t, s * gone * reach, s * gone * d * slope, KEPT
    return d_t, 0.0, 0.0, 1.0
