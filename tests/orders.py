"""What a host's bytes allow a robot to do, read off the line with the same `protocol` that both ends use.

A claim says that some coils may be on from one moment to another. `Ledger` is handed each byte that the firmware read
and each that it sent, with the bench's time, and keeps the claims and how long the lease lived. What the robot's
answers leave open is allowed, so that whoever holds a run against a ledger accuses no innocent robot.

    ledger = Ledger(profile)
    ledger.heard(data, now_us)
    ledger.claims, ledger.alive
"""

from math import inf

from host.profile import Profile
from protocol import frames, messages, program
from protocol.link import Link, Received
from tests.claims import Claim, budgets, limp_start_us

ENDED = (messages.FINISHED, messages.ABORTED, messages.TRIP, messages.DISARMED)
TESTED = (messages.ARM, messages.CALIBRATE)
DRIVING = (messages.FIRE, messages.MOVE, messages.ORIENT, messages.PRESS)
TEST_US = 2_000_000  # the longest that a self-test takes between such an order and its answer
PULSES_US = 20_000  # and all of it that one coil is on
TALKS_MAX = 32  # sessions that are listened to at once: one read may hold so many greetings


class Talk:
    """One session, overheard: what its host says, and what the robot answers."""

    def __init__(self, seed: int, session: int) -> None:
        self.session = session
        self.open: dict[int, tuple[messages.Message, Claim | None, object, int]] = {}  # and how many claims there were
        self.host, self.robot = Link(seed, device=True), Link(seed)
        for link in (self.host, self.robot):
            link.begin(seed, session)


class Ledger:
    """The orders of one robot's hosts; `alive` lists (time, until when a coil may be on by the lease, from then on)."""

    def __init__(self, profile: Profile, seed: int) -> None:
        self.claims: list[Claim] = []
        self.alive: list[tuple[int, float]] = [(0, 0)]
        self._profile = profile
        self._joints = profile.mask(profile.joint_labels)
        self._limp_us = limp_start_us(profile.servo_limits)
        self._seed = seed
        self._reads = 0
        self._current: list[Claim] = []
        self.reset(0)

    def reset(self, now_us: int) -> None:
        """The robot has begun anew: no order holds any more."""
        self._end_all(now_us)
        self._lease_us = 0.0
        self._test_until_us = 0  # a self-test, which stands before the lease, may last as long
        self._outlives = False
        self._armed_us = now_us
        self._upload = bytearray()
        self._may_outlive = self._one_may = self._doubtful = self._streams = False
        self._played: Claim | None = None  # of the program that was started last, if its code is known
        self._stop = frames.StopFinder()
        self._talks = [Talk(self._seed, 0)]  # any of them may be in force: the robot need not have said so yet
        self._uploader = self._talks[0]

    def heard(self, data: bytes, now_us: int) -> None:
        """Take bytes that the firmware has read."""
        if self._stop.feed(data):
            self._end_all(now_us)
        self._reads += 1
        for talk in self._talks:
            for received in talk.host.receive(data, self._reads):
                if received.kind == messages.HELLO.number and talk is self._talks[0]:
                    self._greeted(received.payload, data.rpartition(b"\x00")[2])
                self._ordered(talk, received, now_us)
        if self._reads in [talk.host.heard_ms for talk in self._talks]:
            self._live(now_us)

    def told(self, data: bytes, now_us: int) -> None:
        """Take bytes that the firmware has sent."""
        for talk in self._talks:
            for received in talk.robot.receive(data, 0):
                message = messages.by_number(received.kind)
                if message is None:
                    continue
                answer = message.unpack(received.payload)
                if message is messages.EVENT and answer.event in ENDED:
                    self._ended(answer.event, now_us)
                elif message in (messages.OK, messages.REFUSED) and answer.request in talk.open:
                    self._answered(*talk.open.pop(answer.request), message is messages.OK, now_us)

    def _ordered(self, talk: Talk, received: Received, now_us: int) -> None:
        message = messages.by_number(received.kind)
        if message is None or received.kind < frames.GREETINGS_BELOW:
            return
        try:
            order = message.unpack(received.payload)
        except ValueError:
            return
        claim = None
        if message is messages.ARM:
            claim = self._tested(order.lease_ms, now_us)
        elif message is messages.CALIBRATE:
            claim = self._tested(0, now_us)
        elif message is messages.FIRE and order.duty_permille:
            claim = Claim(order.coils, now_us, now_us + order.hold_ms * 1000)
        elif message is messages.MOVE:
            claim = Claim(order.joints, now_us, now_us + (order.over_ms + order.hold_ms) * 1000 + self._limp_us)
        elif message in (messages.ORIENT, messages.PRESS):
            claim = Claim(self._joints, now_us, now_us + (order.time_ms + order.hold_ms) * 1000)
        elif message is messages.START:
            claim = Claim((1 << 32) - 1, now_us, inf, of_program=True, outlived=self._outlives)
            self._outlives = self._outlives or (self._one_may if self._doubtful else self._may_outlive)
            self._live(now_us)  # it may have begun, though the robot has no room to say so
        elif message is messages.PROGRAM:
            self._begin(talk, order.header)
        elif message is messages.CODE:
            self._doubtful = self._doubtful or talk is not self._uploader
            self._take(order.offset, order.code)
        if claim is not None:
            self._add(claim, now_us)
        talk.open[received.seq] = (message, claim, order, len(self.claims))

    def _tested(self, lease_ms: int, now_us: int) -> Claim:
        lease_us = 1000 * (lease_ms or self._profile.session.lease_ms)
        self._lease_us = max(self._lease_us, lease_us)
        self._armed_us = now_us
        self._test_until_us = now_us + TEST_US
        pulses = dict.fromkeys(range(len(self._profile.channels)), PULSES_US)
        return Claim((1 << len(pulses)) - 1, now_us, now_us + TEST_US, pulses)

    def _begin(self, talk: Talk, header: bytes) -> None:
        self._upload, self._doubtful, self._uploader = bytearray(), False, talk
        self._streams, self._played = False, None
        try:
            flags = program.read_header(header).flags
            self._streams = bool(flags & program.STREAMED)
            self._may_outlive = bool(flags & program.OUTLIVES_HOST)
            self._one_may = self._one_may or self._may_outlive
        except program.BadProgram:
            self._doubtful = True

    def _take(self, offset: int, code: bytes) -> None:
        """Take a piece of a program, which may run already if it is streamed."""
        if not self._streams:
            self._upload[offset : offset + len(code)] = code
            return
        self._upload += code
        if self._played is not None:
            self._played.budget_us = self._budgets()

    def _budgets(self) -> dict[int, float]:
        """Return for how long the program may have each channel on; nothing, which is no limit, when it is none."""
        try:
            return dict(budgets(bytes(self._upload), self._profile.servo_limits))
        except (IndexError, KeyError, ValueError):
            return {}  # pieces of it were not overheard

    def _cancel(self, count: int, now_us: int) -> None:
        """End what programs say of coils; their joints stand where they are, up to the ends of their orders."""
        for claim in self.claims[:count]:
            if claim.of_program and claim.limited:
                self._part(claim, claim.mask & ~self._joints, now_us)

    def _part(self, claim: Claim, ends: int, now_us: int) -> None:
        """End what a claim says of some channels."""
        goes_on = claim.mask & ~ends
        if goes_on:
            self._add(Claim(goes_on, claim.from_us, claim.until_us, claim.budget_us, claim.of_program), now_us)
        claim.mask &= ends
        claim.end(now_us)

    def _answered(
        self, message: messages.Message, claim: Claim | None, order: object, count: int, ok: bool, now_us: int
    ) -> None:
        if message in TESTED and ok:
            self._test_until_us = 0
        if not ok:
            self._doubtful = self._doubtful or message in (messages.PROGRAM, messages.CODE)
            if claim is not None:
                claim.end(now_us if message in TESTED else claim.from_us)  # the self-test has been
            if message is messages.START:
                self._outlives = claim.outlived
                self._live(now_us)
        elif message is messages.CALIBRATE:
            claim.end(now_us)
        elif message is messages.DISARM:
            for older in self.claims[:count]:
                older.end(now_us)
        elif message is messages.CANCEL:
            self._cancel(count, now_us)
        elif message is messages.ARM:
            self._lease_us = 1000.0 * (order.lease_ms or self._profile.session.lease_ms)
        elif message in DRIVING:
            self._replaced(claim.mask if claim else order.coils, claim, count, now_us)
        elif message is messages.START and self._doubtful:
            self._outlives = self._one_may  # an older program may have been started
            self._live(now_us)
        elif message is messages.START:
            self._outlives = self._may_outlive
            claim.budget_us = self._budgets()
            self._played = claim
            self._live(now_us)

    def _replaced(self, coils: int, by: Claim | None, count: int, now_us: int) -> None:
        """End what older orders say of these coils, the first `count` of all: the newest order alone holds."""
        newer = self.claims[count:]
        for claim in self._current:
            if claim is not by and claim.mask & coils and not any(claim is each for each in newer):
                self._part(claim, coils, now_us)

    def _ended(self, event: int, now_us: int) -> None:
        """Take the robot's word that it is off, unless it may be an old one: the robot was armed since."""
        if self._outlives:
            self._outlives = False
            self._live(now_us)
        if event in (messages.TRIP, messages.DISARMED) and now_us - self._armed_us > 500_000:
            self._end_all(now_us)

    def _greeted(self, payload: bytes, begun: bytes) -> None:
        """Listen to a session that may begin, too, from the frame on that has begun when its hello was read."""
        try:
            hello = messages.HELLO.unpack(payload)
        except ValueError:
            return
        if hello.version == frames.VERSION and hello.session not in [talk.session for talk in self._talks]:
            latest = self._talks[1:][1 - TALKS_MAX :]
            self._talks = [self._talks[0], *latest, Talk(self._seed, hello.session)]
            self._talks[-1].host.receive(begun, self._reads)

    def _live(self, now_us: int) -> None:
        until_us = max(now_us + self._lease_us, self._test_until_us)
        self.alive.append((now_us, inf if self._outlives else until_us))

    def _add(self, claim: Claim, now_us: int) -> None:
        self.claims.append(claim)
        self._current = [each for each in self._current if each.until_us > now_us] + [claim]

    def _end_all(self, now_us: int) -> None:
        for claim in self._current:
            claim.end(now_us)
        self._current = []
