"""A made-up run for tests of pictures: two soft fingers of true geometry that pinch a plate or a cube without friction.

The scenes are those of the bench's observer: at each instant the plate lies where the energy of both tips is least.
"""

import math

from host.recording import Recording
from host.records import Event, Telemetry

E_MPA = 0.30
STEP_S = 0.05
FIGURE_13 = ((1.0, 0.0, 8.0), (1.0, 20.0, 8.0), (0.5, 20.0, 8.0), (2.0, -20.0, 8.0), (0.5, -20.0, 8.0))
EXPERIMENT = ((1.0, 0.0, 2.5), *((1.0, swing, 2.5) for swing in (10.0, -10.0) * 3), (0.5, 0.0, 2.5))


class PinchedPlate:
    """An observer of two fingers that swing together and grip; `turn` says by how much."""

    def __init__(self, tip="nail", radius_mm=20.0, link_mm=51.0, width_mm=0.0):
        self.t_s = 0.0
        self.tip, self.radius_mm, self.link_mm, self.width_mm = tip, radius_mm, link_mm, width_mm
        self._base_mm = radius_mm + width_mm / 2
        self._pose = [0.0, 0.0]
        self.turn(0.0, 0.0)

    def turn(self, swing_deg, grip_deg):
        """Turn the joints; the plate follows to where the energy is least."""
        self.deg = {"R": swing_deg + grip_deg, "L": swing_deg - grip_deg}
        if grip_deg > 0.1:
            for _ in range(12):
                slope, bend = self._derivatives(*self._pose)
                det = bend[0] * bend[2] - bend[1] ** 2
                self._pose[0] -= (bend[2] * slope[0] - bend[1] * slope[1]) / det
                self._pose[1] -= (bend[0] * slope[1] - bend[1] * slope[0]) / det

    def object_deg(self):
        """Return the plate's angle."""
        return math.degrees(self._pose[1])

    def observe(self):
        """Return what the bench's observer measures."""
        return {"kind": "fingers", "object_deg": self.object_deg(), "gripped": self.deg["R"] - self.deg["L"] > 0.2}

    def snapshot(self):
        """Return the scene, as the bench's observer does."""
        fingers = {label: self._finger(label) for label in ("R", "L")}
        p, psi = self._pose
        middle = [(fingers["R"]["tip"][i] + fingers["L"]["tip"][i]) / 2 for i in (0, 1)]
        along = -math.sin(psi) * middle[0] + math.cos(psi) * middle[1]
        centre = [p * math.cos(psi) - along * math.sin(psi), p * math.sin(psi) + along * math.cos(psi)]
        return {
            "kind": "fingers",
            "t_s": self.t_s,
            "coils": {},
            "energy_j": {"elastic": self._energy(*self._pose) / 1000, "kinetic": 0.0, "gravity": 0.0},
            "tip_radius_mm": self.radius_mm,
            "youngs_modulus_mpa": E_MPA,
            "stiffness_nmm_per_rad": self._stiffness(),
            "model": {"tip": self.tip, "contact": "frictionless", "motion": "quasi-static"},
            "fingers": fingers,
            "object": {
                "centre": centre,
                "deg": math.degrees(psi),
                "width_mm": self.width_mm,
                "height_mm": self.width_mm,
                "gripped": self.deg["R"] - self.deg["L"] > 0.2,
                "along": "undetermined",
            },
        }

    def _place(self, label):
        side, q = (1 if label == "R" else -1), math.radians(self.deg[label])
        return [side * self._base_mm - self.link_mm * math.sin(q), self.link_mm * math.cos(q)]

    def _contact(self, label, p, psi):
        """Return displacement and relative angle of a tip."""
        (x, y), side = self._place(label), 1 if label == "R" else -1
        gap = side * (x * math.cos(psi) + y * math.sin(psi) - p)
        return self.radius_mm + self.width_mm / 2 - gap, psi - math.radians(self.deg[label])

    def _tip(self, d, theta):
        """Return energy [mJ], normal force [N] and moment [N mm]."""
        c = math.cos(theta) if self.tip == "nail" else 1.0
        moment = 2 * math.pi * E_MPA * d**3 * math.sin(theta) / (3 * c**3) if self.tip == "nail" else 0.0
        return math.pi * E_MPA * d**3 / (3 * c**2), math.pi * E_MPA * d**2 / c**2, moment

    def _energy(self, p, psi):
        return sum(self._tip(*self._contact(label, p, psi))[0] for label in ("R", "L"))

    def _derivatives(self, p, psi, h=1e-4):
        """Return slope and curvature of the energy over shift and angle, by differences."""
        u = {(i, j): self._energy(p + i * h, psi + j * h) for i in (-1, 0, 1) for j in (-1, 0, 1)}
        slope = ((u[1, 0] - u[-1, 0]) / (2 * h), (u[0, 1] - u[0, -1]) / (2 * h))
        across = (u[1, 1] - u[1, -1] - u[-1, 1] + u[-1, -1]) / (4 * h * h)
        return slope, ((u[1, 0] - 2 * u[0, 0] + u[-1, 0]) / h**2, across, (u[0, 1] - 2 * u[0, 0] + u[0, -1]) / h**2)

    def _stiffness(self):
        if self.deg["R"] - self.deg["L"] < 0.2:
            return 0.0
        _, (pp, across, turning) = self._derivatives(*self._pose)
        return turning - across**2 / pp

    def _finger(self, label):
        tip, side = self._place(label), 1 if label == "R" else -1
        d, theta = self._contact(label, *self._pose)
        _, normal, moment = self._tip(d, theta)
        return {
            "joint": [side * self._base_mm, 0.0],
            "elbow": tip,
            "tip": tip,
            "deg": self.deg[label],
            "commanded_deg": self.deg[label],
            "d_mm": d,
            "theta_deg": math.degrees(theta),
            "normal_n": normal,
            "moment_nmm": moment,
            "tangential_n": 0.0,
            "torque_nm": normal * self.link_mm / 1000,
            "current_a": 0.2 + 0.02 * normal,
            "limp": False,
        }


def recorded_pinch(moves=FIGURE_13, observed=True, **fingers):
    """Return the Recording of fingers that make these moves (seconds, swing, grip), a record each 50 ms."""
    plate = PinchedPlate(**fingers)
    recording = Recording((), "fingers-figure13.gait on sim:fingers", joints=("R", "L"))
    recording.note(Event(1000, 0, "started", 0, 0, None, 0))
    swing, grip, now_ms = 0.0, 0.0, 0
    for seconds, to_swing, to_grip in ((STEP_S, 0.0, 0.0), *moves):
        steps = round(seconds / STEP_S)
        for i in range(1, steps + 1):
            plate.turn(swing + (to_swing - swing) * i / steps, grip + (to_grip - grip) * i / steps)
            recording.note(_telemetry(plate, now_ms))
            if observed:
                recording.look(plate, 1000 + now_ms)
            now_ms += round(1000 * STEP_S)
            plate.t_s = now_ms / 1000
        swing, grip = to_swing, to_grip
    return recording


def _telemetry(plate, now_ms):
    deg = (plate.deg["R"], plate.deg["L"])
    joint_ma = tuple(round(200 + 40 * max(0.0, plate._contact(label, *plate._pose)[0]) ** 1.5) for label in ("R", "L"))
    return Telemetry(
        host_ms=1000 + now_ms,
        now_ms=now_ms,
        state="running",
        step=1,
        supply_mv=6000 - sum(joint_ma) // 20,
        current_ma=sum(joint_ma),
        board_degc=26.5,
        duty_permille=(),
        temperature_degc=(),
        joint_position=tuple(round(angle, 2) for angle in deg),
        commanded_position=deg,
        joint_ma=joint_ma,
        object_deg=round(plate.object_deg(), 2),
    )
