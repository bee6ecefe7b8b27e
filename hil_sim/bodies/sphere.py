"""A sphere robot as a plant: electrical power of the coils in, shape, attitude and temperatures out.

Axes: x along the plane in the direction of travel, up its slope, y to the left, z away from it; the origin lies below
the place where the core was before the body came to rest. A sloped plane lies level until a coil is heated for the
first time, and is tilted a moment later, as for the ring. `rotation_deg` is positive for rolling forward.

    plant = SpherePlant(load("sphere-b"))
    plant.advance(5000, power_w)
    plant.observe()["travel_mm"], plant.attitude()
"""

from math import ceil, degrees, inf, isfinite
from typing import Any

import numpy as np

from hil_sim.bodies.coilbody import CoilBody
from hil_sim.bodies.directions import direction
from hil_sim.physics import coil
from hil_sim.physics.bodies import Attitude
from hil_sim.physics.body import gravity, packed
from hil_sim.physics.coilset import coils_of, cold
from hil_sim.physics.compiled import Array, prepare
from hil_sim.physics.flight import jump_of, no_flight
from hil_sim.physics.net import body
from hil_sim.physics.net.apart import nearest
from hil_sim.physics.net.gauge import centre, kinetic
from hil_sim.physics.net.mesh import SPHERE, net_of, unit
from hil_sim.physics.net.motion import begin
from hil_sim.physics.net.pulls import ARM, LENGTH, LENGTH_BEFORE, PULL, freeze, measure
from hil_sim.physics.net.rotation import matrix, quaternion
from hil_sim.physics.net.state import motion_of
from hil_sim.physics.state import method_of
from hil_sim.physics.tally import APEX, CLEARANCE, CONTACTS, ELASTIC, PEAK_FORCE, PEAK_T, STEP, TIME, TURN
from hil_sim.physics.terrain import profile, terrain_of
from hil_sim.robots.file import RobotFile

SEEN = 5.0  # radii of ground on either side in a snapshot
SLICE = 0.25  # [s]
SHARE = 0.01  # of the tolerated error, left to Newton's method
SETTLING_DRAG = 20.0  # [1/s] ASSUMED: numerical, the body is at rest within its settle_s


class SpherePlant(CoilBody):
    """Coils, hoops, core and ground of one robot, at rest at time 0; a function of the powers given to it."""

    def __init__(self, robot: RobotFile, seed: int = 0, rho: float = 0.5, tolerance: float | None = None) -> None:
        assert robot.sphere is not None
        assert isinstance(robot.start, Attitude)
        assert robot.ground is not None
        assert robot.coil is not None
        prepare(body.advance, coil.advance)
        ground, count, numbers = robot.ground, len(robot.labels), robot.sphere
        super().__init__(robot.labels, ground)
        spokes = [direction(label) for label in self.labels[: count - len(robot.jumps)]]
        chords = [(direction(a), direction(b)) for a, b in robot.jumps]
        self._compass = dict(zip(self.labels, (unit(each) for each in spokes), strict=False))
        self._radius = numbers.R
        self._net = net_of(numbers, ground, SPHERE, spokes, chords)
        self._terrain = terrain_of(ground, seed, 2.0 * numbers.R)
        self._method = method_of(rho, tolerance or robot.tolerance, share=SHARE)
        self._motion = motion_of(self._net, *self._placed(numbers.R, robot.start))
        self._tally = self._motion.tally
        self._flight = no_flight()
        self._weight = ground.gravity * float(self._net.mass.sum())
        coils = coils_of(robot.coil, count, ground.T_amb)
        self._coils = packed(coils)
        for s in range(count):
            measure(self._net, self._motion.now.x, self._motion.now.R, self._motion.coils, s)
        self._state = cold(coils, self._motion.coils[LENGTH])
        coil.measure(self._state, self._motion.coils[LENGTH], coils)
        self._motion.coils[LENGTH_BEFORE] = self._motion.coils[LENGTH]
        self._settle(robot.start.settle)
        self._begin(
            body.advance, self._net, self._terrain, self._coils, self._state, self._world, self._method, self._motion,
            self._flight,
        )  # fmt: skip
        self._start = self._centre()
        self.observe()  # no machine code is left to be loaded later

    @property
    def force(self) -> Array:
        """Pulls of the coils [N]."""
        pulls: Array = self._motion.coils[PULL]
        return pulls

    def attitude(self) -> tuple[float, float, float, float]:
        """Return the unit quaternion (w, x, y, z) that turns the round body's axes into those of the bench."""
        return quaternion(self._motion.attitude)

    def angular_rate(self) -> Array:
        """Return the spin of the core in its own axes [rad/s]."""
        spin: Array = self._motion.now.R[-1].T @ self._motion.now.v[-1, 3:]
        return spin

    def specific_force(self) -> Array:
        """Return what an accelerometer in the middle of the core reads, in the core's axes [m/s2]."""
        gx, gz = self._gravity()
        felt: Array = self._motion.now.R[-1].T @ (self._motion.now.a[-1, :3] - np.array([gx, 0.0, gz]))
        return felt

    def observe(self) -> dict[str, Any]:
        """Return what a motion capture system and a thermal camera would say."""
        tally = self._motion.tally
        x, y, _ = self._centre()
        return {
            "travel_mm": 1e3 * (x - self._start[0]),
            "lateral_mm": 1e3 * (y - self._start[1]),
            "rotation_deg": degrees(tally[TURN]),
            "apex_mm": 1e3 * max(0.0, float(tally[APEX]) - self._start[2]),
            "clearance_mm": 1e3 * max(0.0, float(tally[CLEARANCE])),
            "peak_coil_degc": float(tally[PEAK_T]),
            "peak_coil_force_n": float(tally[PEAK_FORCE]),
            "coil_degc": dict(zip(self.labels, self._state.T.tolist(), strict=True)),
            "attitude": list(self.attitude()),
            "down": self._down(),
            "contacts": int(tally[CONTACTS]),
            "strip_gap_mm": 1e3 * gap if isfinite(gap := float(nearest(self._net, self._motion.now.x))) else None,
            "jump": jump_of(self._flight, self._weight, self._start[2]),
        }

    def snapshot(self) -> dict[str, Any]:
        """Return the shape at this moment in millimetres along, across and above the plane, and where coils pull."""
        x, net, coils = self._motion.now.x, self._net, self._motion.coils
        nodes, near = (1e3 * x).tolist(), profile(self._terrain, x[-1, 0], SEEN * self._radius)
        starts = (1e3 * (x[net.near] + coils[ARM : ARM + 3].T)).tolist()
        return {
            "t_s": float(self._tally[TIME]),
            "slope_deg": self._slope_deg(),
            "hub": nodes[-1],
            "attitude": list(self.attitude()),
            "nodes": nodes[:-1],
            "hoops": net.hoops.tolist(),
            "strip_mm": 1e3 * net.width,
            "coils": self._coils_seen(starts, [nodes[far] for far in net.far]),
            "energy_j": {name.removesuffix("_j"): value for name, value in self._stored().items()},
            "terrain_mm": [[1e3 * along, 1e3 * up] for along, up in near],
        }

    def _placed(self, R: float, start: Attitude) -> tuple[Array, Array]:
        """Return places and rotation of the round body, turned, its lowest point on the ground."""
        turn = matrix(start.yaw, start.pitch, start.roll)
        places = np.vstack([R * self._net.directions, np.zeros((1, 3))])
        points = (places[self._net.feet] + self._net.offsets) @ turn.T
        return places @ turn.T - [0.0, 0.0, points[:, 2].min()], turn

    def _settle(self, seconds: float) -> None:
        """Come to rest on the level ground in thick air, then begin to count."""
        m, idle = self._motion, np.zeros(len(self.labels))
        level, thick = self._world._replace(slope=0.0), self._net._replace(drag=SETTLING_DRAG)
        freeze(self._coils, self._state.xi, m.coils)
        begin(thick, self._terrain, gravity(level, 0.0), m)
        parts = (thick, self._terrain, self._coils, self._state, level, self._method, m, self._flight)
        slices = ceil(seconds / SLICE)  # between two of them an interrupt is felt
        for _ in range(slices):
            body.advance(*parts, idle, seconds / slices)
        m.now.v[:] = m.now.a[:] = 0.0
        keep = m.tally[[STEP, ELASTIC, CONTACTS]]
        m.tally[:] = 0.0
        m.tally[[STEP, ELASTIC, CONTACTS]] = keep
        m.tally[APEX] = -inf  # it may rest below the plane, beside a drop
        self._flight[:] = no_flight()
        body.watch(self._net, self._state, m)
        m.tally[TURN] = 0.0

    def _centre(self) -> tuple[float, float, float]:
        net, x = self._net, self._motion.now.x
        return float(centre(net, x, 0)), float(centre(net, x, 1)), float(centre(net, x, 2))

    def _down(self) -> str:
        """Return the label of the coil from the core whose direction is nearest to down."""
        down = -self._motion.attitude[2]
        return max(self._compass, key=lambda label: float(self._compass[label] @ down))

    def _stored(self) -> dict[str, float]:
        """Return the mechanical energy of hoops and core [J]; that in the coils belongs to the coils."""
        m, net = self._motion, self._net
        gx, gz = self._gravity()
        x, _, z = self._centre()
        return {
            "kinetic_j": float(kinetic(net, m.now)),
            "gravity_j": -float(net.mass.sum() * (gx * x + gz * z)),
            "elastic_j": float(m.tally[ELASTIC]),
        }
