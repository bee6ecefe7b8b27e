"""Two soft fingers as a plant: where the servos are told to go in, joint angles, currents and the object's pose out.

Axes: x to the right and y up from the middle between the joints; angles are positive counter-clockwise. R is the right
finger, L the left one; at 0 degrees their links point up. Without friction nothing holds the object along its faces:
"along" is then "undetermined", and its place there a convention. An object that is not gripped is on a stand, where a
single tip pushes it aside (ASSUMED, see physics/hand/still.py).

    plant = FingersPlant(load("fingers"))
    plant.command([8.0, -8.0])
    plant.advance(5000, np.zeros(0))
    plant.observe()["object_deg"]
"""

from collections.abc import Sequence
from math import degrees, nan, radians
from typing import Any

import numpy as np

from hil_sim.physics.compiled import Array
from hil_sim.physics.hand.fingertip import HandError
from hil_sim.physics.hand.hand import Hand, advance, hand_of
from hil_sim.robots.file import RobotFile
from hil_sim.soundness import OutOfModel

SIDES = (1.0, -1.0)  # of the joints along x, the right one first


class FingersPlant:
    """Fingers, servos and object of one robot, at rest at time 0; a function of the commands and nothing else."""

    def __init__(self, robot: RobotFile) -> None:
        assert robot.fingers is not None
        self.labels: list[str] = []
        self.temperature, self.resistance = np.zeros(0), np.zeros(0)
        self.joints = list(robot.joints)
        self._hand: Hand = hand_of(robot.fingers)
        self._commands = [nan, nan]
        self._dead = [False, False]
        self._torque_peak = np.abs(self._hand.motor)

    @property
    def joint_unit(self) -> str:
        """Joints are counted in degrees."""
        return "deg"

    @property
    def joint_position(self) -> Array:
        """Angles of the joints [deg]."""
        return np.degrees(self._hand.q)

    @property
    def joint_current_a(self) -> Array:
        """Currents of the servos while they have power [A]."""
        return self._hand.current

    @property
    def object_deg(self) -> float | None:
        """Orientation of the object [deg]."""
        return degrees(self._hand.pose[2])

    def command(self, positions: Sequence[float | None]) -> None:
        """Tell each servo to which angle [deg] to go from now on; None: it is limp."""
        self._commands = [nan if degree is None else radians(degree) for degree in positions]

    def advance(self, duration_us: int, coil_power_w: Array) -> None:
        """Let time pass; OutOfModel when a tip is pressed beyond what its model is valid for."""
        driven = [nan if dead else command for command, dead in zip(self._commands, self._dead, strict=True)]
        try:
            advance(self._hand, driven, duration_us * 1e-6)
        except HandError as error:
            told = f"the fingers left what their model is valid for at {self._hand.t:.2f} s, {error}"
            raise OutOfModel(told) from error
        np.maximum(self._torque_peak, np.abs(self._hand.motor), out=self._torque_peak)

    def jam(self, label: str, jammed: bool = True) -> None:
        """Let a joint no longer turn, whatever its servo does, or let it turn again."""
        self._hand.jam(self.joints.index(label), jammed)

    def kill(self, label: str, dead: bool = True) -> None:
        """Take all torque from a servo, or give it back."""
        self._dead[self.joints.index(label)] = dead

    def energies(self) -> dict[str, float]:
        """Return what the tips and the object hold [J]."""
        hand = self._hand
        return {"elastic": hand.elastic, "kinetic": hand.kinetic, "gravity": hand.gravity}

    def observe(self) -> dict[str, Any]:
        """Return what a motion capture system, scales between tips and object and the model itself would say."""
        hand = self._hand
        x, y, psi = hand.pose.tolist()
        return {
            "kind": "fingers",
            "object_deg": degrees(psi),
            "object_mm": [1e3 * x, 1e3 * y],
            "along": hand.along,
            "gripped": hand.gripped,
            "energy_mj": 1e3 * hand.elastic,
            "stiffness_nmm_per_rad": 1e3 * hand.K_psi,
            "joint_deg": self._each(np.degrees(hand.q)),
            "joint_torque_nm": self._each(hand.motor),
            "torque_peak_nm": self._each(self._torque_peak),
            "displacement_mm": self._each(1e3 * hand.d),
            "tip_deg": self._each(np.degrees(hand.theta)),
            "normal_n": self._each(hand.N),
            "friction_used": self._each(np.abs(hand.T) / np.maximum(hand.N, 1e-9)),
            "model": self._model(),
        }

    def snapshot(self) -> dict[str, Any]:
        """Return links, tips and object at this moment, mm and degrees."""
        hand, numbers = self._hand, self._hand.numbers
        x, y, psi = hand.pose.tolist()
        return {
            "kind": "fingers",
            "t_s": hand.t,
            "coils": {},
            "energy_j": self.energies(),
            "tip_radius_mm": 1e3 * numbers.a,
            "youngs_modulus_mpa": 1e-6 * numbers.E,
            "stiffness_nmm_per_rad": 1e3 * hand.K_psi,
            "model": self._model(),
            "fingers": {label: self._finger(index) for index, label in enumerate(self.joints)},
            "object": {
                "centre": [1e3 * x, 1e3 * y],
                "deg": degrees(psi),
                "width_mm": 1e3 * numbers.w,
                "height_mm": 1e3 * numbers.h,
                "gripped": hand.gripped,
                "along": hand.along,
            },
        }

    def _finger(self, index: int) -> dict[str, Any]:
        """Return one finger of a snapshot."""
        hand, numbers, side = self._hand, self._hand.numbers, SIDES[index]
        q, command = hand.q[index], self._commands[index]
        link, inward = np.array([-np.sin(q), np.cos(q)]), -side * np.array([np.cos(q), np.sin(q)])
        joint = np.array([side * numbers.B, 0.0])
        elbow = joint + numbers.L * link
        return {
            "joint": (1e3 * joint).tolist(),
            "elbow": (1e3 * elbow).tolist(),
            "tip": (1e3 * (elbow + numbers.e * inward)).tolist(),
            "deg": degrees(q),
            "commanded_deg": None if np.isnan(command) else degrees(command),
            "d_mm": float(1e3 * hand.d[index]),
            "theta_deg": degrees(hand.theta[index]),
            "normal_n": float(hand.N[index]),
            "moment_nmm": float(1e3 * hand.M[index]),
            "tangential_n": float(hand.T[index]),
            "torque_nm": float(hand.motor[index]),
            "current_a": float(self.joint_current_a[index]),
            "limp": bool(np.isnan(command)),
        }

    def _model(self) -> dict[str, str]:
        numbers = self._hand.numbers
        return {"tip": numbers.tip, "contact": numbers.contact, "motion": numbers.motion}

    def _each(self, values: Array) -> dict[str, float]:
        return dict(zip(self.joints, values.tolist(), strict=True))
