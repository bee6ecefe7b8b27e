"""The same messages on CAN: bodies cut into segments, and put together again; the same file on both ends.

Both ends keep one stream of stuffed frames, as on a serial line; this file turns it into CAN frames and back. A body
travels as a transfer: each CAN frame carries a segment byte and up to 7 bytes of the body, on CAN FD up to 63. The
segment byte: bit 7 the first, bit 6 the last of a body, bits 5 to 0 a counter that runs on over all segments that its
sender sends, so that what is left of two bodies never fits together. On CAN FD the body's length stands after the first
segment byte, because the last segment may be padded. The stop pattern is a frame of its own that beats all others:
standard identifier 0, data `STOP`, for every robot. So is the word for which robots wait to start together: identifier
of a `sync`, data `SYNC`; it is in every receiver at the same time, and nobody has to acknowledge it.

A robot's controller has room for one segment, and loses those that come before it was fetched: whoever sends to a
robot leaves GAP_MS between two of them, and WAKE_MS after the first that follows a second of silence. What goes to all
is not acknowledged by each: it keeps WAKE_MS from anything else that the same host sends.

    for frame in Segmenter(node, host, False).feed(link.poll(now_ms)): ...
    received = assembler.feed(frame.identifier, frame.extended, frame.data, now_ms)
    link.receive(received.line, now_ms)

Nothing that arrives can raise. A segment that is missing, late or out of its order costs its body, which the link sends
again; one that comes twice costs nothing.
"""

from collections import namedtuple

from protocol import frames
from protocol.messages import BEACON, BEACON_COILS, STOPPED, SYNC

ALL = 127  # the node of every robot, and of every host
NODE_MAX = 126
HOST = 1  # the node of a host that was not given one
CLASSIC, FD = 8, 64  # bytes of data in a CAN frame
STOP_IDENTIFIER, STOP_DATA = 0, b"STOP"  # a standard frame; every other is extended
SYNC_DATA = b"SYNC"
SYNC_LINE = frames.encode(frames.seal(SYNC.number, 0, 0, b"", 0, 0))  # as which it reaches the core
FIRST, LAST, COUNTER = 0x80, 0x40, 0x3F
BEACONS = (BEACON.number, BEACON_COILS.number)  # kinds whose frames are whole and have no segment byte
LATE_MS = 100  # between two segments of a body
GAP_MS = 1  # at least, between two segments to one robot
WAKE_MS = 6  # at least, after a segment to a robot that heard nothing for SLEEP_MS
SLEEP_MS = 1000
BYTE_NS = 1_000_000 * GAP_MS // 7  # of a byte to a robot
UNDER_WAY_MAX = 4  # bodies at a time
SYNCHRONISE, ORDERS, ANSWERS, GREETINGS, TELEMETRY = 1, 2, 3, 4, 6  # priorities; 0 is left to the stop
FROM_ROBOT = 1 << 17
_KEY = (1 << 26) - 1  # all of an identifier but its priority
_LENGTHS = (8, 12, 16, 20, 24, 32, 48, 64)  # that a CAN FD frame may have beyond 7

CanFrame = namedtuple("CanFrame", ("identifier", "extended", "data"))
Taken = namedtuple("Taken", ("robot", "host", "kind", "line"))  # nodes; `line`: as it goes into Link.receive


def identifier(kind: int, robot: int, host: int, from_robot: bool) -> int:
    """Return the identifier of a body's frames: priority, kind, direction, node of the robot, node of the host."""
    direction = FROM_ROBOT if from_robot else 0
    return priority(kind, from_robot) << 26 | kind << 18 | direction | robot << 10 | host << 3


def priority(kind: int, from_robot: bool) -> int:
    """Return the priority of a kind, 0 being the highest."""
    if kind == SYNC.number:
        return SYNCHRONISE
    if kind < frames.GREETINGS_BELOW and kind != STOPPED.number:
        return GREETINGS
    if frames.is_open(kind):
        return TELEMETRY
    return ANSWERS if from_robot else ORDERS


def kind_of(identifier: int) -> int:
    """Return the kind of a body's frames."""
    return identifier >> 18 & 0xFF


class Segmenter:
    """Turns the stream that one end writes into CAN frames; `robot` and `host` may be changed between two bodies."""

    def __init__(self, robot: int, host: int, from_robot: bool, mtu: int = CLASSIC) -> None:
        self.robot = robot
        self.host = host
        self.mtu = mtu
        self._from_robot = from_robot
        self._counter = 0
        self._tail = b""
        self._skipping = False

    def feed(self, data: bytes) -> list:
        """Take bytes of the stream; return the CAN frames of the bodies that they completed, and of each stop."""
        chunks = (self._tail + data).split(b"\x00")
        self._tail = chunks.pop()
        out = []
        for chunk in chunks:
            if self._skipping:
                self._skipping = False
            elif chunk == STOP_DATA:
                out.append(CanFrame(STOP_IDENTIFIER, False, STOP_DATA))
            elif chunk:
                self._cut(chunk, out)
        if len(self._tail) > frames.BODY_MAX + 1:
            self._skipping = True
            self._tail = b""
        return out

    def _cut(self, stuffed: bytes, out: list) -> None:
        body = frames.decode(stuffed) if len(stuffed) <= frames.BODY_MAX + 1 else None
        if body is None or len(body) < frames.BODY_MIN:
            return
        number = identifier(body[1], self.robot, self.host, self._from_robot)
        if body[1] == SYNC.number:
            out.append(CanFrame(number, True, SYNC_DATA))
            return
        rest = bytes((len(body),)) + body if self.mtu == FD else body
        step = self.mtu - 1
        for at in range(0, len(rest), step):
            mark = (FIRST if at == 0 else 0) | (LAST if at + step >= len(rest) else 0) | self._counter
            out.append(CanFrame(number, True, padded(bytes((mark,)) + rest[at : at + step])))
            self._counter = (self._counter + 1) & COUNTER


def padded(data: bytes) -> bytes:
    """Return data with as many zeros as a CAN FD frame of that length needs."""
    if len(data) <= CLASSIC:
        return data
    return data + bytes(min([length for length in _LENGTHS if length >= len(data)]) - len(data))


class Partial:
    """A body of which segments are still to come."""

    def __init__(self, key: int) -> None:
        self.key = key
        self.counter = 0  # of the segment that came last
        self.heard_ms = 0
        self.length = 0  # of what came
        self.told = 0  # what the length will be, on CAN FD
        self.pieces = []


class Assembler:
    """Puts the bodies together that one end is sent; `dropped` counts those that a lost segment has cost.

    Frames of the other direction, of other networks and beacons are passed over. It keeps at most UNDER_WAY_MAX bodies,
    each of at most 253 bytes: the one that has waited longest gives way.
    """

    def __init__(self, from_robot: bool) -> None:
        self.dropped = 0
        self._direction = FROM_ROBOT if from_robot else 0
        self._under_way = []

    def feed(self, identifier: int, extended: bool, data: bytes, now_ms: int, fd: bool = False):
        """Take a CAN frame; return what it completes, or None. A stop is for all, and is of no kind: 0."""
        if not extended:
            stop = identifier == STOP_IDENTIFIER and data == STOP_DATA
            return Taken(ALL, ALL, 0, frames.STOP) if stop else None
        if identifier & (FROM_ROBOT | 7) != self._direction or len(data) < 2 or kind_of(identifier) in BEACONS:
            return None
        if kind_of(identifier) == SYNC.number:
            line = SYNC_LINE if data == SYNC_DATA else None
        else:
            line = self._line(identifier & _KEY, data, now_ms, fd)
        return Taken(identifier >> 10 & 127, identifier >> 3 & 127, kind_of(identifier), line) if line else None

    def _line(self, key: int, data: bytes, now_ms: int, fd: bool):
        """Take a segment; return the stuffed body that it completes, or None."""
        partial = self._partial(key, data, now_ms)
        body = None if partial is None else self._continued(partial, data, now_ms, fd)
        return None if body is None else frames.encode(body)

    def _partial(self, key: int, data: bytes, now_ms: int):
        """Return the body that a segment belongs to, a new one for its first, or None where it fits to none."""
        partial = None
        for each in self._under_way:
            if each.key == key:
                partial = each
        mark = data[0]
        if mark & FIRST:
            if partial is not None and partial.counter != mark & COUNTER:
                self._drop(partial)
            elif partial is not None:
                self._under_way.remove(partial)
            return self._begun(key)
        if partial is None:
            return None
        if mark & COUNTER == partial.counter and not mark & LAST:
            return None
        if mark & COUNTER != (partial.counter + 1) & COUNTER or now_ms - partial.heard_ms > LATE_MS:
            self._drop(partial)
            return None
        return partial

    def _begun(self, key: int):
        if len(self._under_way) >= UNDER_WAY_MAX:
            oldest = self._under_way[0]
            for each in self._under_way:
                if oldest.heard_ms - each.heard_ms > 0:
                    oldest = each
            self._drop(oldest)
        partial = Partial(key)
        self._under_way.append(partial)
        return partial

    def _continued(self, partial, data: bytes, now_ms: int, fd: bool):
        """Take a segment that fits; return the body if it was the last, and a body can be made of it."""
        mark, piece = data[0], data[1:]
        if mark & FIRST and fd and piece:
            partial.told, piece = piece[0], piece[1:]
        partial.counter = mark & COUNTER
        partial.heard_ms = now_ms
        partial.length += len(piece)
        partial.pieces.append(piece)
        if partial.length >= frames.BODY_MAX + FD:
            self._drop(partial)
            return None
        if not mark & LAST:
            return None
        self._under_way.remove(partial)
        body = b"".join(partial.pieces)
        if partial.told:
            body = body[: partial.told] if partial.told <= len(body) else b""
        if not frames.BODY_MIN <= len(body) <= frames.BODY_MAX or body[1] != partial.key >> 18:
            self.dropped += 1
            return None
        return body

    def _drop(self, partial) -> None:
        self._under_way.remove(partial)
        self.dropped += 1
