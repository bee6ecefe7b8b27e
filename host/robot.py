"""A robot to give orders to: the blocking face of a session, over any line.

Leaving the `with` block switches everything off as far as the line allows; leaving it by Ctrl-C sends stop and says
what the robot acknowledged.

    with Robot(open_link("/dev/ttyACM0")) as robot:
        robot.connect()
        robot.arm()
        robot.fire(["A"], duty_permille=600, hold_ms=500)
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from typing import Any

from host.conversation import Conversation, Recorder
from host.definitions import texts_of
from host.errors import BadRequest, Interrupted, LinkLost, Silent, SoftrigError
from host.link import Link
from host.orders import Orders
from host.outages import Interruption
from host.records import Event, Record, Stopped, Telemetry, ended, state_name
from protocol import causes, messages

PATIENCE_MS = 1500  # for the lease of a host that has gone
AGAIN_MS = 250
STOP_WAIT_MS = 2000
HELP_WAIT_MS = 20_000
GOODBYE_MS = 1000
LINGER_MS = 2000  # between the end of a program and the event that says so
ENDS = ("finished", "aborted", "tripped", "disarmed")


class Robot(Orders):
    """One robot at the end of `link`, with its pairing `key` if it has one; all raise the errors of host.errors."""

    def __init__(self, link: Link, recorder: Recorder | None = None, key: bytes = b"") -> None:
        super().__init__(Conversation(link, recorder, key))

    def __enter__(self) -> Robot:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: object) -> None:
        try:
            if isinstance(error, KeyboardInterrupt):
                raise self._interrupted() from error
            if error is not None:
                self.leave()
            elif self._armed:
                self._goodbye()
        finally:
            self.talk.end()

    @property
    def link(self) -> Link:
        """Return the line to the robot."""
        return self.talk.link

    @property
    def dictionary(self) -> bytes:
        """Return the text that the robot gave of itself: table of messages and profile."""
        return self.talk.session.dictionary

    @property
    def last(self) -> Telemetry | None:
        """Return the newest telemetry, or None."""
        return self.talk.session.hearing.last

    def now_ms(self) -> int:
        """Return the line's clock."""
        return self.talk.now_ms()

    def robot_ms(self) -> int | None:
        """Return the robot's clock now, or None before it has told it."""
        return self.talk.session.robot_ms(self.talk.now_us())

    def connect(self, watch_only: bool = False) -> None:
        """Say hello and learn the robot; waits a moment for the lease of a host that has gone."""
        talk, until_ms = self.talk, self.now_ms() + PATIENCE_MS
        talk.wait(lambda: talk.session.open)
        while talk.session.viewer and not watch_only and self.now_ms() < until_ms:
            talk.wait(lambda: False, self.now_ms() + AGAIN_MS)
            talk.renew()
            talk.wait(lambda: talk.session.open)

    def attach(self, session: int = 0) -> int:
        """Take over the lease and the running program of a session, 0: of whichever has them; return its number."""
        talk = self.talk
        talk.wait(lambda: talk.session.open)
        holder: int = talk.session.identity.holder
        if not holder:
            raise BadRequest("no program runs, and nobody holds the lease: there is nothing to take over")
        if session not in (0, holder):
            raise BadRequest(f"session {session} has nothing to take over: the robot obeys session {holder}")
        talk.renew(holder)
        talk.wait(lambda: talk.session.open)
        if not talk.session.mute:
            talk.session.hearing.holds_lease = True
        self.status()  # its answer says that the robot has followed
        return holder

    def endure(self, patience_ms: int, stops: bool = False) -> None:
        """Go on over a line that breaks or falls silent for up to that long; with `stops`, only to stop the robot."""
        self.talk.endure(patience_ms, stops)

    def info(self) -> dict[str, Any]:
        """Return who the robot is and what it allows."""
        identity, profile = self.talk.session.identity, self.profile
        return {
            "robot": profile.robot,
            "firmware": identity.firmware.decode("utf-8", "replace"),
            "protocol": identity.version,
            "dictionary": f"{identity.dictionary_crc:08x}",
            "boot": identity.boot,
            "session": self.talk.session.number,
            "state": state_name(identity.state),
            "paired": identity.secured != messages.UNPAIRED,
            "may_arm": not self.talk.session.mute,
            "coils": list(profile.coil_labels),
            "joints": list(profile.joint_labels),
        }

    def help_texts(self) -> dict[str, str]:
        """Return what the robot says that each message, field and variable of its dictionary means."""
        talk = self.talk
        pages = talk.session.read_help()
        talk.wait(lambda: pages.complete, self.now_ms() + HELP_WAIT_MS)
        if not pages.complete:
            raise LinkLost("the robot did not give the help texts of its dictionary")
        return texts_of(pages.text)

    def leave_armed(self) -> None:
        """Go without disarming: the robot disarms itself when its lease runs out."""
        self._armed = False

    def leave(self) -> None:
        """Switch everything off as far as the line still allows; raises nothing of ours."""
        if not self._armed:
            return
        with suppress(SoftrigError):
            try:
                self._goodbye()
            except LinkLost:
                self.stop(GOODBYE_MS)
        self._armed = False

    def watch(self) -> Iterator[Record]:
        """Yield telemetry and events as they come, up to the one that ends a program that runs, or waits to begin."""
        left_ms = self.now_ms() + LINGER_MS
        waits = False
        while True:
            for record in self.talk.taken():
                yield record
                if isinstance(record, Event) and record.event in ENDS:
                    return
                if isinstance(record, Event) and record.event in ("accepted", "started"):
                    waits = record.event == "accepted"
                if isinstance(record, Stopped) or (isinstance(record, Telemetry) and record.state == "running"):
                    left_ms = self.now_ms() + LINGER_MS
            if waits or self.talk.outages.lasting_ms(self.now_ms()):
                left_ms = self.now_ms() + LINGER_MS
            if self.now_ms() >= left_ms:
                raise LinkLost("the program ended and the robot's word about it was lost; `softrig status` asks it")
            self.talk.turn(left_ms)

    def listen(self, time_ms: int) -> Iterator[Record]:
        """Yield telemetry and events for that long."""
        until_ms = self.now_ms() + time_ms
        while True:
            yield from self.talk.taken()
            if self.now_ms() >= until_ms:
                return
            self.talk.turn(until_ms)

    def stop(self, wait_ms: int = STOP_WAIT_MS) -> Stopped:
        """Switch everything off from any state, without a hello; Silent when no answer comes."""
        talk = self.talk
        talk.stopped = None
        talk.session.stop(talk.now_us())
        talk.wait(lambda: talk.stopped is not None, talk.now_ms() + wait_ms)
        if talk.stopped is None:
            talk.session.end_stop()
            raise Silent("stop was sent and nobody answered it: switch its supply off by hand")
        return talk.stopped

    def statistics(self) -> dict[str, Any]:
        """Return what the line did so far, and how the robot's clock stands to ours."""
        by_slot = {str(slot): count for slot, count in self.missed().items()}
        return {**self.talk.session.statistics(self.talk.now_us()), "telemetry_missed_by_slot": by_slot}

    def interruptions(self) -> list[Interruption]:
        """Return when the line was interrupted and came back."""
        return self.talk.outages.over

    def missed(self) -> dict[int, int]:
        """Return how many records of telemetry did not come, by slot."""
        return self.talk.session.hearing.selections.missed()

    @property
    def _armed(self) -> bool:
        return self.talk.session.hearing.holds_lease

    @_armed.setter
    def _armed(self, held: bool) -> None:
        self.talk.session.hearing.holds_lease = held

    def _goodbye(self) -> None:
        """Disarm, and stop a robot that does not answer to that."""
        until_ms = self.now_ms() + GOODBYE_MS
        seq = self.talk.ask(messages.DISARM)
        said = self.talk.session.hearing.answers.said
        self.talk.wait(lambda: seq in said, until_ms)
        if seq not in said:
            self.stop()

    def _interrupted(self) -> Interrupted:
        """Send stop and return the words about what came back; a second Ctrl-C ends the waiting."""
        try:
            stopped = self.stop()
        except (SoftrigError, KeyboardInterrupt) as error:
            return Interrupted(f"interrupted: stop was sent but not acknowledged ({error})")
        hearing = self.talk.session.hearing
        name = causes.row(stopped.code)
        return Interrupted(
            f"interrupted: stop acknowledged, {ended(stopped.coils, hearing.parts)}; the robot is {stopped.state}"
            f"{f' ({name.name})' if name else ''}: `softrig clear` before the next run"
        )
