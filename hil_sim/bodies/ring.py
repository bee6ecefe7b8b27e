"""The ring robot as a plant: electrical power of the coils in, shape and temperatures out.

Axes: x along the plane and up its slope, y away from it, the origin below the place where the robot stood at the
start. Coil 0 is down at the start and the others follow counter-clockwise, so that rolling forward, to greater x,
brings them down in their order; `rotation_deg` is positive in that sense. A sloped plane lies level, however long,
until a coil is heated for the first time, and is tilted a moment later (`tilt_after_s`, `tilt_deg_per_s` of the robot
file), as an operator tilts the table under a robot that has taken hold: a round ring rolls off any slope.

    plant = RingPlant(load("circular"))
    plant.advance(5000, np.array([0.3, 0, 0, 0, 0, 0, 0, 0]))
    plant.observe()["travel_mm"]
"""

from math import degrees
from typing import Any

import numpy as np

from hil_sim.bodies.coilbody import CoilBody
from hil_sim.physics import body, coil
from hil_sim.physics.bodies import StartNumbers
from hil_sim.physics.coilset import coils_of, cold
from hil_sim.physics.compiled import Array, prepare
from hil_sim.physics.contact import crossings
from hil_sim.physics.flight import jump_of
from hil_sim.physics.gauge import centre, rim_energy
from hil_sim.physics.ring import ring_of, round_pose
from hil_sim.physics.spokes import LENGTH, LENGTH_BEFORE, PULL
from hil_sim.physics.state import method_of, motion_of
from hil_sim.physics.tally import APEX, CLEARANCE, PEAK_FORCE, PEAK_T, STEP, TIME, TURN
from hil_sim.physics.terrain import profile
from hil_sim.robots.file import RobotFile

SEEN = 10.0  # radii of the ground on either side that a snapshot shows
SETTLING_DRAG = 20.0  # [1/s] ASSUMED: numerical, the ring is at rest within its settle_s of 1 s


class RingPlant(CoilBody):
    """Coils, ring and ground of one robot, at rest at time 0; a function of the powers given to it and nothing else."""

    def __init__(self, robot: RobotFile, seed: int = 0, rho: float = 0.8, tolerance: float | None = None) -> None:
        prepare(body.advance)
        numbers, start = robot.ring, robot.start
        if numbers is None or not isinstance(start, StartNumbers):
            raise ValueError(f"{robot.name} is no ring but a {robot.kind}")
        assert robot.ground is not None
        assert robot.coil is not None
        ground, count = robot.ground, len(robot.labels)
        super().__init__(robot.labels, ground)
        self._ring = ring_of(numbers, ground, count, seed)
        self._method = method_of(rho, tolerance or robot.tolerance)
        R = self._radius = numbers.R
        self._motion = motion_of(self._ring, round_pose(self._ring, R, R, start.turn))
        self._tally = self._motion.tally
        self._motion.spokes[[LENGTH, LENGTH_BEFORE]] = R - numbers.attach
        coils = coils_of(robot.coil, count, ground.T_amb)
        self._coils = body.packed(coils)
        self._state = cold(coils, self._motion.spokes[LENGTH])
        coil.measure(self._state, self._motion.spokes[LENGTH], coils)
        self._settle(start.settle)
        self._begin(body.advance, self._ring, self._coils, self._state, self._world, self._method, self._motion)
        self._weight = float(self._ring.mass[:-2:2].sum()) * ground.gravity
        self._start = centre(self._ring, self._motion.now[0])
        self.observe()  # no machine code is left to be loaded later

    @property
    def force(self) -> Array:
        """Pulls of the coils [N]."""
        pulls: Array = self._motion.spokes[PULL]
        return pulls

    def observe(self) -> dict[str, Any]:
        """Return what a motion capture system and a thermal camera would say."""
        tally = self._motion.tally
        x, _ = centre(self._ring, self._motion.now[0])
        return {
            "travel_mm": 1e3 * (x - self._start[0]),
            "lateral_mm": 0.0,
            "rotation_deg": degrees(tally[TURN]),
            "apex_mm": 1e3 * max(0.0, float(tally[APEX]) - self._start[1]),
            "clearance_mm": 1e3 * float(tally[CLEARANCE]),
            "peak_coil_degc": float(tally[PEAK_T]),
            "peak_coil_force_n": float(tally[PEAK_FORCE]),
            "coil_degc": dict(zip(self.labels, self._state.T.tolist(), strict=True)),
            "rim_crossings": crossings(self._ring, self._motion.now[0]),
            "jump": jump_of(self._motion.flight, self._weight, self._start[1]),
        }

    def snapshot(self) -> dict[str, Any]:
        """Return the shape at this moment in millimetres along and above the plane, and where each coil pulls."""
        q, ring = self._motion.now[0], self._ring
        nodes = (1e3 * q[:-3].reshape(-1, 2)).tolist()
        hub, angle = (1e3 * q[-3:-1]).tolist(), float(q[-1])
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        ends = (1e3 * (q[-3:-1, None] + turn @ ring.arms)).T.tolist()
        return {
            "t_s": float(self._tally[TIME]),
            "hub": [*hub, angle],
            "nodes": nodes,
            "coils": self._coils_seen(ends, [nodes[foot] for foot in ring.feet]),
            "slope_deg": self._slope_deg(),
            "energy_j": {name.removesuffix("_j"): energy for name, energy in self._stored().items()},
            "terrain_mm": [[1e3 * along, 1e3 * up] for along, up in profile(ring.terrain, q[-3], SEEN * self._radius)],
        }

    def _settle(self, seconds: float) -> None:
        """Come to rest on the level plane in thick air, then begin to count.

        Strictly: a round ring of nodes stands on one of them as on a point, and what is left would tip it to a side.
        """
        strict = self._method._replace(share=0.0)
        level, thick = self._world._replace(slope=0.0), self._ring._replace(drag=SETTLING_DRAG)
        tally, now, idle = self._motion.tally, self._motion.now, np.zeros(len(self.labels))
        if seconds > 0.0:
            body.advance(thick, self._coils, self._state, level, strict, self._motion, idle, seconds)
        now[1:3] = 0.0
        keep = tally[[STEP, TURN]]
        tally[:] = 0.0
        self._motion.flight[:] = 0.0
        tally[[STEP, TURN]] = keep

    def _stored(self) -> dict[str, float]:
        """Return the mechanical energy of rim and hub [J]; that in the coils belongs to the coils."""
        now, ring = self._motion.now, self._ring
        gx, gy = self._gravity()
        x, y = centre(ring, now[0])
        weighed = ring.mass[:-2:2].sum()
        return {
            "kinetic_j": 0.5 * float(ring.mass @ now[1] ** 2),
            "gravity_j": -float(weighed * (gx * x + gy * y)),
            "elastic_j": rim_energy(ring, now[0]),
        }
