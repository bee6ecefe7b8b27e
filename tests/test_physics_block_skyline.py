"""The order of the nodes and the factor of the stiffness, against numpy."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hil_sim.physics.block.block import Block, hold
from hil_sim.physics.block.elements import stiffness_of
from hil_sim.physics.block.material import BlockError
from hil_sim.physics.block.mesh import mesh_of, rectangle
from hil_sim.physics.block.order import cuthill_mckee, order_of, pairs_of, profile
from tests.block_samples import THREE, distorted, ends, scattered


def dense(block, stiffness):
    """Return the whole stiffness as a square array."""
    blocks = stiffness_of(block.mesh, stiffness.D, block.triangles.volume, block.pair, block.i.size)
    K = np.zeros((block.mesh.nodes, 2, block.mesh.nodes, 2))
    K[block.i, :, block.j, :] = blocks
    return K.reshape(2 * block.mesh.nodes, -1)


@settings(max_examples=15)
@given(seed=st.integers(0, 99), scattering=st.booleans())
def test_displacements_and_influences_are_those_of_the_whole_matrix(seed, scattering):
    mesh = scattered(40, seed) if scattering else distorted(8, 5, seed)
    block, rng = Block(mesh, THREE, 0.04), np.random.default_rng(seed)
    bottom, punch = ends(mesh)
    held = hold((bottom, 0.0, 0.0), (punch, None, -1e-3))
    stiffness = block.stiffness(held, 0.05)
    K, f = dense(block, stiffness), rng.normal(size=2 * mesh.nodes)
    free = np.setdiff1d(np.arange(f.size), held.dofs)

    expected = np.zeros((2, f.size))
    expected[0, held.dofs] = held.u
    unit = (free == free[7]).astype(float)
    right = np.array([f[free] - K[np.ix_(free, held.dofs)] @ held.u, unit])
    expected[:, free] = np.linalg.solve(K[np.ix_(free, free)], right.T).T

    assert pytest.approx(K.T, rel=1e-12, abs=1e-9) == K
    assert stiffness.solve(f, held.u) == pytest.approx(expected[0], abs=1e-10 * np.abs(expected[0]).max())
    assert stiffness.influence(free[[7, 7]])[1] == pytest.approx(expected[1], abs=1e-10 * np.abs(expected[1]).max())


def test_what_is_held_has_no_influence():
    block = Block(rectangle(0.08, 0.04, 6, 3), THREE)
    held = hold((ends(block.mesh)[0], 0.0, 0.0))
    stiffness = block.stiffness(held, 0.1)

    assert not stiffness.influence(held.dofs).any()
    assert stiffness.influence(np.zeros(0, np.int64)).shape == (0, 2 * block.mesh.nodes)


@pytest.mark.parametrize(("columns", "rows"), [(64, 32), (10, 60)])
def test_a_long_rectangle_is_ordered_along_its_length(columns, rows):
    mesh = rectangle(columns, rows, columns, rows)
    i, j = pairs_of(mesh)

    assert profile(order_of(mesh.points, i, j), i, j) <= mesh.nodes * (min(columns, rows) + 3)


def test_cuthill_mckee_finds_the_narrow_way_through_a_bent_strip():
    strip = rectangle(100.0, 1.0, 100, 2)
    angle = 0.06 * strip.points[:, 0]
    bent = np.stack([np.sin(angle), np.cos(angle)], axis=1) * (10 + strip.points[:, 1:])
    shuffle = np.random.default_rng(1).permutation(strip.nodes)
    mesh = mesh_of(bent[np.argsort(shuffle)], shuffle[strip.triangles.T])
    i, j = pairs_of(mesh)

    order = cuthill_mckee(i, j)
    assert sorted(order) == list(range(mesh.nodes))
    assert profile(np.argsort(order), i, j) < 6 * mesh.nodes
    assert profile(order_of(mesh.points, i, j), i, j) <= profile(np.argsort(order), i, j)


def test_factors_are_kept_by_step_and_supports():
    block = Block(rectangle(0.08, 0.04, 6, 3), THREE)
    bottom, punch = ends(block.mesh)
    low, high = (hold((bottom, 0.0, 0.0), (punch, None, y)) for y in (-0.001, 0.0))

    assert block.stiffness(low, 0.1) is block.stiffness(high, 0.1)
    assert block.stiffness(low, 0.1) is block.stiffness(low, 0.1, unloading=True)  # the same viscosities
    assert block.stiffness(low, 0.05) is not block.stiffness(low, 0.1)
    assert block.stiffness(hold((bottom, 0.0, 0.0)), 0.1) is not block.stiffness(low, 0.1)


def test_a_dual_modulus_has_another_factor_in_unloading():
    block = Block(rectangle(0.08, 0.04, 6, 3), THREE._replace(c0_unloading=1e3))
    held = hold((ends(block.mesh)[0], 0.0, 0.0))

    loading, unloading = (block.stiffness(held, 0.1, each) for each in (False, True))

    assert loading is block.stiffness(held, 0.1) is not unloading
    assert (loading.update.C > unloading.update.C)[:3, :3].all()


@pytest.mark.parametrize("nodes", [[], [0], [0, 4, 8]])
def test_supports_that_leave_the_block_free_are_refused(nodes):
    block = Block(rectangle(0.08, 0.04, 6, 3), THREE)

    with pytest.raises(BlockError, match=r"the supports leave node \d+ free to move along [xy] without strain"):
        block.stiffness(hold((nodes, None if len(nodes) > 1 else 0.0, 0.0)), 0.1)


def test_a_piece_without_supports_is_refused():
    one = rectangle(1.0, 1.0, 2, 2)
    two = mesh_of(np.r_[one.points, one.points + 5.0], np.c_[one.triangles, one.triangles + one.nodes].T)

    with pytest.raises(BlockError, match=r"free to move"):
        Block(two, THREE).stiffness(hold((range(one.nodes), 0.0, 0.0)), 0.1)


def test_a_node_held_in_two_places_or_nowhere_is_refused():
    with pytest.raises(BlockError, match=r"node 3 is held at 0\.2 m along y, and at 0\.1 m"):
        hold(([1, 3], 0.0, 0.1), ([3], None, 0.2))
    with pytest.raises(BlockError, match=r"node 5 is held at nan m along x"):
        hold(([5], float("nan"), None))
    with pytest.raises(BlockError, match=r"node 99 is held, the mesh has 0 to 27"):
        Block(rectangle(0.08, 0.04, 6, 3), THREE).stiffness(hold(([0, 1, 99], 0.0, 0.0)), 0.1)


@pytest.mark.parametrize("thickness", [0.0, -1.0, float("inf")])
def test_a_block_without_thickness_is_refused(thickness):
    with pytest.raises(BlockError, match=r"thickness = .* m, must be above 0 m"):
        Block(rectangle(1.0, 1.0, 1, 1), THREE, thickness)
