"""The robot's core: states, lease, orders, faults and telemetry, one step every 5 ms.

It is handed the bytes that arrived and the time, and hands back the bytes to send. What looks at the chips or drives
them, and must never allocate memory, is its `control`.
"""

from firmware.commands import Commands
from firmware.control import Control
from firmware.greetings import Greetings
from firmware.pairing import Pairing
from firmware.player import FINISHED, STARVED, TIMED_OUT, UNSEEN
from firmware.records import Records
from firmware.reports import Reports
from firmware.tasks import CONTROL, RECEIVE, Tasks
from protocol import codes, messages
from protocol.frames import GREETINGS_BELOW, StopFinder
from protocol.link import Link

VERSION = b"0.1.0"
LEAVE_MS = 100  # between the order for the console and the end: its answer is sent, and acknowledged
UPTIME_MAX_MS = 1 << 29  # six days; a board's small integers end at 2**30


class Core:
    """One robot. `board` gives pins and chips, `profile` labels and limits, `boot` names this start."""

    def __init__(self, board, profile, boot: int, after_reset: bool = False, loud: int = 0) -> None:
        self.board = board
        self.profile = profile
        self.boot = boot
        self.dictionary = board.dictionary()
        self.state = self.was = messages.BOOT  # now, and when this step began
        self.version = VERSION
        self.code = 0  # of the last fault
        self.overruns = 0
        self.can = None  # its port, where there is one
        self.session = 0
        self.lease_ms = 0  # of the session that armed
        self.now_ms = 0
        self._after_reset = after_reset
        self._loud = loud  # a PWM chip that boot.py could not switch off
        self.pairing = Pairing(board.open, board.serial)
        self.records = Records(self, messages.RESET if after_reset else messages.POWER_ON)
        self.control = Control(board, profile)
        self.channels, self.sense, self.guard = self.control.channels, self.control.sense, self.control.guard
        self.attitude, self.player, self.limbs = self.control.attitude, self.control.player, self.control.limbs
        self.commands = Commands(self)
        self.greetings = Greetings(self)
        self.link = Link(self.dictionary.crc, self.records.settings.node, True)
        self.link.grant_bytes = board.credit_bytes
        self.link.byte_ns = board.byte_ns
        self.reports = Reports(self)
        self.tasks = Tasks()
        self._stop = StopFinder()
        self.intact_ms = -1  # when bytes came last that made sense, -1: never
        self._armed_ms = 0
        self._attach = 0  # the session that the one on offer would take over from
        self._leave_ms = -1  # when to make room for the console, -1: never

    def step(self, now_ms: int, data: bytes, room: int) -> bytes:
        """Take the bytes that arrived, run one control step, and return the bytes to send: at most `room`."""
        self.now_ms = now_ms
        self.was = self.state
        if self.state == messages.BOOT:
            self._begin()
        self.records.keep()
        if data:
            self._receive(data)
        self.tasks.report(RECEIVE)
        if messages.ARMED <= self.state <= messages.RUNNING and not self.lease_left_ms():
            self._end_lease()
        self.commands.go_on()
        code = self.control.tried(now_ms, self.state)
        self.tasks.report(CONTROL)
        if code:
            self.trip(code, self.guard.channel, self.guard.value)
        if self.limbs and self.limbs.lost():
            self._lose_object()
        if self.state == messages.RUNNING:
            self._end_program()
        self.reports.tell()
        out = self.link.poll(now_ms, room)
        if self.reports.subscriptions.active:
            out += self.reports.telemetry(room - len(out))
        return out

    def arm(self, lease_ms: int) -> None:
        """Allow orders while the lease lives: every coil and joint has been tested, and the supply is on."""
        self.lease_ms = lease_ms
        self.state = messages.ARMED
        self._armed_ms = self.now_ms

    def disarm(self, code: int = 0, value: int = 0) -> None:
        """Everything off, supply off, lease returned; a tripped robot stays tripped."""
        self.control.all_off(self.now_ms)
        self.commands.give_up(codes.NOT_ARMED)
        if self.state in (messages.ARMED, messages.RUNNING):
            self.state = messages.IDLE
            self.reports.event(messages.DISARMED, code, 255, value)
            self.player.leave()
        self.lease_ms = 0

    def trip(self, code: int, channel: int = 255, value: int = 0) -> None:
        """Everything off at once, supply off, latched until `clear`; the first cause is the one that stays."""
        self.control.all_off(self.now_ms)
        self.commands.give_up(code)
        if self.state != messages.TRIPPED:
            self.code = code
            self.state = messages.TRIPPED
            self.lease_ms = 0
            self.reports.event(messages.TRIP, code, channel, value)
            self.player.leave()

    def clear(self) -> bool:
        """Leave the tripped state; False when the cause is still there."""
        try:
            self.control.begin(self.now_ms)
            self.sense.begin_supply()
        except OSError:
            return False
        if self.guard.check(self.now_ms, False):
            return False
        self.state = messages.IDLE
        self.reports.event(messages.CLEARED)
        return True

    def start(self, upload, paused: bool) -> None:
        """Run a program that was checked, or have it stand at its beginning."""
        self.player.load(upload, self.now_ms, paused)
        self.state = messages.RUNNING
        self.reports.event(messages.STARTED)

    def end_program(self, event: int, code: int = 0, value: int = 0) -> None:
        """Leave the running program: all coils off, joints hold where they are, still armed."""
        self.channels.all_off(self.now_ms)
        if self.limbs:
            self.limbs.stand()
        self.state = messages.ARMED
        if event == messages.FINISHED:
            self.reports.step_done()
        elif self.player.failed:
            code = self.player.failed
        self.reports.event(event, code, 255, value)
        self.player.leave()

    def offer(self, hello) -> bool:
        """Have a session begin with its first frame; return whether it may, as things stand.

        That frame must show the pairing key, if there is one; a robot whose key is damaged begins none.
        """
        key = self.pairing.offer(hello, self.link.decoder.dictionary_crc)
        if hello.session == self.session:
            return True
        if self.pairing.secured == messages.KEY_DAMAGED:
            return False
        if not self.link.offer(hello.session, key):
            return False
        self._attach = hello.attach
        return self._may_adopt()

    def serve_console(self) -> None:
        """Make room for the console soon, once the answer is on its way."""
        self._leave_ms = self.now_ms + LEAVE_MS

    def is_leaving(self) -> bool:
        """Return whether the console was asked for: nothing is armed any more."""
        return self._leave_ms >= 0

    def leaves(self) -> bool:
        """Return whether it is time to make room for the console."""
        return 0 <= self._leave_ms <= self.now_ms

    def holder(self) -> int:
        """Return the session that holds the lease, or whose program runs; 0: none."""
        return self.session if self.lease_left_ms() or self.state == messages.RUNNING else 0

    def at_rest(self) -> bool:
        """Return whether nothing is on and nothing can be: the time to write to the flash."""
        test = self.control.selftest
        quiet = self.control.driven_mask() == 0 and not (test.running or test.done)
        return quiet and self.state in (messages.IDLE, messages.TRIPPED)

    def may_restart(self) -> bool:
        """Return whether the clock should begin anew: it would outgrow small integers, and nobody is at work."""
        return self.now_ms > UPTIME_MAX_MS and self.at_rest()

    def lease_left_ms(self) -> int:
        """Return what is left of the lease, 0 when nobody holds it."""
        heard_ms = self.link.heard_ms
        if self.lease_ms == 0 or heard_ms is None:
            return 0
        since_ms = heard_ms if heard_ms > self._armed_ms else self._armed_ms
        left_ms = self.lease_ms - (self.now_ms - since_ms)
        return left_ms if left_ms > 0 else 0

    def _begin(self) -> None:
        self.state = messages.IDLE
        if self._after_reset:
            self.sense.assume_hot()
        self.records.begin()
        try:
            self.control.begin(self.now_ms)
            self.sense.begin_supply()
        except OSError:
            self.trip(codes.CHIP)
        if self._loud:
            self.trip(codes.CHIP, 255, self._loud)
        if self._after_reset:
            self.trip(codes.WATCHDOG)
        if self.pairing.secured == messages.KEY_DAMAGED:
            self.trip(codes.KEY)

    def _receive(self, data: bytes) -> None:
        if self._stop.feed(data):
            driven = self.control.driven_mask()
            self.intact_ms = self.now_ms
            self.trip(codes.STOP)
            self.greetings.stopped(driven)
        self.link.may_adopt = self._may_adopt()
        delivered = self.link.receive(data, self.now_ms)
        if delivered or self.link.heard_ms == self.now_ms:
            self.intact_ms = self.now_ms
        if self.link.session != self.session:
            self._take_session(self.link.session)
        for received in delivered:
            if received.kind < GREETINGS_BELOW:
                self.greetings.serve(received)
            elif received.kind == messages.CLOCK_REQUEST.number:
                self.reports.clock(received.payload)
            else:
                self.commands.serve(received)

    def _may_adopt(self) -> bool:
        """Return whether the session on offer may begin: nobody holds the lease, or it is handed over."""
        return self.lease_left_ms() == 0 or self._attach == self.session

    def _take_session(self, session: int) -> None:
        """Follow the link to a new session: it has what it took over, or no lease, so that what was armed ends now."""
        is_taken_over = self._attach == self.session
        if not is_taken_over:
            self.lease_ms = 0
        self._attach = 0
        self.session = session
        self.pairing.session_begun()
        self.commands.forget(is_taken_over)
        self.reports.subscriptions.forget()

    def _end_lease(self) -> None:
        if not (self.state == messages.RUNNING and self.commands.upload.outlives_host):
            self.disarm(codes.LEASE_EXPIRED, self.lease_ms)

    def _lose_object(self) -> None:
        """The loop that turns the object ended for want of the camera: the joints hold, a program ends."""
        since_ms = self.now_ms - self.limbs.camera.seen_ms
        if self.state == messages.RUNNING:
            self._abort(codes.CAMERA, since_ms)
        else:
            self.reports.event(messages.LOST, codes.CAMERA, 255, since_ms)

    def _end_program(self) -> None:
        player = self.player
        if player.outcome == FINISHED:
            self.end_program(messages.ABORTED if player.failed else messages.FINISHED)
        elif player.outcome == TIMED_OUT:
            self._abort(codes.WAIT_TIMEOUT)
        elif player.outcome == STARVED:
            self.end_program(messages.ABORTED, codes.STARVED)
        elif player.outcome == UNSEEN:
            self._lose_object()

    def _abort(self, code: int, value: int = 0) -> None:
        """Everything off; then what the program does when it was aborted, if it says so, else its end."""
        if not self.player.catch(code, self.now_ms):
            self.end_program(messages.ABORTED, code, value)
            return
        self.channels.all_off(self.now_ms)
        if self.limbs:
            self.limbs.stand()
        self.reports.event(messages.CAUGHT, code, 255, value)
