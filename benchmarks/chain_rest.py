"""Finds rest under load and small vibrations of a MuJoCo model with welds, by Newton's method around MuJoCo.

MuJoCo gives places, spring forces, the mass matrix and what its equalities want, with their Jacobian; so rest has no
error of a time step, of damping or of soft constraints. Stiffness is their change with place, by central differences.
"""

import mujoco
import numpy as np
from scipy.linalg import eigh, null_space

from benchmarks.sphere_chain import sphere_chain
from hil_sim.physics.bodies import SphereNumbers

NUDGE, TINY, MOST = 1e-6, 1e-12, 40
FREE = slice(6, None)  # joints but for the place of the first body, which is held


def pole_distance(numbers: SphereNumbers, nodes: int, loads: list[float], stretch: bool = True) -> np.ndarray:
    """Return the distance of two opposite crossings under each of these rising loads that press them together [m]."""
    rest = Rest(sphere_chain(numbers, nodes, stretch))
    return np.array([rest.settle(load) for load in loads])


def frequencies(numbers: SphereNumbers, nodes: int, stretch: bool = False) -> np.ndarray:
    """Return the frequencies of small vibrations of the free sphere, lowest first [Hz]."""
    return Rest(sphere_chain(numbers, nodes, stretch)).frequencies()


def extrapolated(coarse: np.ndarray, fine: np.ndarray, ratio: float = 2.0) -> np.ndarray:
    """Return the limit of what converges with the square of the length of a link, from two meshes of this ratio."""
    return fine + (fine - coarse) / (ratio**2 - 1)


class Rest:
    """A model without speed under a force along z on the body "+z", and the forces that hold its welds."""

    def __init__(self, spec: mujoco.MjSpec) -> None:
        spec.option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self.pole = self.model.body("+z").id
        self.move(np.zeros(self.model.nv))
        self.ties = np.zeros(self.data.nefc)

    def move(self, by: np.ndarray) -> None:
        """Move all joints and look at what follows."""
        mujoco.mj_integratePos(self.model, self.data.qpos, by, 1.0)
        for stage in (mujoco.mj_kinematics, mujoco.mj_comPos, mujoco.mj_makeConstraint, mujoco.mj_passive):
            stage(self.model, self.data)

    def pull(self, load: float) -> np.ndarray:
        """Return what pulls at each joint: springs, a load on the upper pole downwards [N], the welds."""
        data, lever = self.data, np.zeros((3, self.model.nv))
        mujoco.mj_jacBody(self.model, data, lever, None, self.pole)
        return data.qfrc_passive - load * lever[2] + self.jacobian().T @ self.ties

    def jacobian(self) -> np.ndarray:
        """Return how what the welds want changes with the joints."""
        return self.data.efc_J.reshape(self.data.nefc, self.model.nv).copy()

    def stiffness(self, load: float) -> np.ndarray:
        """Return how all that pulls changes with each joint, with the sign of a spring's constant."""
        k, here, start = np.zeros((self.model.nv, self.model.nv)), self.pull(load), self.data.qpos.copy()
        for column, unit in enumerate(np.eye(self.model.nv)):
            self.move(NUDGE * unit)
            k[:, column] = (here - self.pull(load)) / NUDGE
            self.data.qpos[:] = start
        self.move(0 * here)
        return k

    def settle(self, load: float) -> float:
        """Go to rest under a load [N] from where it is, and return the height of the upper pole over the first body."""
        for _ in range(MOST):
            k, j = self.stiffness(load)[FREE, FREE], self.jacobian()[:, FREE]
            whole = np.block([[k, -j.T], [j, np.zeros((len(j), len(j)))]])
            wrong = np.concatenate([self.pull(load)[FREE], -self.data.efc_pos])
            step = np.linalg.solve(whole, wrong)
            step *= min(1.0, 0.3 / abs(step[: len(k)]).max())
            self.ties += step[len(k) :]
            self.move(np.concatenate([np.zeros(6), step[: len(k)]]))
            if abs(step[: len(k)]).max() < 1e-9:
                return float(self.data.xpos[self.pole, 2] - self.data.xpos[1, 2])
        raise RuntimeError(f"no rest found under {load} N")

    def frequencies(self) -> np.ndarray:
        """Return the frequencies of small vibrations of the free unloaded body, lowest first [Hz]."""
        mass = np.zeros((self.model.nv, self.model.nv))
        mujoco.mj_forward(self.model, self.data)
        mujoco.mj_fullM(self.model, self.data, mass)
        k, free = self.stiffness(0.0), null_space(self.jacobian())
        squares = eigh(free.T @ (k + k.T) @ free / 2, free.T @ mass @ free, eigvals_only=True)
        return np.sqrt(np.maximum(squares[6:], 0)) / (2 * np.pi)  # six are of the rigid body
