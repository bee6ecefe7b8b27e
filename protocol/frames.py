"""Frames on the wire: COBS between zero bytes, sealed with a seeded CRC-32.

A body is `version|flags u8, kind u8, seq u8, ack u8, payload, crc32 u32` and at most 253 bytes long, so that COBS
costs exactly one byte and the frame ends with the only zero in it. The CRC starts from `seed`, the CRC-32 of the
robot's dictionary: a host with other definitions cannot make a frame that this robot takes. Kinds below 0x10 are
sealed with seed 0, so that two strangers can always say hello.

    line = encode(seal(0x14, 3, 7, payload, seed, RELIABLE))
    frames = Decoder(seed).feed(line)
"""

from binascii import crc32
from collections import namedtuple

VERSION = 1
RELIABLE = 1  # flag: acknowledged, resent when lost, delivered once and in order
BODY_MAX = 253
PAYLOAD_MAX = BODY_MAX - 8
UNSEEDED_BELOW = 0x10
STOP = b"\x00STOP\x00"  # four bytes between delimiters: shorter than any frame, so no valid frame holds it

Frame = namedtuple("Frame", ("flags", "kind", "seq", "ack", "payload"))


def seal(kind: int, seq: int, ack: int, payload: bytes, seed: int, flags: int) -> bytes:
    """Return the body with its check; ValueError when the payload is longer than PAYLOAD_MAX."""
    if len(payload) > PAYLOAD_MAX:
        raise ValueError(f"payload {len(payload)} bytes, at most {PAYLOAD_MAX}")
    body = bytes((VERSION << 4 | flags, kind, seq, ack)) + payload
    return body + crc32(body, _seed_of(kind, seed)).to_bytes(4, "little")


def unseal(body: bytes, seed: int) -> Frame | None:
    """Return the frame of `body`, or None when it is damaged or foreign.

    A frame of another version is foreign too, unless it is unseeded: a hello of any version must be answered.
    """
    if not 8 <= len(body) <= BODY_MAX or (body[0] >> 4 != VERSION and body[1] >= UNSEEDED_BELOW):
        return None
    if crc32(body[:-4], _seed_of(body[1], seed)) != int.from_bytes(body[-4:], "little"):
        return None
    return Frame(body[0] & 15, body[1], body[2], body[3], body[4:-4])


def encode(body: bytes) -> bytes:
    """Return `body` as it goes on the wire: stuffed so that its only zero is the last byte."""
    stuffed = b"".join([bytes((len(run) + 1,)) + run for run in body.split(b"\x00")])
    return stuffed + b"\x00"


def decode(stuffed: bytes) -> bytes | None:
    """Return the body of a stuffed frame without its delimiter, or None when its lengths do not add up."""
    runs = []
    at = 0
    while at < len(stuffed):
        end = at + stuffed[at]
        if end == at or end > len(stuffed):
            return None
        runs.append(stuffed[at + 1 : end])
        at = end
    return b"\x00".join(runs)


class Decoder:
    """Collects received bytes and yields the whole, intact frames among them.

    Noise on a line is weather, not a bug: a damaged frame is counted in `dropped` and skipped. Nothing that arrives
    can raise, and never more than one frame is kept.
    """

    def __init__(self, seed: int = 0) -> None:
        self.seed = seed
        self.dropped = 0
        self._tail = b""
        self._skipping = False

    def feed(self, data: bytes) -> list[Frame]:
        """Take received bytes; return the list of frames they completed."""
        chunks = (self._tail + data).split(b"\x00")
        self._tail = chunks.pop()
        frames = []
        for chunk in chunks:
            if self._skipping:
                self._skipping = False
            elif chunk and chunk != b"STOP":
                self._take(chunk, frames)
        if len(self._tail) > BODY_MAX + 1:
            self.dropped += not self._skipping
            self._skipping = True
            self._tail = b""
        return frames

    def _take(self, chunk: bytes, frames: list) -> None:
        body = decode(chunk) if len(chunk) <= BODY_MAX + 1 else None
        frame = unseal(body, self.seed) if body is not None else None
        if frame is None:
            self.dropped += 1
        else:
            frames.append(frame)


class StopFinder:
    """Finds the stop pattern in received bytes before any decoding, also when it arrives in pieces."""

    def __init__(self) -> None:
        self._tail = b""

    def feed(self, data: bytes) -> bool:
        """Return whether the pattern was completed by these bytes."""
        window = self._tail + data
        found = STOP in window
        self._tail = window[-5:]
        return found


def _seed_of(kind: int, seed: int) -> int:
    return 0 if kind < UNSEEDED_BELOW else seed
