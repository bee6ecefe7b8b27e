"""The orders at which a block converges to a field whose forces are known."""

import numpy as np
import pytest

from hil_sim.physics.block.block import Block, hold
from hil_sim.physics.block.law import push_and_hold
from hil_sim.physics.block.mesh import rectangle
from hil_sim.physics.block.step import advance, rest
from tests.block_samples import MIXED, distorted

T = 2.0
MIDDLES = np.array([[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]])  # of the sides: exact to the second power
RATIO = {"strain": lambda nu: 1.0 / (1.0 - 2.0 * nu), "stress": lambda nu: (1.0 + nu) / (1.0 - nu)}


def field(x, y):
    """Return the displacements at the end, and their gradient (axis, by, ...)."""
    (sx, cx), (sy, cy) = ((np.sin(np.pi * each), np.cos(np.pi * each)) for each in (x, y))
    return np.array([sx * sy, cx * sy]), np.pi * np.array([[cx * sy, sx * cy], [-sx * sy, cx * cy]])


def force(x, y, material):
    """Return the force per volume that the field needs at T, when it grows evenly: -div sigma of each part."""
    (sx, cx), (sy, cy) = ((np.sin(np.pi * each), np.cos(np.pi * each)) for each in (x, y))
    u, _ = field(x, y)
    swell = np.pi**2 * np.array([-sx * sy - sx * cy, cx * cy - cx * sy])  # gradient of the divergence
    bare = material._replace(branches=(), E0=0.0, c0=0.0)
    parts = [(bare._replace(E0=material.E0), material.nu0), (bare._replace(c0=material.c0), material.nu_c)]
    parts += [(bare._replace(branches=(branch,)), branch.nu) for branch in material.branches]
    total = np.zeros_like(u)
    for part, nu in parts:
        shear = push_and_hold(part, T, T) / (2.0 * (1.0 + nu))
        total += shear * (2.0 * np.pi**2 * u - RATIO[material.plane](nu) * swell)
    return total


def errors(mesh, material):
    """Return the errors of the displacement and of its gradient, root mean square over the square."""
    corners = mesh.points[mesh.triangles]
    places = np.einsum("mc,ctd->mtd", MIDDLES, corners)
    nodal = np.einsum("mc,dmt,t->ctd", MIDDLES, force(*np.moveaxis(places, 2, 0), material), mesh.area / 3.0)
    forces = np.stack([np.bincount(mesh.triangles.ravel(), nodal[..., axis].ravel()) for axis in (0, 1)], axis=1)
    state, block, held = rest(Block(mesh, material)), Block(mesh, material), hold(*rim(mesh))
    state = advance(block, state, held, T, forces)

    u, gradient = field(*np.moveaxis(places, 2, 0))
    found = np.einsum("mc,ctd->dmt", MIDDLES, state.u[mesh.triangles])
    slopes = state.strain[[0, 1, 3], None]
    strain = np.array([gradient[0, 0], gradient[1, 1], gradient[0, 1] + gradient[1, 0]])
    weights = mesh.area / 3.0
    return np.sqrt(((found - u) ** 2 * weights).sum()), np.sqrt(((slopes - strain) ** 2 * weights).sum())


def rim(mesh):
    """Return the boundary held where the field puts it."""
    return [([node], *field(*mesh.points[node])[0]) for node in mesh.boundary]


def test_displacements_converge_with_order_two_and_strains_with_order_one():
    found = np.array([errors(rectangle(1.0, 1.0, n, n), MIXED) for n in (16, 32, 64)])

    orders = np.log2(found[:-1] / found[1:])
    assert orders[:, 0] == pytest.approx([2.0, 2.0], abs=0.1)
    assert orders[:, 1] == pytest.approx([1.0, 1.0], abs=0.1)


def test_they_do_so_on_distorted_meshes():
    found = np.array([errors(distorted(n, n, 1, 1.0, 1.0, 0.2), MIXED) for n in (16, 32, 64)])

    orders = np.log2(found[:-1] / found[1:])
    assert orders.mean(axis=0) == pytest.approx([2.0, 1.0], abs=0.1)


def test_in_plane_stress_with_one_poisson_ratio_too():
    branches = tuple(branch._replace(nu=0.3) for branch in MIXED.branches)
    material = MIXED._replace(branches=branches, nu0=0.3, nu_c=0.3, plane="stress")

    found = np.array([errors(rectangle(1.0, 1.0, n, n), material) for n in (16, 32, 64)])
    assert np.log2(found[1] / found[2]) == pytest.approx([2.0, 1.0], abs=0.1)
