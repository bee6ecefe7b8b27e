"""Budgets and interlocks: whatever the orders say, these conditions switch everything off.

Checked on every control step, none of them can be turned off over the wire. Independent of this file stand each
order's own end (channels), the lease (core) and the hardware behind the heartbeat (board).
"""

from firmware.sense import BOARD_MAX_DECIDEGC, BOARD_MIN_DECIDEGC, STRAY_MA
from protocol import codes

SETTLE_MS = 100  # readings are averages: a condition must last this long before it is believed


class Guard:
    """Holds what is measured and estimated against the limits of the profile."""

    def __init__(self, profile, sense, channels, board) -> None:
        self.channel = 255  # of the fault that `check` returned last
        self.value = 0
        self._trip_millidegc = profile.coil.trip_decidegc * 100
        self._budget_uj = profile.coil.heat_budget_mj * 1000
        self._current_max_ma = profile.supply.current_max_ma
        self._low_mv = profile.supply.low_mv
        self._high_mv = profile.supply.high_mv
        self._sense = sense
        self._channels = channels
        self._board = board
        self.joints_draw = False  # whether servos may take current
        self._stray_since_ms = 0
        self._low_since_ms = 0

    def check(self, now_ms: int, powered: bool) -> int:
        """Return the code of the fault that holds now, or 0; its channel and value stand in the attributes."""
        sense = self._sense
        self.channel = 255
        self.value = 0
        if not self._board.estop_closed():
            return codes.ESTOP
        if self._board.alert():
            return self.fault(codes.ALERT, sense.current_ma)
        if not BOARD_MIN_DECIDEGC <= sense.board_decidegc <= BOARD_MAX_DECIDEGC:
            return self.fault(codes.SENSOR, sense.board_decidegc)
        if sense.current_ma <= STRAY_MA or self._channels.on_mask or self.joints_draw:
            self._stray_since_ms = now_ms
        elif now_ms - self._stray_since_ms > SETTLE_MS:
            return self.fault(codes.STRAY_CURRENT, sense.current_ma)
        if sense.supply_mv > self._high_mv:
            return self.fault(codes.SUPPLY_HIGH, sense.supply_mv)
        if not powered:
            self._low_since_ms = now_ms
            return 0
        return self._powered(now_ms)

    def _powered(self, now_ms: int) -> int:
        """Return the code of what may only be wrong while the supply is on, or 0."""
        sense = self._sense
        if sense.current_ma > self._current_max_ma:
            return self.fault(codes.OVER_CURRENT, sense.current_ma)
        if sense.supply_mv >= self._low_mv:
            self._low_since_ms = now_ms
        elif now_ms - self._low_since_ms > SETTLE_MS:
            return self.fault(codes.SUPPLY_LOW, sense.supply_mv)
        hottest, fullest = sense.hottest, sense.fullest
        if hottest < 0:
            return 0
        if sense.temperature_millidegc[hottest] > self._trip_millidegc:
            return self.fault(codes.OVER_TEMPERATURE, sense.temperature_millidegc[hottest] // 100, hottest)
        if sense.heat_uj[fullest] > self._budget_uj:
            return self.fault(codes.HEAT_BUDGET, sense.heat_uj[fullest] // 1000, fullest)
        return 0

    def fault(self, code: int, value: int, channel: int = 255) -> int:
        """Keep what a fault is about and return its code."""
        self.value = value
        self.channel = channel
        return code
