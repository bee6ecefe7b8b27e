"""What a robot can be told and asked, one method each; every one waits for the robot's answer.

What cannot even be written into a message is refused here as the robot would refuse it; all other limits are its own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

from host.answers import Answer
from host.coils import CoilState
from host.conversation import Conversation
from host.errors import NONE, BadRequest, LinkLost, Refused
from host.kept import Fault, FaultPage, Settings
from host.profile import Profile
from host.records import Status
from host.selections import numbers_of
from protocol import codes, messages

PIECE = 192  # bytes of code in a message
PIECES_AHEAD = 4
WORD_MAX = 0xFFFF
LONG_MAX = 0xFFFFFFFF
CENTI_MAX = 0x7FFF  # of an angle or a position

Kind = TypeVar("Kind")


class Orders:
    """The orders of one robot, given in the present session of `talk`."""

    def __init__(self, talk: Conversation) -> None:
        self.talk = talk

    @property
    def profile(self) -> Profile:
        """Return the robot's own profile; there is one once it is connected."""
        profile = self.talk.session.hearing.profile
        if profile is None:
            raise LinkLost("not connected yet: call connect() first")
        return profile

    def status(self) -> Status:
        """Ask for the robot's state."""
        return _expected(Status, self.talk.order(messages.STATUS_REQUEST), "its status")

    def arm(self, lease_ms: int = 0, without: Iterable[str] = ()) -> None:
        """Have every coil and joint tested, take the lease and allow orders; 0 takes the robot's own lease.

        The coils and groups of `without` are known to be broken: they are not tested, and never driven.
        """
        _within("arm", codes.LEASE_LIMIT, lease_ms, self.profile.session.lease_max_ms)
        broken = self._broken(without)
        self.talk.order(messages.ARM, session=self.talk.session.number, lease_ms=lease_ms, without=broken)

    def disarm(self) -> None:
        """Switch all coils off, let all joints go limp and return the lease."""
        self.talk.order(messages.DISARM)
        self.talk.session.hearing.holds_lease = False

    def clear(self) -> None:
        """Leave the tripped state once its cause is gone."""
        self.talk.order(messages.CLEAR)

    def fire(self, coils: Iterable[str], duty_permille: int, hold_ms: int) -> None:
        """Heat these coils or groups, each for that long."""
        mask, limits = self.profile.coil_mask(coils), self.profile.coil
        _within("fire", codes.DUTY_LIMIT, duty_permille, limits.duty_max_permille)
        _within("fire", codes.HOLD_LIMIT, hold_ms, limits.hold_max_ms)
        self.talk.order(messages.FIRE, coils=mask, duty_permille=duty_permille, hold_ms=hold_ms)

    def move(self, joints: Iterable[str], target_centi: int, over_ms: int, hold_ms: int) -> None:
        """Bring these joints or groups on a straight line to a position in hundredths of their unit, then hold them.

        After `hold_ms` they go limp. A joint that is limp sets out from where it is and may take longer: it never goes
        faster than it may.
        """
        mask, limits = self.profile.joint_mask(joints), self.profile.servo
        _writable("over", over_ms)
        _within("move", codes.HOLD_LIMIT, hold_ms, limits.hold_max_ms, LONG_MAX)
        if abs(target_centi) > CENTI_MAX:
            limit = limits.least_centi if target_centi < 0 else limits.most_centi
            raise Refused("move", codes.RANGE_LIMIT, target_centi, limit, unit=limits.unit)
        self.talk.order(messages.MOVE, joints=mask, target_centi=target_centi, over_ms=over_ms, hold_ms=hold_ms)

    def orient(self, target_centideg: int, time_ms: int, hold_ms: int) -> None:
        """Turn the object that both joints hold to an angle, regulated for `time_ms`; then hold it for that long.

        When the camera is lost for too long the loop ends with the event `lost`, and the joints hold.
        """
        limits = self.profile.servo
        _writable("for", time_ms)
        _within("orient", codes.HOLD_LIMIT, hold_ms, limits.hold_max_ms, LONG_MAX)
        if abs(target_centideg) > CENTI_MAX:
            most_deg = CENTI_MAX / 100
            raise BadRequest(f"orient to {target_centideg / 100:g} deg: at most {most_deg:g} deg either way")
        self.talk.order(messages.ORIENT, target_centideg=target_centideg, time_ms=time_ms, hold_ms=hold_ms)

    def press(self, target_mn: int, over_ms: int, time_ms: int, hold_ms: int) -> None:
        """Press with a force, reached on a straight line within `over_ms` and regulated until `time_ms` has passed.

        Then the axis holds where it stands for `hold_ms`, and stays there when it is limp.
        """
        limits, load = self.profile.servo, self.profile.load
        if target_mn < 0:
            raise BadRequest(f"press with {target_mn / 1000:g} N: a press cannot pull; lift it with a move")
        if load:
            _within("press", codes.FORCE_LIMIT, target_mn, load.most_mn)
        _writable("over", over_ms)
        _writable("for", time_ms, LONG_MAX)
        _within("press", codes.HOLD_LIMIT, hold_ms, limits.hold_max_ms, LONG_MAX)
        self.talk.order(messages.PRESS, target_mn=target_mn, over_ms=over_ms, time_ms=time_ms, hold_ms=hold_ms)

    def faults(self) -> list[Fault]:
        """Return the faults that the robot has kept over resets and power cuts, newest first."""
        faults: list[Fault] = []
        while True:
            page = _expected(FaultPage, self.talk.order(messages.FAULTS_REQUEST, skip=len(faults)), "its faults")
            faults += page.faults
            if not page.faults or len(faults) >= page.count:
                return faults

    def clear_faults(self) -> None:
        """Have the robot forget the faults that it has kept."""
        self.talk.order(messages.CLEAR_FAULTS)

    def coils(self) -> dict[str, CoilState]:
        """Return what the resistance of each coil says, as it was measured last."""
        return _expected(dict, self.talk.order(messages.COILS_REQUEST), "its coils")

    def settings(self) -> Settings:
        """Ask for the robot's settings."""
        return _expected(Settings, self.talk.order(messages.SETTINGS_REQUEST), "its settings")

    def change(self, name: str, value: int, coil: str | None = None) -> None:
        """Change a setting, one of SETTING_NAMES, and have the robot keep it."""
        channel = NONE if coil is None else self.profile.coil_mask([coil]).bit_length() - 1
        self.talk.order(messages.SET, setting=messages.SETTING_NAMES.index(name), channel=channel, value=value)

    def calibrate(self, without: Iterable[str] = ()) -> None:
        """Have the resistance of every cold coil measured and kept, but for those known to be broken."""
        broken = self._broken(without)
        self.talk.order(messages.CALIBRATE, session=self.talk.session.number, without=broken)

    def subscribe(
        self, period_ms: int, variables: Iterable[str] | None = None, on_change: bool = False, slot: int = 0
    ) -> None:
        """Have variables sent at that period, as Telemetry, or as Sample if they are named; 0 ends it.

        On change: only when one of them is another than before, and at that distance at least. Each of the four slots
        has its own.
        """
        named = b"" if variables is None else numbers_of(variables)
        self.talk.order(messages.SUBSCRIBE, slot=slot, period_ms=period_ms, on_change=int(on_change), variables=named)

    def overhear(self, period_ms: int) -> None:
        """Have the usual variables sent, as Telemetry, also where this session may only watch; 0 ends it."""
        self.talk.session.overhear(period_ms, self.talk.now_us())

    def upload(self, header: bytes, code: bytes, progress: Callable[[int], None] | None = None) -> None:
        """Send a compiled program; `progress` is told how many bytes have been taken."""
        talk = self.talk
        talk.order(messages.PROGRAM, header=header)
        pieces = [(at, code[at : at + PIECE]) for at in range(0, len(code), PIECE)]
        for orders in (pieces[i : i + PIECES_AHEAD] for i in range(0, len(pieces), PIECES_AHEAD)):
            sent = [talk.ask(messages.CODE, offset=at, code=piece) for at, piece in orders]
            for seq, (at, piece) in zip(sent, orders, strict=True):
                talk.answer(seq)
                if progress:
                    progress(at + len(piece))

    def start(self, at_ms: int = messages.AT_ONCE, paused: bool = False) -> None:
        """Run the program that was uploaded: at once, or when the robot's clock shows `at_ms`.

        One that begins `paused` stands still before its first step.
        """
        self.talk.order(messages.START, at_ms=at_ms, paused=int(paused))

    def ready(self) -> None:
        """Have the program that was uploaded wait for the next `sync`."""
        self.start(messages.AT_SYNC)

    def pause(self) -> None:
        """Stop the clock of the running program: nothing new begins, what is on its way ends by itself."""
        self.talk.order(messages.PAUSE, how=messages.PAUSE_NOW)

    def resume(self) -> None:
        """Let a paused program go on."""
        self.talk.order(messages.PAUSE, how=messages.RESUME)

    def step(self) -> None:
        """Let a paused program go on up to its next step."""
        self.talk.order(messages.PAUSE, how=messages.ONE_STEP)

    def service(self) -> None:
        """Have the robot end its program and open its console, once; refused unless it is at rest."""
        self.talk.order(messages.SERVICE)

    def cancel(self) -> None:
        """End the running program; all coils off, joints hold, still armed."""
        self.talk.order(messages.CANCEL)

    def _broken(self, without: Iterable[str]) -> int:
        """Return the mask of coils that are known to be broken; BadRequest names a joint, which none can do without."""
        mask = self.profile.mask(without)
        for label in self.profile.named(mask):
            if label in self.profile.joint_labels:
                raise BadRequest(f"{label} is a joint: only a coil can be left out")
        return mask


def _expected(kind: type[Kind], answer: Answer | None, what: str) -> Kind:
    """Return an answer that is of the right kind."""
    if not isinstance(answer, kind):
        raise LinkLost(f"the robot answered a request for {what} with something else")
    return answer


def _writable(what: str, time_ms: int, most_ms: int = WORD_MAX) -> None:
    """Refuse a time that its message cannot carry."""
    if time_ms > most_ms:
        raise BadRequest(f"{what} {time_ms} ms: at most {most_ms} ms in one order")


def _within(request: str, code: int, value: int, limit: int, most: int = WORD_MAX) -> None:
    """Refuse, as the robot would, a value that is beyond what its message can carry."""
    if value > most:
        raise Refused(request, code, value, limit)
