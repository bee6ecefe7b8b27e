"""Two soft fingers, their servos and the object between them, advanced by one call over a tick of the bench.

    hand = hand_of(HandNumbers(a=0.020, E=0.30e6, L=0.051, B=0.020))
    advance(hand, (0.14, -0.14), 0.005)      # R, L [rad]; NaN: limp
    hand.pose, hand.d, hand.tau, hand.current

Everything is in SI units, arrays of two hold R first. `advance` raises OutOfRange, a HandError and so a ValueError,
when a tip is pressed to the edge of its plate: the hand is then as it was when that happened, and the run is over, as
the model says nothing beyond. What loses contact, slides or finds no rest is no error: the object stays on its stand,
and `gripped` is False.
"""

from collections.abc import Sequence
from math import isinf, nan

import numpy as np

from hil_sim.physics.compiled import Array, prepare
from hil_sim.physics.hand import motion, servo
from hil_sim.physics.hand.fingertip import FINGERS, HandError
from hil_sim.physics.hand.grasp import HELD, failure
from hil_sim.physics.hand.motion import ROWS, march
from hil_sim.physics.hand.numbers import HandNumbers, fingers_of, servo_of
from hil_sim.physics.hand.rolling import NEW, WORK
from hil_sim.physics.hand.state import (
    ALONG,
    ENERGY,
    GRIPPED,
    JAM_R,
    LOAD,
    MOMENT,
    MOTOR,
    NORMAL,
    Q_R,
    RATES,
    READ,
    SLIDE_R,
    STATE,
    STIFFNESS,
    THETA,
    D,
    X,
    Y,
    lying,
)
from hil_sim.physics.hand.still import creep


class Hand:
    """The state of fingers and object; all arrays of two are (R, L)."""

    def __init__(self, numbers: HandNumbers, q: Sequence[float] = (0.0, 0.0)) -> None:
        self.numbers = numbers
        self.fingers, self.servo = fingers_of(numbers), servo_of(numbers)
        self.t = 0.0  # [s]
        self.state = lying(numbers.L, *q)
        self.read = np.zeros(READ)
        self.work, self.rows = np.zeros(WORK), np.zeros((ROWS, STATE))
        self.step = servo.longest_step(self.servo, self.fingers)  # of joints and object [s]
        if numbers.motion == "dynamic":
            self.step = min(self.step, motion.longest_step(self.fingers))

    @property
    def q(self) -> Array:
        """Angles of the joints [rad]."""
        return self.state[Q_R : Q_R + 2].copy()

    @property
    def rates(self) -> Array:
        """Speeds of the joints [rad/s]."""
        return self.state[RATES + Q_R : RATES + Q_R + 2].copy()

    @property
    def tau(self) -> Array:
        """Torques that the fingers exert on their joints: the load of the servos, CCW positive [N m]."""
        return self.read[LOAD : LOAD + 2].copy()

    @property
    def motor(self) -> Array:
        """Torques of the motors, 0 while limp [N m]."""
        return self.read[MOTOR : MOTOR + 2].copy()

    @property
    def current(self) -> Array:
        """Currents of the servos, at least that without load while they have power at all [A]."""
        n = self.numbers
        return np.array([servo.current(motor, n.stall, n.I_idle, n.I_stall) for motor in self.motor])

    @property
    def pose(self) -> Array:
        """Middle of the object and its orientation: x [m], y [m], psi [rad]."""
        return self.state[X : X + 3].copy()

    @property
    def d(self) -> Array:
        """Displacements of the tips, 0 where one does not touch [m]."""
        return np.maximum(self.read[D : D + 2], 0.0)

    @property
    def theta(self) -> Array:
        """Orientation of the object relative to the tips [rad]."""
        return self.read[THETA : THETA + 2].copy()

    @property
    def N(self) -> Array:
        """Normal forces [N]."""
        return self.read[NORMAL : NORMAL + 2].copy()

    @property
    def M(self) -> Array:
        """Moments of the tips on the object about their centres, towards theta = 0 when positive with theta [N m]."""
        return self.read[MOMENT : MOMENT + 2].copy()

    @property
    def T(self) -> Array:
        """Forces along the faces, 0 without friction [N]."""
        return self.read[ALONG : ALONG + 2].copy()

    @property
    def slide(self) -> Array:
        """Displacements d_t of the faces along themselves [m]."""
        return self.state[SLIDE_R : SLIDE_R + 2].copy()

    @property
    def elastic(self) -> float:
        """Elastic energy of both tips [J]."""
        return float(self.read[ENERGY])

    @property
    def kinetic(self) -> float:
        """Kinetic energy of the object, 0 in quasi-static motion [J]."""
        vx, vy, spin = self.state[RATES + X : RATES + X + 3]
        return float(0.5 * self.fingers.m * (vx * vx + vy * vy) + 0.5 * self.fingers.inertia * spin * spin)

    @property
    def gravity(self) -> float:
        """Energy of the object in gravity over the level of the joints, 0 where its place is undetermined [J]."""
        return float(self.fingers.m * self.fingers.g * self.state[Y]) if self.along == "determined" else 0.0

    @property
    def K_psi(self) -> float:
        """Rotational stiffness of the grip, the object free to shift; 0 while not gripped [N m/rad]."""
        return float(self.read[STIFFNESS])

    @property
    def gripped(self) -> bool:
        """Whether the tips hold the object; otherwise it is on a stand."""
        return bool(self.state[GRIPPED])

    @property
    def along(self) -> str:
        """Whether the place along the faces is "determined" by friction or, without it, "undetermined"."""
        return "undetermined" if self.numbers.contact == "frictionless" else "determined"

    def jam(self, finger: int, jammed: bool = True) -> None:
        """Let joint 0 (R) or 1 (L) no longer turn, whatever its servo does, or let it turn again."""
        self.state[JAM_R + finger] = float(jammed)
        if jammed:
            self.state[RATES + Q_R + finger] = 0.0


def hand_of(numbers: HandNumbers, q: Sequence[float] = (0.0, 0.0)) -> Hand:
    r"""Return a hand at rest at time 0, its object upright on a stand in the middle, L above the joints.

    Parameters
    ----------
    numbers : HandNumbers
        Numbers of tips, links, object and servos, and the models [SI]
    q : sequence of float
        Angles of the joints, R and L [rad]

    Returns
    -------
    Hand
        The state, with its forces read

    Raises
    ------
    HandError
        A number that cannot be, or tips that are too deep in the object from the start
    """
    prepare(creep)
    hand = Hand(numbers, q)
    limp = (hand.fingers, hand.servo, nan, nan, 0.0, hand.step)
    _judge(hand, creep(*limp, hand.state, hand.read, hand.work))
    if numbers.motion == "dynamic":
        prepare(march)
        _judge(hand, march(*limp, hand.state, hand.read, hand.work, hand.rows))
    return hand


def advance(hand: Hand, commands: Sequence[float], dt: float) -> None:
    r"""Advance the hand by a time in which its servos are told to go to these angles.

    Parameters
    ----------
    hand : Hand
        The state, changed in place
    commands : sequence of float
        Angles that the servos R and L are told to go to, NaN: limp [rad]
    dt : float
        Time, of any length [s]

    Raises
    ------
    OutOfRange
        A tip is pressed to the edge of its plate
    NoEquilibrium
        The object in motion has turned by half a turn
    HandError
        A command that is infinite, or a time that is negative or no number
    """
    c_r, c_l = (float(command) for command in commands)
    for finger, command in zip(FINGERS, (c_r, c_l), strict=True):
        if isinf(command):
            raise HandError(f"finger {finger}: command {command} rad is not a finite number (NaN: limp)")
    if not 0.0 <= dt < np.inf:
        raise HandError(f"dt = {dt} s, must be a finite number of at least 0 s")
    if dt > 0.0:
        given = (hand.fingers, hand.servo, c_r, c_l, dt, hand.step)
        if hand.numbers.motion == "dynamic":
            status = march(*given, hand.state, hand.read, hand.work, hand.rows)
        else:
            status = creep(*given, hand.state, hand.read, hand.work)
        _judge(hand, status)
        hand.t += dt


def _judge(hand: Hand, status: int) -> None:
    """Raise what a kernel found wrong."""
    if status != HELD:
        raise failure(status, hand.work[NEW:], hand.fingers)


__all__ = ["Hand", "HandNumbers", "advance", "hand_of"]
