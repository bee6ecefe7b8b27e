"""How many frames a damaged byte costs, ours against others', and what they take for a frame that never was one.

Each codec sends the same records; bytes of its stream are flipped, taken out or put in at places drawn from a seed, and
the stream is fed in pieces as a port gives them. Lost are the records that never arrive, wrong those that arrive and
were not sent. One record for a damaged byte is what cannot be helped.

    python benchmarks/bench_noise.py
"""

import random
from collections.abc import Callable

from benchmarks.wire_codecs import CODECS, values

RECORDS = 2000
HITS = 150  # in a stream
SEEDS = range(4)
PIECE = 256
AIM = 2.0  # records lost for a damaged byte: its own, and at most one more

Damage = Callable[[bytearray, int, random.Random], None]


def flip(stream: bytearray, at: int, draw: random.Random) -> None:
    """Change some bits of a byte."""
    stream[at] ^= draw.randrange(1, 256)


def lose(stream: bytearray, at: int, draw: random.Random) -> None:
    """Take a byte out."""
    del stream[at]


def insert(stream: bytearray, at: int, draw: random.Random) -> None:
    """Put a byte in."""
    stream.insert(at, draw.randrange(256))


def tried(codec, damage: Damage, seed: int) -> tuple[int, int, int]:
    """Return how many records were lost and how many were wrong in a damaged stream, and how often it raised."""
    draw = random.Random(seed)
    sent = [values(100_000 + i) for i in range(RECORDS)]
    stream = bytearray(b"".join(codec.encode(codec.prepared(record)) for record in sent))
    for at in sorted(draw.sample(range(len(stream)), HITS), reverse=True):
        damage(stream, at, draw)
    arrived, raised = [], 0
    for at in range(0, len(stream), PIECE):
        try:
            arrived += [codec.told(record) for record in codec.feed(bytes(stream[at : at + PIECE]))]
        except Exception:  # a codec may raise whatever it likes: that is what is counted
            raised += 1
    return len(set(sent) - set(arrived)), len(arrived) - len(set(arrived) & set(sent)), raised


def main() -> None:
    """Print a row for each codec."""
    hits = HITS * len(SEEDS)
    print(f"records lost for each of {hits} damaged bytes, aim at most {AIM:.0f}; wrong records and exceptions, aim 0")
    print(f"{'':28}flipped   taken out   put in   wrong   raised")
    for build in CODECS:
        lost, wrong, raised = [], 0, 0
        for damage in (flip, lose, insert):
            results = [tried(build(), damage, seed) for seed in SEEDS]
            lost.append(sum(result[0] for result in results) / hits)
            wrong += sum(result[1] for result in results)
            raised += sum(result[2] for result in results)
        print(f"{build().name:28}{lost[0]:7.2f} {lost[1]:11.2f} {lost[2]:8.2f} {wrong:7} {raised:8}")


if __name__ == "__main__":
    main()
