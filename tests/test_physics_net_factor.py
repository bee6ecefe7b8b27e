"""The sparse solver of the net: the right solution, little fill, and a plain no to a matrix that is not positive."""

import numpy as np
import pytest

from hil_sim.physics.net.factor import clear, factor, solve
from hil_sim.physics.net.pattern import pattern_of, slot


def sphere(nodes, jumps=False):
    """Return the number of bodies and the coupled pairs of three hoops, a core with 18 coils, and four jump coils."""
    points = np.round(np.cos(2 * np.pi * (np.arange(nodes) - np.array([[0], [nodes // 4]])) / nodes), 9) + 0.0
    hoops = [np.insert(points, axis, 0.0, axis=0).T for axis in range(3)]
    numbers = {point: n for n, point in enumerate(dict.fromkeys(tuple(p) for hoop in hoops for p in hoop))}
    rings = [[numbers[tuple(point)] for point in hoop] for hoop in hoops]
    core = len(numbers)

    beams = [(ring[i - 1], ring[i]) for ring in rings for i in range(nodes)]
    coils = [(node, core) for node in sorted({node for ring in rings for node in ring[:: nodes // 8]})]
    square = [rings[axis][turn * nodes // 8] for axis, turn in ((1, 7), (0, 7), (1, 5), (0, 5))]
    return core + 1, beams + coils + [(square[i], square[i - 1]) for i in range(4 if jumps else 0)]


def stiff(bodies, pairs, seed=0):
    """Return a random positive definite matrix (n, 6, n, 6) that couples the pairs alone."""
    random = np.random.default_rng(seed)
    matrix = np.zeros((bodies, 6, bodies, 6))
    for pair in pairs:
        part = random.normal(size=(6, 2, 6))
        matrix[np.ix_(pair, range(6), pair, range(6))] += np.einsum("eai,ebj->aibj", part, part)
    matrix[range(bodies), :, range(bodies), :] += 0.1 * np.eye(6)
    return matrix


def filled(pattern, pairs, matrix):
    """Return the blocks of a matrix, put where `slot` says."""
    blocks = np.full((pattern.slots, 6, 6), np.nan)
    clear(blocks)
    for body, s in enumerate(pattern.diagonal):
        blocks[s] = np.tril(matrix[body, :, body])
    for a, b in pairs:
        s, later = slot(pattern, a, b)
        blocks[s] = matrix[a, :, b] if later else matrix[b, :, a]
    return blocks


def solution(pattern, blocks, right):
    """Return the solution, for blocks that are kept."""
    work, x = blocks.copy(), np.empty_like(right)
    assert factor(pattern, work)
    solve(pattern, work, right, x)
    return x


@pytest.mark.parametrize("jumps", [False, True])
@pytest.mark.parametrize("nodes", [16, 24, 32])
def test_the_solution_is_that_of_the_full_matrix(nodes, jumps):
    bodies, pairs = sphere(nodes, jumps)
    pattern, matrix = pattern_of(bodies, pairs), stiff(bodies, pairs)
    right = np.random.default_rng(1).normal(size=(bodies, 6))

    x = solution(pattern, filled(pattern, pairs, matrix), right)

    exact = np.linalg.solve(matrix.reshape(6 * bodies, -1), right.ravel()).reshape(-1, 6)
    assert bodies == 3 * nodes - 5
    assert np.abs(x - exact).max() < 1e-9 * np.abs(exact).max()  # rounding alone: measured 5e-15


def test_the_right_side_may_be_overwritten_by_the_solution():
    bodies, pairs = sphere(16)
    pattern = pattern_of(bodies, pairs)
    blocks = filled(pattern, pairs, stiff(bodies, pairs))
    right = np.random.default_rng(1).normal(size=(bodies, 6))
    x = solution(pattern, blocks, right)

    factor(pattern, blocks)
    solve(pattern, blocks, right, right)

    assert np.array_equal(right, x)


def test_a_chain_has_no_fill_and_lone_bodies_are_solved_by_themselves():
    pairs = [(0, 1), (1, 2), (2, 3)]
    pattern, matrix = pattern_of(5, pairs), stiff(5, pairs)

    x = solution(pattern, filled(pattern, pairs, matrix), np.ones((5, 6)))

    assert pattern.slots == 5 + 3
    assert x[4] == pytest.approx(10.0)  # its block is 0.1 times the unit matrix


@pytest.mark.parametrize(("nodes", "jumps", "updates"), [(16, 0, 194), (24, 0, 266), (24, 1, 302), (32, 0, 338)])
def test_the_fill_stays_small_however_the_bodies_are_numbered(nodes, jumps, updates):
    """A node with two neighbours costs 3 updates, one that has a coil too 6, six crossings and the core 50."""
    bodies, pairs = sphere(nodes, bool(jumps))
    numbers = [np.random.default_rng(seed).permutation(bodies) for seed in range(5)]

    counts = {pattern_of(bodies, [(n[a], n[b]) for a, b in pairs]).target.size for n in numbers}

    assert counts == {updates}


def test_the_same_pairs_give_the_same_plan_in_any_order():
    bodies, pairs = sphere(24, jumps=True)

    plans = pattern_of(bodies, pairs), pattern_of(bodies, [(b, a) for a, b in reversed(pairs)])

    assert all(np.array_equal(one, other) for one, other in zip(*plans, strict=True))


def test_two_solutions_of_one_matrix_agree_to_the_last_bit():
    bodies, pairs = sphere(24, jumps=True)
    pattern = pattern_of(bodies, pairs)
    blocks = filled(pattern, pairs, stiff(bodies, pairs))
    right = np.random.default_rng(1).normal(size=(bodies, 6))

    assert np.array_equal(solution(pattern, blocks, right), solution(pattern, blocks, right))


@pytest.mark.parametrize("body", [0, 7, 42])
@pytest.mark.parametrize("unknown", [0, 5])
def test_a_matrix_that_is_not_positive_is_refused(body, unknown):
    bodies, pairs = sphere(16)
    pattern, matrix = pattern_of(bodies, pairs), stiff(bodies, pairs)
    least = 1 / np.linalg.inv(matrix.reshape(6 * bodies, -1))[6 * body + unknown, 6 * body + unknown]

    answers = []
    for share in (0.999, 1.001):  # just short of the one negative eigenvalue, and just past it
        tilted = matrix.copy()
        tilted[body, unknown, body, unknown] -= share * least
        answers.append(factor(pattern, filled(pattern, pairs, tilted)))

    assert answers == [True, False]


def test_what_is_not_a_number_is_refused():
    pattern = pattern_of(2, [(0, 1)])

    assert not factor(pattern, np.full((pattern.slots, 6, 6), np.nan))


def test_blocks_of_another_shape_are_refused():
    pattern = pattern_of(2, [(0, 1)])

    assert not factor(pattern, np.ones((pattern.slots, 1, 1)))


def test_the_rows_of_a_block_are_those_of_the_body_eliminated_later():
    pattern = pattern_of(3, [(0, 1), (1, 2)])

    assert pattern.place.tolist() == [0, 1, 2]
    assert slot(pattern, 1, 0) == (1, True)
    assert slot(pattern, 0, 1) == (1, False)


@pytest.mark.parametrize("pair", [(1, 3), (3, 1), (0, 2), (1, 1), (0, 4), (-1, 0)])
def test_only_coupled_bodies_have_a_block(pair):
    """1 and 3 meet once 0 is eliminated, but that block is fill and nobody's to write to."""
    pattern = pattern_of(4, [(0, 1), (1, 2), (2, 3), (3, 0)])

    with pytest.raises(ValueError, match="not coupled"):
        slot(pattern, *pair)


@pytest.mark.parametrize("pair", [(0, 0), (0, 3), (-1, 0)])
def test_a_pair_is_two_of_the_bodies(pair):
    with pytest.raises(ValueError, match="not two of 3 bodies"):
        pattern_of(3, [pair])
