"""A reliable session over a line that loses, repeats or damages bytes; the same file on both ends.

Reliable frames are numbered, acknowledged, resent and delivered once and in order. Posted frames (telemetry) are
numbered too, so that the receiver can count what is missing, and never resent. The link opens no port and reads no
clock: it is handed bytes and a time and hands back bytes.

    link.send(FIRE.number, payload, now_ms)
    port.write(link.poll(now_ms))
    for received in link.receive(port.read(), now_ms): ...
"""

from collections import namedtuple

from protocol import frames
from protocol.messages import ALIVE

WINDOW = 8  # frames on the way at once
QUEUE_MAX = 64
FRAME_MAX = frames.BODY_MAX + 2  # on the wire, stuffed and delimited
TRIES_MAX = 12
RTO_FIRST_MS = 250
RTO_MIN_MS = 100  # a full window of long frames takes that long at 115200 baud
RTO_MAX_MS = 400  # so that a line that loses half of all exchanges is not taken for a dead one

Received = namedtuple("Received", ("kind", "seq", "payload"))


class LinkFull(RuntimeError):
    """Too many frames wait to be sent."""


class Waiting:
    """A reliable frame that its receiver has not acknowledged."""

    def __init__(self, kind: int, seq: int, payload: bytes) -> None:
        self.kind = kind
        self.seq = seq
        self.payload = payload
        self.sent_ms = 0
        self.tries = 0


class Link:
    """One end of the line. `seed` is the CRC of the dictionary that both ends must share."""

    def __init__(self, seed: int = 0) -> None:
        self.decoder = frames.Decoder(seed)
        self.reset(seed)

    def reset(self, seed: int) -> None:
        """Forget the session: numbers start at 0, nothing waits, counters stay with the decoder."""
        self.decoder.seed = seed
        self.heard_ms = None  # time of the last intact seeded frame
        self.resent = 0
        self.duplicates = 0
        self.missed = 0
        self.broken = False  # a frame was sent TRIES_MAX times in vain; it is still sent again
        self.rtt_ms = None
        self._spread_ms = 0
        self._rto_ms = RTO_FIRST_MS
        self._next_send = 0
        self._next_post = 0
        self._next_receive = 0
        self._next_posted = None
        self._ahead = []
        self._waiting = []
        self._posts = []
        self._ack_due = False

    def room(self) -> int:
        """Return how many more frames `send` takes now."""
        return QUEUE_MAX - len(self._waiting)

    def idle(self) -> bool:
        """Return whether all that was sent is acknowledged."""
        return not self._waiting

    def send(self, kind: int, payload: bytes, now_ms: int) -> int:
        """Queue a reliable frame and return its sequence number; LinkFull when QUEUE_MAX frames wait."""
        if self.room() <= 0:
            raise LinkFull(f"{QUEUE_MAX} frames wait for an acknowledgement")
        seq = self._next_send
        self._next_send = (seq + 1) & 255
        self._waiting.append(Waiting(kind, seq, payload))
        return seq

    def post(self, kind: int, payload: bytes, first: bool = False) -> None:
        """Queue a frame that is not resent, before all others if need be; the oldest gives way when too many wait."""
        if len(self._posts) >= QUEUE_MAX:
            self._posts.pop(0)
        self._posts.insert(0 if first else len(self._posts), (kind, payload))

    def acknowledge(self) -> None:
        """Have the next `poll` write at least an `alive`."""
        self._ack_due = True

    def receive(self, data: bytes, now_ms: int) -> list[Received]:
        """Take received bytes; return what they deliver, in order, each reliable frame exactly once."""
        delivered = []
        for frame in self.decoder.feed(data):
            if frame.kind < frames.UNSEEDED_BELOW:
                delivered.append(Received(frame.kind, frame.seq, frame.payload))
                continue
            self.heard_ms = now_ms
            self._acknowledged(frame.ack, now_ms)
            if frame.flags & frames.RELIABLE:
                self._take_reliable(frame, delivered)
            elif frame.kind != ALIVE.number:
                self._take_posted(frame, delivered)
        return delivered

    def poll(self, now_ms: int, room: int = 65_536) -> bytes:
        """Return the bytes to write now: new frames, frames that are due again, an acknowledgement if one is owed.

        No frame is begun that might not fit into `room` bytes; what is left comes with a later call.
        """
        if not (self._waiting or self._posts or self._ack_due):
            return b""
        out = []
        for waiting in self._waiting[:WINDOW]:
            if room >= FRAME_MAX and self._due(waiting, now_ms):
                out.append(self._sealed(waiting, now_ms))
                room -= len(out[-1])
        while self._posts and room >= FRAME_MAX:
            out.append(self._posted())
            room -= len(out[-1])
        if self._ack_due and room >= FRAME_MAX:
            out.append(self._line(ALIVE.number, 0, b"", 0))
        return b"".join(out)

    def _posted(self) -> bytes:
        kind, payload = self._posts.pop(0)
        line = self._line(kind, self._next_post, payload, 0)
        self._next_post = (self._next_post + (kind >= frames.UNSEEDED_BELOW)) & 255
        return line

    def _take_reliable(self, frame, delivered: list) -> None:
        self._ack_due = True
        distance = (frame.seq - self._next_receive) & 255
        known = [ahead.seq for ahead in self._ahead]
        if distance >= WINDOW or frame.seq in known:
            self.duplicates += 1
            return
        self._ahead.append(frame)
        while True:
            due = [ahead for ahead in self._ahead if ahead.seq == self._next_receive]
            if not due:
                return
            self._ahead.remove(due[0])
            delivered.append(Received(due[0].kind, due[0].seq, due[0].payload))
            self._next_receive = (self._next_receive + 1) & 255

    def _take_posted(self, frame, delivered: list) -> None:
        if self._next_posted is not None:
            gap = (frame.seq - self._next_posted) & 255
            self.missed += gap if gap < 128 else 0
        self._next_posted = (frame.seq + 1) & 255
        delivered.append(Received(frame.kind, frame.seq, frame.payload))

    def _acknowledged(self, ack: int, now_ms: int) -> None:
        while self._waiting and 0 < (ack - self._waiting[0].seq) & 255 <= WINDOW and self._waiting[0].tries:
            waiting = self._waiting.pop(0)
            if waiting.tries == 1:
                self._measure(now_ms - waiting.sent_ms)

    def _measure(self, rtt_ms: int) -> None:
        """Adapt the resend time-out to the round trip (Jacobson 1988; resent frames are not measured, Karn 1987)."""
        if self.rtt_ms is None:
            self.rtt_ms, self._spread_ms = rtt_ms, rtt_ms // 2
        else:
            self._spread_ms += (abs(rtt_ms - self.rtt_ms) - self._spread_ms) // 4
            self.rtt_ms += (rtt_ms - self.rtt_ms) // 8
        self._rto_ms = min(max(self.rtt_ms + 4 * self._spread_ms, RTO_MIN_MS), RTO_MAX_MS)

    def _due(self, waiting: Waiting, now_ms: int) -> bool:
        if waiting.tries == 0:
            return True
        backed_off = min(self._rto_ms << min(waiting.tries - 1, 5), RTO_MAX_MS)
        if now_ms - waiting.sent_ms < backed_off:
            return False
        self.broken = self.broken or waiting.tries >= TRIES_MAX
        return True

    def _sealed(self, waiting: Waiting, now_ms: int) -> bytes:
        self.resent += waiting.tries > 0
        waiting.tries += 1
        waiting.sent_ms = now_ms
        return self._line(waiting.kind, waiting.seq, waiting.payload, frames.RELIABLE)

    def _line(self, kind: int, seq: int, payload: bytes, flags: int) -> bytes:
        if kind >= frames.UNSEEDED_BELOW:
            self._ack_due = False  # this frame carries it
        return frames.encode(frames.seal(kind, seq, self._next_receive, payload, self.decoder.seed, flags))
