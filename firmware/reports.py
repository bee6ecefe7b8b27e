"""What the core tells its host: events, surely and once; telemetry, at the period that was asked for."""

import struct

from protocol import codes, messages

ROOM = 8  # places of the link's queue that events leave to answers


class Reports:
    """The voice of one core."""

    def __init__(self, core) -> None:
        self.period_ms = 0  # of telemetry, 0: none
        self._core = core
        self._player, self._channels, self._attitude = core.player, core.channels, core.attitude
        self._due_ms = 0
        self._step = 0
        self._records = bytearray(4 * core.channels.count)

    def event(self, event: int, code: int = 0, channel: int = 255, value: int = 0) -> None:
        """Tell the host what happened, unless it has stopped listening; what has a code is kept as well."""
        core = self._core
        if code:
            core.records.note(self._now(), code, channel, value, core.was)
        if core.link.room() > ROOM:
            payload = messages.EVENT.pack(
                event=event, code=code, step=core.player.step, channel=channel, value=value, now_ms=self._now()
            )
            core.link.send(messages.EVENT.number, payload, core.now_ms)

    def tell(self) -> None:
        """Send what the control step left to tell: a step, coils cut off, a lost sensor, telemetry that is due."""
        if self._player.step != self._step:
            self._step = self._player.step
            if self._step:
                self.event(messages.STEP)
        if self._channels.cut_off_mask:
            self._cut_offs(self._core)
        if self._attitude.lost:
            self._attitude.lost = False
            self.event(messages.LOST, codes.ATTITUDE)
        if self.period_ms and self._core.now_ms - self._due_ms >= 0:
            self._due_ms = self._core.now_ms + self.period_ms
            self._core.link.post(messages.TELEMETRY.number, self._telemetry(self._core))

    def coils(self) -> bytes:
        """Return what the resistances say, as `coils` carries it."""
        resistance, told = self._core.control.resistance, b""
        for channel in range(self._core.channels.count):
            told += struct.pack(
                "<HHhh", resistance.measured_mohm(channel) // 10, resistance.martensite_permille(channel),
                resistance.least_decidegc(channel), resistance.most_decidegc(channel),
            )  # fmt: skip
        return told

    def _cut_offs(self, core) -> None:
        for channel in range(core.channels.count):
            if core.channels.cut_off_mask >> channel & 1:
                self.event(messages.CUT_OFF, 0, channel, core.sense.temperature_millidegc[channel] // 100)
        core.channels.cut_off_mask = 0

    def _telemetry(self, core) -> bytes:
        records = self._records
        for channel in range(core.channels.count):
            duty = core.channels.duty_permille[channel]
            temperature = core.sense.temperature_millidegc[channel] // 100
            records[4 * channel] = duty & 0xFF
            records[4 * channel + 1] = duty >> 8
            records[4 * channel + 2] = temperature & 0xFF
            records[4 * channel + 3] = temperature >> 8 & 0xFF
        return messages.TELEMETRY.pack(
            now_ms=self._now(), state=core.state, step=core.player.step, supply_mv=core.sense.supply_mv,
            current_ma=core.sense.current_ma, board_decidegc=core.sense.board_decidegc,
            roll_decideg=core.attitude.roll_decideg(), pitch_decideg=core.attitude.pitch_decideg(),
            down=core.attitude.down_channel(), channels=records,
        )  # fmt: skip

    def _now(self) -> int:
        return self._core.now_ms & 0xFFFFFFFF
