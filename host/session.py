"""One conversation with a robot, without a port and without a clock: bytes and times in, bytes and records out.

`receive` takes whatever arrived and never raises; `poll` returns what to write and raises what became of the session
(Silent, NotOurs, Mismatch, LinkLost, RobotFault). Whoever owns the line calls both, and again at `wake_us`. Times are
the host's clock in microseconds, so that the robot's can be told to better than its own milliseconds.

    session = Session(opened(line), now_us)
    line.write(session.poll(now_us))
    for record in session.receive(line.read(), now_us): ...
"""

from __future__ import annotations

from typing import Any

from host.answers import Asked
from host.dictionaries import Known, Unknown
from host.errors import BadRequest, LinkLost, NotPaired, Refused
from host.handshake import Handshake, page_question
from host.hearing import Hearing
from host.pages import Pages
from host.pairing import Opening, keyless, may_order, session_key
from host.records import Record
from host.selections import selection_of
from host.stopping import Stopping
from protocol import codes, messages
from protocol.link import Link

KEEPALIVE_US = 100_000
WATCH_AGAIN_US = 800_000  # a robot sends for two seconds: one request may be lost
TICK_US = 50_000  # while the robot owes something
IDLE_TICK_US = 250_000


class Session:
    """The host's end of the session that `opening` begins; `key` is the robot's pairing key, if it has one."""

    def __init__(self, opening: Opening, now_us: int, known: Known | None = None, key: bytes = b"") -> None:
        self._opening = opening
        self._key = key
        self._handshake = Handshake(opening, now_us // 1000, known or Unknown())
        self.hearing = Hearing(self._handshake, now_us)
        self.open = False  # the robot is known, and orders may be given
        self.viewer = False  # another session holds the lease, so that this one may watch and stop only
        self.mute = False  # the robot would not listen to anything but a stop: it has a key, or another holder
        self._link = Link()
        self._stopping = Stopping()
        self._written_us = now_us
        self._watch_ms = 0  # period of what is asked for without a session, 0: nothing
        self._watch_due_us = now_us
        self._bytes_in = self._bytes_out = self._damaged_before = 0

    @property
    def number(self) -> int:
        """Return what names the session; the robot keeps it apart from others by it."""
        return self._opening.session

    @property
    def identity(self) -> Any:
        """Return the robot's `identity`, or None before it has answered."""
        return self._handshake.identity

    @property
    def dictionary(self) -> bytes:
        """Return the text that the robot gave of itself."""
        return self._handshake.dictionary

    def request(self, message: messages.Message, now_us: int, **values: Any) -> int:
        """Queue an order and return its number, under which `hearing.answers` will hold what the robot said."""
        if self.mute:
            raise Refused(message.name, codes.LEASE_HELD) if self.viewer else keyless(message.name)
        try:
            payload = message.pack(**values)
        except ValueError as error:
            raise BadRequest(str(error)) from error
        seq: int = self._link.send(message.number, payload, now_us // 1000)
        if message is messages.SUBSCRIBE:
            robot_ms = self.hearing.keeper.clock.earliest(now_us / 1000)
            self.hearing.selections.ask(seq, selection_of(values), robot_ms)
        self.hearing.answers.expect(seq, Asked(message.name, now_us // 1000, values, self.hearing.keeper.told_ms))
        return seq

    def overhear(self, period_ms: int, now_us: int) -> None:
        """Have the robot send the usual variables to whoever listens, as long as this host lives; 0 ends it."""
        self._watch_ms, self._watch_due_us = period_ms, now_us

    def read_help(self) -> Pages:
        """Have the help texts of the dictionary read; they are there once the pages are complete."""
        self.hearing.help = Pages()
        return self.hearing.help

    def room(self) -> int:
        """Return how many more orders may be queued now."""
        return int(self._link.room())

    def stop(self, now_us: int) -> None:
        """Have the stop pattern sent until it is answered, or `end_stop`; works before and without a hello."""
        self._stopping.begin(now_us)
        self.hearing.stopped = False

    def end_stop(self) -> None:
        """Send the stop pattern no more, though nobody has answered it."""
        self._stopping.end()

    def receive(self, data: bytes, now_us: int) -> list[Record]:
        """Take what a read of the line gave, even if that is nothing; return the records it completed."""
        hearing, now_ms = self.hearing, now_us // 1000
        self._bytes_in += len(data)
        records = []
        for received in self._link.receive(data, now_ms):
            record = hearing.take(received.kind, received.payload, now_us)
            if record is not None:
                records.append(record)
        hearing.silence.heard(self._link.heard_ms)
        hearing.silence.read_ms = now_ms
        if hearing.stopped:
            self.end_stop()
        if not self.open and hearing.profile is not None:
            self._begin()
        return records

    def poll(self, now_us: int) -> bytes:
        """Return the bytes to write now, or raise what ended the session."""
        out = b""
        if self._stopping.due_us is not None:
            out = self._stopping.poll(now_us)
        elif not self.open:
            out = self._ask(now_us // 1000)
        else:
            self._check(now_us // 1000)
        if self.open:
            self._talk(now_us)
            out += self._link.poll(now_us // 1000)
        if out:
            self._written_us = now_us
            self._bytes_out += len(out)
        return out

    def wake_us(self, now_us: int) -> int:
        """Return when `poll` must be called again at the latest, if nothing arrives before."""
        hearing, now_ms = self.hearing, now_us // 1000
        owed = hearing.silence.expects or hearing.keeper.doubts or hearing.answers.oldest() is not None
        due_us = now_us + (TICK_US if owed else IDLE_TICK_US)
        if self._stopping.due_us is not None:
            due_us = min(due_us, self._stopping.due_us)
        elif not self.open:
            due_us = min(due_us, 1000 * self._handshake.due_ms())
        resend_ms = self._link.due_ms(now_ms) if self.open else None
        if resend_ms is not None:
            due_us = min(due_us, 1000 * resend_ms)
        if hearing.holds_lease:
            due_us = min(due_us, self._written_us + KEEPALIVE_US)
        if self._watch_ms:
            due_us = min(due_us, self._watch_due_us)
        if hearing.help and (page_ms := hearing.help.due_ms()):
            due_us = min(due_us, 1000 * page_ms)
        if self._listens:
            due_us = min(due_us, hearing.keeper.due_us(now_us))
        return max(due_us, now_us + 1000)

    def robot_ms(self, now_us: int) -> int | None:
        """Return the robot's clock at the host's time, or None before the robot has told it."""
        return self.hearing.keeper.clock.at(now_us / 1000)

    def statistics(self, now_us: int) -> dict[str, Any]:
        """Return what the line did, and how the robot's clock stands to ours."""
        link = self._link
        return {
            "bytes_sent": self._bytes_out,
            "bytes_received": self._bytes_in,
            "frames_resent": link.resent,
            "frames_repeated": link.duplicates,
            "telemetry_missed": self.hearing.missed(),
            "frames_forged": link.forged,
            "frames_damaged": link.decoder.dropped + self.hearing.damaged - self._damaged_before,
            "round_trip_ms": link.rtt_ms,
            **self.hearing.clock_figures(now_us),
        }

    @property
    def _listens(self) -> bool:
        """Return whether the robot's clock matters now: something is subscribed to, or the lease is held."""
        hearing = self.hearing
        return self.open and not self.mute and (hearing.holds_lease or hearing.silence.expects)

    def _talk(self, now_us: int) -> None:
        """Have the link say what is due unasked: a question for the clock, or only that the host lives."""
        hearing = self.hearing
        if hearing.help:
            for place in hearing.help.due(now_us // 1000):
                self._link.post(*page_question(messages.HELP, *place))
        if self._watch_ms and now_us >= self._watch_due_us:
            self._watch_due_us = now_us + WATCH_AGAIN_US
            self._link.post(messages.WATCH.number, messages.WATCH.packed(self._watch_ms))
        asks = self._listens and hearing.silence.on_time()
        question = hearing.keeper.question(now_us) if asks else None
        if question is not None:
            self._link.post(messages.CLOCK_REQUEST.number, question)
        elif hearing.holds_lease and now_us - self._written_us >= KEEPALIVE_US:
            self._link.acknowledge()

    def _begin(self) -> None:
        """Seal all further frames with the session's seed."""
        identity = self.identity
        self.open = True
        self.viewer = identity.role == messages.VIEWER
        self.mute = self.viewer or not may_order(self._key, identity)
        try:
            key = session_key(self._key, self._opening, identity)
        except NotPaired as error:
            self.hearing.trouble = error
            return
        self._damaged_before = self._link.decoder.dropped
        self._link.begin(identity.dictionary_crc, self.number, key)
        self._link.granted(identity.slots, identity.bytes)
        self._link.byte_ns = identity.byte_ns
        if not self.mute:
            self._link.acknowledge()  # the robot takes the session up with its first frame

    def _ask(self, now_ms: int) -> bytes:
        if self.hearing.trouble:  # of what a robot said that answered a stop
            raise self.hearing.trouble
        for kind, payload in self._handshake.poll(now_ms, self._bytes_in > 0):
            self._link.post(kind, payload)
        return bytes(self._link.poll(now_ms))

    def _check(self, now_ms: int) -> None:
        """Raise what became of the session; ask a robot that is silent or that is in doubt who it is."""
        hearing, silence = self.hearing, self.hearing.silence
        if hearing.trouble:
            raise hearing.trouble
        oldest = hearing.answers.oldest()
        how = silence.given_up(oldest)
        if how:
            figures = ", ".join(f"{name} {value}" for name, value in self.statistics(1000 * now_ms).items())
            raise LinkLost(f"the robot {how} ({figures}); it switches everything off by itself")
        if silence.probes(now_ms, oldest, hearing.keeper.doubts):
            hearing.greets(now_ms)
            self._link.post(messages.HELLO.number, self._opening.payload())
