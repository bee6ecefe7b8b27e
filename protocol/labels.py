"""What a coil's label says about where it points: a letter, then three digits `1`, `0` or `m1` (the paper's bar).

direction("A10m1")   # (1, 0, -1): forward and down, in the robot's own axes
direction("A")       # None: a name only
"""


def direction(label: str) -> tuple | None:
    """Return the direction in the robot's axes x (forward), y (left), z (up), or None when the label has none."""
    digits = []
    at = 1
    while at < len(label):
        size = 2 if label[at] == "m" else 1
        digit = label[at : at + size]
        if digit not in ("1", "0", "m1"):
            return None
        digits.append(-1 if digit == "m1" else int(digit))
        at += size
    return tuple(digits) if len(digits) == 3 and any(digits) else None
