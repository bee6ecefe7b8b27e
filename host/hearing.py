"""What a session has heard from its robot so far: who it is, what it answered, how its clock runs.

It is handed the frames that the link delivers and hands back the records among them. What ends the session stands in
`trouble`; nothing that arrives can raise.

    hearing = Hearing(handshake, now_us)
    record = hearing.take(kind, payload, now_us)
"""

from __future__ import annotations

from typing import Any

from host.answers import Answers
from host.errors import SoftrigError, TakenOver
from host.handshake import Handshake
from host.pages import Pages
from host.profile import Parts, Profile
from host.recognition import changed, restarted
from host.records import Record, Status, Telemetry, event_of, state_name, stopped_of
from host.selections import Selections, selection_of
from host.silence import Silence
from host.timekeeper import LATE_MS, SLACK_MS, Origin, Timekeeper
from protocol import frames, messages


class Hearing:
    """The robot as this session knows it."""

    def __init__(self, handshake: Handshake, now_us: int) -> None:
        self.handshake = handshake
        self.profile: Profile | None = None  # the robot's, once it is known
        self.parts = Parts()  # of the robot
        self.answers = Answers()
        self.keeper = Timekeeper()
        self.silence = Silence(now_us // 1000)
        self.selections = Selections()
        self.holds_lease = False
        self.stopped = False  # the robot has answered a stop
        self.last: Telemetry | None = None
        self.help: Pages | None = None  # the help texts, once somebody wants to read them
        self.told_ms: int | None = None  # when telemetry came last
        self.trouble: SoftrigError | None = None
        self._greeted: Origin | None = None  # of the answer to the first hello to an open session that is unanswered
        self.damaged = 0  # frames whose payload did not fit their message

    def overdue_ms(self) -> int:
        """Return for how long the robot has owed an answer or telemetry."""
        return self.silence.silent_ms(self.answers.oldest())

    def greets(self, now_ms: int) -> None:
        """Note that hello is said again; the first that is not answered counts."""
        self._greeted = self._greeted or self.keeper.made_after(now_ms, SLACK_MS)

    def missed(self) -> int:
        """Return how many records of telemetry did not come."""
        return sum(self.selections.missed().values())

    def clock_figures(self, now_us: int) -> dict[str, float | None]:
        """Return how the robot's clock stands to ours; None where that is not known."""
        figures = self.keeper.clock.figures(now_us / 1000)
        return {
            "clock_offset_ms": round(figures.offset_ms, 2) if figures else None,
            "clock_drift_ppm": round(figures.drift_ppm, 1) if figures else None,
            "clock_bound_ms": round(figures.bound_ms, 2) if figures else None,
        }

    def take(self, kind: int, payload: bytes, now_us: int) -> Record | None:
        """Take one delivered frame; a payload that does not fit its message is dropped like a damaged frame."""
        try:
            if kind in (messages.TELEMETRY.number, messages.EVENT.number, messages.STOPPED.number):
                return self._told(kind, payload, now_us)
            if kind == messages.CLOCK.number:
                self.keeper.answered(messages.CLOCK.unpack(payload), now_us)
            elif kind < frames.GREETINGS_BELOW:
                self._introduced(kind, payload, now_us)
            else:
                self._answered(kind, payload, now_us)
        except ValueError:
            self.damaged += 1
        return None

    def _told(self, kind: int, payload: bytes, now_us: int) -> Record | None:
        """Take what the robot says by itself."""
        now_ms = now_us // 1000
        if kind == messages.EVENT.number:
            event = event_of(payload, self.parts.channels, now_ms)
            self.holds_lease = self.holds_lease and event.event not in ("tripped", "disarmed")
            if self.keeper.happened(event.now_ms, now_us, len(payload)):
                self.trouble = self.trouble or restarted(event.event)
            return event
        if kind == messages.STOPPED.number:
            stopped = stopped_of(payload, self.parts.channels, now_ms)
            self.stopped, self.holds_lease = True, False
            self._compare(stopped.now_ms, self._lately(), stopped.state, now_us, len(payload))
            return stopped
        told = self.selections.take(payload, self.parts, now_ms)
        if told is None:
            return None
        self.told_ms = now_ms
        self.silence.heard(now_ms)
        self.last = told if isinstance(told, Telemetry) else self.last
        state = told.state if isinstance(told, Telemetry) else str(told.values.get("state", ""))
        self._compare(told.now_ms, self._lately(), state, now_us, len(payload))
        return told

    def _answered(self, kind: int, payload: bytes, now_us: int) -> None:
        """Take the answer to an order."""
        taken = self.answers.take(kind, payload, self.parts, now_us // 1000)
        if taken is None or taken.asked is None:
            return
        name, values = taken.asked.name, taken.asked.values
        if isinstance(taken.answer, Status):
            status, asked = taken.answer, taken.asked
            origin = Origin(asked.at_ms, asked.told_ms, SLACK_MS)
            self._compare(status.uptime_ms, origin, status.state, now_us, len(payload))
            self.keeper.clock.answered(asked.at_ms, status.uptime_ms)
        elif taken.answer is None and name == messages.ARM.name:
            self.holds_lease = True
        elif taken.answer is None and name == messages.SUBSCRIBE.name:
            selection = selection_of(values)
            self.silence.expect(selection.slot, selection.silence_ms)
        if self.trouble:
            del self.answers.said[taken.seq]  # it is of another start of the robot

    def _introduced(self, kind: int, payload: bytes, now_us: int) -> None:
        """Take a greeting: the answers to hello and dictionary, or to the probe of a silent line."""
        handshake = self.handshake
        if self.profile:
            if kind == messages.IDENTITY.number:
                self._recognised(messages.IDENTITY.unpack(payload), now_us, len(payload))
            elif kind == messages.DICTIONARY_PAGE.number and self.help:
                page = messages.DICTIONARY_PAGE.unpack(payload)
                if page.part == messages.HELP:
                    self.help.take(page.offset, page.text, now_us // 1000)
            return
        stranger = handshake.identity is None
        handshake.take(kind, payload, now_us // 1000)
        if handshake.profile:
            self.profile, self.parts = handshake.profile, handshake.profile.parts
        if stranger and handshake.identity is not None:
            self.keeper.byte_ns = handshake.identity.byte_ns
            self.keeper.introduced(handshake.begun_ms, handshake.identity.uptime_ms, now_us, len(payload))

    def _recognised(self, identity: Any, now_us: int, payload_bytes: int) -> None:
        """Take the answer to the probe of a silent line."""
        if identity.session != self.handshake.identity.session:
            return
        self.trouble = self.trouble or changed(self.handshake.identity, identity)
        self.holds_lease = self.holds_lease and not isinstance(self.trouble, TakenOver)  # else it would stop the robot
        greeted, self._greeted = self._greeted, None
        if greeted is not None:
            self._compare(identity.uptime_ms, greeted, state_name(identity.state), now_us, payload_bytes)
            self.keeper.introduced(greeted.host_ms, identity.uptime_ms, now_us, payload_bytes)

    def _lately(self) -> Origin:
        """Return the origin of what the robot says by itself: the line was empty when it was read before."""
        return self.keeper.made_after(self.silence.read_ms, LATE_MS)

    def _compare(self, robot_ms: int, origin: Origin, state: str, now_us: int, payload_bytes: int) -> None:
        """Take a robot time; one that is before what was told is of a clock that has begun anew."""
        if self.keeper.told(robot_ms, origin, now_us, payload_bytes):
            self.trouble = self.trouble or restarted(state)
