"""A robot to give orders to: the blocking face of a session, over any line.

No threads and no sleeps: all waiting is the line's own, on the line's own clock. Leaving the `with` block switches
every coil off as far as the line allows; leaving it by Ctrl-C sends stop and says what the robot acknowledged.

    with Robot(open_link("/dev/ttyACM0")) as robot:
        robot.arm()
        robot.fire(["A"], duty_permille=600, hold_ms=500)
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from typing import Any, Protocol

from host.coils import CoilState
from host.errors import NONE, Interrupted, LinkLost, Refused, Silent, SoftrigError
from host.kept import Fault, FaultPage, Settings
from host.link import Link
from host.profile import Profile
from host.records import Event, Record, Status, Stopped, Telemetry
from host.selections import numbers_of
from host.session import Answer, Session
from protocol import causes, codes, messages

PATIENCE_MS = 1500  # for the lease of a host that has gone
AGAIN_MS = 250
STOP_WAIT_MS = 2000
GOODBYE_MS = 1000
LINGER_MS = 2000  # between the end of a program and the event that says so
PIECE = 192  # bytes of code in a message
WORD_MAX = 0xFFFF
ENDS = ("finished", "aborted", "tripped", "disarmed")


class Recorder(Protocol):
    """Whoever keeps what passes between host and robot."""

    def line(self, direction: str, data: bytes, host_ms: int, robot_ms: int | None) -> None:
        """Keep bytes that went "out" or came "in"."""

    def record(self, record: Record) -> None:
        """Keep what the robot told."""


class Robot:
    """One robot at the end of `link`; every method raises the errors of host.errors."""

    def __init__(self, link: Link, recorder: Recorder | None = None) -> None:
        self.link = link
        self.acknowledged: Stopped | None = None
        self._recorder = recorder
        self._news: list[Record] = []
        self._session = self._fresh_session()

    def __enter__(self) -> Robot:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: object) -> None:
        try:
            if isinstance(error, KeyboardInterrupt):
                raise self._interrupted() from error
            if error is not None:
                self.leave()
            elif self._session.holds_lease:
                self._goodbye()
        finally:
            self.link.close()

    @property
    def profile(self) -> Profile:
        """Return the robot's own profile; there is one once `connect` has returned."""
        if self._session.profile is None:
            raise LinkLost("not connected yet: call connect() first")
        return self._session.profile

    @property
    def dictionary(self) -> bytes:
        """Return the text that the robot gave of itself: table of messages and profile."""
        return self._session.dictionary

    @property
    def last(self) -> Telemetry | None:
        """Return the newest telemetry, or None."""
        return self._session.last

    def now_ms(self) -> int:
        """Return the line's clock."""
        return round(self.link.now_s() * 1e6) // 1000

    def connect(self, watch_only: bool = False) -> None:
        """Say hello and learn the robot; waits a moment for the lease of a host that has gone."""
        until_ms = self.now_ms() + PATIENCE_MS
        self._wait(lambda: self._session.open)
        while self._session.viewer and not watch_only and self.now_ms() < until_ms:
            again_ms = self.now_ms() + AGAIN_MS
            self._wait(lambda until=again_ms: self.now_ms() >= until)  # type: ignore[misc]
            self._session = self._fresh_session()
            self._wait(lambda: self._session.open)

    def info(self) -> dict[str, Any]:
        """Return who the robot is and what it allows."""
        identity, profile = self._session.identity, self.profile
        return {
            "robot": profile.robot,
            "firmware": identity.firmware.decode("utf-8", "replace"),
            "protocol": identity.version,
            "dictionary": f"{identity.dictionary_crc:08x}",
            "boot": identity.boot,
            "state": messages.STATES[identity.state],
            "may_arm": not self._session.viewer,
            "coils": list(profile.labels),
        }

    def status(self) -> Status:
        """Ask for the robot's state."""
        answer = self._order(messages.STATUS_REQUEST)
        if not isinstance(answer, Status):
            raise LinkLost("the robot answered a request for its status with something else")
        return answer

    def arm(self, lease_ms: int = 0, without: Iterable[str] = ()) -> None:
        """Have every coil tested, take the lease and allow orders; 0 takes the robot's own lease.

        The coils and groups of `without` are known to be broken: they are not tested, and never driven.
        """
        self._within("arm", codes.LEASE_LIMIT, lease_ms, self.profile.session.lease_max_ms)
        broken = self.profile.mask(without)
        self._order(messages.ARM, session=self._session.number, lease_ms=lease_ms, without=broken)

    def disarm(self) -> None:
        """Switch all coils off and return the lease."""
        self._order(messages.DISARM)
        self._session.holds_lease = False

    def leave_armed(self) -> None:
        """Go without disarming: the robot disarms itself when its lease runs out."""
        self._session.holds_lease = False

    def leave(self) -> None:
        """Switch everything off as far as the line still allows; raises nothing of ours."""
        if not self._session.holds_lease:
            return
        with suppress(SoftrigError):
            try:
                self._goodbye()
            except LinkLost:
                self.stop(GOODBYE_MS)
        self._session.holds_lease = False

    def clear(self) -> None:
        """Leave the tripped state once its cause is gone."""
        self._order(messages.CLEAR)

    def fire(self, coils: Iterable[str], duty_permille: int, hold_ms: int) -> None:
        """Heat these coils or groups, each for that long."""
        mask, limits = self.profile.mask(coils), self.profile.coil
        self._within("fire", codes.DUTY_LIMIT, duty_permille, limits.duty_max_permille)
        self._within("fire", codes.HOLD_LIMIT, hold_ms, limits.hold_max_ms)
        self._order(messages.FIRE, coils=mask, duty_permille=duty_permille, hold_ms=hold_ms)

    def faults(self) -> list[Fault]:
        """Return the faults that the robot has kept over resets and power cuts, newest first."""
        faults: list[Fault] = []
        while True:
            page = self._order(messages.FAULTS_REQUEST, skip=len(faults))
            if not isinstance(page, FaultPage):
                raise LinkLost("the robot answered a request for its faults with something else")
            faults += page.faults
            if not page.faults or len(faults) >= page.count:
                return faults

    def clear_faults(self) -> None:
        """Have the robot forget the faults that it has kept."""
        self._order(messages.CLEAR_FAULTS)

    def coils(self) -> dict[str, CoilState]:
        """Return what the resistance of each coil says, as it was measured last."""
        coils = self._order(messages.COILS_REQUEST)
        if not isinstance(coils, dict):
            raise LinkLost("the robot answered a request for its coils with something else")
        return coils

    def settings(self) -> Settings:
        """Ask for the robot's settings."""
        settings = self._order(messages.SETTINGS_REQUEST)
        if not isinstance(settings, Settings):
            raise LinkLost("the robot answered a request for its settings with something else")
        return settings

    def change(self, name: str, value: int, coil: str | None = None) -> None:
        """Change a setting, one of SETTING_NAMES, and have the robot keep it."""
        channel = NONE if coil is None else self.profile.mask([coil]).bit_length() - 1
        self._order(messages.SET, setting=messages.SETTING_NAMES.index(name), channel=channel, value=value)

    def calibrate(self, without: Iterable[str] = ()) -> None:
        """Have the resistance of every cold coil measured and kept, but for those known to be broken."""
        broken = self.profile.mask(without)
        self._order(messages.CALIBRATE, session=self._session.number, without=broken)

    def subscribe(
        self, period_ms: int, variables: Iterable[str] | None = None, on_change: bool = False, slot: int = 0
    ) -> None:
        """Have variables sent at that period, as Telemetry, or as Sample if they are named; 0 ends it.

        On change: only when one of them is another than before, and at that distance at least. Each of the four slots
        has its own.
        """
        named = b"" if variables is None else numbers_of(variables)
        self._order(messages.SUBSCRIBE, slot=slot, period_ms=period_ms, on_change=int(on_change), variables=named)

    def upload(self, header: bytes, code: bytes, progress: Callable[[int], None] | None = None) -> None:
        """Send a compiled program; `progress` is told how many bytes have been taken."""
        self._order(messages.PROGRAM, header=header)
        pieces = [(at, code[at : at + PIECE]) for at in range(0, len(code), PIECE)]
        for orders in (pieces[i : i + 4] for i in range(0, len(pieces), 4)):
            sent = [self._ask(messages.CODE, offset=at, code=piece) for at, piece in orders]
            for seq, (at, piece) in zip(sent, orders, strict=True):
                self._answer(seq)
                if progress:
                    progress(at + len(piece))

    def start(self) -> None:
        """Run the program that was uploaded."""
        self._order(messages.START, at_ms=messages.AT_ONCE)

    def cancel(self) -> None:
        """End the running program; all coils off, still armed."""
        self._order(messages.CANCEL)

    def watch(self) -> Iterator[Record]:
        """Yield telemetry and events as they come, up to the event that ends the running program."""
        left_ms = self.now_ms() + LINGER_MS
        while True:
            for record in self._taken():
                yield record
                if isinstance(record, Event) and record.event in ENDS:
                    return
                if isinstance(record, Stopped) or (isinstance(record, Telemetry) and record.state == "running"):
                    left_ms = self.now_ms() + LINGER_MS
            if self.now_ms() >= left_ms:
                raise LinkLost("the program ended and the robot's word about it was lost; `softrig status` asks it")
            self._turn(left_ms)

    def listen(self, time_ms: int) -> Iterator[Record]:
        """Yield telemetry and events for that long."""
        until_ms = self.now_ms() + time_ms
        while True:
            yield from self._taken()
            if self.now_ms() >= until_ms:
                return
            self._turn(until_ms)

    def stop(self, wait_ms: int = STOP_WAIT_MS) -> Stopped:
        """Switch everything off from any state, without a hello; Silent when no answer comes."""
        self.acknowledged = None
        self._session.stop(self.now_ms())
        until_ms = self.now_ms() + wait_ms
        self._wait(lambda: self.acknowledged is not None or self.now_ms() >= until_ms, until_ms)
        if self.acknowledged is None:
            raise Silent("stop was sent and nobody answered it: switch the coil supply off by hand")
        return self.acknowledged

    def statistics(self) -> dict[str, int | None]:
        """Return what the line did so far."""
        return self._session.statistics()

    def _within(self, request: str, code: int, value: int, limit: int) -> None:
        """Refuse, as the robot would, a value that is beyond what its message can carry."""
        if value > WORD_MAX:
            raise Refused(request, code, value, limit)

    def _order(self, message: messages.Message, **values: Any) -> Answer | None:
        """Give an order and wait for its answer; Refused when the robot refuses it."""
        return self._answer(self._ask(message, **values))

    def _ask(self, message: messages.Message, **values: Any) -> int:
        self._wait(lambda: self._session.room() > 0)
        return self._session.request(message, self.now_ms(), **values)

    def _answer(self, seq: int) -> Answer | None:
        answers = self._session.answers
        self._wait(lambda: seq in answers)
        answer = answers.pop(seq)
        if isinstance(answer, Refused):
            raise answer
        return answer

    def _wait(self, done: Callable[[], bool], until_ms: int | None = None) -> None:
        """Serve the line until `done`; the session itself raises when nothing comes any more."""
        while not done():
            self._turn(until_ms)

    def _turn(self, until_ms: int | None = None) -> None:
        """Write what is due, then wait for bytes until something is due again."""
        now_ms = self.now_ms()
        out = self._session.poll(now_ms)
        wake_ms = self._session.wake_ms(now_ms)
        try:
            if out:
                self._keep("out", out, now_ms)
                self.link.write(out)
            data = self.link.read((wake_ms if until_ms is None else min(wake_ms, until_ms)) / 1000)
        except OSError as error:
            raise LinkLost(f"the line broke ({error}); the robot switches its coils off by itself") from error
        now_ms = self.now_ms()
        news = self._session.receive(data, now_ms)
        if data:
            self._keep("in", data, now_ms)
        self._news += news
        for record in news:
            self._noticed(record)

    def _noticed(self, record: Record) -> None:
        if isinstance(record, Stopped):
            self.acknowledged = record
        if self._recorder:
            self._recorder.record(record)

    def _keep(self, direction: str, data: bytes, now_ms: int) -> None:
        if self._recorder:
            self._recorder.line(direction, data, now_ms, self._session.robot_ms(now_ms))

    def _taken(self) -> list[Record]:
        news, self._news = self._news, []
        return news

    def _fresh_session(self) -> Session:
        """Return a session with a number made of the clock, which no other host is likely to share."""
        now_ms = self.now_ms()
        return Session(round(self.link.now_s() * 1e6) * 2654435761 % 0xFFFFFFFF + 1, now_ms)

    def _goodbye(self) -> None:
        """Disarm, and stop a robot that does not answer to that."""
        until_ms = self.now_ms() + GOODBYE_MS
        seq = self._ask(messages.DISARM)
        self._wait(lambda: seq in self._session.answers or self.now_ms() >= until_ms, until_ms)
        if seq not in self._session.answers:
            self.stop()

    def _interrupted(self) -> Interrupted:
        """Send stop and return the words about what came back; a second Ctrl-C ends the waiting."""
        try:
            stopped = self.stop()
        except (SoftrigError, KeyboardInterrupt) as error:
            return Interrupted(f"interrupted: stop was sent but not acknowledged ({error})")
        coils = f"coils {' '.join(stopped.coils)} were on and are off now" if stopped.coils else "no coil was on"
        name = causes.row(stopped.code)
        return Interrupted(
            f"interrupted: stop acknowledged, {coils}; the robot is {stopped.state}"
            f"{f' ({name.name})' if name else ''}: `softrig clear` before the next run"
        )
