"""What the core tells its host: events, surely and once; telemetry, at the period that was asked for."""

import struct

from firmware.subscriptions import Subscriptions
from protocol import codes, messages

ROOM = 8  # places of the link's queue that events leave to answers
STOPS_STEPS = (messages.ABORTED, messages.TRIP, messages.DISARMED)


class Reports:
    """The voice of one core."""

    def __init__(self, core) -> None:
        self.subscriptions = Subscriptions(core)
        self._core = core
        self._player, self._channels, self._attitude = core.player, core.channels, core.attitude
        self._step = 0
        self._paused = False

    def clock(self, payload: bytes) -> None:
        """Answer a question for the clock."""
        now_ms = self._now()
        try:
            host_us = messages.CLOCK_REQUEST.unpack(payload).host_us
        except ValueError:
            return
        told = messages.CLOCK.pack(host_us=host_us, received_ms=now_ms, sent_ms=now_ms)
        self._core.link.post(messages.CLOCK.number, told)

    def event(self, event: int, code: int = 0, channel: int = 255, value: int = 0, step: int = -1) -> None:
        """Tell the host what happened, unless it has stopped listening; what has a code is kept as well."""
        core = self._core
        if self._player.notes:
            self._notes()
        if event in STOPS_STEPS:
            self._step = 0
            self._paused = False
        if code and not (event == messages.ABORTED and self._player.failed):  # it was kept when it was caught
            core.records.note(self._now(), code, channel, value, core.was)
        if core.link.room() > ROOM:
            payload = messages.EVENT.pack(
                event=event, code=code, step=core.player.step if step < 0 else step, channel=channel, value=value,
                now_ms=self._now(),
            )  # fmt: skip
            core.link.send(messages.EVENT.number, payload, core.now_ms)

    def tell(self) -> None:
        """Send what the control step left to tell: notes, a step, a pause, coils cut off, a lost sensor."""
        if self._player.news:
            self._news()
        if self._player.step != self._step:
            self.step_done()
            self._step = self._player.step
            if self._step:
                self.event(messages.STEP)
        if self._channels.cut_off_mask:
            self._cut_offs(self._core)
        if self._attitude.lost:
            self._attitude.lost = False
            self.event(messages.LOST, codes.ATTITUDE)

    def telemetry(self, room: int) -> bytes:
        """Return the frames of the records that are due, as far as there is room for them."""
        link, now_ms, out = self._core.link, self._core.now_ms, b""
        while True:
            record = self.subscriptions.record(now_ms, room - len(out))
            if not record:
                return out
            link.post(messages.TELEMETRY.number, record)
            out += link.poll(now_ms, room - len(out))
            if len(self.subscriptions.active) == 1:
                return out  # the next one is due later

    def step_done(self) -> None:
        """Tell that the step told last has ended: all its ops have run, or the program has ended."""
        if self._step:
            self.event(messages.STEP_DONE, step=self._step)
            self._step = 0

    def coils(self) -> bytes:
        """Return what the resistances say, as `coils` carries it."""
        resistance, told = self._core.control.resistance, b""
        for channel in range(self._core.channels.count):
            told += struct.pack(
                "<HHhh", resistance.measured_mohm(channel) // 10, resistance.martensite_permille(channel),
                resistance.least_decidegc(channel), resistance.most_decidegc(channel),
            )  # fmt: skip
        return told

    def _news(self) -> None:
        player = self._player
        player.news = False
        if player.notes:
            self._notes()
        if player.paused or self._paused:  # both: it went through a step that takes no time
            self._paused = player.paused
            if self._core.state == messages.RUNNING:
                self.event(messages.PAUSED if player.paused else messages.RESUMED)

    def _notes(self) -> None:
        """Tell the notes that were passed: before what came after them."""
        count, self._player.notes = self._player.notes, 0
        for place in range(count):
            self.event(messages.NOTED, step=self._player.noted[place])

    def _cut_offs(self, core) -> None:
        for channel in range(core.channels.count):
            if core.channels.cut_off_mask >> channel & 1:
                self.event(messages.CUT_OFF, 0, channel, core.sense.temperature_millidegc[channel] // 100)
        core.channels.cut_off_mask = 0

    def _now(self) -> int:
        return self._core.now_ms & 0xFFFFFFFF
