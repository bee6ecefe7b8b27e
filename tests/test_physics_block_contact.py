"""Contact that presses and never pulls, on the compliance of any solid: complementarity and the end of the search."""

from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hil_sim.physics.block import contact
from hil_sim.physics.block.contact import ContactUnsettled, slope, touch, touch_with

SEEDS = st.integers(0, 2**32 - 1)


def solid(seed, n, coupling=1.0):
    """Return the compliance of a solid that is positive definite and nothing else, and gaps of both signs."""
    random = np.random.default_rng(seed)
    root = random.normal(size=(n, n))
    return coupling * root @ root.T + 1e-3 * np.eye(n), random.normal(size=n)


def assert_complementary(C, g, found):
    """Hold forces and gaps to the three conditions of contact, to rounding."""
    rest = g + C @ found.force
    assert (found.force >= 0.0).all()
    assert rest.min() > -1e-9 * max(1.0, np.abs(C).max() * found.force.max())
    assert np.abs(found.force * rest).max() < 1e-8 * max(1.0, found.force.max())
    assert found.active[found.force > 0.0].all()


def test_two_springs_press_alone_and_together():
    C = np.array([[2.0, 1.0], [1.0, 2.0]])

    assert touch(C, np.array([1.0, 2.0])).force.tolist() == [0.0, 0.0]
    assert touch(C, np.array([-2.0, 0.0])).force.tolist() == [1.0, 0.0]
    assert touch(C, np.array([-3.0, -3.0])).force == pytest.approx([1.0, 1.0])


@given(SEEDS, st.integers(1, 12), SEEDS)
def test_any_contact_presses_and_leaves_nothing_inside(seed, n, start):
    C, g = solid(seed, n)

    found = touch(C, g, np.random.default_rng(start).random(n) < 0.5)

    assert_complementary(C, g, found)


@given(SEEDS, SEEDS)
def test_the_forces_do_not_depend_on_what_touched_before(seed, start):
    C, g = solid(seed, 8)

    forces = touch(C, g, np.random.default_rng(start).random(8) < 0.5).force

    assert forces == pytest.approx(touch(C, g).force, rel=1e-6, abs=1e-9)


@given(SEEDS)
def test_of_all_sets_of_points_the_one_that_presses_is_found(seed):
    C, g = solid(seed, 5)

    found = touch(C, g).force

    for chosen in product((False, True), repeat=5):
        energy = 0.0
        if any(chosen):
            force = np.linalg.solve(C[np.ix_(chosen, chosen)], -g[list(chosen)])
            energy = 0.5 * g[list(chosen)] @ force if (force >= 0.0).all() else 0.0
        assert 0.5 * found @ C @ found + g @ found <= energy + 1e-9


@given(SEEDS, st.integers(2, 30))
def test_one_point_after_the_other_ends_where_all_at_once_does(seed, n):
    C, g = solid(seed, n)

    found = contact._descend(C, g, 0)

    assert_complementary(C, g, found)
    assert found.force == pytest.approx(touch(C, g).force, rel=1e-5, abs=1e-8)


def test_a_set_that_comes_back_is_left_for_the_slower_way():
    cycling = next(seed for seed in range(10000) if repeats(*solid(seed, 4)))
    C, g = solid(cycling, 4)

    found = touch(C, g)

    assert_complementary(C, g, found)


def repeats(C, g):
    """Return whether all corrections at once come back to a set of points."""
    seen, active = set(), g < 0.0
    while active.tobytes() not in seen:
        seen.add(active.tobytes())
        found = contact._assume(C, g, active, 0)
        wrong = contact._wrong(C, g, found)
        if not wrong.any():
            return False
        active = active ^ wrong
    return True


def test_a_contact_that_nothing_solves_is_told_by_name():
    C = np.array([[1.0, -2.0], [-2.0, 1.0]])  # gives way towards the force: no solid

    with pytest.raises(ContactUnsettled, match="2 points"):
        touch(C, np.array([-1.0, -1.0]))
    with pytest.raises(ContactUnsettled, match="not a number"):
        touch(np.eye(2), np.array([np.nan, 1.0]))


def test_points_without_a_shape_above_them_never_touch():
    C, _ = solid(3, 3)

    found = touch(C, np.array([-1.0, np.inf, np.inf]), np.ones(3, bool))

    assert found.active.tolist() == [True, False, False]
    assert found.gap.tolist() == [0.0, np.inf, np.inf]


def test_the_slope_is_what_a_deeper_shape_adds_while_the_same_points_touch():
    C, g = solid(5, 6)
    found, deeper = (touch(C, g - depth) for depth in (0.0, 1e-7))

    assert (found.active == deeper.active).all()
    assert slope(C, found.active) == pytest.approx((deeper.force - found.force).sum() / 1e-7, rel=1e-5)
    assert slope(C, np.zeros(6, bool)) == 0.0


@given(SEEDS, st.integers(1, 12), st.floats(0.0, 3.0), st.floats(-3.0, 3.0))
def test_a_shape_finds_the_depth_of_a_force(seed, n, depth, start):
    C, g = solid(seed, n)
    known = touch(C, g - depth)
    force = float(known.force.sum())

    found, there = touch_with(C, g, force, -10.0, 10.0, start)

    assert there.force == pytest.approx(known.force, rel=1e-6, abs=1e-9)
    assert found == pytest.approx(depth if force > 0.0 else g.min(), abs=1e-9)


@pytest.mark.parametrize("seed", [1262, 1314, 1988, 2030])
def test_the_depth_of_a_force_is_found_where_lines_alone_lead_round_in_a_circle(seed):
    C, g = solid(seed, 4)
    force = float(touch(C, g - 1.0).force.sum())

    assert touch_with(C, g, force, -10.0, 10.0, 3.0)[0] == pytest.approx(1.0, abs=1e-9)


def test_a_pull_that_is_rounding_is_no_force():
    found = touch(np.eye(2), np.array([-1.0, 1e-16]), np.ones(2, bool))

    assert found.force.tolist() == [1.0, 0.0]


def test_a_shape_that_cannot_get_to_its_force_goes_as_far_as_it_may():
    C, g = np.eye(1), np.array([1.0])

    assert touch_with(C, g, 5.0, 0.0, 2.0, 0.0)[0] == 2.0
    assert touch_with(C, g, 0.1, 1.5, 2.0, 2.0)[0] == 1.5
    assert touch_with(C, g, 0.0, -1.0, 0.5, 0.0)[0] == 0.5
