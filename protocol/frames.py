"""Frames on the wire: COBS between zero bytes, sealed with a seeded CRC-32.

A body is `version|flags u8, kind u8, seq u8, ack u8, [node u8], payload, [tag], crc32 u32` and at most 253 bytes long,
so that COBS costs exactly one byte and the frame ends with the only zero in it. Where the CRC starts from says who can
make the frame: anybody a greeting (kinds below 0x10: 0), whoever knows the robot's dictionary an open frame (0x50 to
0x5F: its CRC-32), and only the two ends of a session any other. So a host with other definitions cannot move a coil,
and what was meant for another session is no frame in this one.

    line = encode(seal(0x14, 3, 7, payload, session_seed(dictionary_crc, session), RELIABLE))
    frames = Decoder(dictionary_crc, session).feed(line)
"""

from binascii import crc32
from collections import namedtuple

VERSION = 2
RELIABLE = 1  # flag: acknowledged, resent when lost, delivered once and in order
NODE = 2  # flag: the number of the robot on a shared line follows the head
SEALED = 4  # flag: a tag that only holders of the pairing key can make stands before the CRC
RESERVED = 8  # flag: never set
HEAD_BYTES = 4
TAG_BYTES = 8
CRC_BYTES = 4
BODY_MIN = HEAD_BYTES + CRC_BYTES
BODY_MAX = 253
PAYLOAD_MAX = BODY_MAX - BODY_MIN - 1 - TAG_BYTES  # so that any payload leaves room for node and tag
INTACT = 0x2144DF1C  # the CRC of a body with its CRC, whatever it starts from
STUFFING = 2  # bytes that COBS and the delimiter add to a body
FRAME_MAX = BODY_MAX + STUFFING
GREETINGS_BELOW = 0x10
OPEN_FROM, OPEN_BELOW = 0x50, 0x60
STOP = b"\x00STOP\x00"  # four bytes between delimiters: shorter than any frame, so no valid frame holds it

Frame = namedtuple(
    "Frame", ("flags", "kind", "seq", "ack", "node", "payload", "body", "offered")
)  # body: up to the CRC


def is_open(kind: int) -> bool:
    """Return whether frames of this kind belong to no session: whoever has the dictionary may read them."""
    return OPEN_FROM <= kind < OPEN_BELOW


def session_seed(dictionary_crc: int, session: int) -> int:
    """Return what the CRC of a session's frames starts from."""
    return crc32(session.to_bytes(4, "little"), dictionary_crc)


def head(kind: int, seq: int, ack: int, flags: int, node: int = 0) -> bytes:
    """Return the first bytes of a body; a `node` sets its flag."""
    if node:
        return bytes((VERSION << 4 | flags | NODE, kind, seq, ack, node))
    return bytes((VERSION << 4 | flags, kind, seq, ack))


def seal(kind: int, seq: int, ack: int, payload: bytes, seed: int, flags: int, node: int = 0) -> bytes:
    """Return the body with its check; ValueError when the payload is longer than PAYLOAD_MAX."""
    if len(payload) > PAYLOAD_MAX:
        raise ValueError(f"payload {len(payload)} bytes, at most {PAYLOAD_MAX}")
    body = head(kind, seq, ack, flags, node) + payload
    return body + crc32(body, 0 if kind < GREETINGS_BELOW else seed).to_bytes(CRC_BYTES, "little")


def close(body: bytes, seed: int) -> bytes:
    """Return a body, complete but for its CRC, with that; a greeting is sealed with 0 whatever the seed."""
    return body + crc32(body, 0 if body[1] < GREETINGS_BELOW else seed).to_bytes(4, "little")


def encode(body: bytes) -> bytes:
    """Return `body` as it goes on the wire: stuffed so that its only zero is the last byte."""
    stuffed = bytearray()
    for run in body.split(b"\x00"):
        stuffed.append(len(run) + 1)
        stuffed += run
    stuffed.append(0)
    return bytes(stuffed)


def decode(stuffed: bytes) -> bytes | None:
    """Return the body of a stuffed frame without its delimiter, or None when its lengths do not add up."""
    runs = []
    end, size = 0, len(stuffed)
    while end < size:
        begin = end + 1
        end += stuffed[end]
        if not begin <= end <= size:
            return None
        runs.append(stuffed[begin:end])
    return b"\x00".join(runs)


class Decoder:
    """Collects received bytes and yields the whole, intact frames among them.

    Noise on a line is weather, not a bug: a damaged or foreign frame is counted in `dropped` and skipped. Nothing that
    arrives can raise, and never more than one frame is kept. Beside the session in force it knows one that is offered.
    """

    def __init__(self, dictionary_crc: int = 0, session: int = 0) -> None:
        self.dropped = 0
        self._tail = b""
        self._skipping = False
        self.tune(dictionary_crc, session)

    def tune(self, dictionary_crc: int, session: int) -> None:
        """Take the frames of this robot and session from now on."""
        self.dictionary_crc = dictionary_crc
        self.seed = session_seed(dictionary_crc, session)
        self._offered_seed = None

    def offer(self, session: int) -> None:
        """Take the frames of that session too, and mark them."""
        self._offered_seed = session_seed(self.dictionary_crc, session)

    def feed(self, data: bytes) -> list[Frame]:
        """Take received bytes; return the list of frames they completed."""
        chunks = (self._tail + data).split(b"\x00")
        self._tail = chunks.pop()
        frames = []
        for chunk in chunks:
            if self._skipping:
                self._skipping = False
            elif chunk and chunk != b"STOP":
                frame = self._frame(chunk)
                if frame is None:
                    self.dropped += 1
                else:
                    frames.append(frame)
        if len(self._tail) > BODY_MAX + 1:
            self.dropped += not self._skipping
            self._skipping = True
            self._tail = b""
        return frames

    def _frame(self, chunk: bytes) -> Frame | None:
        """Return the frame between two zeros, or None when it is damaged, foreign, or shorter than its flags say.

        A frame of another version is foreign too, unless it is a greeting: a hello of any version must be answered.
        """
        body = decode(chunk) if BODY_MIN < len(chunk) <= BODY_MAX + 1 else None
        if body is None:
            return None
        first, kind, seed, offered = body[0], body[1], self.seed, False
        if kind < GREETINGS_BELOW:
            seed = 0
        elif first >> 4 != VERSION or first & RESERVED:
            return None
        elif OPEN_FROM <= kind < OPEN_BELOW:
            seed = self.dictionary_crc
        if crc32(body, seed) != INTACT:
            offered = self._offered_seed is not None and seed == self.seed
            if not offered or crc32(body, self._offered_seed) != INTACT:
                return None
        body = body[:-CRC_BYTES]
        begin, end, node = HEAD_BYTES, len(body), 0
        if first & NODE:
            node = body[4] if end > HEAD_BYTES else 0
            begin += 1
        if first & SEALED:
            end -= TAG_BYTES
        return Frame(first & 15, kind, body[2], body[3], node, body[begin:end], body, offered) if begin <= end else None


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
