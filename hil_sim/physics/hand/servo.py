r"""A position servo: a motor behind a gear that turns a joint, whatever pushes back, within its torque and speed.

Its loop asks for the torque that would bring the joint to the commanded angle c as a critically damped second-order
system, and makes up for the load tau; the motor gives what a direct-current motor can at that speed,

.. math::  \tau_m = \mathrm{clip}\{ J [\omega^2 (c - q) - 2 \omega \dot q] - \tau, \;
           -\tau_s (1 + \dot q / v), \; \tau_s (1 - \dot q / v) \}, \quad J \ddot q = \tau_m + \tau               (V1)

never more than the stall torque tau_s either way. So a joint runs at v at most without a load, slower against one,
stands where the load is tau_s, and is driven back by more than that: it never passes through. A limp joint, one that
is told no angle, is driven back by any load against the rub b of its gear,

.. math::  J \ddot q = \tau - b \dot q                                                                            (V2)

The current grows with the torque of the motor. Source: standard results. ASSUMED: the loop knows its load (hobby
servos hold within their dead band), J, b viscous, no efficiency of the gear, fingers without weight. Checked in
tests/test_physics_hand_servo.py.
"""

from math import isnan, pi, sqrt

from hil_sim.physics.compiled import lean
from hil_sim.physics.hand.fingertip import HandError
from hil_sim.physics.hand.numbers import Fingers, Servo

STEP = 5e-4  # [s] a thirtieth of the time constant of a servo of 60 rad/s
STEP_MIN = 2e-6  # [s]


@lean
def drive(servo: Servo, c: float, q: float, v: float, load: float) -> tuple[float, float]:
    r"""Return acceleration and torque of a servo, equations (V1) and (V2).

    Parameters
    ----------
    servo : Servo
        Numbers of the servo [SI]
    c : float
        Angle that it is told to go to, NaN when it is limp [rad]
    q : float
        Angle of the joint [rad]
    v : float
        Its speed [rad/s]
    load : float
        Torque that the finger exerts on the joint [N m]

    Returns
    -------
    tuple of float
        Acceleration [rad/s^2], torque of the motor [N m]
    """
    if isnan(c):
        return (load - servo.rub * v) / servo.J, 0.0
    asked = servo.J * servo.omega * (servo.omega * (c - q) - 2.0 * v) - load
    most = max(-servo.stall, min(servo.stall, servo.stall * (1.0 - v / servo.rate)))
    least = min(servo.stall, max(-servo.stall, -servo.stall * (1.0 + v / servo.rate)))
    motor = max(least, min(most, asked))
    return (motor + load) / servo.J, motor


def longest_step(servo: Servo, f: Fingers) -> float:
    r"""Return the step that is stable for a joint, free, limp or pressing however deep.

    Parameters
    ----------
    servo : Servo
        Numbers of the servo [SI]
    f : Fingers
        Numbers of the fingers [SI]

    Returns
    -------
    float
        Step [s]

    Raises
    ------
    HandError
        The joint is so light that it takes steps below 2 us
    """
    pressing = sqrt(servo.J / (4.0 * pi * f.E * f.a * f.L * f.L))
    h = min(STEP, 0.03 / servo.omega, 0.5 * servo.J / max(servo.stall / servo.rate, servo.rub), 0.5 * pressing)
    what = f"J = {servo.J:g} kg m^2 is too light"
    return bearable(h, what, "give the joint more inertia or softer tips, its servo less bandwidth or stall torque")


def bearable(h: float, what: str, instead: str) -> float:
    r"""Return a step if it is not too short to be waited for.

    Parameters
    ----------
    h : float
        Step [s]
    what : str
        What asks for it, and what it is like
    instead : str
        What to do if it is too short

    Returns
    -------
    float
        The same [s]

    Raises
    ------
    HandError
        The step is below 2 us
    """
    if h < STEP_MIN:
        raise HandError(f"{what}: it would take steps of {1e6 * h:.2g} us, at least {1e6 * STEP_MIN:g} us; {instead}")
    return h


def current(motor: float, stall: float, I_idle: float, I_stall: float) -> float:
    r"""Return the current of a servo.

    Parameters
    ----------
    motor : float
        Torque of its motor [N m]
    stall : float
        Torque at which it stalls [N m]
    I_idle : float
        Current without load [A]
    I_stall : float
        Current at the stall torque [A]

    Returns
    -------
    float
        Current [A]
    """
    return I_idle + (I_stall - I_idle) * min(1.0, abs(motor) / stall)
