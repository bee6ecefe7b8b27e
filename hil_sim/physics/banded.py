r"""Solves the symmetric system of a closed chain of two-by-two blocks with a border of three.

Node i meets nodes i + 1 and i + 2 around the ring and the hub. Nodes 0 .. N-3 form a band of half-width 5; the last
two nodes and the hub are a border of 7 columns, the right side is the eighth. One pass of L D L^T takes the band away
from border and corner, so each column costs fixed loops of 5 and 8: no search, no allocation, the same sums in the
same order each time.

A pivot that is not positive means that the step is too long for an unstable shape: `solve` then returns False.
"""

from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.ring import AXX, AXY, AYX, AYY, BXX, BXY, BYX, BYY, DXX, DXY, DYY, HXX, HYX

BAND = 6
BORDER = 8
RHS = 7


@lean
def solve(
    blocks: Array, hub: Array, mass: Array, rhs: Array, band: Array, border: Array, corner: Array, x: Array
) -> bool:
    """Write to x the solution of (blocks, hub, mass on the diagonal) x = rhs; return False if it is not positive."""
    n = blocks.shape[1]
    load_band(blocks, mass, rhs, band, border, n)
    load_corner(blocks, hub, mass, rhs, band, border, corner, n)
    columns = 2 * n - 4
    return eliminate(band, border, corner, columns) and substitute(band, border, corner, columns, x)


@lean
def load_band(blocks: Array, mass: Array, rhs: Array, band: Array, border: Array, n: int) -> None:
    """Copy the blocks of nodes 0 .. n-3 to the band and its border."""
    for i in range(n - 2):
        j = 2 * i
        band[j, 0] = blocks[DXX, i] + mass[j]
        band[j, 1] = blocks[DXY, i]
        band[j, 2] = blocks[AXX, i]
        band[j, 3] = blocks[AXY, i]
        band[j, 4] = blocks[BXX, i]
        band[j, 5] = blocks[BXY, i]
        band[j + 1, 0] = blocks[DYY, i] + mass[j + 1]
        band[j + 1, 1] = blocks[AYX, i]
        band[j + 1, 2] = blocks[AYY, i]
        band[j + 1, 3] = blocks[BYX, i]
        band[j + 1, 4] = blocks[BYY, i]
        band[j + 1, 5] = 0.0
        for k in range(4):
            border[j, k] = 0.0
            border[j + 1, k] = 0.0
        for k in range(3):
            border[j, 4 + k] = blocks[HXX + k, i]
            border[j + 1, 4 + k] = blocks[HYX + k, i]
        border[j, RHS] = rhs[j]
        border[j + 1, RHS] = rhs[j + 1]


@lean
def load_corner(
    blocks: Array, hub: Array, mass: Array, rhs: Array, band: Array, border: Array, corner: Array, n: int
) -> None:
    """Move what meets the last two nodes from band to border, and fill the corner of those nodes and the hub."""
    last = 2 * n - 6
    for a in range(2):
        for k in range(2 - a, BAND):
            band[last + a, k] = 0.0
        for k in range(4 - a, BAND):
            band[last - 2 + a, k] = 0.0
        move(blocks, border, AXX, n - 3, 0, a)
        move(blocks, border, BXX, n - 3, 2, a)
        move(blocks, border, BXX, n - 4, 0, a)
        for b in range(2):
            border[b, 2 + a] = blocks[AXX + 2 * a + b, n - 1]
            border[b, a] = blocks[BXX + 2 * a + b, n - 2]
            border[2 + b, 2 + a] = blocks[BXX + 2 * a + b, n - 1]
    corner[:] = 0.0
    for m in range(2):
        i, r = n - 2 + m, 2 * m
        corner[r, r] = blocks[DXX, i]
        corner[r + 1, r] = blocks[DXY, i]
        corner[r + 1, r + 1] = blocks[DYY, i]
        for k in range(3):
            corner[4 + k, r] = blocks[HXX + k, i]
            corner[4 + k, r + 1] = blocks[HYX + k, i]
    for a in range(2):
        for b in range(2):
            corner[2 + b, a] = blocks[AXX + 2 * a + b, n - 2]
    for a in range(3):
        for b in range(a + 1):
            corner[4 + a, 4 + b] = hub[a, b]
    for r in range(7):
        corner[r, r] += mass[2 * n - 4 + r]
        corner[r, RHS] = rhs[2 * n - 4 + r]


@lean
def move(blocks: Array, border: Array, block: int, i: int, column: int, a: int) -> None:
    """Put row a of a neighbour block of node i to two columns of the border."""
    for b in range(2):
        border[2 * i + a, column + b] = blocks[block + 2 * a + b, i]


@lean
def eliminate(band: Array, border: Array, corner: Array, columns: int) -> bool:
    """Factor the band in place (band[:, 0] becomes the inverse pivots) and take it away from border and corner.

    Written out by hand: five rows below the pivot, all of fixed length, are what the compiler turns into vector code.
    """
    for j in range(columns):
        if not band[j, 0] > 0.0:
            return False
        inverse = 1.0 / band[j, 0]
        b1, b2, b3, b4, b5 = band[j, 1], band[j, 2], band[j, 3], band[j, 4], band[j, 5]
        f1, f2, f3, f4, f5 = b1 * inverse, b2 * inverse, b3 * inverse, b4 * inverse, b5 * inverse
        band[j, 0] = inverse
        band[j + 1, 0] -= f1 * b1
        band[j + 1, 1] -= f1 * b2
        band[j + 1, 2] -= f1 * b3
        band[j + 1, 3] -= f1 * b4
        band[j + 1, 4] -= f1 * b5
        band[j + 2, 0] -= f2 * b2
        band[j + 2, 1] -= f2 * b3
        band[j + 2, 2] -= f2 * b4
        band[j + 2, 3] -= f2 * b5
        band[j + 3, 0] -= f3 * b3
        band[j + 3, 1] -= f3 * b4
        band[j + 3, 2] -= f3 * b5
        band[j + 4, 0] -= f4 * b4
        band[j + 4, 1] -= f4 * b5
        band[j + 5, 0] -= f5 * b5
        for c in range(BORDER):
            entry = border[j, c]
            border[j + 1, c] -= f1 * entry
            border[j + 2, c] -= f2 * entry
            border[j + 3, c] -= f3 * entry
            border[j + 4, c] -= f4 * entry
            border[j + 5, c] -= f5 * entry
    reduce(band, border, corner, columns)
    return True


@lean
def reduce(band: Array, border: Array, corner: Array, columns: int) -> None:
    """Take the eliminated columns away from the corner."""
    for r in range(7):
        c0 = c1 = c2 = c3 = c4 = c5 = c6 = c7 = 0.0
        for j in range(columns):
            factor = border[j, r] * band[j, 0]
            c0 += factor * border[j, 0]
            c1 += factor * border[j, 1]
            c2 += factor * border[j, 2]
            c3 += factor * border[j, 3]
            c4 += factor * border[j, 4]
            c5 += factor * border[j, 5]
            c6 += factor * border[j, 6]
            c7 += factor * border[j, 7]
        for c, total in enumerate((c0, c1, c2, c3, c4, c5, c6, c7)):
            corner[r, c] -= total


@lean
def substitute(band: Array, border: Array, corner: Array, columns: int, x: Array) -> bool:
    """Solve the corner, then the band backwards; entries that would reach past the band are zero."""
    for j in range(7):
        if not corner[j, j] > 0.0:
            return False
        inverse = 1.0 / corner[j, j]
        for r in range(j + 1, 7):
            factor = corner[r, j] * inverse
            for c in range(j + 1, r + 1):
                corner[r, c] -= factor * corner[c, j]
            corner[r, RHS] -= factor * corner[j, RHS]
    for j in range(6, -1, -1):
        total = corner[j, RHS]
        for r in range(j + 1, 7):
            total -= corner[r, j] * x[columns + r]
        x[columns + j] = total / corner[j, j]
    x0, x1, x2, x3 = x[columns], x[columns + 1], x[columns + 2], x[columns + 3]
    x4, x5, x6 = x[columns + 4], x[columns + 5], x[columns + 6]
    for j in range(columns):
        known = border[j, 0] * x0 + border[j, 1] * x1 + border[j, 2] * x2 + border[j, 3] * x3
        x[j] = border[j, RHS] - known - border[j, 4] * x4 - border[j, 5] * x5 - border[j, 6] * x6
    x1 = x2 = x3 = x4 = x5 = 0.0
    for j in range(columns - 1, -1, -1):
        far = band[j, 2] * x2 + band[j, 3] * x3 + band[j, 4] * x4 + band[j, 5] * x5
        x0 = (x[j] - far - band[j, 1] * x1) * band[j, 0]
        x[j] = x0
        x1, x2, x3, x4, x5 = x0, x1, x2, x3, x4
    return True
