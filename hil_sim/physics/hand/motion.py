r"""A hand in motion: the object as a rigid body between damped tips, the joints driven by their servos.

.. math::  m \ddot X = -\sum (N s \, n - T s \, t) + (0, -m g), \quad
           I \ddot \psi = -\sum (-N s \, \sigma + M - \tfrac12 w \, T), \quad J \ddot q = \tau_m + \tau             (D1)

The tips are Kelvin-Voigt solids in the normal direction and along the face,

.. math::
    N = \max\{0, U_d + \tau_v (V_{dd} \dot d + V_{d\theta} \dot \theta)\}, \quad
    M = U_\theta + \tau_v (V_{d\theta} \dot d + V_{\theta\theta} \dot \theta), \quad
    T = U_t + \tau_t U_{tt} \dot d_t, \quad |T| \le \mu N                                                        (D2)

with V the energy at d_t = 0, which is convex, so that they take energy only; they never pull. The rolled ways d_t are
states of their own, integrated by their rates (T1) of `rolling`: a plain ordinary differential equation without
constraints, by the classical Runge-Kutta method of order 4. Slip is brought back to its bound after each step. Without
damping and slip the energy is kept to the order of the method.

Without friction nothing holds the object along its faces, so it is guided there, see `guide`. An object that is not
gripped stands on its stand, see `still`; a tip that leaves it, or a grip that shears further than it presses, gives it
back there, at rest. Source: rigid bodies, Kelvin-Voigt solids and the method are standard results; the loads and the
choice of V are derived here. Checked in tests/test_physics_hand_motion.py.
"""

from math import ceil, cos, pi, sin, sqrt

from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.hand.fingertip import springs
from hil_sim.physics.hand.friction import slipped
from hil_sim.physics.hand.geometry import meet, sweep
from hil_sim.physics.hand.grasp import HELD, RESTLESS
from hil_sim.physics.hand.guide import enter, leave, middle
from hil_sim.physics.hand.numbers import FRICTIONLESS, Fingers, Servo
from hil_sim.physics.hand.press import passed, torque
from hil_sim.physics.hand.rolling import NEW, SHEARED
from hil_sim.physics.hand.servo import bearable, drive
from hil_sim.physics.hand.state import (
    ALONG,
    ENERGY,
    GRIPPED,
    JAM_R,
    LOAD,
    MOMENT,
    MOTOR,
    NORMAL,
    PAST_L,
    PAST_R,
    PSI,
    Q_L,
    Q_R,
    RATES,
    SLIDE_R,
    STATE,
    STIFFNESS,
    THETA,
    D,
    X,
    Y,
)
from hil_sim.physics.hand.still import give_way, hold, resistance, within

STEP = 2.5e-4  # [s] errs by 1e-3 in a fast transient, 3e-2 at twice that
TRIAL = 4  # row of the workspace `rows`, after the four of the method
ROWS = 5


def longest_step(f: Fingers) -> float:
    r"""Return the step that is accurate and stable for this object however deep the tips are pressed.

    Parameters
    ----------
    f : Fingers
        Numbers of the fingers [SI]

    Returns
    -------
    float
        Step [s]

    Raises
    ------
    HandError
        The object is so light that its motion takes steps below 2 us
    """
    shift = 4.0 * pi * f.E * f.a * max(1.0, f.k)  # of both tips, pressed by all of their radius [N/m]
    turn = shift * (0.25 * f.w * f.w + f.a * f.a / 3.0)  # [N m/rad]
    squared = max(shift / f.m, turn / f.inertia)  # of the fastest motion [1/s^2]
    h = min(STEP, 0.5 / sqrt(squared), 1.5 / max(1e-9, max(f.tau, f.tau_t) * squared))
    what = f"an object of m = {f.m:g} kg and w = {1e3 * f.w:g} mm, h = {1e3 * f.h:g} mm"
    return bearable(
        h, f"{what} is too light for motion 'dynamic'", "choose 'quasi-static', or give it more mass or softer tips"
    )


@lean
def march(f: Fingers, servo: Servo, c_r: float, c_l: float, dt: float, h: float, state: Array, read: Array,
          work: Array, rows: Array) -> int:  # fmt: skip
    r"""Advance servos and object by dt.

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
    rows : array (5, 19)
        Workspace: the rates of the method, and a state on trial [SI]

    Returns
    -------
    int
        HELD, or what is wrong [1]
    """
    count = max(1, ceil(dt / h - 1e-9))
    for _ in range(count):
        if state[GRIPPED] == 0.0:
            give_way(f, state[Q_R], state[Q_L], state)
            grip(f, state, read, work, rows[TRIAL])
        guided = f.contact == FRICTIONLESS and state[GRIPPED] > 0.0
        if guided:
            enter(f, state)
        step(f, servo, c_r, c_l, dt / count, state, read, rows)
        if guided:
            leave(f, state)
        status = judge(f, state, read, work)
        if status != HELD:
            return status
    read[STIFFNESS] = resistance(f, state, work) if state[GRIPPED] > 0.0 else 0.0
    return HELD


@lean
def grip(f: Fingers, state: Array, read: Array, work: Array, trial: Array) -> None:
    """Take the object from the stand if both tips touch it and would carry it."""
    for i in range(2):
        d, _, _ = meet(f, 1.0 - 2.0 * i, state[Q_R + i], state[X], state[Y], state[PSI])
        if state[PAST_R + i] > 0.0 or not d > 0.0:
            return
    for i in range(STATE):
        trial[i] = state[i]
    if hold(f, state[Q_R], state[Q_L], trial, read, work) == HELD:
        state[GRIPPED] = 1.0


@lean
def step(f: Fingers, servo: Servo, c_r: float, c_l: float, h: float, state: Array, read: Array, rows: Array) -> None:
    """Make one step of the Runge-Kutta method of order 4."""
    trial = rows[TRIAL]
    for k in range(4):
        share = 0.0 if k == 0 else h if k == 3 else 0.5 * h
        for i in range(STATE):
            trial[i] = state[i] + (share * rows[k - 1, i] if k > 0 and i < 2 * RATES else 0.0)
        rates(f, servo, c_r, c_l, trial, read, rows[k])
    for i in range(2 * RATES):
        state[i] += h / 6.0 * (rows[0, i] + 2.0 * (rows[1, i] + rows[2, i]) + rows[3, i])


@lean
def rates(f: Fingers, servo: Servo, c_r: float, c_l: float, state: Array, read: Array, rate: Array) -> None:
    """Write the rates of a state by (D1) and read its forces."""
    held, guided = state[GRIPPED] > 0.0, f.contact == FRICTIONLESS and state[GRIPPED] > 0.0
    for i in range(RATES):
        rate[i], rate[RATES + i] = state[RATES + i], 0.0
    read[ENERGY] = 0.0
    n_x, n_y = cos(state[PSI]), sin(state[PSI])
    for i in range(2):
        s, q = 1.0 - 2.0 * i, state[Q_R + i]
        sigma = bear(f, i, state, read, rate)
        read[LOAD + i] = torque(f, s, q, state[PSI], read[D + i], read[NORMAL + i], read[MOMENT + i], read[ALONG + i])
        joint, read[MOTOR + i] = drive(servo, c_r if i == 0 else c_l, q, state[RATES + Q_R + i], read[LOAD + i])
        if state[JAM_R + i] > 0.0:
            joint, rate[Q_R + i] = 0.0, 0.0
        rate[RATES + Q_R + i] = joint
        if held:
            N, T = s * read[NORMAL + i], s * read[ALONG + i]
            rate[RATES + X] -= N / f.m if guided else (N * n_x + T * n_y) / f.m
            rate[RATES + Y] -= 0.0 if guided else (N * n_y - T * n_x) / f.m
            rate[RATES + PSI] -= (-N * sigma + read[MOMENT + i] - 0.5 * f.w * read[ALONG + i]) / f.inertia
    if held and not guided:
        rate[RATES + Y] -= f.g


@lean
def bear(f: Fingers, i: int, state: Array, read: Array, rate: Array) -> float:
    """Read what tip i does and write the rate of its slide (T1); return its place along the face [m]."""
    s, q, spin, psi = 1.0 - 2.0 * i, state[Q_R + i], state[RATES + PSI], state[PSI]
    n_x, n_y, turn = cos(psi), sin(psi), state[RATES + Q_R + i]
    guided = f.contact == FRICTIONLESS and state[GRIPPED] > 0.0
    x, y = state[X], state[Y]
    if guided:
        mid_x, mid_y, v_x, v_y = middle(f, state)
        x, y = mid_x + state[X] * n_x, mid_y + state[X] * n_y
        rate[X] = state[RATES + X] - n_x * v_x - n_y * v_y
    d, theta, sigma = meet(f, s, q, x, y, psi)
    d = min(d, 0.0) if state[PAST_R + i] > 0.0 else d
    across, along = state[RATES + X], 0.0
    if not guided:
        across = n_x * state[RATES + X] + n_y * state[RATES + Y]
        along = n_x * state[RATES + Y] - n_y * state[RATES + X]
    c_x, c_y = sweep(f, s, q)
    deeper = s * (across - turn * (n_x * c_x + n_y * c_y) - sigma * spin)
    rolled = s * (turn * (n_x * c_y - n_y * c_x) - along) - 0.5 * f.w * spin - (f.a - d) * turn
    read[D + i], read[THETA + i] = d, theta
    read[NORMAL + i] = read[MOMENT + i] = read[ALONG + i] = rate[SLIDE_R + i] = 0.0
    if d > 0.0:
        sticks = f.contact != FRICTIONLESS
        d_t = slipped(f, d, theta, state[SLIDE_R + i])[0] if sticks else 0.0
        U, N, M, T, _, _, _, _, _, T_t = springs(f.b, f.E, f.k, d, theta, d_t)
        _, _, _, _, N_d, N_x, _, M_x, _, _ = springs(f.b, f.E, f.k, d, theta, 0.0)
        tilting = spin - turn
        N = max(0.0, N + f.tau * (N_d * deeper + N_x * tilting))
        M += f.tau * (N_x * deeper + M_x * tilting)
        read[ENERGY] += U
        read[NORMAL + i], read[MOMENT + i] = N, M
        if sticks:
            rate[SLIDE_R + i] = rolled
            read[ALONG + i] = max(-f.mu * N, min(f.mu * N, T + f.tau_t * T_t * rolled)) if N > 0.0 else 0.0
    return sigma


@lean
def judge(f: Fingers, state: Array, read: Array, work: Array) -> int:
    """Let what slips slip and what is lost stand; return HELD, or what is wrong."""
    held, lost, fallen = state[GRIPPED] > 0.0, False, False
    for i in range(2):
        d, theta, sigma = meet(f, 1.0 - 2.0 * i, state[Q_R + i], state[X], state[Y], state[PSI])
        if f.contact != FRICTIONLESS or not held:
            fallen = passed(f, i, d, sigma, state) or fallen
        d = min(d, 0.0) if state[PAST_R + i] > 0.0 else d
        read[D + i], read[THETA + i] = d, theta
        state[SLIDE_R + i] = slipped(f, d, theta, state[SLIDE_R + i])[0] if d > 0.0 else 0.0
        if f.contact != FRICTIONLESS:
            lost = lost or abs(state[SLIDE_R + i]) > SHEARED * d
            if lost or not held:
                most = 0.5 * SHEARED * max(0.0, d)
                state[SLIDE_R + i] = max(-most, min(most, state[SLIDE_R + i]))
        lost = lost or not d > 0.0
    if not abs(state[PSI]) < pi:
        for i in range(RATES):
            work[NEW + i] = state[i]
        return RESTLESS
    if held and fallen:
        state[PAST_R] = state[PAST_L] = 1.0
    if lost:
        state[GRIPPED] = 0.0
        state[RATES + X] = state[RATES + Y] = state[RATES + PSI] = 0.0
    return within(f, state, read, work)
