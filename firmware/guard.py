"""Budgets and interlocks: whatever the orders say, these conditions switch every coil off.

Checked on every control step, none of them can be turned off over the wire. Independent of this file stand each
order's own end (channels), the lease (core) and the hardware behind the heartbeat (board).
"""

from firmware.sense import BOARD_MAX_DECIDEGC, BOARD_MIN_DECIDEGC
from protocol import codes

SETTLE_MS = 100  # readings are averages: a condition must last this long before it is believed
STRAY_MA = 25


class Guard:
    """Holds what is measured and estimated against the limits of the profile."""

    def __init__(self, profile, sense, channels, board) -> None:
        self.channel = 255  # of the fault that `check` returned last
        self.value = 0
        self._coil = profile.coil
        self._supply = profile.supply
        self._sense = sense
        self._channels = channels
        self._board = board
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
        if sense.current_ma <= STRAY_MA or self._channels.on_mask:
            self._stray_since_ms = now_ms
        elif now_ms - self._stray_since_ms > SETTLE_MS:
            return self.fault(codes.STRAY_CURRENT, sense.current_ma)
        if sense.supply_mv > self._supply.high_mv:
            return self.fault(codes.SUPPLY_HIGH, sense.supply_mv)
        if not powered:
            self._low_since_ms = now_ms
            return 0
        return self._powered(now_ms, sense)

    def _powered(self, now_ms: int, sense) -> int:
        """Return the code of what may only be wrong while the supply is on, or 0."""
        if sense.current_ma > self._supply.current_max_ma:
            return self.fault(codes.OVER_CURRENT, sense.current_ma)
        if sense.supply_mv >= self._supply.low_mv:
            self._low_since_ms = now_ms
        elif now_ms - self._low_since_ms > SETTLE_MS:
            return self.fault(codes.SUPPLY_LOW, sense.supply_mv)
        return self._heat(sense.hottest, sense.fullest) if sense.hottest >= 0 else 0

    def _heat(self, hottest: int, fullest: int) -> int:
        sense = self._sense
        if sense.temperature_millidegc[hottest] > self._coil.trip_decidegc * 100:
            return self.fault(codes.OVER_TEMPERATURE, sense.temperature_millidegc[hottest] // 100, hottest)
        if sense.heat_uj[fullest] > self._coil.heat_budget_mj * 1000:
            return self.fault(codes.HEAT_BUDGET, sense.heat_uj[fullest] // 1000, fullest)
        return 0

    def fault(self, code: int, value: int, channel: int = 255) -> int:
        """Keep what a fault is about and return its code."""
        self.value = value
        self.channel = channel
        return code
