"""The two clocks of a worst case: for coils that have no time to cool, and for joints that are left alone for long."""

from __future__ import annotations

from dataclasses import dataclass

from host.gait.plan import Delay, Op, Wait
from host.gait.trial.coiltrial import STEP_MS


@dataclass(slots=True)
class Clock:
    """How far a plan has come if every wait is over at once, and if every wait runs out."""

    now_ms: int = 0
    most_ms: int = 0
    waits: int = 0
    sooner_ms: int = 0  # by how much another way comes here before this one

    @property
    def least_ms(self) -> int:
        """Return when the plan comes here at the earliest."""
        return self.now_ms - self.sooner_ms

    def go_to(self, other: Clock) -> None:
        """Stand where another clock stood."""
        self.now_ms, self.most_ms = other.now_ms, other.most_ms
        self.waits, self.sooner_ms = other.waits, other.sooner_ms

    def pass_by(self, op: Op) -> None:
        """Let the time of one op pass; a wait may end one control step late."""
        if isinstance(op, Delay):
            self.now_ms += op.time_ms
            self.most_ms += op.time_ms
        elif isinstance(op, Wait):
            self.waits += 1
            self.most_ms += op.timeout_ms + STEP_MS

    def run_out(self, op: Wait) -> None:
        """Let all the time of a wait pass."""
        self.now_ms += op.timeout_ms
        self.most_ms += op.timeout_ms + STEP_MS
