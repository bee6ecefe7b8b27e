"""One conversation with a robot, without a port and without a clock: bytes and times in, bytes and records out.

`receive` takes whatever arrived and never raises; `poll` returns what to write and raises what became of the session
(Silent, NotOurs, Mismatch, LinkLost, RobotFault). Whoever owns the line calls both, and again at `wake_ms`.

    session = Session(number, now_ms)
    line.write(session.poll(now_ms))
    for record in session.receive(line.read(), now_ms): ...
"""

from __future__ import annotations

from typing import Any, NamedTuple

from host.coils import CoilState, coils_of
from host.errors import (
    BadRequest,
    DictionaryMismatch,
    LinkLost,
    Mismatch,
    NotOurs,
    Refused,
    RobotFault,
    Silent,
    SoftrigError,
)
from host.handshake import ASK_MS, Handshake, differing_lines, hello, profile_text
from host.kept import FaultPage, Settings, faults_of, settings_of
from host.profile import Profile, read_profile
from host.records import (
    Event,
    Record,
    Status,
    Telemetry,
    coil_name,
    event_of,
    state_name,
    status_of,
    stopped_of,
)
from host.robotclock import RobotClock, since
from host.selections import Selection, Selections, selection_of
from protocol import codes, frames, messages
from protocol.link import Link

KEEPALIVE_MS = 100
NEVER_MS = 1 << 31
STOP_AGAIN_MS = 100
IDLE_TICK_MS = 250
LATE_MS = 500  # between the making of a frame and its arrival on a line that is read
SLACK_MS = 50  # between a question and the time told in its answer, should the clocks be read unluckily
PROBE_MS = 500  # of silence, or without an answer, before hello is said again
SILENT_MS = 2000
ANSWER_MS = 5000

Answer = Status | FaultPage | Settings | dict[str, CoilState]


class Asked(NamedTuple):
    """An order that waits for its answer."""

    name: str
    at_ms: int
    selection: Selection | None  # of the telemetry that it asks for


class Session:
    """The host's end of a session. `number` names it; the robot keeps it apart from others by it."""

    def __init__(self, number: int, now_ms: int) -> None:
        self.number = number
        self.profile: Profile | None = None
        self.dictionary = b""
        self.answers: dict[int, Refused | Answer | None] = {}
        self.holds_lease = False
        self.clock = RobotClock()
        self.last: Telemetry | None = None
        self._handshake = Handshake(number, now_ms)
        self._link = Link()
        self._trouble: SoftrigError | None = None
        self._asked: dict[int, Asked] = {}
        self._greeted_ms: int | None = None  # the first hello to an open session that is not answered
        self._told_ms: int | None = None  # when telemetry came last
        self._event_ms: int | None = None  # the robot's clock in its last event
        self._stopping = False
        self._stop_due_ms = 0
        self._selections = Selections()
        self._periods_ms: dict[int, int] = {}  # of telemetry, by slot
        self._written_ms = self._probed_ms = now_ms
        self._read_ms = now_ms  # when the line was last read: what arrives now was not there then
        self._bytes_in = self._bytes_out = self._damaged_before = 0

    @property
    def open(self) -> bool:
        """Return whether the robot is known, and orders may be given."""
        return self.profile is not None

    @property
    def identity(self) -> Any:
        """Return the robot's `identity`, or None before it has answered."""
        return self._handshake.identity

    @property
    def viewer(self) -> bool:
        """Return whether another session holds the lease, so that this one may watch and stop only."""
        return self.open and self.identity.role == messages.VIEWER

    def request(self, message: messages.Message, now_ms: int, **values: Any) -> int:
        """Queue an order and return its number, under which `answers` will hold what the robot said."""
        if self.viewer:
            raise Refused(message.name, codes.LEASE_HELD)
        try:
            payload = message.pack(**values)
        except ValueError as error:
            raise BadRequest(str(error)) from error
        seq: int = self._link.send(message.number, payload, now_ms)
        selection = selection_of(values) if message is messages.SUBSCRIBE else None
        if selection:
            self._selections.ask(seq, selection)
        self._asked[seq] = Asked(message.name, now_ms, selection)
        return seq

    def room(self) -> int:
        """Return how many more orders may be queued now."""
        return int(self._link.room())

    def stop(self, now_ms: int) -> None:
        """Have the stop pattern sent until `stopped` answers it; works before and without a hello."""
        self._stopping, self._stop_due_ms = True, now_ms

    def receive(self, data: bytes, now_ms: int) -> list[Record]:
        """Take what a read of the line gave, even if that is nothing; return the records it completed."""
        self._bytes_in += len(data)
        records = []
        for received in self._link.receive(data, now_ms):
            record = self._take(received.kind, received.payload, now_ms)
            if record is not None:
                records.append(record)
        self._read_ms = now_ms
        return records

    def poll(self, now_ms: int) -> bytes:
        """Return the bytes to write now, or raise what ended the session."""
        out = self._stop_bytes(now_ms)
        if not self._stopping:
            self._check(now_ms)
        if not self.open:
            out += b"" if self._stopping else self._ask(now_ms)
        elif not self.viewer:
            if now_ms - self._written_ms >= self._keepalive_ms():
                self._link.acknowledge()
            out += self._link.poll(now_ms)
        if out:
            self._written_ms = now_ms
            self._bytes_out += len(out)
        return out

    def wake_ms(self, now_ms: int) -> int:
        """Return when `poll` must be called again at the latest, if nothing arrives before."""
        resend_ms = self._link.due_ms(now_ms) if self.open else None
        due = [now_ms + IDLE_TICK_MS if resend_ms is None else resend_ms]
        if self._stopping:
            due.append(self._stop_due_ms)
        elif not self.open:
            due.append(self._handshake.due_ms())
        if self.open and not self.viewer:
            due.append(self._written_ms + self._keepalive_ms())
        return max(min(due), now_ms + 1)

    def _keepalive_ms(self) -> int:
        """Return how often the robot must hear something: all the time if it is armed, else until it answers."""
        return KEEPALIVE_MS if self.holds_lease else ASK_MS if self._link.heard_ms is None else NEVER_MS

    def robot_ms(self, now_ms: int) -> int | None:
        """Return the robot's clock at the host's `now_ms`, or None before the robot has told it."""
        return self.clock.at(now_ms)

    def statistics(self) -> dict[str, int | None]:
        """Return what the line did: bytes both ways, frames resent, repeated, missed, damaged, round trip [ms]."""
        link = self._link
        return {
            "bytes_sent": self._bytes_out,
            "bytes_received": self._bytes_in,
            "frames_resent": link.resent,
            "frames_repeated": link.duplicates,
            "telemetry_missed": sum(self._selections.missed().values()),
            "frames_damaged": link.decoder.dropped - self._damaged_before,
            "round_trip_ms": link.rtt_ms,
        }

    def missed(self) -> dict[int, int]:
        """Return how many records of telemetry did not come, by slot."""
        return self._selections.missed()

    def _take(self, kind: int, payload: bytes, now_ms: int) -> Record | None:
        """Take one delivered frame; a payload that does not fit its message is dropped like a damaged frame."""
        try:
            return self._understood(kind, payload, now_ms)
        except ValueError:
            self._link.decoder.dropped += 1
            return None

    def _understood(self, kind: int, payload: bytes, now_ms: int) -> Record | None:
        labels = self.profile.labels if self.profile else ()
        if kind == messages.TELEMETRY.number:
            told = self._selections.take(payload, labels, now_ms)
            if told is None:
                return None
            self._told_ms = now_ms
            state = told.state if isinstance(told, Telemetry) else str(told.values.get("state", ""))
            self._compare(told.now_ms, self._expected_ms(self._read_ms, LATE_MS), state, now_ms)
            if isinstance(told, Telemetry):
                self.last = told
            return told
        if kind == messages.EVENT.number:
            return self._happened(event_of(payload, labels, now_ms), now_ms)
        if kind == messages.STOPPED.number:
            self._stopping = self.holds_lease = False
            stopped = stopped_of(payload, labels, now_ms)
            self._compare(stopped.now_ms, self._expected_ms(self._read_ms, LATE_MS), stopped.state, now_ms)
            return stopped
        if kind < frames.GREETINGS_BELOW:
            self._introduce(kind, payload, now_ms)
        else:
            self._answered(kind, payload, labels, now_ms)
        return None

    def _happened(self, event: Event, now_ms: int) -> Event:
        """Take an event: it may have been sent many times, but never arrives before one that is older."""
        self._compare(event.now_ms, self._event_ms, event.event, now_ms)
        self._event_ms = event.now_ms
        self.holds_lease = self.holds_lease and event.event not in ("tripped", "disarmed")
        return event

    def _answered(self, kind: int, payload: bytes, labels: tuple[str, ...], now_ms: int) -> None:
        answer: Refused | Answer | None = None
        if kind == messages.OK.number:
            seq = messages.OK.unpack(payload).request
            asked = self._asked.pop(seq, None)
            if asked:
                self._granted(asked)
        elif kind == messages.REFUSED.number:
            row = messages.REFUSED.unpack(payload)
            seq = row.request
            asked = self._asked.pop(seq, None)
            coil = coil_name(row.channel, labels)
            answer = Refused(asked.name if asked else "an order", row.code, row.value, row.limit, coil)
        elif kind == messages.STATUS.number:
            seq = messages.STATUS.unpack(payload).request
            asked = self._asked.pop(seq, None)
            answer = status = status_of(payload, labels, now_ms)
            if asked:
                self._compare(status.uptime_ms, self._expected_ms(asked.at_ms, SLACK_MS), status.state, now_ms)
        elif kind in (messages.FAULTS.number, messages.SETTINGS.number):
            answer = faults_of(payload, labels) if kind == messages.FAULTS.number else settings_of(payload, labels)
            seq = payload[0]
            asked = self._asked.pop(seq, None)
        elif kind == messages.COILS.number:
            answer = coils_of(payload, labels)
            seq = payload[0]
            asked = self._asked.pop(seq, None)
        else:
            return
        if asked and not self._trouble:
            self.answers[seq] = answer

    def _granted(self, asked: Asked) -> None:
        if asked.name == messages.ARM.name:
            self.holds_lease = True
        elif asked.selection:
            self._periods_ms[asked.selection.slot] = asked.selection.silence_ms

    def _introduce(self, kind: int, payload: bytes, now_ms: int) -> None:
        """Take an unseeded frame: the answers to hello and dictionary, or to the probe of a silent line."""
        if not self.open:
            stranger = self.identity is None
            self._handshake.take(kind, payload, now_ms)
            if stranger and self.identity is not None:
                self.clock.read(self.identity.uptime_ms, now_ms)
            if self._handshake.complete:
                self._begin()
        elif kind == messages.IDENTITY.number:
            self._recognise(messages.IDENTITY.unpack(payload), now_ms)

    def _recognise(self, identity: Any, now_ms: int) -> None:
        """Take the answer to the probe of a silent line."""
        if identity.session != self.number:
            return
        state = state_name(identity.state)
        if identity.boot != self.identity.boot:
            self._trouble = _restarted(state)
        if self._greeted_ms is not None:
            self._compare(identity.uptime_ms, self._expected_ms(self._greeted_ms, SLACK_MS), state, now_ms)
        self._greeted_ms = None

    def _begin(self) -> None:
        """Check that the robot means by every message what we mean, and seal all further frames with its seed."""
        self.dictionary = self._handshake.dictionary
        differing = differing_lines(self.dictionary)
        try:
            if differing:
                raise DictionaryMismatch(differing)
            self.profile = read_profile(profile_text(self.dictionary))
        except Mismatch as mismatch:
            self._trouble = mismatch
            return
        self._damaged_before = self._link.decoder.dropped
        self._link.begin(self.identity.dictionary_crc, self.number)
        self._link.granted(self.identity.slots, self.identity.bytes)
        self._link.byte_ns = self.identity.byte_ns
        self._link.acknowledge()  # the robot takes the session up with its first frame

    def _ask(self, now_ms: int) -> bytes:
        try:
            for kind, payload in self._handshake.poll(now_ms):
                self._link.post(kind, payload)
        except Silent:
            if self._bytes_in and self.identity is None:
                raise NotOurs("something answers, but no robot of ours: check the port and its baud rate") from None
            raise
        return bytes(self._link.poll(now_ms))

    def _check(self, now_ms: int) -> None:
        """Raise what became of the session; ask a robot that has fallen silent whether it is still there."""
        if self._trouble:
            raise self._trouble
        unanswered_ms, silent_ms = self._unanswered_ms(), self._silent_ms()
        if silent_ms >= SILENT_MS:
            raise self._lost("has fallen silent")
        if unanswered_ms >= ANSWER_MS:
            raise self._lost(f"has not answered {next(iter(self._asked.values())).name} for {ANSWER_MS // 1000} s")
        if max(unanswered_ms, silent_ms) >= PROBE_MS and now_ms - self._probed_ms >= PROBE_MS:
            self._probe(now_ms)

    def _unanswered_ms(self) -> int:
        """Return for how long the oldest order had waited for its answer when the line was last read."""
        return self._read_ms - next(iter(self._asked.values())).at_ms if self._asked else 0

    def _silent_ms(self) -> int:
        """Return for how long no intact frame of this session had come, answer or telemetry, that should have."""
        heard = [time_ms for time_ms in (self._link.heard_ms, self._told_ms) if time_ms is not None]
        if not heard:
            return self._unanswered_ms()
        quiet_ms = self._read_ms - max(heard)
        period_ms = min((each for each in self._periods_ms.values() if each), default=0)
        missing_ms = quiet_ms - max(0, 2 * period_ms - PROBE_MS) if period_ms else 0
        return max(missing_ms, min(quiet_ms, self._unanswered_ms()))

    def _lost(self, how: str) -> LinkLost:
        figures = ", ".join(f"{name} {value}" for name, value in self.statistics().items())
        return LinkLost(f"the robot {how} ({figures}); it switches its coils off by itself")

    def _probe(self, now_ms: int) -> None:
        """Ask the robot who it is: one that was reset cannot say anything else to us."""
        self._probed_ms = now_ms
        self._greeted_ms = now_ms if self._greeted_ms is None else self._greeted_ms
        self._link.post(messages.HELLO.number, hello(self.number))

    def _stop_bytes(self, now_ms: int) -> bytes:
        if not self._stopping or now_ms < self._stop_due_ms:
            return b""
        self._stop_due_ms = now_ms + STOP_AGAIN_MS
        return frames.STOP * 3

    def _expected_ms(self, now_ms: int, late_ms: int) -> int | None:
        """Return the earliest robot time that a frame made after the host's `now_ms` may carry."""
        robot_ms = self.clock.earliest(now_ms)
        return None if robot_ms is None else robot_ms - late_ms

    def _compare(self, robot_ms: int, earliest_ms: int | None, state: str, now_ms: int) -> None:
        """Take a robot time; one before `earliest_ms` is of a clock that has begun anew."""
        if earliest_ms is not None and since(robot_ms, earliest_ms) < 0:
            self._trouble = self._trouble or _restarted(state)
        self.clock.read(robot_ms, now_ms)


def _restarted(state: str) -> SoftrigError:
    if state == "tripped":  # so is the event of it called
        return RobotFault(codes.WATCHDOG)
    return LinkLost("the robot restarted in the middle of the session; its coils are off")
