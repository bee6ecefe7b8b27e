"""Stress as it is read off: von Mises, nodal means, means over cells."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hil_sim.physics.block.material import BlockError
from hil_sim.physics.block.mesh import rectangle
from hil_sim.physics.block.stress import Cells, at_nodes, von_mises
from tests.block_samples import PUSH_S, block_of, distorted, pressed, scattered

components = st.floats(-1e5, 1e5)


@given(x=components, y=components, z=components, xy=components)
def test_von_mises_stress_is_that_of_the_deviator(x, y, z, xy):
    tensor = np.array([[x, xy, 0.0], [xy, y, 0.0], [0.0, 0.0, z]])

    deviator = tensor - np.trace(tensor) / 3.0 * np.eye(3)
    expected = np.sqrt(1.5 * (deviator**2).sum())
    assert von_mises(np.array([x, y, z, xy])) == pytest.approx(expected, rel=1e-9, abs=1e-6)


def test_pressure_alone_has_no_von_mises_stress_and_a_pull_has_its_own():
    assert von_mises(np.array([3.0, 3.0, 3.0, 0.0])) == 0.0
    assert von_mises(np.array([[-7.0, 0.0], [0.0, 0.0], [0.0, 0.0], [0.0, 2.0]])) == pytest.approx([7.0, 12**0.5])


@settings(max_examples=10)
@given(seed=st.integers(0, 99), x=st.floats(0.004, 0.076), y=st.floats(0.004, 0.036))
def test_the_mean_of_a_cell_is_that_over_its_area_on_any_mesh(seed, x, y):
    mesh = scattered(60, seed)
    cells = Cells(mesh, [(x, y)], 0.005)

    assert cells.mean(np.ones(mesh.area.size)) == pytest.approx([1.0])
    grid = 0.005 * ((np.arange(64) + 0.5) / 64 - 0.5)
    points = np.stack(np.meshgrid(x + grid, y + grid), axis=-1).reshape(-1, 2)
    owner, values = triangle_at(mesh, points), np.random.default_rng(seed).normal(size=mesh.area.size)
    assert cells.mean(values) == pytest.approx([values[owner].mean()], abs=0.02)


def triangle_at(mesh, points):
    """Return the triangle that each point lies in."""
    inside = np.full((len(points), mesh.area.size), np.inf)
    for corner in range(3):
        off = points[:, None] - mesh.points[mesh.triangles[(corner + 1) % 3]]
        share = off[..., 0] * mesh.slope[0, corner] + off[..., 1] * mesh.slope[1, corner]
        inside = np.minimum(inside, share)
    return inside.argmax(axis=1)


def test_a_cell_on_the_lines_of_the_mesh_takes_whole_triangles():
    cells = Cells(rectangle(0.08, 0.04, 64, 32), [(0.040, 0.030), (0.020, 0.015)], 0.005)

    for _, share in cells.parts:
        whole = share[share > 1e-9]  # the others touch it
        assert whole == pytest.approx(np.full(32, 1 / 32))


def test_means_over_cells_converge_faster_than_the_greatest_stress():
    place, means, greatest = [(0.040, 0.030)], [], []
    for columns in (16, 32, 64):
        block = block_of(columns, columns // 2)
        (state,) = pressed(block, [PUSH_S], 0.5)
        means += list(Cells(block.mesh, place, 0.005).mean(-state.stress[1]))
        greatest.append(von_mises(state.stress).max())

    assert means[2] == pytest.approx(means[1], rel=0.03)
    assert greatest[2] > 1.2 * greatest[1] > 1.2 * greatest[0]


def test_nodes_show_the_mean_of_the_triangles_around_them():
    mesh = distorted(6, 4)
    middles = mesh.points[mesh.triangles].mean(axis=0)

    assert at_nodes(mesh, np.full(mesh.area.size, 3.0)) == pytest.approx(np.full(mesh.nodes, 3.0))
    shown = at_nodes(mesh, middles[:, 0])
    inner = np.setdiff1d(np.arange(mesh.nodes), mesh.boundary)
    assert shown[inner] == pytest.approx(mesh.points[inner, 0], abs=0.08 / 6)


@pytest.mark.parametrize(
    ("centre", "side", "words"),
    [
        ((0.001, 0.02), 0.005, r"the cell of 0\.005 m at \(0\.001, 0\.02\) m is inside the block to 70\.000% only"),
        ((0.2, 0.2), 0.005, r"inside the block to 0\.000% only"),
        ((0.04, 0.02), 0.0, r"side = 0 m of a cell, must be above 0 m"),
    ],
)
def test_a_cell_that_is_not_inside_the_block_is_refused(centre, side, words):
    with pytest.raises(BlockError, match=words):
        Cells(rectangle(0.08, 0.04, 8, 4), [centre], side)
