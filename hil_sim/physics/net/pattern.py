r"""Plans the elimination of a sparse symmetric matrix of six-by-six blocks, one row and column of blocks per body.

Next is always the body that still meets the fewest others, of equals the one of the lowest number: the same pairs
give the same plan. Whatever an eliminated body still meets is coupled from then on ("fill"), and the plan has a place
for every block that arises (standard result: symbolic factorisation by the elimination game, order of least degree).

    pattern = pattern_of(3, [(0, 1), (1, 2)])
    slot(pattern, 1, 0)      # (1, True): the block is kept with the rows of body 1, the columns of body 0
"""

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Indices = NDArray[np.int64]


class Pattern(NamedTuple):
    """Where each block is kept, and which blocks meet when a body is eliminated.

    The blocks of the column at position p of the order are slots start[p] .. start[p + 1] - 1: first the diagonal
    block, then one for each body that is still met, in order of elimination.
    """

    slots: int  # number of blocks
    place: Indices  # position of each body in the order (n,)
    order: Indices  # body at each position (n,)
    diagonal: Indices  # slot of the diagonal block of each body (n,)
    start: Indices  # first slot of each column, and the end (n + 1,)
    row: Indices  # body of the rows of each block (slots,)
    given: Indices  # 1 for a block on the diagonal or of a coupled pair, 0 for fill (slots,)
    target: Indices  # slot that each pair of blocks of a column changes, in the order of `factor` (updates,)


def pattern_of(bodies: int, pairs: Sequence[tuple[int, int]]) -> Pattern:
    """Return the plan for the coupled pairs; raises ValueError for a pair that is not two of the bodies."""
    coupled = _neighbours(bodies, pairs)
    order, columns = _eliminate(coupled)
    kept = [(row, column[0]) for column in columns for row in column]
    slot_of = {block: number for number, block in enumerate(kept)}
    return Pattern(
        slots=len(kept),
        place=_indices(np.argsort(order)),
        order=_indices(order),
        diagonal=_indices(slot_of[body, body] for body in range(bodies)),
        start=_indices(np.cumsum([0, *map(len, columns)])),
        row=_indices(row for row, _ in kept),
        given=_indices(row == body or row in coupled[body] for row, body in kept),
        target=_indices(slot_of[block] for column in columns for block in _met(column)),
    )


def slot(pattern: Pattern, a: int, b: int) -> tuple[int, bool]:
    """Return the slot of the block of two coupled bodies and whether its rows are those of a; raises ValueError."""
    n = pattern.place.size
    if a != b and 0 <= a < n and 0 <= b < n:
        later = bool(pattern.place[a] > pattern.place[b])
        row, column = (a, b) if later else (b, a)
        for s in range(pattern.diagonal[column] + 1, pattern.start[pattern.place[column] + 1]):
            if pattern.row[s] == row and pattern.given[s]:
                return s, later
    raise ValueError(f"bodies {a} and {b} are not coupled")


def _neighbours(bodies: int, pairs: Sequence[tuple[int, int]]) -> list[set[int]]:
    """Return the bodies that each body is coupled to."""
    coupled: list[set[int]] = [set() for _ in range(bodies)]
    for a, b in pairs:
        if a == b or not (0 <= a < bodies and 0 <= b < bodies):
            raise ValueError(f"pair ({a}, {b}), not two of {bodies} bodies")
        coupled[a].add(b)
        coupled[b].add(a)
    return coupled


def _eliminate(coupled: list[set[int]]) -> tuple[list[int], list[list[int]]]:
    """Return the order of elimination, and for each position the body and those it still meets, in that order."""
    met = [set(others) for others in coupled]
    left = set(range(len(met)))
    order: list[int] = []
    while left:
        body = min(left, key=lambda candidate: (len(met[candidate]), candidate))
        left.remove(body)
        order.append(body)
        for other in met[body]:
            met[other] = (met[other] | met[body]) - {other, body}
    place = {body: position for position, body in enumerate(order)}
    return order, [[body, *sorted(met[body], key=place.__getitem__)] for body in order]


def _met(column: list[int]) -> Iterator[tuple[int, int]]:
    """Yield rows and columns of the blocks that the elimination of a column changes, in the order of `factor`."""
    for count, a in enumerate(column[1:], start=2):
        for b in column[1:count]:
            yield a, b


def _indices(numbers: Iterable[int]) -> Indices:
    return np.array(list(numbers), dtype=np.int64)
