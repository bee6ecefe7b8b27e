"""A block under a press once more, of other parts: scikit-fem's elements, scipy's solvers, contact by least squares.

The history stands at the quadrature points, three to a triangle, with x, y, z and xy. The forces of contact are
non-negative least squares: with the compliance C = L L^T of the surface and the depths w by which it would be inside
the shape they make |L^T f - L^-1 w| least. Nothing here comes from physics/block but numbers.
"""

import numpy as np
from scipy.optimize import nnls
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, ElementTriP1, ElementVector, LinearForm, MeshTri

IN_PLANE, PARTS, SETTLED = (0, 1, 3), 10, 5.0


def isotropic(E, nu):
    """Return the matrix of stress by strain, x, y, z and engineering shear xy."""
    lame, shear = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), 0.5 * E / (1.0 + nu)
    C = np.diag([2.0 * shear] * 3 + [shear])
    C[:3, :3] += lame
    return C


def components(gradient):
    """Return the strain of a gradient [i, j] = du_i / dx_j in the plane."""
    zero = 0.0 * gradient[0, 0]
    return np.stack([gradient[0, 0], gradient[1, 1], zero, gradient[0, 1] + gradient[1, 0]])


def times(C, strain):
    """Return the matrix times what stands at the quadrature points."""
    return np.einsum("ij,j...->i...", C, strain)


class FemBlock:
    """A block that stands on its lowest nodes, below a shape that is `height(x)` above its lowest point."""

    def __init__(self, points, triangles, material, thickness, height):
        mesh = MeshTri(points.T.copy(), triangles.copy())
        self.basis = Basis(mesh, ElementVector(ElementTriP1()), intorder=2)
        self.material, self.thickness = material, thickness
        x, y = mesh.p
        surface = np.flatnonzero(np.isfinite(height(x)) & (y == y.max()))
        self.gap, self.pressed = height(x[surface]), self.basis.nodal_dofs[1, surface]
        self.free = np.setdiff1d(np.arange(self.basis.N), self.basis.nodal_dofs[:, y == y.min()])
        still = np.zeros((4, *self.basis.dx.shape))
        self.strain, self.stress, self.q = still, still, [still] * len(material.branches)
        self.u, self.forces = np.zeros(self.basis.N), np.zeros(surface.size)
        self.t = self.settled_s = self.depth = 0.0
        self.unloading, self.kept = False, {}

    def press(self, dt, depth):
        """Go to a depth, in parts while the block settles after it was freed."""
        parts, began = PARTS if self.t < self.settled_s else 1, self.depth
        for part in range(1, parts + 1):
            self._step(dt / parts, began + part / parts * (depth - began))

    def _viscosities(self):
        """Return those of the dashpot and of the branches that hold now."""
        m, now = self.material, lambda c, other: other if self.unloading and other is not None else c
        return now(m.c0, m.c0_unloading), [now(branch.c, branch.c_unloading) for branch in m.branches]

    def _material(self, dt):
        """Return what strain at the end of a step does, spring and dashpot alone and all, and the branches' share."""
        m, (c0, viscosities) = self.material, self._viscosities()
        spring, dashpot, branches = isotropic(m.E0, m.nu0), isotropic(c0 / dt, m.nu_c), []
        for (E, _, nu, _), c in zip(m.branches, viscosities, strict=True):
            branches.append((np.exp(-dt * E / c), isotropic(c / dt * (1.0 - np.exp(-dt * E / c)), nu)))
        return spring, dashpot, branches, spring + dashpot + sum(gain for _, gain in branches)

    def _system(self, dt):
        """Return the material of a step, its factored stiffness and what forces on the surface do."""
        key = (round(dt * 1e9), self.unloading)
        if key not in self.kept:
            told = self._material(dt)
            stiffness = self._assembled(self._flat(told[-1]))
            factor, unit = splu(stiffness[self.free][:, self.free].tocsc()), np.zeros((self.basis.N, self.pressed.size))
            unit[self.pressed, np.arange(self.pressed.size)] = 1.0
            influence = np.zeros_like(unit)
            influence[self.free] = factor.solve(unit[self.free])
            self.kept[key] = told, factor, influence
        return self.kept[key]

    def _flat(self, C):
        """Return the matrix in the plane, without stress along z if there is none."""
        return C if self.material.plane == "strain" else C - np.outer(C[:, 2], C[2]) / C[2, 2]

    def _assembled(self, C):
        @BilinearForm
        def energy(u, v, _):
            strain, virtual = components(u.grad), components(v.grad)
            return sum(C[i, j] * strain[j] * virtual[i] for i in IN_PLANE for j in IN_PLANE)

        return self.thickness * energy.assemble(self.basis).tocsr()

    def _against(self, stress):
        @LinearForm
        def work(v, _):
            virtual = components(v.grad)
            return sum(stress[i] * virtual[i] for i in IN_PLANE)

        return self.thickness * work.assemble(self.basis)

    def _step(self, dt, depth):
        (spring, dashpot, branches, C), factor, influence = self._system(dt)
        past = times(spring, self.strain) + sum(keep * q for (keep, _), q in zip(branches, self.q, strict=True))
        flat = self.material.plane == "stress"
        bare = past - np.multiply.outer(C[:, 2] / C[2, 2], past[2]) if flat else past
        tried = self.u.copy()
        tried[self.free] -= factor.solve(self._against(bare)[self.free])
        forces = pushed(influence[self.pressed], tried[self.pressed] - self.gap + depth)
        u = tried - influence @ forces
        grown = components(self.basis.interpolate(u - self.u).grad)
        if flat:
            grown[2] = -(past[2] + times(C, grown)[2]) / C[2, 2]
        self.q = [keep * q + times(gain, grown) for (keep, gain), q in zip(branches, self.q, strict=True)]
        self.strain = self.strain + grown
        self.stress = times(spring, self.strain) + times(dashpot, grown) + sum(self.q)
        freed = self.forces.any() and not forces.any()
        work = -forces @ (u - self.u)[self.pressed]
        self.u, self.forces, self.depth, self.t = u, forces, depth, self.t + dt
        self.unloading = bool(freed or (work < 0.0 if abs(work) > 1e-15 else self.unloading))
        self.settled_s = self.t + SETTLED / self._fastest() if freed else self.settled_s

    def _fastest(self):
        """Return the fastest rate of strain and branches without load, of the unloaded material with its dashpot."""
        was, self.unloading = self.unloading, True
        c0, viscosities = self._viscosities()
        self.unloading = was
        E = np.array([branch.E for branch in self.material.branches])
        strain = np.r_[-self.material.E0, -np.ones(E.size)] / c0
        rates = np.c_[np.zeros(E.size), np.diag(E / viscosities)]
        return -np.linalg.eigvals(np.vstack([strain, np.outer(E, strain) - rates])).real.min()


def pushed(C, inside):
    """Return the forces that leave nothing inside and do not pull, exact for the points that nnls lets touch."""
    if (inside <= 0.0).all():
        return np.zeros_like(inside)
    L = np.linalg.cholesky(0.5 * (C + C.T))
    touch = nnls(L.T, np.linalg.solve(L, inside), maxiter=100 * inside.size)[0] > 0.0
    forces = np.zeros_like(inside)
    forces[touch] = np.linalg.solve(C[np.ix_(touch, touch)], inside[touch])
    return forces
