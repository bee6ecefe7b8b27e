r"""A hand that moves slowly: the servos turn the joints, and the object is at rest between the tips at any moment.

An object that is not gripped is on a stand (ASSUMED), at the height and the angle at which it came there. It slides on
it to either side without friction: one tip alone pushes it aside until it just touches. It is gripped as soon as both
tips press on it and it finds a rest between them that carries it; where it no longer does, the stand has it again,
where it is. An object that slides out of the grip, or along it until an end of its faces passes a tip, is out of reach:
neither tip touches it then until it has withdrawn, see `press`. Checked in tests/test_physics_hand_bench.py and
tests/test_physics_hand_ends.py.
"""

from math import ceil, cos, inf, sin

from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.hand.fingertip import deepest
from hil_sim.physics.hand.friction import slipped
from hil_sim.physics.hand.geometry import meet
from hil_sim.physics.hand.grasp import DEEP_L, DEEP_R, HELD, OVER_L, OVER_R, SLIDES, correction, rest
from hil_sim.physics.hand.numbers import FRICTIONLESS, Fingers, Servo
from hil_sim.physics.hand.press import passed, press
from hil_sim.physics.hand.rolling import FOUND, NEW, OLD, SHEARED, balance, follow, rolled, stiffness
from hil_sim.physics.hand.servo import drive
from hil_sim.physics.hand.state import (
    GRIPPED,
    JAM_R,
    LOAD,
    MOTOR,
    PAST_L,
    PAST_R,
    PSI,
    Q_L,
    Q_R,
    RATES,
    SLIDE_R,
    STIFFNESS,
    THETA,
    D,
    X,
    Y,
)

LEANING = 0.1  # cos psi: below it the faces lie more on the stand than across it, and nothing is pushed aside


@lean
def creep(f: Fingers, servo: Servo, c_r: float, c_l: float, dt: float, h: float, state: Array, read: Array,
          work: Array) -> int:  # fmt: skip
    r"""Advance servos and object by dt with the object at rest at any moment.

    Parameters
    ----------
    f : Fingers
        Numbers of the fingers [SI]
    servo : Servo
        Numbers of a servo [SI]
    c_r : float
        Angle that the right servo is told to go to, NaN: limp [rad]
    c_l : float
        Angle that the left servo is told to go to, NaN: limp [rad]
    dt : float
        Time [s]
    h : float
        Longest step [s]
    state : array (19,)
        State of the hand, changed in place [SI]
    read : array (16,)
        What can be read of it [SI]
    work : array (44,)
        Workspace of `rolling` [SI]

    Returns
    -------
    int
        HELD, or what is wrong [1]
    """
    count = max(1, ceil(dt / h - 1e-9))
    for _ in range(count):
        q_r = turn(servo, 0, c_r, dt / count, state, read)
        q_l = turn(servo, 1, c_l, dt / count, state, read)
        status = relax(f, q_r, q_l, state, read, work)
        if status != HELD:
            return status
    return HELD


@lean
def turn(servo: Servo, i: int, c: float, h: float, state: Array, read: Array) -> float:
    """Let the servo of joint i act for h [s] against the load of the moment; return the new angle [rad]."""
    acceleration, read[MOTOR + i] = drive(servo, c, state[Q_R + i], state[RATES + Q_R + i], read[LOAD + i])
    state[RATES + Q_R + i] = 0.0 if state[JAM_R + i] > 0.0 else state[RATES + Q_R + i] + h * acceleration
    angle: float = state[Q_R + i] + h * state[RATES + Q_R + i]
    return angle


@lean
def relax(f: Fingers, q_r: float, q_l: float, state: Array, read: Array, work: Array) -> int:
    """Turn the joints, let the object come to rest and read the forces; return HELD or what is wrong."""
    read[STIFFNESS] = 0.0
    if state[GRIPPED] > 0.0:
        status = hold(f, q_r, q_l, state, read, work)
        if status in (DEEP_R, DEEP_L):
            return status
        if status in (OVER_R, OVER_L) or (status == SLIDES and f.mu < inf):
            state[PAST_R] = state[PAST_L] = 1.0
        state[GRIPPED] = 1.0 if status == HELD else 0.0
    if state[GRIPPED] == 0.0:
        give_way(f, q_r, q_l, state)
        if lie(f, q_r, q_l, state):
            state[GRIPPED] = 1.0 if hold(f, q_r, q_l, state, read, work) == HELD else 0.0
    press(f, state, read)
    return within(f, state, read, work)


@lean
def hold(f: Fingers, q_r: float, q_l: float, state: Array, read: Array, work: Array) -> int:
    r"""Turn the joints with the object between the tips, if it finds a rest.

    Parameters
    ----------
    f : Fingers
        Numbers of the fingers [SI]
    q_r : float
        Angle that the right joint goes to [rad]
    q_l : float
        Angle that the left joint goes to [rad]
    state : array (19,)
        State of the hand, changed in place if there is a rest [SI]
    read : array (16,)
        What can be read, of which the stiffness is filled in [SI]
    work : array (44,)
        Workspace of `rolling` [SI]

    Returns
    -------
    int
        HELD, or what is wrong [1]
    """
    if f.contact != FRICTIONLESS:
        status = follow(f, q_r, q_l, state, work)
        read[STIFFNESS] = stiffness(work) if status == HELD else 0.0
        return status
    found = work[FOUND:]
    status = rest(f, q_r, q_l, found)
    for i in range(3):
        work[NEW + i] = found[i]
    work[NEW + Q_R], work[NEW + Q_L] = q_r, q_l
    if status == HELD:
        read[STIFFNESS] = found[14]
        for i in range(7):
            state[i] = work[NEW + i]
    return status


@lean
def resistance(f: Fingers, state: Array, work: Array) -> float:
    r"""Return the rotational stiffness of a grip where it is, the object free to shift.

    Parameters
    ----------
    f : Fingers
        Numbers of the fingers [SI]
    state : array (19,)
        State of the hand [SI]
    work : array (44,)
        Workspace of `rolling` [SI]

    Returns
    -------
    float
        K_psi [N m/rad]
    """
    if f.contact == FRICTIONLESS:
        across = state[X] * cos(state[PSI]) + state[Y] * sin(state[PSI])
        return correction(f, state[Q_R], state[Q_L], across, state[PSI])[2]
    for i in range(7):
        work[OLD + i] = work[NEW + i] = state[i]
    balance(f, work)
    return stiffness(work)


@lean
def give_way(f: Fingers, q_r: float, q_l: float, state: Array) -> None:
    r"""Let a tip that presses alone push the object on its stand aside, up to the middle where the other presses, too.

    Parameters
    ----------
    f : Fingers
        Numbers of the fingers [SI]
    q_r : float
        Angle of the right joint [rad]
    q_l : float
        Angle of the left joint [rad]
    state : array (19,)
        State of the hand, in which the object is moved along x [SI]
    """
    d_r = meet(f, 1.0, q_r, state[X], state[Y], state[PSI])[0] if state[PAST_R] == 0.0 else 0.0
    d_l = meet(f, -1.0, q_l, state[X], state[Y], state[PSI])[0] if state[PAST_L] == 0.0 else 0.0
    if (d_r > 0.0) == (d_l > 0.0) or cos(state[PSI]) < LEANING:
        return
    way = max(d_r, 0.0) - max(d_l, 0.0)
    if d_r + d_l > 0.0 and state[PAST_R] == 0.0 and state[PAST_L] == 0.0:
        way = 0.5 * (d_r - d_l)
    state[X] -= way / cos(state[PSI])


@lean
def lie(f: Fingers, q_r: float, q_l: float, state: Array) -> bool:
    """Turn the joints with the object on the stand, on which the tips roll; return whether both touch it."""
    touching = 0
    for i in range(2):
        s, q = 1.0 - 2.0 * i, q_r if i == 0 else q_l
        d_0, theta_0, sigma_0 = meet(f, s, state[Q_R + i], state[X], state[Y], state[PSI])
        d, theta, sigma = meet(f, s, q, state[X], state[Y], state[PSI])
        stuck = state[SLIDE_R + i] + s * (sigma - sigma_0) + rolled(f, d_0, theta_0, d, theta)
        state[Q_R + i], state[SLIDE_R + i] = q, 0.0
        if not passed(f, i, d, sigma, state) and d > 0.0:
            touching += 1
            if f.contact != FRICTIONLESS:
                most = 0.5 * SHEARED * d  # it does not come from the stand sheared
                state[SLIDE_R + i] = max(-most, min(most, slipped(f, d, theta, stuck)[0]))
    return touching == 2


@lean
def within(f: Fingers, state: Array, read: Array, work: Array) -> int:
    r"""Return whether both tips are within what the model is valid for.

    Parameters
    ----------
    f : Fingers
        Numbers of the fingers [SI]
    state : array (19,)
        State of the hand [SI]
    read : array (16,)
        What can be read of it [SI]
    work : array (44,)
        Workspace of `rolling`, which takes the state if they are not [SI]

    Returns
    -------
    int
        HELD, or which tip is pressed to the edge of its plate [1]
    """
    for i in range(2):
        if not read[D + i] <= deepest(f.a, read[THETA + i]):
            for j in range(7):
                work[NEW + j] = state[j]
            return DEEP_R + i
    return HELD
