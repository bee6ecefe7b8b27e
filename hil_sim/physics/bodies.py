"""What a robot, its ground and its start are made of: the constants that a robot file holds, in SI units."""

from dataclasses import dataclass


@dataclass(frozen=True)
class RingNumbers:
    """A closed elastic rim with a hub that hangs in its spokes."""

    R: float  # radius of the centre line of the rim [m]
    m: float  # mass of the rim [kg]
    m_hub: float  # mass of the hub [kg]
    r_hub: float  # radius of the hub: it may not pass through the rim [m]
    attach: float  # distance of the spokes' attachments from the centre of the hub [m]
    EI: float  # bending stiffness [N m2]
    EA: float  # stretch stiffness [N]
    tau_v: float  # Kelvin-Voigt time of the bending [s]
    damping: float  # of a taut coil along its axis [N s/m]
    drag: float  # of the air, proportional to mass [1/s]
    nodes: int  # of the mesh [1]


@dataclass(frozen=True)
class SphereNumbers:
    """Three closed elastic hoops at right angles, joined at their six crossings, and a core that hangs in its coils."""

    R: float  # radius of the centre line of a hoop [m]
    m: float  # mass of the three hoops together [kg]
    m_joints: float  # mass of the six crossings together [kg]
    m_core: float  # mass of the core [kg]
    r_core: float  # radius of the core, a ball of even density: it may not pass through a hoop [m]
    attach: float  # distance of the coils' attachments from the centre of the core [m]
    EI: float  # bending stiffness of a strip, flatwise [N m2]
    edgewise: float  # bending stiffness edgewise over flatwise [1]
    twist: float  # torsional stiffness GJ over bending stiffness flatwise [1]
    EA: float  # stretch stiffness [N]
    tau_v: float  # Kelvin-Voigt time of bending and twist [s]
    width: float  # of a strip [m]
    damping: float  # of a taut coil along its axis [N s/m]
    drag: float  # of the air, proportional to mass [1/s]
    nodes: int  # of the mesh of one hoop [1]


@dataclass(frozen=True)
class GroundNumbers:
    """An inclined plane, level or with terrain on it, that pushes and rubs; the contact is one-sided."""

    slope: float  # rises in the direction of travel [rad]
    tilt_after: float  # time that a sloped plane stays level after a coil is first heated [s]
    tilt_rate: float  # mean rate at which it is then tilted [rad/s]
    mu: float  # coefficient of friction [1]
    k_n: float  # normal stiffness of a node's contact [N/m]
    c_n: float  # normal damping of a node's contact [N s/m]
    gravity: float  # [m/s2]
    T_amb: float  # temperature of the air [degC]
    step: float = 0.0  # height of a step in the plane, positive up [m]
    step_at: float = 0.0  # place of its edge in the direction of travel [m]
    rough: float = 0.0  # root mean square height of a random roughness [m]
    rough_length: float = 0.0  # length over which that roughness is correlated [m]


@dataclass(frozen=True)
class StartNumbers:
    """How the body lies before the first step: which point is down, which way it looks."""

    turn: float  # of the body from coil 0 straight down, positive forward [rad]
    settle: float  # time to come to rest under gravity before the clock starts [s]


@dataclass(frozen=True)
class Attitude:
    """How a sphere lies before the first step: turned by yaw about z, then pitch about y, then roll about x."""

    yaw: float  # about the upward axis, positive to the left [rad]
    pitch: float  # about the body's own sideways axis, positive nose down: forward [rad]
    roll: float  # about the body's own forward axis, positive to the right [rad]
    settle: float  # time to come to rest under gravity before the clock starts [s]
