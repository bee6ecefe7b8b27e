"""What a bad line does to the bytes on it, by seeded chance, and which frames it has touched.

stream, touched = damaged(chance, lines)
"""

import random

KINDS = ("flip", "replace", "delete", "insert", "swap", "cut", "merge")


def damaged(chance: random.Random, lines: list[bytes], count: int = 1) -> tuple[bytes, set[int]]:
    """Return the stream of `lines` after `count` damages, and the numbers of the lines that lost or got a byte."""
    stream = [(byte, number) for number, line in enumerate(lines) for byte in line]
    touched: set[int] = set()
    for _ in range(count if stream else 0):
        begin = chance.randrange(len(stream))
        kind = chance.choice(KINDS)
        end = begin + 1 + (chance.randrange(300) if kind == "cut" else chance.randrange(3) if kind == "delete" else 0)
        if kind == "merge":  # the delimiter goes
            begin = next((at for at in range(begin, len(stream)) if stream[at][0] == 0), begin)
            end = begin + 1
        old = stream[begin:end]
        touched |= {number for _, number in old}
        if kind == "swap" and begin + 1 < len(stream):
            touched.add(stream[begin + 1][1])
            stream[begin : begin + 2] = [stream[begin + 1], stream[begin]]
        else:
            stream[begin:end] = [(byte, old[0][1]) for byte in _instead(chance, kind, old[0][0])]
        if not stream:
            break
    return bytes(byte for byte, _ in stream), touched


def _instead(chance: random.Random, kind: str, byte: int) -> bytes:
    if kind == "flip":
        return bytes((byte ^ 1 << chance.randrange(8),))
    if kind == "replace":
        return chance.randbytes(1)
    if kind == "insert":
        return chance.randbytes(chance.choice((1, 1, 2, 40, 600))) + bytes((byte,))
    return b"" if kind != "swap" else bytes((byte,))
