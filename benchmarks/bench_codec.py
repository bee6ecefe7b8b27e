"""How long a frame takes from field values to bytes and back, ours against others', at the same 42 bytes.

The codecs take turns, so that a busy machine slows all of them, and each is told by its best turn. The aim is to be at
least four times faster than the best of them in pure Python: all but pymavlink with fastcrc, which is told beside them.
(pycyphal's COBS is in C where the package cobs could be built. Klipper's own host has its blocks in C too.)

    python benchmarks/bench_codec.py
"""

import time
from functools import partial

from benchmarks.wire_codecs import CODECS, values

TURNS = 60
FRAMES = 250
AIM = 4.0


def took_us(work) -> float:
    """Return the CPU time of one call."""
    begun = time.process_time()
    for _ in range(FRAMES):
        work()
    return (time.process_time() - begun) / FRAMES * 1e6


def fastest(works: list) -> list[float]:
    """Return the best turn of each."""
    best = [float("inf")] * len(works)
    for _ in range(TURNS):
        best = [min(old, took_us(work)) for old, work in zip(best, works, strict=True)]
    return best


def main() -> None:
    """Print microseconds, and how many times ours they are."""
    rows = [build() for build in CODECS]
    record = values(123456)
    prepared = [codec.prepared(record) for codec in rows]
    lines = [codec.encode(given) for codec, given in zip(rows, prepared, strict=True)]
    for codec, line in zip(rows, lines, strict=True):
        (told,) = codec.feed(line)
        assert codec.told(told) == record, codec.name
    encode = fastest([partial(codec.encode, given) for codec, given in zip(rows, prepared, strict=True)])
    decode = fastest([partial(codec.feed, line) for codec, line in zip(rows, lines, strict=True)])

    print(f"{'':28}encode us   x ours   decode us   x ours   bytes")
    for codec, put, got, line in zip(rows, encode, decode, lines, strict=True):
        print(f"{codec.name:28}{put:9.2f}{put / encode[0]:9.1f}{got:12.2f}{got / decode[0]:9.1f}{len(line):8}")
    for what, times in (("encode", encode), ("decode", decode)):
        least = {codec.name: took / times[0] for codec, took in zip(rows, times, strict=True) if codec.pure}
        del least[rows[0].name]
        name = min(least, key=least.__getitem__)
        print(f"{what}: {least[name]:.1f} times faster than the best of them ({name}), aim {AIM:.0f}")


if __name__ == "__main__":
    main()
