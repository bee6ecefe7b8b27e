"""What a robot tells everybody on its CAN bus, unasked: its state, and two coils at a time.

Tools that know only frames of a fixed layout read these; the hosts of sessions have telemetry.

    beacons = Beacons(core, port)
    beacons.tell(now_ms)
"""

from protocol.canbus import ALL, identifier
from protocol.messages import BEACON, BEACON_COILS

BEACON_MS = 100
COILS_MS = 20
PROBE_MS = 1000  # while nobody is on the bus: somebody may have come


class Beacons:
    """The beacons of one core, sent through `port`."""

    def __init__(self, core, port) -> None:
        self._core = core
        self._port = port
        self._state_id = identifier(BEACON.number, port.node, ALL, True)
        self._coils_id = identifier(BEACON_COILS.number, port.node, ALL, True)
        self._told_ms = self._coils_ms = 0
        self._group = 0

    def tell(self, now_ms: int) -> None:
        """Send what is due."""
        awake = self._port.awake
        if now_ms - self._told_ms >= (BEACON_MS if awake else PROBE_MS):
            self._told_ms = now_ms
            self._port.tell(self._state_id, self._state())
        elif awake and self._core.channels.count and now_ms - self._coils_ms >= COILS_MS:
            self._coils_ms = now_ms
            self._port.tell(self._coils_id, self._coils())

    def _state(self) -> bytes:
        core = self._core
        return BEACON.pack(
            state=core.state, code=core.code, step=core.player.step,
            supply_mv=_word(core.sense.supply_mv), current_ma=_word(core.sense.current_ma),
        )  # fmt: skip

    def _coils(self) -> bytes:
        group, count = self._group, self._core.channels.count
        first = 2 * group
        second = first + 1 if first + 1 < count else -1
        self._group = group + 1 if first + 2 < count else 0
        return BEACON_COILS.pack(
            group=group, duty_a_percent=self._percent(first), duty_b_percent=self._percent(second),
            temperature_a_decidegc=self._decidegc(first), temperature_b_decidegc=self._decidegc(second),
        )  # fmt: skip

    def _percent(self, channel: int) -> int:
        return self._core.channels.duty_permille[channel] // 10 if channel >= 0 else 0

    def _decidegc(self, channel: int) -> int:
        return self._core.sense.temperature_millidegc[channel] // 100 if channel >= 0 else 0


def _word(value: int) -> int:
    return min(max(0, value), 0xFFFF)
