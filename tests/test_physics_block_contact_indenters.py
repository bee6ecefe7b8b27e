"""Rigid shapes that press on a block: their undersides exactly, and what cannot be pressed."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hil_sim.physics.block.indenters import Cylinder, IndenterError, Polygon, Punch, gap

WEDGE = Polygon(((-5e-3, 5e-3), (0.0, 0.0), (5e-3, 5e-3)))
SQUARE = ((-5e-3, 2e-3), (5e-3, 2e-3), (5e-3, 9e-3), (-5e-3, 9e-3))
SENSELESS = (
    (lambda: Punch(width=0.0), "width = 0 m"),
    (lambda: Punch(width=np.nan), "width = nan m"),
    (lambda: Cylinder(R=-1e-3), "R = -0.001 m"),
    (lambda: Cylinder(R=np.inf), "R = inf m"),
    (lambda: Cylinder(R=1e-3, bonded=True), "a bonded cylinder is not modelled"),
    (lambda: Polygon(SQUARE, bonded=True), "a bonded polygon is not modelled"),
    (lambda: Polygon(SQUARE[:2]), "at least 3 corners"),
    (lambda: Polygon(((0.0, 0.0), (1.0, np.nan), (1.0, 1.0))), "corner 1 of the polygon is not finite"),
    (lambda: Polygon(((0.0, 0.0), (1.0, 1.0), (2.0, 2.0))), "enclose no area"),
    (lambda: Polygon(((0.0, 0.0), (2.0, 0.0), (1.0, 0.5), (1.0, 2.0))), "not convex"),
    (lambda: Polygon(((0.0, 0.0), (2.0, 0.0), (1.0, 0.0), (1.0, 2.0))), "not convex"),
    (lambda: Polygon(tuple((np.cos(4 * k), np.sin(4 * k)) for k in np.pi / 5 * np.arange(5))), "not convex"),
)


@pytest.mark.parametrize(("make", "reason"), SENSELESS, ids=[reason for _, reason in SENSELESS])
def test_a_senseless_indenter_is_refused_by_name(make, reason):
    with pytest.raises(IndenterError, match=reason):
        make()


def test_a_punch_is_flat_to_its_edges_and_nowhere_else():
    x = np.array([-10.1e-3, -10e-3, 0.0, 10e-3, 10.1e-3])

    assert Punch(width=0.020).height(x).tolist() == [np.inf, 0.0, 0.0, 0.0, np.inf]


@given(st.floats(1e-4, 1.0), st.floats(-1.0, 1.0))
def test_a_cylinder_is_round_however_large_it_is(R, share):
    z = float(Cylinder(R).height(np.array([share * R]))[0])

    assert (share * R) ** 2 + (R - z) ** 2 == pytest.approx(R**2, rel=1e-12)


def test_a_cylinder_loses_no_digit_near_its_axis_and_ends_at_its_side():
    heights = Cylinder(R=1.0).height(np.array([1e-9, 1.0, 1.001]))

    assert heights[0] == pytest.approx(0.5e-18, rel=1e-12)
    assert heights[1:].tolist() == [1.0, np.inf]


def test_a_wedge_rises_by_its_slope():
    assert WEDGE.height(np.array([-5e-3, -2e-3, 0.0, 1e-3, 6e-3])) == pytest.approx([5e-3, 2e-3, 0, 1e-3, np.inf])


@pytest.mark.parametrize("corners", [SQUARE, SQUARE[::-1], SQUARE[2:] + SQUARE[:2], SQUARE + SQUARE[-1:]])
def test_a_square_is_a_punch_wherever_its_corners_begin(corners):
    x = np.linspace(-6e-3, 6e-3, 25)

    assert Polygon(corners).height(x).tolist() == Punch(width=10e-3).height(x).tolist()


@given(st.lists(st.floats(0.0, 2 * np.pi), min_size=3, max_size=9, unique=True), st.floats(-1.0, 1.0))
def test_the_underside_of_a_polygon_is_its_lowest_point_at_each_place(angles, x):
    corners = np.array([(np.cos(angle), np.sin(angle)) for angle in sorted(angles)])
    try:
        polygon = Polygon(tuple(map(tuple, corners)))
    except IndenterError:
        return  # of no area
    chords = np.array([(p, q) for p in corners for q in corners if p[0] < q[0] and p[0] <= x <= q[0]])

    found = float(polygon.height(np.array([x]))[0])

    if len(chords):
        (x0, y0), (x1, y1) = chords[:, 0].T, chords[:, 1].T
        lowest = np.min(y0 + (y1 - y0) * ((x - x0) / (x1 - x0)))
        assert found == pytest.approx(lowest - corners[:, 1].min(), abs=1e-9)


def test_the_gap_is_how_far_each_point_is_below_the_shape():
    x, y = np.array([0.0, 3e-3, 9e-3]), np.array([0.040, 0.039, 0.040])

    gaps = gap(WEDGE, x, y, depth=2e-3, begin=0.040)

    assert gaps == pytest.approx([-2e-3, 2e-3, np.inf], abs=1e-15)


def test_a_shape_is_lowest_at_its_edges_in_its_middle_or_at_corners():
    assert Punch(0.02).lowest == (-0.01, 0.01)
    assert Cylinder(0.02).lowest == (0.0,)
    assert Polygon(((-1, 1), (0.5, 0), (1, 1))).lowest == (0.5,)
    assert Polygon(((-1, 1), (-1, 0), (2, 0), (2, 1))).lowest == (-1.0, 2.0)
