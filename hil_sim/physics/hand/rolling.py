r"""Two soft fingers hold an object by friction: where it rests, step by step along a path of the joints.

A tip that sticks rolls on its face: its material follows the face while the finger turns, so the face is displaced
along itself, relative to the tip's plate, at the rate

.. math::  \dot d_t = s \, \dot \sigma + (a - d) \, \dot \theta
           = -s \, t \cdot \dot X - \tfrac12 w \, \dot \psi + s \, t \cdot \dot C - (a - d) \, \dot q              (T1)

with X the middle of the object, (G2) of `geometry` for the rest. The energy of both tips is (F3) of `fingertip`; its
virtual work over (T1) gives, with N, M, T the derivatives of U by d, theta and d_t, the loads on the object

.. math::  F = -\sum (N s \, n - T s \, t) + (0, -m g), \quad
           M_\psi = -\sum (-N s \, \sigma + M - \tfrac12 w \, T)                                                   (T2)

and (L1) of `press` on a joint. (T1) cannot be integrated to a function of the pose, so the path
matters; over a step the middle value of d is taken, which errs with the square of the step. |T| is at most mu N, by
`friction`. Newton's method solves (T2) = 0 for (x, y, psi) with the exact derivatives, also of the slip; a step that
does not converge is taken in halves. Friction determines the place along the faces, which `grasp` leaves open. With
w = 0 psi drops out of (T1): both constraints could not hold at once, and such an object is refused.

What the friction cannot carry slides: then there is no rest, and no step is returned. Nor is there one beyond d_t = d,
where (F3) would make a tip that is pushed along its face press ever harder. Source: derived here; Inoue and Hirai's
later energy has the same three terms (recalled, not read). Checked in tests/test_physics_hand_tangential.py.
"""

from math import cos, hypot, inf, sin

from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.hand.fingertip import deepest, springs
from hil_sim.physics.hand.friction import slipped
from hil_sim.physics.hand.geometry import meet
from hil_sim.physics.hand.grasp import DEEP_R, HELD, LOST_R, OVER_R, PRECISION, RESTLESS, SLIDES
from hil_sim.physics.hand.numbers import Fingers
from hil_sim.physics.hand.state import PSI, Q_L, Q_R, SLIDE_R, X, Y

ITERATIONS_MAX, CUTS_MAX = 30, 12
SHORTEST = 1.0 / 256.0  # of a step
FAR = 0.5  # of the depth: what slips as far in one step has no rest
SHEARED = 1.0  # of the depth: a tip pushed further along its face lets go, (F3) would make it press ever harder

# A workspace: the step's two ends, then residual [N], [N m], Jacobian, its slip over the depth, Newton's steps, and
# what `grasp.rest` finds.
OLD, NEW, RESIDUAL, JACOBIAN, SLIP, COUNT, FOUND, WORK = 0, 7, 14, 17, 26, 27, 28, 44


@lean
def follow(f: Fingers, q_r: float, q_l: float, state: Array, work: Array) -> int:
    r"""Turn the joints and let the held object come to rest again.

    Parameters
    ----------
    f : Fingers
        Numbers of the fingers [SI]
    q_r : float
        Angle that the right joint goes to [rad]
    q_l : float
        Angle that the left joint goes to [rad]
    state : array (7,) or longer
        Pose, slides and angles, changed in place if there is a rest all the way [SI]
    work : array (44,)
        Workspace, of which COUNT is the number of Newton's steps [SI]

    Returns
    -------
    int
        HELD, or what is wrong [1]
    """
    work[COUNT] = 0.0
    for i in range(7):
        work[OLD + i] = state[i]
    done, share = 0.0, 1.0
    while done < 1.0:
        share = min(share, 1.0 - done)
        for i in range(7):
            work[NEW + i] = work[OLD + i]
        work[NEW + Q_R] = state[Q_R] + (done + share) * (q_r - state[Q_R])
        work[NEW + Q_L] = state[Q_L] + (done + share) * (q_l - state[Q_L])
        status = settle(f, work)
        if status == HELD:
            done, share = done + share, 2.0 * share
            for i in range(7):
                work[OLD + i] = work[NEW + i]
        elif share < SHORTEST:
            return status
        else:
            share *= 0.5
    for i in range(7):
        state[i] = work[OLD + i]
    return HELD


@lean
def settle(f: Fingers, work: Array) -> int:
    """Find the rest at the new angles of the workspace by Newton's method; return HELD or what is wrong."""
    error = balance(f, work)
    for _ in range(ITERATIONS_MAX):
        if error == inf:
            break
        work[COUNT] += 1.0
        to_x, to_y, to_psi = correction(work)
        x, y, psi = work[NEW + X], work[NEW + Y], work[NEW + PSI]
        share, before = 1.0, error
        for _ in range(CUTS_MAX):
            work[NEW + X], work[NEW + Y], work[NEW + PSI] = x + share * to_x, y + share * to_y, psi + share * to_psi
            error = balance(f, work)
            if error < before:
                break
            share *= 0.5
        if hypot(to_x, to_y) < PRECISION * f.a and abs(to_psi) < PRECISION:
            return judged(f, work)
    return judged(f, work) if error == inf else RESTLESS


@lean
def judged(f: Fingers, work: Array) -> int:
    """Return HELD if what is in the workspace is a rest within the model, else what is wrong."""
    if work[SLIP] > FAR:
        return SLIDES
    for i in range(2):
        d, theta, sigma = meet(f, 1.0 - 2.0 * i, work[NEW + Q_R + i], work[NEW + X], work[NEW + Y], work[NEW + PSI])
        if not d > 0.0:
            return LOST_R + i
        if f.h > 0.0 and abs(sigma) > 0.5 * f.h:
            return OVER_R + i
        if abs(work[NEW + SLIDE_R + i]) > SHEARED * d:
            return SLIDES
        if not d <= deepest(f.a, theta):
            return DEEP_R + i
    return HELD if stiffness(work) > 0.0 else RESTLESS


@lean
def balance(f: Fingers, work: Array) -> float:
    r"""Fill residual (T2), its Jacobian and the slides of the new state.

    Parameters
    ----------
    f : Fingers
        Numbers of the fingers [SI]
    work : array (44,)
        Workspace, its two ends given [SI]

    Returns
    -------
    float
        Size of the residual, infinite where a tip does not touch [N]
    """
    for i in range(RESIDUAL, SLIP + 1):
        work[i] = 0.0
    work[RESIDUAL + Y] = f.m * f.g
    for i in range(2):
        if not load(f, i, work):
            return inf
    moment = work[RESIDUAL + PSI] / f.a
    return hypot(hypot(work[RESIDUAL + X], work[RESIDUAL + Y]), moment)


@lean
def rolled(f: Fingers, d_0: float, theta_0: float, d: float, theta: float) -> float:
    r"""Return how far a tip rolls on its face over a step, the second term of (T1).

    Parameters
    ----------
    f : Fingers
        Numbers of the fingers [SI]
    d_0 : float
        Displacement of the tip before [m]
    theta_0 : float
        Relative orientation before [rad]
    d : float
        Displacement after [m]
    theta : float
        Relative orientation after [rad]

    Returns
    -------
    float
        Way, which errs with the cube of the step [m]
    """
    return (f.a - 0.5 * (d_0 + d)) * (theta - theta_0)


@lean
def load(f: Fingers, i: int, work: Array) -> bool:
    """Add the loads of tip i and their derivatives to the workspace; return False if it does not touch."""
    s, psi = 1.0 - 2.0 * i, work[NEW + PSI]
    d_0, theta_0, sigma_0 = meet(f, s, work[OLD + Q_R + i], work[OLD + X], work[OLD + Y], work[OLD + PSI])
    d, theta, sigma = meet(f, s, work[NEW + Q_R + i], work[NEW + X], work[NEW + Y], psi)
    if not d > 0.0 or not cos(theta) > 0.0:
        return False
    stuck = work[OLD + SLIDE_R + i] + s * (sigma - sigma_0) + rolled(f, d_0, theta_0, d, theta)
    d_t, by_d, by_theta, by_stuck = slipped(f, d, theta, stuck)
    work[NEW + SLIDE_R + i] = d_t
    work[SLIP] = max(work[SLIP], abs(stuck - d_t) / d)
    _, N, M, T, N_d, N_x, N_t, M_x, M_t, T_t = springs(f.b, f.E, f.k, d, theta, d_t)
    n_x, n_y, away = s * cos(psi), s * sin(psi), f.a + 0.5 * f.w - d
    for j in range(3):
        # What coordinate j changes: depth, tilt, the rolled way of a virtual displacement, and that of this step.
        g_d = n_x if j == 0 else n_y if j == 1 else -s * sigma
        g_x = 1.0 if j == 2 else 0.0
        g_t = n_y if j == 0 else -n_x if j == 1 else -0.5 * f.w
        g_s = g_t + (0.5 * (d - d_0) if j == 2 else 0.0) - 0.5 * (theta - theta_0) * g_d
        to_t = by_d * g_d + by_theta * g_x + by_stuck * g_s
        to_N = N_d * g_d + N_x * g_x + N_t * to_t
        to_M = N_x * g_d + M_x * g_x + M_t * to_t
        to_T = N_t * g_d + M_t * g_x + T_t * to_t
        work[RESIDUAL + j] += N * g_d + M * g_x + T * g_t
        work[JACOBIAN + j] += to_N * n_x + to_T * n_y
        work[JACOBIAN + 3 + j] += to_N * n_y - to_T * n_x
        work[JACOBIAN + 6 + j] += -s * sigma * to_N + to_M - 0.5 * f.w * to_T
    work[JACOBIAN + 2] += -N * n_y + T * n_x
    work[JACOBIAN + 5] += N * n_x + T * n_y
    work[JACOBIAN + 6] += -N * n_y
    work[JACOBIAN + 7] += N * n_x
    work[JACOBIAN + 8] += N * away
    return True


@lean
def correction(work: Array) -> tuple[float, float, float]:
    """Return Newton's step of x [m], y [m] and psi [rad], by Cramer's rule."""
    a, b, c = work[JACOBIAN], work[JACOBIAN + 1], work[JACOBIAN + 2]
    d, e, g = work[JACOBIAN + 3], work[JACOBIAN + 4], work[JACOBIAN + 5]
    h, k, m = work[JACOBIAN + 6], work[JACOBIAN + 7], work[JACOBIAN + 8]
    u, v, w = work[RESIDUAL], work[RESIDUAL + 1], work[RESIDUAL + 2]
    minor_a, minor_b, minor_c = e * m - g * k, d * m - g * h, d * k - e * h
    det = a * minor_a - b * minor_b + c * minor_c
    by_x = u * minor_a - b * (v * m - g * w) + c * (v * k - e * w)
    by_y = a * (v * m - g * w) - u * minor_b + c * (d * w - v * h)
    by_psi = a * (e * w - v * k) - b * (d * w - v * h) + u * minor_c
    return -by_x / det, -by_y / det, -by_psi / det


@lean
def stiffness(work: Array) -> float:
    r"""Return the rotational stiffness of the grip, the object free to shift.

    Parameters
    ----------
    work : array (44,)
        Workspace in which `balance` has filled the Jacobian [SI]

    Returns
    -------
    float
        K_psi [N m/rad]
    """
    a, b, c = work[JACOBIAN], work[JACOBIAN + 1], work[JACOBIAN + 2]
    d, e, g = work[JACOBIAN + 3], work[JACOBIAN + 4], work[JACOBIAN + 5]
    h, k, m = work[JACOBIAN + 6], work[JACOBIAN + 7], work[JACOBIAN + 8]
    det = a * e - b * d
    K: float = m - (h * (c * e - b * g) + k * (a * g - c * d)) / det
    return K
