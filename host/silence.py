"""When a robot that says nothing is asked whether it is still there, and when it is given up.

Time counts as silence only as far as the line was read: a host that was held up blames nobody. A robot is silent when
an answer or telemetry is due and no intact frame of the session comes.

    silence = Silence(now_ms)
    silence.read_ms = now_ms     # after each read of the line
    silence.heard(now_ms)        # an intact frame of the session
    silence.given_up(oldest)     # why the robot is given up, or None
"""

from __future__ import annotations

from host.answers import Asked

PROBE_MS = 500  # of silence, or without an answer, before hello is said again
SILENT_MS = 2000
ANSWER_MS = 5000
MARGIN_MS = 50  # that telemetry may come late


class Silence:
    """What is expected of the robot, and since when it has been missing."""

    def __init__(self, now_ms: int) -> None:
        self.read_ms = now_ms  # when the line was last read: what arrives now was not there then
        self.heard_ms: int | None = None  # when the last intact frame of the session came, or its last telemetry
        self.patience_ms = 0  # how much longer than usual nothing may come, on a line that may break and come back
        self._periods_ms: dict[int, int] = {}  # of telemetry, by subscription
        self._period_ms = 0  # how often it comes at least, 0: none is due
        self._probed_ms = now_ms

    @property
    def expects(self) -> bool:
        """Return whether any telemetry is due at all."""
        return self._period_ms > 0

    def heard(self, time_ms: int | None) -> None:
        """Note when an intact frame came; None: none did."""
        if time_ms is not None:
            self.heard_ms = time_ms if self.heard_ms is None else max(self.heard_ms, time_ms)

    def on_time(self) -> bool:
        """Return whether no telemetry is overdue, so that what a restarted robot would not understand may be sent."""
        if not self._period_ms or self.heard_ms is None:
            return True
        return self.read_ms - self.heard_ms <= 2 * self._period_ms + MARGIN_MS

    def expect(self, slot: int, period_ms: int) -> None:
        """Expect telemetry of a subscription that often; 0: not any more."""
        self._periods_ms[slot] = period_ms
        self._period_ms = min((each for each in self._periods_ms.values() if each), default=0)

    def given_up(self, oldest: Asked | None) -> str | None:
        """Return what the robot did to be given up, or None."""
        if self.silent_ms(oldest) >= SILENT_MS + self.patience_ms:
            return "has fallen silent"
        if oldest and self._waited_ms(oldest) >= ANSWER_MS + self.patience_ms:
            return f"has not answered {oldest.name} for {ANSWER_MS // 1000} s"
        return None

    def probes(self, now_ms: int, oldest: Asked | None, doubts: bool) -> bool:
        """Return whether the robot is to be asked now who it is: because it is silent, or because of these doubts."""
        missing_ms = max(self._waited_ms(oldest), self.silent_ms(oldest))
        if (missing_ms < PROBE_MS and not doubts) or now_ms - self._probed_ms < PROBE_MS:
            return False
        self._probed_ms = now_ms
        return True

    def silent_ms(self, oldest: Asked | None) -> int:
        """Return for how long no intact frame of this session had come, answer or telemetry, that should have."""
        if self.heard_ms is None:
            return self._waited_ms(oldest)
        quiet_ms = self.read_ms - self.heard_ms
        missing_ms = quiet_ms - max(0, 2 * self._period_ms - PROBE_MS) if self._period_ms else 0
        return max(missing_ms, min(quiet_ms, self._waited_ms(oldest)))

    def _waited_ms(self, oldest: Asked | None) -> int:
        """Return for how long the oldest order had waited for its answer when the line was last read."""
        return self.read_ms - oldest.at_ms if oldest else 0
