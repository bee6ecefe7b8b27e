"""The self-test that stands before every ARM: is each coil whole, and does the supply switch switch?

One look per control step, one coil at a time, for about 2 ms each. With the supply open no current may flow through an
output that is on (else its switch is welded); with the supply on and every output off none either (else a MOSFET is
stuck); then each coil's resistance must be in its band, each joint's position one that its potentiometer gives, and a
load cell be there. The first that is not ends the test with everything off. A robot without coils has nothing to see a
welded switch by.
"""

from firmware.sense import STRAY_MA
from firmware.slot import PULSE_US
from protocol import codes

SWITCH_STEPS = 2  # ASSUMED: the supply's switch, or relay, has followed after 10 ms
WELDED_AT = SWITCH_STEPS
STRAY_AT = 2 * SWITCH_STEPS + 1
NO_JOINT = 255


class SelfTest:
    """One test at a time. When `done`, `code` is 0 or that of the fault, with its channel, value and limit."""

    def __init__(self, board, slot, channels, sense, resistance, monitor, profile, limbs=None) -> None:
        self.running = False
        self.done = False
        self.code = self.value = self.limit = 0
        self.channel = 255
        self._board = board
        self._slot = slot
        self._channels = channels
        self._sense = sense
        self._resistance = resistance
        self._monitor = monitor
        self._limbs = limbs
        self._low_mv = profile.supply.low_mv
        self._cold_millidegc = profile.coil.mf_millidegc
        self._without = 0
        self._turn = 0
        self._at = 0

    def begin(self, without: int) -> None:
        """Have every coil tested but these; nothing may be on."""
        self.running = True
        self.done = False
        self.code = self.value = self.limit = 0
        self.channel = 255
        self._without = without
        self._turn = 0
        self._at = self._tested_from(0)

    def cancel(self) -> None:
        """Forget the test; what it drives must be switched off by the caller."""
        self.running = self.done = False

    def step(self) -> None:
        """Do the next look; OSError when a chip does not answer, then the same look is next again."""
        if self._turn == 0:
            self._board.power(False)
            self._monitor.begin()
        elif self._turn == WELDED_AT:
            self._look_welded()
        elif self._turn == STRAY_AT:
            self._look_stray()
        elif self._turn > STRAY_AT:
            self._look_at_coil()
        self._turn += 1

    def _look_welded(self) -> None:
        if self._at < self._channels.count:
            self._slot.measure(self._at)
            current_ma = self._monitor.seen_ma()
            self._slot.end()
            if current_ma > STRAY_MA:
                self._fail(codes.CONTACTOR, 255, current_ma, STRAY_MA)
                return
        self._board.power(True)

    def _look_stray(self) -> None:
        current_ma = self._slot.idle_ma()
        self._slot.end()
        if current_ma > STRAY_MA:
            self._fail(codes.STRAY_CURRENT, 255, current_ma, STRAY_MA)

    def _look_at_coil(self) -> None:
        channel = self._at
        if channel < self._channels.count:
            self._sense.pulse(channel, 1000, PULSE_US)
            mohm = self._slot.measure(channel)
            supply_mv = self._slot.seen_mv()
            self._slot.end()
            self._judge(channel, mohm, supply_mv)
            self._at = self._tested_from(channel + 1)
        if self.running and self._at >= self._channels.count:
            self._look_at_joints()

    def _look_at_joints(self) -> None:
        channel = self._limbs.broken_channel() if self._limbs else NO_JOINT
        load = self._limbs.load if self._limbs else None
        if channel != NO_JOINT:
            self._fail(codes.JOINT, channel, self._limbs.sense.counts(channel))
        elif load and load.broken:
            self._fail(codes.LOAD_CELL, self._channels.count, load.counts)
        else:
            self._finish()

    def _judge(self, channel: int, mohm: int, supply_mv: int) -> None:
        is_cold = self._sense.temperature_millidegc[channel] < self._cold_millidegc
        code = self._resistance.verdict(mohm, is_cold)
        if supply_mv < self._low_mv // 2:
            self._fail(codes.SUPPLY_LOW, 255, supply_mv, self._low_mv)
        elif code:
            self._fail(code, channel, mohm, self._resistance.limit_mohm(code, is_cold))
        else:
            self._resistance.take(channel, mohm)
            if is_cold:
                self._resistance.refer(channel, mohm)
            self._sense.weigh(channel, self._resistance.hot_mohm(channel))

    def _fail(self, code: int, channel: int, value: int, limit: int = 0) -> None:
        self.code, self.channel, self.value, self.limit = code, channel, value, limit
        self._board.power(False)
        self._monitor.begin()  # ends the alert that a shorted coil has raised
        self._finish()

    def _finish(self) -> None:
        self.running = False
        self.done = True

    def _tested_from(self, channel: int) -> int:
        while channel < self._channels.count and self._without >> channel & 1:
            channel += 1
        return channel
