"""One coil in the worst case of a plan: its order, its heat, its rest, in the firmware's arithmetic rounded up."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

from host.gait.plan import Fire
from host.limits import CoilLimits

STEP_MS = 5  # control step of the firmware


@dataclass(slots=True)
class CoilTrial:
    """One coil during the trial, and what it came to."""

    on_ms: int = 0
    energy_uj: int = 0
    orders: int = 0
    heat_peak_uj: int = 0
    longest_ms: int = 0  # on without a pause
    heat_uj: int = 0
    heat_at_ms: int = 0
    since_ms: int = 0
    begin_ms: int = 0
    end_ms: int = -(10**9)  # as the script says
    off_ms: int = 0  # when the control step notices it, at the latest
    power_uw: int = 0
    duty_permille: int = 0
    waits: int = 0
    order: Fire | None = None
    reach: int = 0  # mask of the coils that this one stands for
    others_uj: int = 0  # of a chosen coil: the most that one chosen before still holds
    others_at_ms: int = 0

    def raise_to(self, other: CoilTrial) -> None:
        """Take over what is more in another one that is like this: its sums, its heat."""
        self.on_ms, self.energy_uj = max(self.on_ms, other.on_ms), max(self.energy_uj, other.energy_uj)
        self.orders, self.heat_peak_uj = max(self.orders, other.orders), max(self.heat_peak_uj, other.heat_peak_uj)
        self.longest_ms = max(self.longest_ms, other.longest_ms)
        self.heat_uj, self.others_uj = max(self.heat_uj, other.heat_uj), max(self.others_uj, other.others_uj)
        self.order = self.order or other.order

    def cut(self, left_ms: int, had_ms: int) -> None:
        """Take it that its order, counted to its end already, has `had_ms` more and not the `left_ms` it had left."""
        self.heat_uj += energy_uj(self.power_uw, had_ms)
        self.heat_peak_uj = max(self.heat_peak_uj, self.heat_uj)
        self.on_ms -= left_ms - had_ms
        self.energy_uj -= energy_uj(self.power_uw, left_ms - had_ms)

    def shift(self, time_ms: int) -> None:
        """Have all that it did happen that much later."""
        self.since_ms, self.begin_ms = self.since_ms + time_ms, self.begin_ms + time_ms
        self.end_ms, self.off_ms = self.end_ms + time_ms, self.off_ms + time_ms
        self.heat_at_ms, self.others_at_ms = self.heat_at_ms + time_ms, self.others_at_ms + time_ms

    def rested_ms(self, limits: CoilLimits) -> int:
        """Return until when the coil must rest after its last time on."""
        if self.end_ms - self.since_ms + STEP_MS > limits.on_max_ms:
            return self.end_ms + limits.rest_ms + STEP_MS
        return self.end_ms

    def settle_others(self, now_ms: int, limits: CoilLimits) -> None:
        """Bring the heat of what a name has stood for before up to now."""
        if self.others_uj:
            self.others_uj = min(self.others_uj, heat_uj(self.others_uj, 0, now_ms - self.others_at_ms, limits))
        self.others_at_ms = now_ms


def heat_uj(heat_uj: int, power_uw: int, time_ms: int, limits: CoilLimits) -> int:
    """Return the heat after `time_ms`: the firmware's steps in closed form, with all they may round up."""
    leak_ms = limits.heat_leak_ms
    kept: float = (1 - STEP_MS / leak_ms) ** (time_ms / STEP_MS)
    goal_uj = power_uw * leak_ms / 1000 + leak_ms / STEP_MS
    return ceil(goal_uj + (heat_uj - goal_uj) * kept)


def energy_uj(power_uw: int, time_ms: int) -> int:
    """Return the energy of that power, rounded up."""
    return -(-power_uw * time_ms // 1000)
