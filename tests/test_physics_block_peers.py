"""The block against scikit-fem and scipy, which assemble and solve by themselves on the same mesh."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, ElementTriP1, ElementVector, MeshTri
from skfem.helpers import ddot, div, sym_grad

from hil_sim.physics.block.block import Block
from hil_sim.physics.block.law import fastest
from hil_sim.physics.block.mesh import rectangle
from tests.block_samples import (
    DEPTH,
    FIVE,
    HOLD_S,
    MIXED,
    PUSH_S,
    THICK,
    THREE,
    distorted,
    ends,
    materials,
    pressed,
    scattered,
)

TIMES_S = [0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 5.5, 8.0]


def stiffness(mesh, nu, plane):
    """Return scikit-fem's stiffness for Young's modulus 1."""
    shear = 0.5 / (1.0 + nu)
    swell = nu / ((1.0 + nu) * (1.0 - 2.0 * nu)) if plane == "strain" else nu / (1.0 - nu**2)

    @BilinearForm
    def energy(u, v, _):
        return 2.0 * shear * ddot(sym_grad(u), sym_grad(v)) + swell * div(u) * div(v)

    basis = Basis(MeshTri(mesh.points.T.copy(), mesh.triangles.copy()), ElementVector(ElementTriP1()))
    return THICK * energy.assemble(basis).tocsc()


class Peer:
    """The same block of scikit-fem's matrices, each branch with its history by node, solved by scipy."""

    def __init__(self, mesh, material):
        self.c0, self.settling_s = material.c0, 5.0 / fastest(material)
        self.spring = material.E0 * stiffness(mesh, material.nu0, material.plane)
        self.dashpot = stiffness(mesh, material.nu_c, material.plane)
        self.branches = [stiffness(mesh, branch.nu, material.plane) * branch.E for branch in material.branches]
        self.rates = [branch.E / branch.c for branch in material.branches]
        self.u, self.forces = np.zeros((2, 2 * mesh.nodes))
        self.q = [self.u] * len(self.rates)

    def advance(self, held, target, dt):
        """Take one step to a target of what is held."""
        keep = [np.exp(-dt * rate) for rate in self.rates]
        gain = [(1.0 - a) / (dt * rate) for a, rate in zip(keep, self.rates, strict=True)]
        past = self.spring @ self.u + sum(a * q for a, q in zip(keep, self.q, strict=True))
        K = (
            self.spring
            + self.c0 / dt * self.dashpot
            + sum(g * part for g, part in zip(gain, self.branches, strict=True))
        )
        free, du = np.setdiff1d(np.arange(past.size), held), np.zeros(past.size)
        du[held] = (target - self.u)[held]
        du[free] = splu(K[free][:, free].tocsc()).solve(-past[free] - K[free][:, held] @ du[held])
        self.forces = past + K @ du
        self.q = [a * q + g * (part @ du) for a, q, g, part in zip(keep, self.q, gain, self.branches, strict=True)]
        self.u = self.u + du


def peer(mesh, material, times_s, dt):
    """Return displacements and forces on the nodes at some times of `pressed`."""
    other, found, (bottom, punch) = Peer(mesh, material), [], ends(mesh, 0.040)
    freed_s, target = PUSH_S + HOLD_S + 1e-9, np.zeros(2 * mesh.nodes)
    for step in range(1, round(max(times_s) / dt) + 1):
        t = step * dt
        fixed = np.r_[bottom, punch] if t < freed_s else bottom
        target[2 * punch + 1] = -DEPTH * min(1.0, t / PUSH_S)
        parts = 10 if freed_s < t < freed_s + other.settling_s + dt - 2e-9 else 1
        for _ in range(parts):
            other.advance(np.r_[2 * fixed, 2 * fixed + 1], target, dt / parts)
        found += [(other.u, other.forces)] * (np.abs(np.array(times_s) - t) < 1e-9).sum()
    return found


def agree(mesh, material, dt, times_s=TIMES_S):
    """Compare displacements and forces of both at some times."""
    states = pressed(Block(mesh, material, THICK), times_s, dt, width=0.040)
    greatest = max(np.abs(state.force).max() for state in states)
    for state, (u, forces) in zip(states, peer(mesh, material, times_s, dt), strict=True):
        assert state.u.ravel() == pytest.approx(u, abs=1e-10 * DEPTH)
        assert state.force.ravel() == pytest.approx(forces, abs=1e-10 * greatest)


@pytest.mark.parametrize("material", [THREE, FIVE, MIXED, THREE._replace(plane="stress")])
def test_forces_and_displacements_are_scikit_fem_s(material):
    agree(rectangle(0.08, 0.04, 16, 8), material, 0.25)


@settings(max_examples=8)
@given(material=materials(one_nu=False), seed=st.integers(0, 99), scattering=st.booleans())
def test_also_with_other_poisson_ratios_in_each_branch_and_on_other_meshes(material, seed, scattering):
    mesh = scattered(40, seed) if scattering else distorted(16, 8, seed)

    agree(mesh, material._replace(plane="strain"), 0.5)


def test_also_at_a_finer_mesh():
    agree(rectangle(0.08, 0.04, 64, 32), MIXED, 0.5, [0.5, 2.0])
