"""Stands for the coils of a robot that no model is known of: time passes, nothing is said of temperatures."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from host.predictors import Passed


class Blind:
    """As many coils as a robot has, none of them ever warm."""

    def __init__(self, labels: Sequence[str], spare: int) -> None:
        self.labels: Sequence[str] = labels
        self.degc = self.energy_mj = np.zeros(len(labels) + spare)
        self._trace = np.zeros((0, len(labels) + spare + 1))

    def restart(self) -> None:
        """Do nothing: they are cold."""

    def copy(self, place: int, index: int) -> None:
        """Do nothing: one coil is as the other."""

    def advance(
        self,
        duty_permille: Sequence[int],
        time_ms: int,
        limit_degc: Sequence[float] | None = None,
        kept: int = 0,
        until: tuple[int, bool, float, bool] | None = None,
        every_ms: int = 0,
    ) -> Passed:
        """Let all of the time pass."""
        return Passed(time_ms, self.degc, self.degc, self.degc, self._trace)
