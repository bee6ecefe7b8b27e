"""The labels of a sphere's coils: a letter, then a direction in the body's own axes, `m` for the paper's bar.

    direction("A10m1")  # (1, 0, -1): forward and down

Forward is x, left is y, up is z. Hoops have points in the directions of the axes and of the sums of two of them.
"""

import re

Direction = tuple[int, int, int]
_LABEL = re.compile(r"[A-Z](m1|0|1)(m1|0|1)(m1|0|1)")


def direction(label: str) -> Direction:
    """Return the direction that a label names; ValueError when there is no point of a hoop."""
    match = _LABEL.fullmatch(label)
    if match is None:
        raise ValueError(f"{label}: not a letter and three of 1, 0, m1, as in A10m1")
    x, y, z = (int(digit.replace("m", "-")) for digit in match.groups())
    if x * x + y * y + z * z not in (1, 2):
        raise ValueError(f"{label}: no point of a hoop, which lie along one axis or between two of them")
    return x, y, z
