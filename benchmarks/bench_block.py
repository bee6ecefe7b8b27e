"""Times a step of the rheological block against scikit-fem with scipy's splu, in one run.

All get the same mesh and the three-element block of scenario A under a bonded punch that goes down; each factors its
stiffness once and uses it again. `scikit-fem` keeps the history at the points of quadrature and assembles the load of
the past anew in each step, as one does with it; `its matrices` is the least that scipy can do: matrices of scikit-fem,
the history of the branch kept by node, no stress at all. Forces must agree. They take turns of ten steps; printed is
the processor time of a step in the best turn, and its share of the 20 ms that the step stands for.

    python benchmarks/bench_block.py
"""

from collections.abc import Callable
from time import process_time

import numpy as np
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, ElementTriP1, ElementVector, LinearForm, MeshTri
from skfem.helpers import ddot, div, sym_grad

from hil_sim.physics.block.block import Block, hold
from hil_sim.physics.block.material import Material, Maxwell
from hil_sim.physics.block.mesh import Mesh, rectangle
from hil_sim.physics.block.step import advance, rest

E1, C1, C0, NU, THICK = 60e3, 300e3, 6e3, 0.35, 0.040
STEP_S, TURNS, STEPS, SPEED = 0.020, 12, 10, -0.002  # of the punch [m/s]
COLUMNS = (32, 64, 96, 128)
AIM, AIM_TRIANGLES = 0.2, 9216
KEEP = np.exp(-STEP_S * E1 / C1)
GAIN = E1 * (1.0 - KEEP) / (STEP_S * E1 / C1)
SHEAR, SWELL = 0.5 / (1.0 + NU), NU / ((1.0 + NU) * (1.0 - 2.0 * NU))
Step = Callable[[], float]


def punch_of(mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Return the nodes at the bottom and those under a punch of 20 mm."""
    x, y = mesh.points.T
    return mesh.where(y == 0.0), mesh.where((y > 0.03999) & (np.abs(x - 0.04) < 0.01001))


def own(mesh: Mesh) -> Step:
    """Return what takes one step of ours and returns the force on the punch [N]."""
    bottom, punch = punch_of(mesh)
    block = Block(mesh, Material((Maxwell(E1, C1, NU),), c0=C0, nu_c=NU), THICK)
    state = rest(block)

    def step() -> float:
        nonlocal state
        down = SPEED * (state.t + STEP_S)
        state = advance(block, state, hold((bottom, 0.0, 0.0), (punch, 0.0, down)), STEP_S)
        return float(state.force[punch, 1].sum())

    return step


@BilinearForm
def elastic(u, v, _):
    """Return the energy of Young's modulus 1."""
    return 2.0 * SHEAR * ddot(sym_grad(u), sym_grad(v)) + SWELL * div(u) * div(v)


@LinearForm
def held_back(v, w):
    """Return the work of the stress of the past."""
    return ddot(w.past, sym_grad(v))


class Peer:
    """Scikit-fem's matrix, factored by scipy for the free degrees of freedom."""

    def __init__(self, mesh: Mesh) -> None:
        self.basis = Basis(
            MeshTri(mesh.points.T.copy(), mesh.triangles.copy()), ElementVector(ElementTriP1()), intorder=1
        )
        self.K = (THICK * elastic.assemble(self.basis)).tocsr()
        bottom, self.punch = punch_of(mesh)
        fixed = np.r_[bottom, self.punch]
        self.free = np.setdiff1d(np.arange(2 * mesh.nodes), np.r_[2 * fixed, 2 * fixed + 1])
        self.scale = GAIN + C0 / STEP_S
        options = {"permc_spec": "MMD_AT_PLUS_A", "diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
        self.factor = splu(self.scale * self.K[self.free][:, self.free].tocsc(), **options)
        self.coupling = self.scale * self.K[self.free][:, 2 * self.punch + 1]
        self.past, self.q = np.zeros(2 * mesh.nodes), np.zeros((2, 2, mesh.area.size, 1))

    def move(self, load: np.ndarray) -> np.ndarray:
        """Return the displacements of a step that begins with these forces of the past."""
        down, du = np.full(self.punch.size, SPEED * STEP_S), np.zeros(load.size)
        du[2 * self.punch + 1] = down
        du[self.free] = self.factor.solve(-load[self.free] - self.coupling @ down)
        return du

    def by_points(self) -> float:
        """Take a step with the history at the points of quadrature; return the force on the punch [N]."""
        load = THICK * held_back.assemble(self.basis, past=KEEP * self.q)
        du = self.move(load)
        strain = sym_grad(self.basis.interpolate(du))
        stress = 2.0 * SHEAR * strain + SWELL * np.einsum("ii...,jk->jk...", strain, np.eye(2))
        self.q = KEEP * self.q + GAIN * stress
        total = THICK * held_back.assemble(self.basis, past=self.q + C0 / STEP_S * stress)
        return float(total[2 * self.punch + 1].sum())

    def by_nodes(self) -> float:
        """Take a step with the history as forces on the nodes; return the force on the punch [N]."""
        load = KEEP * self.past
        moved = self.K @ self.move(load)
        self.past = load + GAIN * moved
        return float((load + self.scale * moved)[2 * self.punch + 1].sum())


def timed(make: Callable[[], Step]) -> tuple[float, Step]:
    """Return how long it takes up to the end of the first step [s], and what takes the next."""
    start = process_time()
    step = make()
    step()
    return process_time() - start, step


def raced(columns: int) -> float:
    """Print the times of one mesh; return our step over its length."""
    mesh = rectangle(0.080, 0.040, columns, columns // 2)
    names = ("own", "scikit-fem, splu", "its matrices, splu")
    begun = [timed(make) for make in (lambda: own(mesh), lambda: Peer(mesh).by_points, lambda: Peer(mesh).by_nodes)]
    took, forces = [float("inf")] * 3, [0.0] * 3
    for _ in range(TURNS):
        for i, (_, step) in enumerate(begun):
            start = process_time()
            forces[i] = [step() for _ in range(STEPS)][-1]
            took[i] = min(took[i], (process_time() - start) / STEPS)
    for i, name in enumerate(names):
        apart = abs(forces[i] / forces[0] - 1.0)
        times = f"{1e3 * begun[i][0]:9.0f}{1e3 * took[i]:9.2f}{took[i] / STEP_S:9.3f}{took[i] / took[0]:8.1f}x"
        print(f"{mesh.area.size:8}  {name:20}{times}{apart:10.0e}")
    return took[0] / STEP_S


def main() -> None:
    """Print the table."""
    timed(lambda: own(rectangle(0.080, 0.040, 8, 4)))  # compiles
    print(f"{'triangles':8}{'':21}{'ready ms':>9}{'step ms':>9}{'of 20 ms':>9}{'own is':>9}{'apart':>10}")
    shares = {columns * columns: raced(columns) for columns in COLUMNS}
    print(f"aim: at most {AIM} of a step at {AIM_TRIANGLES} triangles: {shares[AIM_TRIANGLES]:.3f}")


if __name__ == "__main__":
    main()
