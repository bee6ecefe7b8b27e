"""Fuzzed frames without end: noise, damaged frames, frames of others; none may be taken for one that was sent.

.venv/bin/python -m tests.million 1000000
"""

import random
import sys
from time import perf_counter

from protocol import frames
from protocol.link import Link
from tests.damage import damaged

CRC, SESSION = 0x12345678, 0xDEADBEEF
BATCH = 50
FOREIGN = [frames.session_seed(CRC, SESSION + 1), frames.session_seed(CRC + 1, SESSION), CRC, 0, 0xFFFFFFFF]


def fuzz(number: int, seed: int = 1) -> tuple[int, int]:
    """Feed fuzzed frames to a decoder and a link until so many have come; return how many were dropped, and were whole.

    AssertionError when one is taken that was not sent like that.
    """
    chance = random.Random(seed)
    decoder, link = frames.Decoder(CRC, SESSION), Link(device=True)
    link.begin(CRC, SESSION)
    whole, payloads = 0, set()
    while decoder.dropped + whole < number:
        sent = [_valid(chance) for _ in range(BATCH)]
        lines = [_foreign(chance) if chance.random() < 0.3 else frames.encode(body) for body in sent]
        stream = damaged(chance, lines, BATCH // 3)[0] + b"\x00"
        bodies = {body[:-4] for body in sent}
        for frame in decoder.feed(stream):
            assert frame.body in bodies, frame.body.hex()
            whole += 1
        payloads |= {body[4:-4] for body in sent}  # the link keeps those that came before their turn
        for received in link.receive(stream, 0):
            assert received.payload in payloads, received.payload.hex()
    return decoder.dropped, whole


def _valid(chance: random.Random) -> bytes:
    payload = chance.randbytes(chance.choice((3, 7, 8, 8, 16, 40)))
    seed = frames.session_seed(CRC, SESSION)
    return frames.seal(chance.randrange(0x10, 0x50), chance.randrange(256), 0, payload, seed, chance.randrange(2))


def _foreign(chance: random.Random) -> bytes:
    """Return a frame of another robot, session or version, or noise that is stuffed like a frame."""
    if chance.random() < 0.3:
        return frames.encode(chance.randbytes(chance.randrange(8, 60)))
    body = bytearray(_valid(chance)[:-4])
    seed = chance.choice(FOREIGN)
    if chance.random() < 0.2:
        body[0] = chance.choice((0x10, 0x30, 0xF1, 0x28))
        seed = frames.session_seed(CRC, SESSION)
    body[1] = 0x10 + body[1] % 0x40
    return frames.encode(bytes(body) + frames.crc32(body, seed).to_bytes(4, "little"))


if __name__ == "__main__":
    begun_s = perf_counter()
    dropped, came = fuzz(int(sys.argv[1]))
    print(f"{sys.argv[1]} frames: {dropped} dropped, {came} came whole, none wrong, {perf_counter() - begun_s:.1f} s")
