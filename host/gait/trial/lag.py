"""How late a plan may be: a control step takes so many ops and no more, and what is due at one time may be more."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from host.gait.plan import Delay, Guard, Loop, OnFault, Op, Wait
from host.gait.trial.coiltrial import STEP_MS

OPS_PER_STEP = 32  # of the firmware's sequencer


@dataclass(slots=True)
class Lag:
    """The ops that may still be waiting for their turn, and by how much waits began late for it."""

    late_ms: int = 0
    behind: int = 0
    passed_ms: int = 0  # since the first of them was due
    peak_ms: int = 0  # the most by which a single op came after it was due

    def total_ms(self) -> int:
        """Return by how much the plan is late in all."""
        return self.late_ms + self._waiting_ms()

    def play(self, ops: Iterable[Op]) -> Lag:
        """Let these ops come due; of a loop two turns, which the others are like."""
        step = 0
        for op in ops:
            if isinstance(op, Loop):
                self._loop(op)
                continue
            if isinstance(op, OnFault):
                self.play(op.body)
                continue
            self.behind += 1
            if not isinstance(op, Guard):
                self.behind += op.step != step
                step = op.step
            self.peak_ms = max(self.peak_ms, self._waiting_ms())
            if isinstance(op, Delay):
                self._pass(op.time_ms)
            elif isinstance(op, Wait):
                # Its time is counted from when it was due; what comes next is counted from when it is over.
                self.late_ms, self.behind, self.passed_ms = self.total_ms(), 1, 0
        return self

    def _loop(self, loop: Loop) -> None:
        self.behind += 1
        for _ in range(min(loop.count, 2)):
            late_ms, behind = self.late_ms, self.behind
            self.play(loop.body)
            self.behind += 1
        if loop.count > 2:
            self.late_ms += (loop.count - 2) * (self.late_ms - late_ms)
            self.behind += (loop.count - 2) * max(self.behind - behind, 0)
            self.peak_ms = max(self.peak_ms, self._waiting_ms())

    def _waiting_ms(self) -> int:
        """Return for how long the last of the ops that are due waits for its turn."""
        return max(self.behind - 1, 0) // OPS_PER_STEP * STEP_MS

    def _pass(self, time_ms: int) -> None:
        """Let the steps pass that lie within a time, wherever it begins."""
        self.passed_ms += time_ms
        self.behind = max(0, self.behind - self.passed_ms // STEP_MS * OPS_PER_STEP)
        self.passed_ms = self.passed_ms % STEP_MS if self.behind else 0
