"""What a ring robot, its ground and its start are made of: the constants that a robot file holds, in SI units."""

from dataclasses import dataclass


@dataclass(frozen=True)
class RingNumbers:
    """A closed elastic rim with a hub that hangs in its spokes."""

    R: float  # radius of the centre line of the rim [m]
    m: float  # mass of the rim [kg]
    m_hub: float  # mass of the hub [kg]
    r_hub: float  # radius of the hub: it may not pass through the rim [m]
    attach: float  # distance of the spokes' attachments from the centre of the hub [m]
    slack: float  # of a cold spoke at its full length [m]
    EI: float  # bending stiffness [N m2]
    EA: float  # stretch stiffness [N]
    tau_v: float  # Kelvin-Voigt time of the bending [s]
    damping: float  # of a taut coil along its axis [N s/m]
    drag: float  # of the air, proportional to mass [1/s]
    nodes: int  # of the mesh [1]


@dataclass(frozen=True)
class GroundNumbers:
    """An inclined plane that pushes and rubs; the contact is one-sided."""

    slope: float  # rises in the direction of travel [rad]
    tilt_after: float  # time that a sloped plane stays level after a coil is first heated [s]
    tilt_rate: float  # mean rate at which it is then tilted [rad/s]
    mu: float  # coefficient of friction [1]
    k_n: float  # normal stiffness of a node's contact [N/m]
    c_n: float  # normal damping of a node's contact [N s/m]
    gravity: float  # [m/s2]
    T_amb: float  # temperature of the air [degC]


@dataclass(frozen=True)
class StartNumbers:
    """How the body lies before the first step: which point is down, which way it looks."""

    turn: float  # of the body from coil 0 straight down, positive forward [rad]
    settle: float  # time to come to rest under gravity before the clock starts [s]
