"""The control step: sensing, guarding, sequencing, driving, measuring. It never allocates memory.

It holds the chips and all that looks at them or drives them; who may order what, and what the host is told, is the
core's. An error of a chip is answered by one more try, then by a fault.
"""

from firmware.attitude import Attitude, Blind
from firmware.channels import NONE, Channels, Refused
from firmware.guard import Guard
from firmware.patrol import Patrol
from firmware.player import GUARDED, LOST, Player
from firmware.resistance import MOST_MOHM, Resistance
from firmware.selftest import SelfTest
from firmware.sense import Sense
from firmware.slot import Slot
from protocol import codes, messages

CHECK_EVERY = 64  # control steps between two looks at the chips' settings
ALERT_PERMILLE = 1125  # of the supply's highest current: the guard's own limit comes first where it is slow


class Control:
    """Everything between the chips and the orders."""

    def __init__(self, board, profile) -> None:
        chips = _chips(board, profile)
        outputs = [(chips[coil.chip], coil.output) for coil in profile.coils]
        supply = profile.supply
        self.board = board
        self.monitor = board.monitor(supply.shunt_mohm, supply.current_max_ma * ALERT_PERMILLE // 1000)
        self.chips = list(chips.values())
        self.channels = Channels(self.chips, outputs, profile.coil, supply.at_once_max)
        self.sense = Sense(board, self.monitor, self.channels.count, profile)
        self.guard = Guard(profile, self.sense, self.channels, board)
        self.attitude = _attitude(board, profile)
        self.limbs = _limbs(board, profile)
        self.resistance = Resistance(self.channels.count, profile.coil)
        self.player = Player(self.channels, self.sense, self.attitude, self.limbs, self.resistance)
        self.slot = Slot(board, self.monitor, self.channels, self.sense, profile.coil.wiring_mohm, MOST_MOHM)
        self.patrol = Patrol(self.slot, self.channels, self.sense, self.resistance, profile)
        self.selftest = SelfTest(
            board, self.slot, self.channels, self.sense, self.resistance, self.monitor, profile, self.limbs
        )  # fmt: skip
        self._turn = 0

    def begin(self, now_ms: int) -> None:
        """Set up every chip with all outputs off and the supply open; OSError when one does not answer."""
        self.board.power(False)
        self.channels.all_off(now_ms)
        for chip in self.chips:
            chip.begin()
        self.channels.forget_written()
        self.monitor.begin()
        if not self.attitude.known:
            self.attitude.begin(now_ms)

    def all_off(self, now_ms: int) -> None:
        """Switch everything off as far as the chips answer."""
        self.board.power(False)
        self.selftest.cancel()
        self.channels.without_mask = 0
        self.channels.all_off(now_ms)
        if self.limbs:
            self.limbs.all_off()
        try:
            self.channels.shut()
        except OSError:
            pass  # the supply is open: the coils are off without the chips

    def tried(self, now_ms: int, state: int) -> int:
        """Run the control step; a chip that does not answer is asked once more, then all is switched off."""
        try:
            return self.step(now_ms, state)
        except OSError:
            pass
        try:
            return self.step(now_ms, state)
        except OSError as error:
            return self.guard.fault(codes.CHIP, error.args[0])

    def step(self, now_ms: int, state: int) -> int:
        """Sense, guard, sequence, drive and measure once; return the code of a fault, or 0."""
        sense, channels = self.sense, self.channels
        sense.update(now_ms, channels.on_mask, channels.duty_permille)
        if self.slot.begun:  # an error has left it open
            self.slot.end()
        sense.read()
        self.attitude.look(now_ms)
        if self.limbs:
            self.limbs.look(now_ms)
        powered = messages.ARMED <= state <= messages.RUNNING or self.selftest.running
        code = self.guard.check(now_ms, powered)
        if not code and state == messages.RUNNING:
            code = self._play(now_ms)
        too_long = channels.update(now_ms, sense.temperature_millidegc) if channels.on_mask else NONE
        if too_long >= 0 and not code:
            code = self.guard.fault(codes.ON_TOO_LONG, channels.on_for_ms(too_long, now_ms), too_long)
        if self.limbs and not code:
            code = self._drive_limbs(now_ms, powered and not self.selftest.running)
        if powered and not code:
            code = self._measure()
        self._turn += 1
        if self._turn >= CHECK_EVERY and state != messages.TRIPPED:
            self._check_chips(now_ms)
        channels.write()
        self.board.beat()
        return code

    def driven_mask(self) -> int:
        """Return the channels of all coils that are on and joints that are driven."""
        return self.channels.on_mask | (self.limbs.joints.on_mask if self.limbs else 0)

    def _drive_limbs(self, now_ms: int, powered: bool) -> int:
        code = self.limbs.drive(now_ms, powered)
        self.guard.joints_draw = self.limbs.may_draw(now_ms)
        return code and self.guard.fault(code, self.limbs.value, self.limbs.channel)

    def _measure(self) -> int:
        """Go on with the self-test, whose findings refuse the arming, or with the patrol, whose findings trip."""
        if self.selftest.running:
            if not self.guard.joints_draw:  # else it would take that for a MOSFET that is stuck
                self.selftest.step()
            return self._doubted(self.selftest.code) and self._pressed()
        found = 0 if self.guard.joints_draw else self.patrol.step()  # it would take the servos' current for a coil's
        if not found:
            return 0
        self._doubted(found)
        return self._pressed() or self.guard.fault(found, self.patrol.value, self.patrol.channel)

    def _doubted(self, found: int) -> int:
        """Return what was found, and have the chips looked at: it may be their doing."""
        if found:
            self._turn = CHECK_EVERY
        return found

    def _pressed(self) -> int:
        """Return the code of an emergency stop that was pressed in the middle of a measurement, or 0."""
        return 0 if self.board.estop_closed() else codes.ESTOP

    def _play(self, now_ms: int) -> int:
        try:
            outcome = self.player.run(now_ms)
        except Refused as refused:
            return self.guard.fault(codes.REFUSED_STEP, refused.value, refused.channel)
        return codes.GUARD if outcome == GUARDED else codes.ATTITUDE if outcome == LOST else 0

    def _check_chips(self, now_ms: int) -> None:
        """Look in turn whether a chip has lost its settings, as after a brown-out.

        With nothing on, say so again: a write that went astray may have left a coil on too weakly for the guard.
        """
        for chip in self.chips:
            if not chip.configured():
                raise OSError(chip.address)
        if not self.monitor.configured():
            raise OSError(self.monitor.address)
        if not self.channels.on_mask:
            self.channels.shut()
        self.attitude.check(now_ms)
        self._turn = 0


def _chips(board, profile) -> dict:
    """Return the driver of each PWM chip that the profile names."""
    chips = {}
    for coil in profile.coils:
        if coil.chip not in chips:
            chips[coil.chip] = board.pwm(coil.chip)
    return chips


def _limbs(board, profile):
    """Return what turns joints, or None where the profile names none; what it takes is loaded only here."""
    if not profile.joints:
        return None
    from firmware.limbs import Limbs  # noqa: PLC0415

    return Limbs(board, profile)


def _attitude(board, profile):
    """Return what knows where down is, or nothing of the kind where the profile names no sensor."""
    if not profile.imu_address:
        return Blind()
    return Attitude(board.imu(profile.imu_address), [coil.label for coil in profile.coils])
