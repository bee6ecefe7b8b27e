"""Our frames against pymavlink's on the same 42 bytes: a time, 18 words and two bytes, field values to bytes and back.

python benchmarks/bench_codec.py
"""

import time

from pymavlink.dialects.v20 import common as mavlink

from protocol import frames
from protocol.messages import Field, Message

WORDS = list(range(1000, 1018))
SEED = 0x12345678
SAME = Message(
    0x50, "same", "The payload of MAVLink's RC_CHANNELS.",
    Field("time_ms", "I", ""), *[Field(f"word_{i}", "H", "") for i in range(18)],
    Field("count", "B", ""), Field("rssi", "B", ""),
)  # fmt: skip
VALUES = {"time_ms": 123456, **{f"word_{i}": word for i, word in enumerate(WORDS)}, "count": 18, "rssi": 99}
ROUNDS = 5
FRAMES = 4000


class Sink:
    """A file for pymavlink to write to."""

    def write(self, data: bytes) -> None:
        """Forget the data."""


def fastest_us(work) -> float:
    """Return the CPU time of one call of `work`, the best of ROUNDS."""
    best = float("inf")
    for _ in range(ROUNDS):
        begun = time.process_time()
        for _ in range(FRAMES):
            work()
        best = min(best, (time.process_time() - begun) / FRAMES)
    return best * 1e6


def main() -> None:
    """Print microseconds and ratios."""
    mav = mavlink.MAVLink(Sink())
    packed = mav.rc_channels_encode(123456, 18, *WORDS, 99).pack(mav)
    ours = frames.encode(frames.seal(SAME.number, 1, 2, SAME.pack(**VALUES), SEED, 0))
    decoder = frames.Decoder(SEED)

    encode_us = fastest_us(lambda: frames.encode(frames.seal(SAME.number, 1, 2, SAME.pack(**VALUES), SEED, 0)))
    decode_us = fastest_us(lambda: SAME.unpack(decoder.feed(ours)[0].payload))
    mav_encode_us = fastest_us(lambda: mav.rc_channels_encode(123456, 18, *WORDS, 99).pack(mav))
    mav_decode_us = fastest_us(lambda: mav.parse_buffer(packed))

    print("                 encode us   decode us   bytes")
    print(f"softrig        {encode_us:11.2f} {decode_us:11.2f} {len(ours):7}")
    print(f"pymavlink      {mav_encode_us:11.2f} {mav_decode_us:11.2f} {len(packed):7}")
    print(f"times faster   {mav_encode_us / encode_us:11.1f} {mav_decode_us / decode_us:11.1f}")


if __name__ == "__main__":
    main()
