r"""Two soft fingers hold an object without friction: where it rests, by Newton's method on the energy.

Without friction only p = n . (x, y), the place across the faces, and psi enter the energy U = U_r + U_l of the tips,
so the place *along* the faces is undetermined: the Hessian over (x, y, psi) has an eigenvalue that is exactly zero. It
is reported as undetermined, by the convention that the object's middle is level with the middle of the two tips. With
the depths and tilts of `geometry` (G2), sigma_i = t . C_i and s = +1, -1,

.. math::  U_p = N_r - N_l, \quad U_\psi = -N_r \sigma_r + N_l \sigma_l + M_r + M_l                               (G3)

and the Hessian follows in closed form. The start and the safety of the iteration come from a reduction that is
derived here. For a given psi the first of (G3) is solved by d_i = D g_i / (g_r + g_l) with g = cos(theta) for the nail
tip and 1 for the radial one, D = 2 a + w - R cos(psi - beta), R and beta length and direction of the line between the
tips' centres. What is left has the slope

.. math::  \frac{d \ln U}{d \psi} = \frac{3 R \sin(\psi - \beta)}{D} + 2 b \tan(\psi - u), \quad
           u = \tfrac12 (q_r + q_l)                                                                               (G4)

of opposite signs at beta and at u: the object comes to rest between the line of the centres, which would turn it
against the fingers, and the fingers' own direction, to which the nail effect (b = 1) pulls; a radial tip (b = 0) lets
it follow the line of the centres. Newton's steps are kept in that bracket, so they cannot fail. For small swings (G4)
is the gain law, free of E, with d the depth of the grip:

.. math::  \frac{d\psi}{dq} = -\frac{d + 3 e}{3 a + 1.5 w - d}, \quad B = a + \tfrac12 w + e                        (G5)

Source: Hirai, section 3.3. Gravity does not enter: nothing could carry the object along the faces. Checked in
tests/test_physics_hand_grasp.py.
"""

from collections.abc import Sequence
from math import atan2, cos, degrees, hypot, isinf, pi, sin, tan
from typing import Any, NamedTuple

import numpy as np

from hil_sim.physics.compiled import Array, kernel, lean, prepare
from hil_sim.physics.hand.fingertip import FINGERS, ContactLost, HandError, NoEquilibrium, deepest, refusal, springs
from hil_sim.physics.hand.geometry import centre, meet, sweep
from hil_sim.physics.hand.numbers import Fingers, HandNumbers, fingers_of

HELD, LOST_R, LOST_L, DEEP_R, DEEP_L, RESTLESS, SLIDES, OVER_R, OVER_L = range(9)
PRECISION = 1e-9  # [rad] and of the radius: the step after which Newton's next would be below rounding
ITERATIONS_MAX = 60


class Grasp(NamedTuple):
    """Where the object rests: arrays over the poses, those of the fingers (poses, 2) with R first."""

    x: Array  # [m]
    y: Array  # by convention: along the faces the place is undetermined [m]
    psi: Array  # [rad]
    d: Array  # [m]
    theta: Array  # [rad]
    N: Array  # [N]
    M: Array  # [N m]
    torque: Array  # that the object exerts on each joint [N m]
    U: Array  # [J]
    K_psi: Array  # rotational stiffness of the grip, the object free to shift [N m/rad]
    iterations: Array  # of Newton's method [1]
    along: str = "undetermined"


def grasp(numbers: HandNumbers, q_r: Any, q_l: Any) -> Grasp:
    r"""Return where the object rests for each pose of the joints, without friction.

    Parameters
    ----------
    numbers : HandNumbers
        Numbers of the hand; its contact and motion do not matter here [SI]
    q_r : array_like (n,)
        Angle of the right joint [rad]
    q_l : array_like (n,)
        Angle of the left joint [rad]

    Returns
    -------
    Grasp
        Pose, depths, forces, energy and stiffness, one row for each pose [SI]

    Raises
    ------
    ContactLost
        The tips are farther apart than the object is wide
    OutOfRange
        A tip would be pressed to the edge of its plate
    HandError
        A number that cannot be
    """
    fingers = fingers_of(numbers._replace(contact="frictionless", motion="quasi-static"))
    q_r, q_l = joint_angles(q_r, q_l)
    prepare(rest_all)
    found, status = np.empty((q_r.size, 16)), np.empty(q_r.size, np.int64)
    rest_all(fingers, q_r, q_l, found, status)
    wrong = np.flatnonzero(status)
    if wrong.size:
        i = wrong[0]
        raise failure(int(status[i]), (*found[i, :3], 0.0, 0.0, q_r[i], q_l[i]), fingers)
    d, theta, N, M, torque = (found[:, i : i + 2] for i in range(3, 13, 2))
    x, y, psi, U, K_psi, count = found[:, [0, 1, 2, 13, 14, 15]].T
    return Grasp(x, y, psi, d, theta, N, M, torque, U, K_psi, count.astype(int))


def joint_angles(q_r: Any, q_l: Any) -> tuple[Array, Array]:
    r"""Return both joints' angles as flat arrays of one length.

    Parameters
    ----------
    q_r : array_like
        Angles of the right joint [rad]
    q_l : array_like
        Angles of the left joint [rad]

    Returns
    -------
    tuple of array (n,)
        The same [rad]

    Raises
    ------
    HandError
        An angle that is no finite number
    """
    pair = np.broadcast_arrays(np.atleast_1d(np.asarray(q_r, float)), np.atleast_1d(np.asarray(q_l, float)))
    for finger, angles in zip(FINGERS, pair, strict=True):
        if not np.isfinite(angles).all():
            raise HandError(f"finger {finger}: q = {angles[~np.isfinite(angles)][0]} rad is not a finite number")
    return np.ascontiguousarray(pair[0].ravel()), np.ascontiguousarray(pair[1].ravel())


def failure(status: int, state: Sequence[float] | Array, f: Fingers) -> HandError:
    """Return the error of a status for the pose and joints of a state: x, y, psi, two slides, q_r, q_l [SI]."""
    if status == RESTLESS:
        return NoEquilibrium(f"no equilibrium: Newton's method finds none near psi = {degrees(state[2]):.3f} deg")
    if status == SLIDES and isinf(f.mu):
        return ContactLost("the tips are sheared by more than they are pressed: beyond d_t = d nothing holds them")
    if status == SLIDES:
        return ContactLost(f"friction of ratio {f.mu:g} does not carry the object: it slides out of the fingers")
    i = (status - 1) % 2
    d, theta, sigma = meet(f, 1.0 - 2.0 * i, state[5 + i], state[0], state[1], state[2])
    if status in (OVER_R, OVER_L):
        return ContactLost(
            f"finger {FINGERS[i]}: the tip is {1e3 * sigma:.3f} mm along its face,"
            f" which ends {0.5e3 * f.h:.3f} mm from its middle"
        )
    return refusal(f"finger {FINGERS[i]}", d, theta, deepest(f.a, theta))


@kernel
def rest_all(f: Fingers, q_r: Array, q_l: Array, found: Array, status: Array) -> None:
    """Fill a row of found and the status for each pose, see `rest`."""
    for i in range(q_r.size):
        status[i] = rest(f, q_r[i], q_l[i], found[i])


@lean
def rest(f: Fingers, q_r: float, q_l: float, found: Array) -> int:
    r"""Find where the object rests without friction.

    Parameters
    ----------
    f : Fingers
        Numbers of the fingers [SI]
    q_r : float
        Angle of the right joint [rad]
    q_l : float
        Angle of the left joint [rad]
    found : array (16,)
        Filled with x, y, psi, d, theta, N, M and torque of both, U, K_psi and iterations [SI]

    Returns
    -------
    int
        HELD, or what is wrong [1]
    """
    p, psi, K, count = settle(f, q_r, q_l)
    (rx, ry), (lx, ly) = centre(f, 1.0, q_r), centre(f, -1.0, q_l)
    along = 0.5 * (cos(psi) * (ry + ly) - sin(psi) * (rx + lx))
    x, y = p * cos(psi) - along * sin(psi), p * sin(psi) + along * cos(psi)
    found[0], found[1], found[2], found[13], found[14], found[15] = x, y, psi, 0.0, K, count
    status = HELD
    for i in range(2):
        s, q = (1.0, q_r) if i == 0 else (-1.0, q_l)
        d, theta, _ = meet(f, s, q, x, y, psi)
        U, N, M, _, _, _, _, _, _, _ = springs(f.b, f.E, f.k, d, theta, 0.0)
        dx, dy = sweep(f, s, q)
        found[3 + i], found[5 + i], found[7 + i], found[9 + i] = d, theta, N, M
        found[11 + i] = N * s * (cos(psi) * dx + sin(psi) * dy) + M
        found[13] += U
        if status == HELD and not d > 0.0:
            status = LOST_R + i
        elif status == HELD and not d <= deepest(f.a, theta):
            status = DEEP_R + i
    return RESTLESS if status == HELD and not (K > 0.0 and count < ITERATIONS_MAX) else status


@lean
def settle(f: Fingers, q_r: float, q_l: float) -> tuple[float, float, float, int]:
    """Return p [m] and psi [rad] of the least energy, K_psi [N m/rad] and the number of Newton's steps."""
    (rx, ry), (lx, ly) = centre(f, 1.0, q_r), centre(f, -1.0, q_l)
    R, beta, u = hypot(rx - lx, ry - ly), atan2(ry - ly, rx - lx), 0.5 * (q_r + q_l)
    D = 2.0 * f.a + f.w - R
    if abs(u - beta) >= 0.5 * pi or abs(q_r - q_l) >= pi:
        return shift(f, q_r, q_l, u), u, 0.0, 0  # the fingers have passed each other, as the depths will say
    if D <= 0.0:
        return shift(f, q_r, q_l, beta), beta, 0.0, 0
    psi = (3.0 * R * beta + 2.0 * f.b * D * u) / (3.0 * R + 2.0 * f.b * D)
    p = shift(f, q_r, q_l, psi)
    low, high = min(beta, u), max(beta, u)
    for count in range(1, ITERATIONS_MAX):
        if 3.0 * R * sin(psi - beta) / (D + R - R * cos(psi - beta)) + 2.0 * f.b * tan(psi - u) > 0.0:
            high = psi
        else:
            low = psi
        to_p, to_psi, K = correction(f, q_r, q_l, p, psi)
        p, psi = p + to_p, psi + to_psi
        if abs(to_psi) < PRECISION and abs(to_p) < PRECISION * f.a:
            return p, psi, K, count
        if not low <= psi <= high:
            psi = 0.5 * (low + high)
            p = shift(f, q_r, q_l, psi)
    return p, psi, 0.0, ITERATIONS_MAX


@lean
def shift(f: Fingers, q_r: float, q_l: float, psi: float) -> float:
    """Return p at which the tips press equally hard on an object at psi, where they touch it [m]."""
    (rx, ry), (lx, ly) = centre(f, 1.0, q_r), centre(f, -1.0, q_l)
    r, left = cos(psi) * rx + sin(psi) * ry, cos(psi) * lx + sin(psi) * ly
    g_r, g_l, share = cos(psi - q_r), cos(psi - q_l), 0.5
    if f.b > 0.0 and g_r > 0.0 and g_l > 0.0:
        share = g_r / (g_r + g_l)
    return share * (2.0 * f.a + f.w - r + left) - (f.a + 0.5 * f.w - r)


@lean
def correction(f: Fingers, q_r: float, q_l: float, p: float, psi: float) -> tuple[float, float, float]:
    r"""Return Newton's step by (G3), and the rotational stiffness here.

    Parameters
    ----------
    f : Fingers
        Numbers of the fingers [SI]
    q_r : float
        Angle of the right joint [rad]
    q_l : float
        Angle of the left joint [rad]
    p : float
        Place of the object across its faces [m]
    psi : float
        Its orientation [rad]

    Returns
    -------
    tuple of float
        Step of p [m], step of psi [rad], K_psi [N m/rad]
    """
    g_p = g_psi = H_pp = H_px = H_xx = 0.0
    for i in range(2):
        s, q = (1.0, q_r) if i == 0 else (-1.0, q_l)
        cx, cy = centre(f, s, q)
        across, sigma = cos(psi) * cx + sin(psi) * cy, cos(psi) * cy - sin(psi) * cx
        d = f.a + 0.5 * f.w - s * (across - p)
        _, N, M, _, N_d, N_x, _, M_x, _, _ = springs(f.b, f.E, f.k, d, psi - q, 0.0)
        turn = -s * sigma  # of d with psi
        g_p += s * N
        g_psi += N * turn + M
        H_pp += N_d
        H_px += s * (N_d * turn + N_x)
        H_xx += (N_d * turn + 2.0 * N_x) * turn + M_x + N * s * across
    K = H_xx - H_px * H_px / H_pp
    to_psi = (g_p * H_px / H_pp - g_psi) / K
    return -(g_p + H_px * to_psi) / H_pp, to_psi, K
