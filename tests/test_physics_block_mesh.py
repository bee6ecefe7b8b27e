"""Meshes: the structured one, any other given as arrays, and what does not conform."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from hil_sim.physics.block.material import BlockError
from hil_sim.physics.block.mesh import counterclockwise, mesh_of, rectangle
from tests.block_samples import HEIGHT, WIDTH, distorted, scattered

SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]
HALVES = [(0, 1, 2), (0, 2, 3)]


def test_the_diagonals_of_a_rectangle_alternate():
    mesh = rectangle(2.0, 1.0, 2, 1)

    assert mesh.points.tolist() == [[0, 0], [0, 1], [1, 0], [1, 1], [2, 0], [2, 1]]
    assert sorted(map(sorted, mesh.triangles.T.tolist())) == [[0, 1, 3], [0, 2, 3], [2, 3, 4], [3, 4, 5]]


@given(columns=st.integers(1, 9), rows=st.integers(1, 9))
def test_the_triangles_of_a_rectangle_cover_it(columns, rows):
    mesh = rectangle(WIDTH, HEIGHT, columns, rows)

    assert mesh.nodes == (columns + 1) * (rows + 1)
    assert mesh.area.size == 2 * columns * rows
    assert mesh.area == pytest.approx(WIDTH * HEIGHT / mesh.area.size)
    assert len(mesh.edges) == len(mesh.boundary) == 2 * (columns + rows)


@settings(max_examples=20)
@given(seed=st.integers(0, 99))
def test_the_shape_functions_of_any_mesh_have_the_slopes_of_linear_fields(seed):
    mesh = scattered(40, seed)

    x, y = (mesh.points[mesh.triangles, axis] for axis in (0, 1))
    assert mesh.area.sum() == pytest.approx(WIDTH * HEIGHT)
    assert np.einsum("dat,at->dt", mesh.slope, 3 * x - 5 * y) == pytest.approx(np.tile([[3], [-5]], mesh.area.size))
    assert np.abs(mesh.slope.sum(axis=1)).max() < 1e-9 * np.abs(mesh.slope).max()


def test_boundary_edges_run_around_the_block_with_the_material_on_the_left():
    mesh = distorted(6, 4)

    (x, y), (dx, dy) = (
        mesh.points[mesh.edges[:, 0]].T,
        (mesh.points[mesh.edges[:, 1]] - mesh.points[mesh.edges[:, 0]]).T,
    )
    assert 0.5 * (x * dy - y * dx).sum() == pytest.approx(WIDTH * HEIGHT)


def test_clockwise_triangles_can_be_turned_over():
    turned = counterclockwise(SQUARE, [(0, 2, 1), (0, 2, 3)])

    assert mesh_of(SQUARE, turned).area == pytest.approx([0.5, 0.5])


@pytest.mark.parametrize(
    ("points", "triangles", "words"),
    [
        (SQUARE, [(0, 1, 2), (0, 3, 2)], r"triangle 1 \(nodes \[0, 3, 2\]\) runs clockwise"),
        ([*SQUARE, (2, 0)], [*HALVES, (0, 1, 4)], r"triangle 2 \(nodes \[0, 1, 4\]\) has no area"),
        (SQUARE, [*HALVES, (0, 1, 1)], r"triangle 2 .* has no area"),
        ([*SQUARE, (2, 2)], HALVES, r"node 4 belongs to no triangle"),
        ([*SQUARE, (1, 1e-12)], [*HALVES, (4, 2, 0)], r"nodes 1 and 4 coincide"),
        ([*SQUARE, (2, 0.5)], [*HALVES, (0, 4, 2), (1, 4, 2)], r"edge \[0, 2\] has 3 triangles, at most 2"),
        (SQUARE, [(0, 1, 2), (0, 1, 3), (0, 2, 3)], r"edge \[0, 1\] has two triangles on the same side"),
        ([*SQUARE, (0.5, -1), (0.5, 0)], [*HALVES, (0, 4, 5), (4, 1, 5)], r"node 5 hangs on the edge \[0, 1\]"),
        ([*SQUARE[:3], (0, np.nan)], HALVES, r"node 3 is at \(0.0, nan\) m, must be finite"),
        (SQUARE, [(0, 1, 4)], r"triangle 0 has nodes \[0, 1, 4\], must be 0 to 3"),
        (SQUARE, [(0, 1, -2)], r"triangle 0 has nodes \[0, 1, -2\]"),
        ([(0, 0, 0)], HALVES, r"points have the shape \(1, 3\), must be \(N, 2\)"),
        (SQUARE, [(0.0, 1.0, 2.0)], r"triangles are float64 of the shape \(1, 3\), must be integers"),
        (SQUARE, np.zeros((0, 3), int), r"triangles are int64 of the shape \(0, 3\)"),
    ],
)
def test_a_mesh_that_does_not_conform_is_refused_by_number(points, triangles, words):
    with pytest.raises(BlockError, match=words):
        mesh_of(points, triangles)


@pytest.mark.parametrize(
    ("extent", "words"),
    [
        ((0.0, 1.0, 2, 2), r"width = 0 m, must be above 0 m"),
        ((1.0, float("nan"), 2, 2), r"height = nan m"),
        ((1.0, 1.0, 0, 2), r"columns = 0, at least 1"),
        ((1.0, 1.0, 2, -1), r"rows = -1, at least 1"),
    ],
)
def test_a_rectangle_that_cannot_be_is_refused(extent, words):
    with pytest.raises(BlockError, match=words):
        rectangle(*extent)


@settings(max_examples=50)
@given(columns=st.integers(4, 64), left=st.floats(0.001, 0.079), right=st.floats(0.001, 0.079))
def test_lines_of_nodes_stand_where_they_are_wanted(columns, left, right):
    assume(right - left > 2 * 0.080 / columns)
    mesh = rectangle(0.080, 0.040, columns, 2, [right, left, -0.01, 0.09])

    x = np.unique(mesh.points[:, 0])

    assert x.size == columns + 1
    assert all(np.abs(x - line).min() < 1e-15 for line in (0.0, left, right, 0.080))


def test_lines_that_are_there_already_move_nothing():
    assert (rectangle(0.080, 0.040, 64, 2, [0.030, 0.050]).points == rectangle(0.080, 0.040, 64, 2).points).all()


def test_lines_nearer_to_each_other_than_a_cell_are_refused():
    with pytest.raises(BlockError, match="too few to part x"):
        rectangle(0.080, 0.040, 64, 2, [0.0402, 0.0398])
