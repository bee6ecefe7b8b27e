"""What a link has sent and nobody has acknowledged: how much may be on the way, and what is due again, and when.

The time-out follows the round trip (Jacobson 1988; a frame that was sent twice is not measured, Karn 1987) and the
bytes that were ahead on the line. A frame is also due again as soon as one that was sent after it has arrived: on a
line that keeps the order it is lost then, on any other it comes twice, which the receiver sees.
"""

from protocol.frames import FRAME_MAX

WINDOW = 32  # frames on the way at once
BYTES_ANY = 0xFFFF  # a credit that nothing exceeds
TRIES_MAX = 12
RTO_FIRST_MS = 250
RTO_MAX_MS = 400  # beyond the bytes ahead: a line that loses half of all exchanges is not taken for a dead one
TICK_MS = 5  # a robot looks at its line once in a control step: no round trip is known better
PROBE_MS = 400  # without credit one frame is tried after that long: what gave the credit back may be lost


class Waiting:
    """A reliable frame that its receiver has not acknowledged."""

    tries = 0
    arrived = False
    sent_ms = 0
    ahead_ms = 0  # what the line had to carry before its end, when it was sent
    again_ms = 0
    order = 0  # among all that was sent

    def __init__(self, kind: int, number: int, payload: bytes, size: int) -> None:
        self.kind = kind
        self.number = number
        self.payload = payload
        self.size = size  # on the wire


class Flight:
    """The frames of one direction, in their order."""

    def __init__(self) -> None:
        self.waiting = []
        self.resent = 0
        self.broken = False  # a frame was sent TRIES_MAX times in vain; it is still sent again
        self.rtt_ms = None
        self._mean_eighths = 0  # of the round trip, in 1/8 ms: in whole ms it would only ever fall
        self._spread_quarters = 0
        self._rto_ms = RTO_FIRST_MS
        self._slots = WINDOW
        self._bytes = BYTES_ANY
        self._order = 0
        self._newest = 0  # order of the last known to have arrived
        self._news_ms = 0  # when the other end last acknowledged anything

    def grant(self, slots: int, octets: int) -> None:
        """Keep within so many frames and bytes from the oldest that is not acknowledged."""
        self._slots = min(slots, WINDOW)
        self._bytes = octets

    def add(self, kind: int, number: int, payload: bytes, size: int) -> None:
        """Queue a frame."""
        self.waiting.append(Waiting(kind, number, payload, size))

    def due(self, now_ms: int) -> list:
        """Return the frames to send now, oldest first."""
        due = []
        for waiting in self._allowed(now_ms):
            if waiting.tries == 0 or now_ms - waiting.again_ms >= 0:
                due.append(waiting)
        return due

    def due_ms(self, now_ms: int) -> int | None:
        """Return when a frame is due at the latest; None: nothing waits."""
        if not self.waiting:
            return None
        times = [waiting.again_ms if waiting.tries else now_ms for waiting in self._allowed(now_ms)]
        return max(now_ms, min(times)) if times else max(now_ms, self._news_ms + PROBE_MS)

    def sent(self, waiting: Waiting, now_ms: int, byte_ns: int) -> None:
        """Note that a frame is on its way now."""
        wait_ms = self._rto_ms
        if waiting.tries:
            wait_ms = min(wait_ms << min(waiting.tries, 5), RTO_MAX_MS)
            self.resent += 1
            self.broken = self.broken or waiting.tries >= TRIES_MAX
        waiting.tries += 1
        waiting.sent_ms = now_ms
        if byte_ns:
            waiting.ahead_ms = self._ahead(waiting) * byte_ns // 1_000_000
            wait_ms += waiting.ahead_ms + FRAME_MAX * byte_ns // 1_000_000  # a whole frame may go before the answer
        waiting.again_ms = now_ms + wait_ms
        self._order += 1
        waiting.order = self._order

    def acknowledged(self, ack: int, have: int, now_ms: int) -> None:
        """Take that all frames before the number that ends in `ack` have arrived, and after it those of the mask."""
        queue = self.waiting
        while queue and 0 < (ack - queue[0].number) & 255 <= WINDOW and queue[0].tries:
            self._arrived(queue.pop(0), now_ms)
        if not have or not queue or (ack - queue[0].number) & 255:
            return
        for waiting in queue[1 : WINDOW + 1]:
            place = waiting.number - queue[0].number - 1
            if have >> place & 1 and waiting.tries:
                self._arrived(waiting, now_ms)
        for waiting in queue[:WINDOW]:
            if waiting.tries and not waiting.arrived and waiting.order < self._newest:
                waiting.again_ms = now_ms

    def _allowed(self, now_ms: int) -> list:
        """Return those that may be on the way: what was sent already, and what credit is left for."""
        slots = self._slots
        if not slots and now_ms - self._news_ms >= PROBE_MS:
            slots = 1
        if slots and len(self.waiting) == 1:
            return self.waiting  # the oldest may always be sent
        allowed, flying = [], 0
        for place, waiting in enumerate(self.waiting):
            if place >= WINDOW:
                break
            if waiting.arrived:
                continue
            if waiting.tries == 0 and (place >= slots or (flying and flying + waiting.size > self._bytes)):
                break
            flying += waiting.size
            allowed.append(waiting)
        return allowed

    def _ahead(self, last: Waiting) -> int:
        """Return how many bytes are on the way, up to the end of a frame."""
        total = 0
        for waiting in self.waiting[:WINDOW]:
            if waiting is last:
                break
            if waiting.tries and not waiting.arrived:
                total += waiting.size
        return total + last.size

    def _arrived(self, waiting: Waiting, now_ms: int) -> None:
        self._news_ms = now_ms
        if waiting.arrived:
            return
        waiting.arrived = True
        if waiting.tries == 1:
            self._newest = max(self._newest, waiting.order)
            self._measure(max(0, now_ms - waiting.sent_ms - waiting.ahead_ms))

    def _measure(self, rtt_ms: int) -> None:
        """Adapt the time-out to the round trip, less the time that the bytes took."""
        if self.rtt_ms is None:
            self._mean_eighths, self._spread_quarters = 8 * rtt_ms, 2 * rtt_ms
        else:
            error = rtt_ms - self.rtt_ms
            if error == 0 and self._spread_quarters < 4:
                return
            self._mean_eighths += error
            self._spread_quarters += abs(error) - (self._spread_quarters >> 2)
        self.rtt_ms = self._mean_eighths >> 3
        self._rto_ms = min(self.rtt_ms + max(self._spread_quarters, TICK_MS), RTO_MAX_MS)
