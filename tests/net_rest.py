"""Brings a free sphere of the net to rest between two loads on its poles, by Newton's method on its own tangent."""

from dataclasses import replace

import numpy as np

from hil_sim.physics.bodies import SphereNumbers
from hil_sim.physics.net.mesh import SPHERE, net_of, node_at
from hil_sim.physics.net.motion import correct, forces
from hil_sim.physics.net.pulls import FREE, SOFT
from hil_sim.physics.net.rotation import turned
from hil_sim.physics.net.state import motion_of
from hil_sim.physics.terrain import terrain_of
from hil_sim.robots.file import load

TOP, BOTTOM = (0, 0, 1), (0, 0, -1)
SOFTNESS = 1e-6  # [N/m] of the spring between the poles: its pull does not depend on their distance
MOST, DONE, WARY, BOLD = 200, 1e-10, 1e6, 1e-2


class NetRest:
    """A net far above the ground, without gravity, whose poles pull each other; its core is light and loose."""

    def __init__(self, numbers: SphereNumbers, nodes: int) -> None:
        ground, light = load("sphere-b").ground, replace(numbers, nodes=nodes, m_core=1e-6)
        self.net, self.terrain = net_of(light, ground, SPHERE, [], [(BOTTOM, TOP)]), terrain_of(ground, 0)
        places = np.vstack([numbers.R * self.net.directions, np.zeros((1, 3))])
        places[:, 2] += 1.0
        self.motion = motion_of(self.net, places, np.eye(3))

    def settle(self, pull: float) -> float:
        """Go to rest under a pull [N] from where it is, and return the distance of the poles [m]."""
        m, caution = self.motion, 1.0  # as if some mass held each body back [1/s2]
        m.coils[SOFT], m.coils[FREE] = SOFTNESS, -pull / SOFTNESS
        for _ in range(MOST):
            forces(self.net, self.terrain, (0.0, 0.0), m, m.now)
            m.rhs[:] = -m.now.f
            if not correct(self.net, m, 0.0, caution, False):
                caution = min(WARY, 10.0 * caution)
                continue
            caution = max(BOLD, 0.1 * caution)
            self.go()
            if abs(m.correction[:-1]).max() < DONE:
                return float(
                    m.now.x[node_at(self.net.directions, TOP), 2] - m.now.x[node_at(self.net.directions, BOTTOM), 2]
                )
        raise RuntimeError(f"no rest found under {pull} N")

    def go(self) -> None:
        """Move and turn all bodies by the correction, none far."""
        m = self.motion
        m.correction[:] *= min(1.0, 0.3 / max(1e-12, abs(m.correction[:-1, 3:]).max()))
        m.now.x[:] += m.correction[:, :3]
        before = m.now.R.copy()
        for body in range(self.net.bodies):
            turned(before, m.correction, body, m.now.R)


def net_pole_distance(numbers: SphereNumbers, nodes: int, pulls: list[float]) -> np.ndarray:
    """Return the distance of two opposite crossings under each of these rising pulls of one to the other [m]."""
    rest = NetRest(numbers, nodes)
    return np.array([rest.settle(pull) for pull in pulls])
