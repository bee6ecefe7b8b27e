"""One joint in the worst case of a plan: its order, where it may be, how long it has held."""

from __future__ import annotations

from dataclasses import dataclass

from host.gait.plan import Move, Orient, Press
from host.gait.trial.coiltrial import STEP_MS


@dataclass(slots=True)
class JointTrial:
    """One joint during the trial, and what it came to; `least` and `most` are the ends of its range."""

    least_centi: int
    most_centi: int
    moves: int = 0
    lowest_centi: int | None = None  # that it was told to go to, or may have been by an orient or a press
    highest_centi: int | None = None
    fastest_centi_per_s: int = 0
    held_ms: int = 0
    driven_ms: int = 0  # by orders, until they ended or others took their place
    order: Move | Orient | Press | None = None  # None: limp
    begin_ms: int = 0  # of its order, if every wait is over at once
    begin_most_ms: int = 0  # if every wait runs out
    low_centi: int = 0  # where it may have been when its move began, or be while it is oriented or pressed and after,
    high_centi: int = 0  # or be without an order

    def place(self, now_ms: int, most_ms: int) -> tuple[int, int]:
        """Return the lowest and the highest position at which it may be told to stand."""
        order = self.order
        if order is None or isinstance(order, Orient | Press):
            return self.low_centi, self.high_centi
        passed = (now_ms - self.begin_ms, most_ms - self.begin_most_ms)
        shares = [min(passed_ms, order.time_ms) for passed_ms in passed]
        ways = [(start, (order.target_centi - start) * share, order.time_ms)
                for start in (self.low_centi, self.high_centi) for share in shares]  # fmt: skip
        return min(start + way // time for start, way, time in ways), max(
            start - -way // time for start, way, time in ways
        )

    def held(self, most_ms: int) -> int:
        """Return for how long it has had no order, at most: up to the control step after that."""
        if self.order is None:
            return 0
        passed_ms = most_ms - self.begin_most_ms - self.order.time_ms
        return passed_ms + STEP_MS if passed_ms > 0 else 0

    def driven(self, most_ms: int) -> int:
        """Return for how long its order has driven it, at most."""
        return 0 if self.order is None else min(most_ms - self.begin_most_ms, self.order.time_ms)

    def raise_to(self, other: JointTrial) -> None:
        """Take over what is more in another one that is like this."""
        self.moves, self.driven_ms = max(self.moves, other.moves), max(self.driven_ms, other.driven_ms)
        self.held_ms = max(self.held_ms, other.held_ms)
        self.fastest_centi_per_s = max(self.fastest_centi_per_s, other.fastest_centi_per_s)
        if other.lowest_centi is not None and other.highest_centi is not None:
            self.reach(other.lowest_centi, other.highest_centi)

    def reach(self, low_centi: int, high_centi: int) -> None:
        """Count these positions among those that it was told."""
        lowest, highest = self.lowest_centi, self.highest_centi
        self.lowest_centi = low_centi if lowest is None else min(lowest, low_centi)
        self.highest_centi = high_centi if highest is None else max(highest, high_centi)
