r"""Factors and solves a sparse symmetric matrix of six-by-six blocks along the plan of `pattern_of`.

Right-looking block Cholesky, M = R^T R (standard result). Of column p with diagonal block D = L L^T and lower blocks
A_a of the bodies a that p still meets:

.. math::   R_{pp} = L^T, \qquad R_{pa} = L^{-1} A_a^T, \qquad M_{ab} \leftarrow M_{ab} - R_{pa}^T R_{pb}        (L1)

R_pa takes the place of A_a, and the inverse of L that of the lower triangle of D. All loops are of length six or less
and run along the rows of blocks, nothing is allocated, and the sums are the same in the same order each time. The
inner kernels begin with a test for blocks of six by six, since past it the compiler knows where each row lies (a fifth
faster). A pivot that is not positive means that the matrix is not positive definite (Sylvester's law of inertia):
`factor` then returns False, as for blocks of any other shape.

    blocks = np.zeros((pattern.slots, 6, 6))     # fill the lower blocks: blocks[slot(pattern, a, b)[0]] ...
    if factor(pattern, blocks):
        solve(pattern, blocks, b, x)

Held against numpy.linalg.solve in tests/test_physics_net_factor.py.
"""

import math

from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.net.pattern import Indices, Pattern


@lean
def clear(blocks: Array) -> None:
    """Set all blocks to zero, as `factor` needs it of those that are not filled in anew."""
    blocks[:] = 0.0


@lean
def factor(pattern: Pattern, blocks: Array) -> bool:
    """Factor the matrix in place; return False, with the blocks spoilt, if it is not positive definite.

    Parameters
    ----------
    pattern : Pattern
        Where each block is kept [1]
    blocks : array (slots, 6, 6)
        Lower blocks, rows of the body that is eliminated later; of a diagonal block the lower triangle is read [any]
    """
    start, target = pattern.start, pattern.target
    update = 0
    for p in range(start.size - 1):
        diagonal, end = start[p], start[p + 1]
        if not invert(blocks, diagonal):
            return False
        scale(blocks, diagonal, end)
        update = spread(blocks, diagonal, end, target, update)
    return True


@lean
def invert(blocks: Array, s: int) -> bool:
    """Replace the lower triangle of block s = L L^T by the inverse of L; return False if a pivot is not positive.

    The roots wait until the end: the divisions alone are one long chain.
    """
    if blocks.shape[1] != 6 or blocks.shape[2] != 6:
        return False
    for j in range(6):
        pivot = blocks[s, j, j]
        for k in range(j):
            pivot -= blocks[s, j, k] * blocks[s, j, k] * blocks[s, k, k]
        if not pivot > 0.0:
            return False
        blocks[s, j, j] = 1.0 / pivot
        for i in range(j + 1, 6):
            entry = blocks[s, i, j]
            for k in range(j):
                entry -= blocks[s, i, k] * blocks[s, j, k] * blocks[s, k, k]
            blocks[s, i, j] = entry
    for i in range(6):
        for j in range(i):
            blocks[s, i, j] *= blocks[s, j, j]
        for j in range(i):
            entry = -blocks[s, i, j]
            for k in range(j + 1, i):
                entry -= blocks[s, i, k] * blocks[s, k, j]
            blocks[s, i, j] = entry
    for i in range(6):
        root = math.sqrt(blocks[s, i, i])
        for j in range(i):
            blocks[s, i, j] *= root
        blocks[s, i, i] = root
    return True


@lean
def scale(blocks: Array, diagonal: int, end: int) -> None:
    """Replace each block below the diagonal of a column by its R_pa, equation (L1)."""
    if blocks.shape[1] != 6 or blocks.shape[2] != 6:
        return
    for s in range(diagonal + 1, end):
        for i in range(1, 6):
            for j in range(i):
                blocks[s, i, j], blocks[s, j, i] = blocks[s, j, i], blocks[s, i, j]
        for i in range(5, -1, -1):
            c0 = c1 = c2 = c3 = c4 = c5 = 0.0
            for k in range(i + 1):
                weight = blocks[diagonal, i, k]
                c0 += weight * blocks[s, k, 0]
                c1 += weight * blocks[s, k, 1]
                c2 += weight * blocks[s, k, 2]
                c3 += weight * blocks[s, k, 3]
                c4 += weight * blocks[s, k, 4]
                c5 += weight * blocks[s, k, 5]
            blocks[s, i, 0], blocks[s, i, 1], blocks[s, i, 2] = c0, c1, c2
            blocks[s, i, 3], blocks[s, i, 4], blocks[s, i, 5] = c3, c4, c5


@lean
def spread(blocks: Array, diagonal: int, end: int, target: Indices, update: int) -> int:
    """Take R_pa^T R_pb away from every block where two bodies of a column meet; return the number of updates so far."""
    if blocks.shape[1] != 6 or blocks.shape[2] != 6:
        return update
    for a in range(diagonal + 1, end):
        for b in range(diagonal + 1, a):
            c = target[update]
            update += 1
            for i in range(6):
                c0, c1, c2 = blocks[c, i, 0], blocks[c, i, 1], blocks[c, i, 2]
                c3, c4, c5 = blocks[c, i, 3], blocks[c, i, 4], blocks[c, i, 5]
                for k in range(6):
                    weight = blocks[a, k, i]
                    c0 -= weight * blocks[b, k, 0]
                    c1 -= weight * blocks[b, k, 1]
                    c2 -= weight * blocks[b, k, 2]
                    c3 -= weight * blocks[b, k, 3]
                    c4 -= weight * blocks[b, k, 4]
                    c5 -= weight * blocks[b, k, 5]
                blocks[c, i, 0], blocks[c, i, 1], blocks[c, i, 2] = c0, c1, c2
                blocks[c, i, 3], blocks[c, i, 4], blocks[c, i, 5] = c3, c4, c5
        c = target[update]
        update += 1
        for i in range(6):
            for j in range(i + 1):
                entry = blocks[c, i, j]
                for k in range(6):
                    entry -= blocks[a, k, i] * blocks[a, k, j]
                blocks[c, i, j] = entry
    return update


@lean
def solve(pattern: Pattern, blocks: Array, b: Array, x: Array) -> None:
    """Write to x the solution of M x = b, M as `factor` left it; x may be b.

    Parameters
    ----------
    pattern : Pattern
        Where each block is kept [1]
    blocks : array (slots, 6, 6)
        What `factor` made of the matrix [any]
    b : array (n, 6)
        Right side, row by row of the bodies as they are numbered [any]
    x : array (n, 6)
        Solution, numbered likewise [any]
    """
    for body in range(b.shape[0]):
        for i in range(6):
            x[body, i] = b[body, i]
    forward(pattern, blocks, x)
    backward(pattern, blocks, x)


@lean
def forward(pattern: Pattern, blocks: Array, x: Array) -> None:
    """Replace x by the solution y of R^T y = x."""
    order, start, row = pattern.order, pattern.start, pattern.row
    for p in range(order.size):
        diagonal, body = start[p], order[p]
        for i in range(5, -1, -1):
            total = 0.0
            for k in range(i + 1):
                total += blocks[diagonal, i, k] * x[body, k]
            x[body, i] = total
        for s in range(diagonal + 1, start[p + 1]):
            other = row[s]
            for j in range(6):
                total = x[other, j]
                for k in range(6):
                    total -= blocks[s, k, j] * x[body, k]
                x[other, j] = total


@lean
def backward(pattern: Pattern, blocks: Array, x: Array) -> None:
    """Replace x by the solution y of R y = x."""
    order, start, row = pattern.order, pattern.start, pattern.row
    for p in range(order.size - 1, -1, -1):
        diagonal, body = start[p], order[p]
        for s in range(diagonal + 1, start[p + 1]):
            other = row[s]
            for k in range(6):
                total = x[body, k]
                for j in range(6):
                    total -= blocks[s, k, j] * x[other, j]
                x[body, k] = total
        for k in range(6):
            total = 0.0
            for i in range(k, 6):
                total += blocks[diagonal, i, k] * x[body, i]
            x[body, k] = total
