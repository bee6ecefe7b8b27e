"""Measures in turn, while the robot is armed: each coil that is on, then whether nothing flows with every output off.

One sense slot every SLOT_EVERY control steps, so that it costs 0.6 % of the time. When the mean current is more than
the orders explain, the slot with every output off comes at once, then the next coil of the round, and so on: only
what they measure is a fault. So the tolerance of that sum may be narrow, and neither phase changes, ramps nor aliasing
of the averages can trip the robot.
"""

from firmware.channels import NONE, bits
from firmware.sense import STRAY_MA
from firmware.slot import PULSE_US, WRITE_US
from protocol import codes

SLOT_EVERY = 64  # control steps
DOUBT_AFTER = 16  # control steps between two slots, if there is a doubt
DOUBTS_MAX = 5  # readings of the mean current, one every 10 ms, that nothing explains
TOLERANCE = 8  # an eighth: 0.5 % aliasing, 8 % of phase since the coil was measured, 2 % of stretch


class Patrol:
    """The rounds of one robot; `channel` and `value` are those of the last fault."""

    def __init__(self, slot, channels, sense, resistance, profile) -> None:
        self.channel = 255
        self.value = 0
        self._slot = slot
        self._channels = channels
        self._sense = sense
        self._resistance = resistance
        self._wiring_mohm = profile.coil.wiring_mohm
        self._faint_mv = profile.supply.low_mv // 2
        self._since = 0
        self._last = NONE
        self._doubts = 0
        self._asked = False  # whether the slot with every output off was the last one, for a doubt
        self._mohm = 0

    def step(self) -> int:
        """Do what this control step is there for; return the code of a fault, or 0."""
        self._since += 1
        if not self._channels.on_mask:
            self._doubts = 0
            return 0
        if self._sense.current_fresh:
            self._doubt(self._sense.current_ma)
        if self._since < DOUBT_AFTER:
            return 0
        doubted = self._doubts >= DOUBTS_MAX
        if doubted and not self._asked:
            self._asked = True
            return self._look_at(NONE)
        if not doubted and self._since < SLOT_EVERY:
            return 0
        self._asked = False
        self._last = self._next()
        return self._look_at(self._last)

    def expected_ma(self) -> int:
        """Return the mean current that the orders explain, with resistances as measured last."""
        duty_permille, mohm = self._channels.duty_permille, self._resistance.mohm
        supply_mv, wiring_mohm = self._sense.supply_mv, self._wiring_mohm
        total, mask, channel = 0, self._channels.on_mask, 0
        while mask:
            if mask & 1:
                total += duty_permille[channel] * supply_mv // (mohm[channel] + wiring_mohm)
            mask >>= 1
            channel += 1
        return total

    def _doubt(self, current_ma: int) -> None:
        expected_ma = self.expected_ma()
        unexplained = current_ma > expected_ma + expected_ma // TOLERANCE + STRAY_MA
        self._doubts = self._doubts + 1 if unexplained else 0

    def _next(self) -> int:
        """Return the next coil that is on, or NONE when the round is done."""
        for channel in range(self._last + 1, self._channels.count):
            if self._channels.on_mask >> channel & 1:
                return channel
        return NONE

    def _look_at(self, channel: int) -> int:
        self._since = 0
        self._doubts = 0
        code = self._nothing_flows() if channel == NONE else self._coil(channel)
        self._slot.end()
        return code

    def _nothing_flows(self) -> int:
        """Return EXCESS_CURRENT if current flows with every output off, measured twice."""
        self.channel = 255
        self.value = self._slot.idle_ma()
        if self.value > STRAY_MA:
            self.value = self._slot.idle_ma()
        return codes.EXCESS_CURRENT if self.value > STRAY_MA else 0

    def _coil(self, channel: int) -> int:
        """Measure a coil, a second time before it is called broken; look whether it was another one that took more."""
        code = self._measured(channel) and self._measured(channel)
        if code == codes.COIL_SHORT and self._nothing_flows():
            return codes.EXCESS_CURRENT
        self.channel = channel
        self.value = self._mohm
        return code

    def _measured(self, channel: int) -> int:
        rest_permille = 1000 - self._channels.duty_permille[channel]
        self._sense.pulse(channel, rest_permille, PULSE_US + WRITE_US * bits(self._channels.on_mask))
        self._mohm = self._slot.measure(channel)
        if self._slot.seen_mv() < self._faint_mv:
            return 0  # the guard has its own word about that
        code = self._resistance.verdict(self._mohm)
        if not code:
            self._resistance.take(channel, self._mohm)
        return code
