"""A reliable session over a line that loses, repeats, reorders or damages bytes; the same file on both ends.

Reliable frames are numbered, acknowledged, resent one by one when they are missed, and delivered once and in order.
Posted frames are numbered too, so that the receiver can count what is missing, and never resent. Both ends keep within
the credit that the other gives. The link opens no port and reads no clock: it is handed bytes and a time and hands back
bytes.

    link.begin(dictionary_crc, session)
    link.send(FIRE.number, payload, now_ms)
    port.write(link.poll(now_ms))
    for received in link.receive(port.read(), now_ms): ...
"""

from collections import namedtuple

from protocol import frames, secret
from protocol.flight import BYTES_ANY, WINDOW, Flight
from protocol.messages import ALIVE

QUEUE_MAX = 96
POSTS_MAX = 16  # a board has not the memory for as many answers as strangers may ask for
RESERVE = WINDOW + 8  # places of it that no credit is given for: a window may come on credit that was taken back since
ALIVE_BYTES = 7
LAPS = 4  # of its 256 numbers that a posted frame may be ahead when all before it were lost
_POSTED_LAPS = (0, -1) + tuple(range(1, LAPS))  # in the order of what is likely; -1: it was heard before
LATE = 16  # a posted frame that seems so much older than the newest is: it was late on its way, or comes twice
TAGS_MAX = 24  # looked at in one read: more than a line brings in a control step, and all the work that forgers make
PAST_MAX = 8  # sessions whose end is remembered

Received = namedtuple("Received", ("kind", "seq", "payload"))


class LinkFull(RuntimeError):
    """Too many frames wait to be sent."""


class Link:
    """One end of the line. `node` is the robot's number on a shared line, 0: the line is not shared."""

    def __init__(self, dictionary_crc: int = 0, node: int = 0, device: bool = False) -> None:
        self.decoder = frames.Decoder(dictionary_crc)
        self.node = node
        self.byte_ns = 0  # of a byte on the line; 0: not known
        self.grant_bytes = BYTES_ANY  # that this end takes unacknowledged
        self.may_adopt = False  # the session that is offered, at its first frame
        self.forged = 0  # frames whose tag was wrong, or missing
        self.foreign = 0  # intact frames of a session that is not in force
        self._device = device
        self._addressed = node != 0 and not device
        self._past = []
        self._tags_left = TAGS_MAX
        self.session = 0
        self.begin(dictionary_crc, 0)

    def begin(self, dictionary_crc: int, session: int, key: bytes = b"") -> None:
        """Begin a session: numbers start at 0, nothing waits. With a `key` every frame of it carries a tag."""
        self.decoder.tune(dictionary_crc, session)
        if self.session not in (0, session):
            self._past = (self._past + [self.session])[-PAST_MAX:]
        self.session = session
        self.key = key
        self.heard_ms = None  # time of the last frame of the session
        self.duplicates = 0
        self.missed = 0
        self.flight = Flight()
        self._offered = None
        self._next_send = 0  # numbers count on beyond 255; frames carry their last byte
        self._next_post = 0
        self._next_open = 0
        self._next_receive = 0
        self._next_posted = 0
        self._next_telemetry = None
        self._ahead = []
        self._posts = []
        self._ack_due = False
        self._told_slots = WINDOW
        self._retell = 0  # reliable frames that are still answered by an `alive`: the one before may be lost

    def offer(self, session: int, key: bytes = b"") -> bool:
        """Be ready for a session that may follow: its first frame begins it, when `may_adopt` then.

        False: it has been, and is over; a hello that was late on its way does not bring its frames back.
        """
        if session in self._past:
            return False
        if session != self.session:
            self._offered = (session, key)
            self.decoder.offer(session)
        return True

    def granted(self, slots: int, octets: int) -> None:
        """Keep within so many frames and bytes that are not acknowledged; later the other end says so itself."""
        self.flight.grant(slots, octets)

    @property
    def resent(self) -> int:
        """Return how many frames of this session were sent again."""
        return self.flight.resent

    @property
    def rtt_ms(self) -> int | None:
        """Return the round trip, smoothed, or None before the first."""
        return self.flight.rtt_ms

    @property
    def broken(self) -> bool:
        """Return whether a frame was sent many times in vain; it is still sent again."""
        return self.flight.broken

    def room(self) -> int:
        """Return how many more frames `send` takes now."""
        return QUEUE_MAX - len(self.flight.waiting)

    def idle(self) -> bool:
        """Return whether all that was sent is acknowledged."""
        return not self.flight.waiting

    def send(self, kind: int, payload: bytes, now_ms: int) -> int:
        """Queue a reliable frame and return its sequence number.

        LinkFull when QUEUE_MAX frames wait; ValueError when the payload is longer than PAYLOAD_MAX.
        """
        _check(payload)
        if len(self.flight.waiting) >= QUEUE_MAX:
            raise LinkFull(f"{QUEUE_MAX} frames wait for an acknowledgement")
        number = self._next_send
        self._next_send = number + 1
        self.flight.add(kind, number, payload, self._size(len(payload)))
        return number & 255

    def post(self, kind: int, payload: bytes, first: bool = False) -> None:
        """Queue a frame that is not resent, before all others if need be; the second gives way when too many wait.

        ValueError when the payload is longer than PAYLOAD_MAX.
        """
        _check(payload)
        if len(self._posts) >= POSTS_MAX:
            self._posts.pop(1)  # the first may be the answer to a stop
        self._posts.insert(0 if first else len(self._posts), (kind, payload))

    def acknowledge(self) -> None:
        """Have the next `poll` write an `alive`, whatever else it writes."""
        self._ack_due = True

    def receive(self, data: bytes, now_ms: int) -> list[Received]:
        """Take received bytes; return what they deliver, in order, each reliable frame exactly once."""
        delivered = []
        self._tags_left = TAGS_MAX
        begun = False  # the session that was offered when these bytes came: they were decoded all at once
        for frame in self.decoder.feed(data):
            flags, kind, seq, _, node, payload, _, offered = frame
            if not self._is_ours(flags, node):
                continue
            if kind < frames.GREETINGS_BELOW:
                delivered.append(Received(kind, seq, payload))
            elif frames.OPEN_FROM <= kind < frames.OPEN_BELOW:
                self._take_open(frame, delivered)
            elif offered and not begun:
                if self._begins(frame):
                    begun = True
                    # what the last session said a moment ago is nobody's order any more
                    delivered = [received for received in delivered if received.kind < frames.GREETINGS_BELOW]
                    self._take(frame, now_ms, delivered)
            elif offered == begun:
                self._take(frame, now_ms, delivered)
            else:
                self.foreign += 1
        return delivered

    def poll(self, now_ms: int, room: int = 65_536) -> bytes:
        """Return the bytes to write now: new frames, frames that are due again, an acknowledgement if one is owed.

        No frame is begun that does not fit into `room` bytes; what is left comes with a later call.
        """
        if self._told_slots == 0 and self._opens():
            self._ack_due = True
        flight = self.flight
        if not (flight.waiting or self._posts or self._ack_due):
            return b""
        out = []
        while self._posts and room >= self._size(len(self._posts[0][1])):
            out.append(self._posted())
            room -= len(out[-1])
        for waiting in flight.due(now_ms) if flight.waiting else ():
            if room < self._size(len(waiting.payload)):
                break
            flight.sent(waiting, now_ms, self.byte_ns)
            out.append(self._spoken(waiting.kind, waiting.number, waiting.payload, frames.RELIABLE))
            room -= len(out[-1])
        if self._ack_due and room >= self._size(ALIVE_BYTES):
            out.append(self._alive())
        return b"".join(out)

    def due_ms(self, now_ms: int) -> int | None:
        """Return when `poll` has something to write, at the latest; None: nothing waits."""
        if self._posts or self._ack_due or self._opens():
            return now_ms
        return self.flight.due_ms(now_ms)

    def _is_ours(self, flags: int, node: int) -> bool:
        """Return whether a frame is for, or from, the robot of this line; a robot answers as it is spoken to."""
        if not self._device:
            return node == self.node
        named = flags & frames.NODE != 0
        if named and node != self.node:
            return False
        self._addressed = named
        return True

    def _take(self, frame, now_ms: int, delivered: list) -> None:
        """Take a frame of the session, unless its tag is wrong; one that was heard before says nothing of now."""
        if self.session == 0:
            self.foreign += 1
            return
        flags, kind, seq, ack, _, payload, _, _ = frame
        reliable = flags & frames.RELIABLE
        in_turn = reliable and seq == self._next_receive & 255
        number = self._next_receive if in_turn else self._number(frame)
        if self.key:
            number = self._true_number(frame, number)
            if number < 0:
                self.forged += 1
                return
        if not (in_turn or (self._is_new(number) if reliable else number >= self._next_posted)):
            self._ack_due = self._ack_due or reliable != 0
            self.duplicates += 1
            return
        self.heard_ms = now_ms
        if kind == ALIVE.number:
            self._take_alive(frame, number, now_ms)
            return
        self.flight.acknowledged(ack, 0, now_ms)
        if not reliable:
            self._next_posted = number + 1
            delivered.append(Received(kind, seq, payload))
            return
        self._ack_due = True
        self._retell -= self._retell > 0
        if in_turn and not self._ahead:
            self._next_receive = number + 1
            delivered.append(Received(kind, seq, payload))
        elif in_turn or self._kept() + len(payload) <= self.grant_bytes:
            self._ahead.append((number, Received(kind, seq, payload)))
            self._deliver(delivered)

    def _begins(self, frame) -> bool:
        """Begin the session that was offered, if this frame is a true one of it and the time is right."""
        session, key = self._offered
        if key and not self._is_true(frame, frame.seq, key):
            self.forged += 1
            return False
        if not self.may_adopt:
            self.foreign += 1
            return False
        self.begin(self.decoder.dictionary_crc, session, key)
        self._ack_due = True
        return True

    def _take_alive(self, frame, number: int, now_ms: int) -> None:
        self._next_posted = number + 1
        try:
            alive = ALIVE.unpack(frame.payload)
        except ValueError:
            self.decoder.dropped += 1
            return
        self.flight.grant(alive.slots, alive.bytes)
        self.flight.acknowledged(frame.ack, alive.have, now_ms)

    def _deliver(self, delivered: list) -> None:
        """Deliver what has come and is due now."""
        while True:
            due = [ahead for ahead in self._ahead if ahead[0] == self._next_receive]
            if not due:
                return
            self._ahead.remove(due[0])
            delivered.append(due[0][1])
            self._next_receive += 1

    def _kept(self) -> int:
        """Return how many bytes wait for what was sent before them: no more than the credit that was given."""
        return sum([len(received.payload) for _, received in self._ahead])

    def _is_new(self, number: int) -> bool:
        """Return whether a reliable frame of that number may come now, and has not yet."""
        if not 0 <= number - self._next_receive < WINDOW:
            return False
        return number not in [ahead[0] for ahead in self._ahead]

    def _take_open(self, frame, delivered: list) -> None:
        if self._next_telemetry is not None:
            gap = (frame.seq - self._next_telemetry) & 255
            self.missed += gap if gap < 128 else 0
        self._next_telemetry = (frame.seq + 1) & 255
        delivered.append(Received(frame.kind, frame.seq, frame.payload))

    def _number(self, frame) -> int:
        """Return the number that the last byte of it, which the frame carries, stands for.

        A reliable frame may be a little older than what is due, and a posted one than the last; with tags it is newer.
        """
        if frame.flags & frames.RELIABLE:
            return self._next_receive + ((frame.seq - self._next_receive + 128) & 255) - 128
        late = 0 if self.key else LATE
        return self._next_posted + ((frame.seq - self._next_posted + late) & 255) - late

    def _true_number(self, frame, number: int) -> int:
        """Return the number that the frame's tag was made with, or -1: it is forged, or was heard long before."""
        for lap in (0,) if frame.flags & frames.RELIABLE else _POSTED_LAPS:
            if self._is_true(frame, number + 256 * lap, self.key):
                return number + 256 * lap
        return -1

    def _is_true(self, frame, number: int, key: bytes) -> bool:
        if not frame.flags & frames.SEALED or number < 0 or not self._tags_left:
            return False
        self._tags_left -= 1
        body = frame.body[: -frames.TAG_BYTES]
        return secret.same(frame.body[-frames.TAG_BYTES :], secret.tag(key, not self._device, number, body))

    def _posted(self) -> bytes:
        kind, payload = self._posts.pop(0)
        if kind < frames.GREETINGS_BELOW:
            return frames.encode(frames.seal(kind, 0, 0, payload, 0, 0, self._named()))
        if frames.is_open(kind):
            number, self._next_open = self._next_open & 255, self._next_open + 1
            crc = self.decoder.dictionary_crc
            return frames.encode(frames.seal(kind, number, 0, payload, crc, 0, self._named()))
        number, self._next_post = self._next_post, self._next_post + 1
        return self._spoken(kind, number, payload, 0)

    def _alive(self) -> bytes:
        """Return the frame that says what has arrived and how much more may come."""
        have = 0
        for number, _ in self._ahead:
            have |= 1 << (number - self._next_receive - 1)
        self._ack_due = False
        if self._told_slots != self._slots():
            self._told_slots = self._slots()
            self._retell = WINDOW
        number, self._next_post = self._next_post, self._next_post + 1
        payload = ALIVE.packed(have, self._told_slots, self.grant_bytes)
        return self._spoken(ALIVE.number, number, payload, 0)

    def _slots(self) -> int:
        """Return for how many more frames there would be room to answer; a host answers none.

        If both ends kept frames back for want of room, both would wait for each other.
        """
        if not self._device:
            return WINDOW
        left = QUEUE_MAX - RESERVE - len(self.flight.waiting)
        return max(0, left) if left < WINDOW else WINDOW

    def _opens(self) -> bool:
        """Return whether the other end waits for credit that there is again."""
        return self._told_slots == 0 and self._slots() > 0

    def _named(self) -> int:
        """Return the number of the robot that frames carry now, 0: none."""
        return self.node if self._addressed else 0

    def _spoken(self, kind: int, number: int, payload: bytes, flags: int) -> bytes:
        """Return a frame of the session as it goes on the wire; it carries the acknowledgement."""
        node = self.node if self._addressed else 0
        if not self._ahead and not self._retell and self._told_slots == self._slots():
            self._ack_due = False  # this frame carries all there is to say
        ack = self._next_receive & 255
        if not self.key:
            return frames.encode(frames.seal(kind, number & 255, ack, payload, self.decoder.seed, flags, node))
        body = frames.head(kind, number & 255, ack, flags | frames.SEALED, node) + payload
        body += secret.tag(self.key, self._device, number, body)
        return frames.encode(frames.close(body, self.decoder.seed))

    def _size(self, payload_bytes: int) -> int:
        """Return how long the frame of a payload is on the wire, at most."""
        extra = 1 if self._addressed else 0
        return payload_bytes + frames.BODY_MIN + frames.STUFFING + extra + (frames.TAG_BYTES if self.key else 0)


def _check(payload: bytes) -> None:
    if len(payload) > frames.PAYLOAD_MAX:
        raise ValueError(f"payload {len(payload)} bytes, at most {frames.PAYLOAD_MAX}")
