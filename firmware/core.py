"""The robot's core: states, lease, orders, faults and telemetry, one step every 5 ms.

It is handed the bytes that arrived and the time, and hands back the bytes to send; it opens nothing and waits for
nothing. `control` is the part that must never allocate memory: sensing, guarding, sequencing, driving.
"""

from binascii import crc32

from firmware.attitude import Attitude, Blind
from firmware.channels import Channels, Refused
from firmware.commands import Commands
from firmware.greetings import Greetings
from firmware.guard import Guard
from firmware.player import FINISHED, GUARDED, LOST, TIMED_OUT, Player
from firmware.records import Records
from firmware.reports import Reports
from firmware.sense import Sense
from protocol import codes, messages
from protocol.frames import UNSEEDED_BELOW, StopFinder
from protocol.link import Link

VERSION = b"0.1.0"
CHECK_EVERY = 64  # control steps between two looks at the chips' settings
UPTIME_MAX_MS = 1 << 29  # six days; a board's small integers end at 2**30


class Core:
    """One robot. `board` gives pins and chips, `profile` labels and limits, `boot` names this start."""

    def __init__(self, board, profile, boot: int, after_reset: bool = False, loud: int = 0) -> None:
        self.board = board
        self.profile = profile
        self.boot = boot
        self.dictionary = messages.dictionary(profile.text)
        self.state = self.was = messages.BOOT  # now, and when this step began
        self.version = VERSION
        self.code = 0  # of the last fault
        self.overruns = 0
        self.session = 0
        self.lease_ms = 0  # of the session that armed
        self.now_ms = 0
        self._after_reset = after_reset
        self.records = Records(self, messages.RESET if after_reset else messages.POWER_ON)
        self._loud = loud  # a PWM chip that boot.py could not switch off
        chips = _chips(board, profile)
        self.monitor = board.monitor(profile.supply.shunt_mohm)
        outputs = [(chips[channel.chip], channel.output) for channel in profile.channels]
        self.channels = Channels(outputs, profile.coil, profile.supply.at_once_max)
        self.sense = Sense(board, self.monitor, self.channels.count, profile)
        self.guard = Guard(profile, self.sense, self.channels, board)
        self.attitude = _attitude(board, profile)
        self.player = Player(self.channels, self.sense, self.attitude)
        self.commands = Commands(self)
        self.greetings = Greetings(self)
        self.link = Link(crc32(self.dictionary))
        self.reports = Reports(self)
        self._chips = list(chips.values())
        self._stop = StopFinder()
        self._turn = 0

    def step(self, now_ms: int, data: bytes, room: int) -> bytes:
        """Take the bytes that arrived, run one control step, and return the bytes to send: at most `room`."""
        self.now_ms = now_ms
        self.was = self.state
        self.records.keep()
        if self.state == messages.BOOT:
            self._begin()
        if data:
            self._receive(data)
        self._lease()
        self.commands.go_on()
        code = self._controlled()
        if code:
            self.trip(code, self.guard.channel, self.guard.value)
        self._end_program()
        self.reports.tell()
        return self.link.poll(now_ms, room)

    def control(self, now_ms: int) -> int:
        """Sense, guard, sequence and drive once; return the code of a fault, or 0. Allocates nothing."""
        self.sense.update(now_ms, self.channels.on_mask, self.channels.duty_permille)
        self.sense.read()
        self.attitude.look(now_ms)
        powered = messages.ARMED <= self.state <= messages.RUNNING
        code = self.guard.check(now_ms, powered)
        if not code and self.state == messages.RUNNING:
            code = self._play(now_ms)
        too_long = self.channels.update(now_ms, self.sense.temperature_millidegc)
        if too_long >= 0 and not code:
            self.guard.channel = too_long
            self.guard.value = self.channels.on_for_ms(too_long, now_ms)
            code = codes.ON_TOO_LONG
        self._check_chips()
        self.channels.write()
        self.board.beat()
        return code

    def arm(self, lease_ms: int) -> None:
        """Supply on, orders allowed while the lease lives."""
        self.lease_ms = lease_ms
        self.state = messages.ARMED
        self.board.power(True)

    def disarm(self, code: int = 0, value: int = 0) -> None:
        """All coils off, supply off, lease returned; a tripped robot stays tripped."""
        self._all_off()
        if self.state in (messages.ARMED, messages.RUNNING):
            self.state = messages.IDLE
            self.reports.event(messages.DISARMED, code, 255, value)
            self.player.step = 0
        self.lease_ms = 0

    def trip(self, code: int, channel: int = 255, value: int = 0) -> None:
        """All coils off at once, supply off, latched until `clear`; the first cause is the one that stays."""
        self._all_off()
        if self.state != messages.TRIPPED:
            self.code = code
            self.state = messages.TRIPPED
            self.lease_ms = 0
            self.reports.event(messages.TRIP, code, channel, value)
            self.player.step = 0

    def clear(self) -> bool:
        """Leave the tripped state; False when the cause is still there."""
        try:
            self._begin_chips()
            self.sense.begin_supply()
        except OSError:
            return False
        if self.guard.check(self.now_ms, False):
            return False
        self.state = messages.IDLE
        self.reports.event(messages.CLEARED)
        return True

    def start(self, code: bytes) -> None:
        """Run a code that was checked."""
        self.player.load(code, self.now_ms)
        self.state = messages.RUNNING
        self.reports.event(messages.STARTED)

    def end_program(self, event: int, code: int = 0, value: int = 0) -> None:
        """Leave the running program: all coils off, still armed."""
        self.channels.all_off(self.now_ms)
        self.state = messages.ARMED
        self.reports.event(event, code, 255, value)
        self.player.step = 0

    def take_session(self, session: int) -> None:
        """Give the link to a new session; it holds no lease, so that what the last one armed ends now."""
        self.session = session
        self.lease_ms = 0
        self.commands.upload.request = -1
        self.link.reset(self.link.decoder.seed)
        self.reports.period_ms = 0

    def at_rest(self) -> bool:
        """Return whether no coil is on and none can be: the time to write to the flash."""
        return self.state in (messages.IDLE, messages.TRIPPED) and self.channels.on_mask == 0

    def may_restart(self) -> bool:
        """Return whether the clock should begin anew: it would outgrow small integers, and nobody is at work."""
        return self.now_ms > UPTIME_MAX_MS and self.state == messages.IDLE

    def lease_left_ms(self) -> int:
        """Return what is left of the lease, 0 when nobody holds it."""
        if self.lease_ms == 0 or self.link.heard_ms is None:
            return 0
        return max(0, self.lease_ms - (self.now_ms - self.link.heard_ms))

    def _begin(self) -> None:
        self.state = messages.IDLE
        if self._after_reset:
            self.sense.assume_hot()
        self.records.begin()
        try:
            self._begin_chips()
            self.sense.begin_supply()
        except OSError:
            self.trip(codes.CHIP)
        if self._loud:
            self.trip(codes.CHIP, 255, self._loud)
        if self._after_reset:
            self.trip(codes.WATCHDOG)

    def _begin_chips(self) -> None:
        self.board.power(False)
        self.channels.all_off(self.now_ms)
        for chip in self._chips:
            chip.begin()
        self.channels.forget_written()
        self.monitor.begin()
        if not self.attitude.known:
            self.attitude.begin(self.now_ms)

    def _receive(self, data: bytes) -> None:
        if self._stop.feed(data):
            coils = self.channels.on_mask
            self.trip(codes.STOP)
            self.greetings.stopped(coils)
        for received in self.link.receive(data, self.now_ms):
            if received.kind < UNSEEDED_BELOW:
                self.greetings.serve(received)
            else:
                self.commands.serve(received)

    def _lease(self) -> None:
        if self.state not in (messages.ARMED, messages.RUNNING) or self.lease_left_ms():
            return
        if not (self.state == messages.RUNNING and self.commands.upload.outlives_host):
            self.disarm(codes.LEASE_EXPIRED, self.lease_ms)

    def _controlled(self) -> int:
        """Run the control step; a chip that does not answer is asked once more, then all is switched off."""
        try:
            return self.control(self.now_ms)
        except OSError:
            pass
        try:
            return self.control(self.now_ms)
        except OSError as error:
            self.guard.channel = 255
            self.guard.value = error.args[0]
            return codes.CHIP

    def _play(self, now_ms: int) -> int:
        try:
            outcome = self.player.run(now_ms)
        except Refused as refused:
            self.guard.channel = refused.channel
            self.guard.value = refused.value
            return codes.REFUSED_STEP
        return codes.GUARD if outcome == GUARDED else codes.ATTITUDE if outcome == LOST else 0

    def _end_program(self) -> None:
        if self.state != messages.RUNNING:
            return
        if self.player.outcome == FINISHED:
            self.end_program(messages.FINISHED)
        elif self.player.outcome == TIMED_OUT:
            self.end_program(messages.ABORTED, codes.WAIT_TIMEOUT)

    def _check_chips(self) -> None:
        """Look in turn whether a chip has lost its settings, as after a brown-out."""
        self._turn += 1
        if self._turn < CHECK_EVERY or self.state == messages.TRIPPED:
            return
        for chip in self._chips:
            if not chip.configured():
                raise OSError(chip.address)
        if not self.monitor.configured():
            raise OSError(self.monitor.address)
        self.attitude.check(self.now_ms)
        self._turn = 0

    def _all_off(self) -> None:
        self.board.power(False)
        self.channels.all_off(self.now_ms)
        try:
            for chip in self._chips:
                chip.all_off()
            self.channels.forget_written()
        except OSError:
            pass  # the supply is open: the coils are off without the chips


def _chips(board, profile) -> dict:
    """Return the driver of each PWM chip that the profile names."""
    chips = {}
    for channel in profile.channels:
        if channel.chip not in chips:
            chips[channel.chip] = board.pwm(channel.chip)
    return chips


def _attitude(board, profile):
    """Return what knows where down is, or nothing of the kind where the profile names no sensor."""
    if not profile.imu_address:
        return Blind()
    return Attitude(board.imu(profile.imu_address), [channel.label for channel in profile.channels])
