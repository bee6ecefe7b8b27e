"""The numbers of a hand in SI units, as a robot file gives them and as the kernels take them.

    fingers = fingers_of(HandNumbers(a=0.020, E=0.30e6, L=0.051, B=0.020))

`fingers_of` and `servo_of` refuse what cannot be, by name, value, limit and unit.
"""

from math import inf, isfinite
from typing import NamedTuple

from hil_sim.physics.hand.fingertip import HandError, quantity

TIPS = ("nail", "radial")
CONTACTS = ("frictionless", "stick", "coulomb")
MOTIONS = ("quasi-static", "dynamic")
FRICTIONLESS, STICK, COULOMB = range(3)


class HandNumbers(NamedTuple):
    """Two equal fingers R (at +B) and L (at -B), their servos and the object, in SI units."""

    a: float  # radius of a tip [m]
    E: float  # Young's modulus of the tips [Pa]
    L: float  # joint to the height of the tip's centre [m]
    B: float  # half the distance between the joints [m]
    e: float = 0.0  # tip's centre inward from the line of the link [m]
    w: float = 0.0  # width of the object [m]
    h: float = 0.0  # its height, of its faces; 0: without an end [m]
    m: float = 0.0  # its mass [kg]
    mu: float = 0.0  # friction ratio of tip and object, for "coulomb" [1]
    k: float = 1.0  # shear stiffness of the tips over their normal stiffness [1]
    tau: float = 0.002  # of the tips' damping in the normal direction [s]
    tau_t: float = 0.002  # of their damping along the face [s]
    g: float = 0.0  # gravity, along -y [m/s^2]
    omega: float = 60.0  # bandwidth of a servo [rad/s]
    rate: float = 7.0  # its speed without load [rad/s]
    stall: float = 3.0  # its torque at rest [N m]
    J: float = 0.01  # moment of inertia of motor, gear and finger about the joint [kg m^2]
    rub: float = 0.4  # of gear and motor, turned from outside while limp [N m s/rad]
    I_idle: float = 0.0  # current of a servo without load [A]
    I_stall: float = 0.0  # at its stall torque [A]
    tip: str = "nail"
    contact: str = "frictionless"
    motion: str = "quasi-static"


class Fingers(NamedTuple):
    """Tips, links and object as the kernels take them."""

    b: float  # 1: nail, 0: radial [1]
    E: float  # [Pa]
    k: float  # [1]
    a: float  # [m]
    L: float  # [m]
    B: float  # [m]
    e: float  # [m]
    w: float  # [m]
    h: float  # [m]
    m: float  # [kg]
    inertia: float  # of the object about its centre [kg m^2]
    mu: float  # infinite where the tips stick [1]
    tau: float  # [s]
    tau_t: float  # [s]
    g: float  # [m/s^2]
    contact: int  # FRICTIONLESS, STICK or COULOMB


class Servo(NamedTuple):
    """One servo, both are equal, as the kernels take it."""

    omega: float  # [rad/s]
    rate: float  # [rad/s]
    stall: float  # [N m]
    J: float  # [kg m^2]
    rub: float  # [N m s/rad]


LENGTHS = {"a": "m", "L": "m", "B": "m"}
POSITIVE = {**LENGTHS, "E": "Pa", "k": "", "omega": "rad/s", "rate": "rad/s", "stall": "N m", "J": "kg m^2"}
DAMPING = {"tau": "s", "tau_t": "s", "rub": "N m s/rad"}
NOT_NEGATIVE = {**DAMPING, "w": "m", "h": "m", "m": "kg", "mu": "", "I_idle": "A", "I_stall": "A"}
FINITE = {"e": "m", "g": "m/s^2"}


def fingers_of(numbers: HandNumbers) -> Fingers:
    r"""Return tips, links and object for the kernels.

    Parameters
    ----------
    numbers : HandNumbers
        Numbers of the hand [SI]

    Returns
    -------
    Fingers
        The same, checked [SI]

    Raises
    ------
    HandError
        A number that is none or outside its range, a model that is not known, sticking without width, dynamics
        without mass or extent
    """
    _check(numbers)
    n = numbers
    contact = CONTACTS.index(n.contact)
    mu = n.mu if contact == COULOMB else inf if contact == STICK else 0.0
    inertia = n.m * (n.w**2 + n.h**2) / 12.0
    nail = float(n.tip == "nail")
    return Fingers(nail, n.E, n.k, n.a, n.L, n.B, n.e, n.w, n.h, n.m, inertia, mu, n.tau, n.tau_t, n.g, contact)


def servo_of(numbers: HandNumbers) -> Servo:
    r"""Return a servo for the kernels.

    Parameters
    ----------
    numbers : HandNumbers
        Numbers of the hand [SI]

    Returns
    -------
    Servo
        The same, checked [SI]

    Raises
    ------
    HandError
        As `fingers_of`
    """
    _check(numbers)
    return Servo(numbers.omega, numbers.rate, numbers.stall, numbers.J, numbers.rub)


def _check(numbers: HandNumbers) -> None:
    """Raise HandError for the first number or model that cannot be."""
    for name, known in (("tip", TIPS), ("contact", CONTACTS), ("motion", MOTIONS)):
        if getattr(numbers, name) not in known:
            raise HandError(f"{name} {getattr(numbers, name)!r} is not known: {', '.join(known)}")
    for name, unit in (POSITIVE | NOT_NEGATIVE | FINITE).items():
        value = getattr(numbers, name)
        said, zero = quantity(name, value, unit), f"0 {unit}".rstrip()
        if not isfinite(value):
            raise HandError(f"{said} is not a finite number")
        if name in POSITIVE and value <= 0.0:
            raise HandError(f"{said}, must be above {zero}")
        if name in NOT_NEGATIVE and value < 0.0:
            raise HandError(f"{said}, at least {zero}")
    if numbers.contact != "frictionless" and numbers.w == 0.0:
        raise HandError(
            f"contact {numbers.contact!r} with w = 0 m is over-constrained: both tips would stick to one line of no"
            " width; give the object a width above 0 m or choose 'frictionless'"
        )
    if numbers.motion == "dynamic" and not (numbers.m > 0.0 and numbers.w + numbers.h > 0.0):
        raise HandError(
            f"motion 'dynamic' needs an object of some mass and extent: m = {numbers.m:g} kg, w = {numbers.w:g} m,"
            f" h = {numbers.h:g} m, must be above 0"
        )
