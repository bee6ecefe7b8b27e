"""Plays a plan in its worst case: every wait for a condition over at once, so that no coil has time to cool.

The arithmetic is the firmware's, rounded against the script: power from the nominal supply, the heat budget as energy
that leaks with its own time constant, orders that end on the control step after their time. Cut-offs are taken as never
reached. Loops are played until their turns repeat themselves, so that ten thousand turns cost no more than a few.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from math import ceil

from host.gait.diagnostics import Problems
from host.gait.plan import Delay, Fire, Loop, Op, Wait
from host.profile import Profile

STEP_MS = 5  # control step of the firmware
EVENTS_MAX = 100_000


class TooLong(Exception):
    """A plan whose worst case takes too much work; `op` is where it was given up."""

    def __init__(self, op: Op) -> None:
        super().__init__()
        self.op = op


@dataclass(slots=True)
class CoilTrial:
    """One coil during the trial, and what it came to."""

    on_ms: int = 0
    energy_uj: int = 0
    orders: int = 0
    heat_peak_uj: int = 0
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


class Trial:
    """The worst case of a plan for the robot of `profile`; what breaks a limit is added to `problems`."""

    def __init__(self, profile: Profile, problems: Problems) -> None:
        self.coils = [CoilTrial() for _ in profile.labels]
        self.now_ms = 0
        self.tail_ms = 0  # how long coils are on after the last op
        self.at_once_peak = 0
        self.current_peak_ma = 0
        supply_mv, coil_mohm = profile.supply_mv, profile.coil.resistance_mohm
        loop_mohm = coil_mohm + profile.coil.wiring_mohm
        self.full_ma = ceil(Fraction(1000 * supply_mv, loop_mohm))
        self.full_uw = ceil(Fraction(1000 * supply_mv * supply_mv * coil_mohm, loop_mohm * loop_mohm))
        self._profile, self._limits, self._problems = profile, profile.coil, problems
        self._waits = 0
        self._left = EVENTS_MAX

    def play(self, plan: Iterable[Op]) -> None:
        """Play all of it, and let every coil end."""
        self._run(plan)
        self.tail_ms = max(0, *(coil.off_ms - self.now_ms for coil in self.coils))
        self.now_ms += self.tail_ms
        for channel in range(len(self.coils)):
            self._settle(channel)

    def _run(self, ops: Iterable[Op]) -> None:
        for op in ops:
            self._left -= 1
            if self._left < 0:
                raise TooLong(op)
            if isinstance(op, Fire):
                self._fire(op)
            elif isinstance(op, Delay):
                self.now_ms += op.time_ms
            elif isinstance(op, Wait):
                self._waits += 1
            elif isinstance(op, Loop):
                self._loop(op)

    def _loop(self, loop: Loop) -> None:
        """Play turns until one leaves everything as it found it; the rest are its copies."""
        before = self._state()
        for turn in range(loop.count):
            start_ms = self.now_ms
            sums = [(coil.on_ms, coil.energy_uj, coil.orders) for coil in self.coils]
            self._run(loop.body)
            after = self._state()
            if after == before:
                self._skip(loop.count - turn - 1, self.now_ms - start_ms, sums)
                return
            before = after

    def _state(self) -> tuple[tuple[int, ...], ...]:
        """Return all that the next turn depends on, as seen from now."""
        rows = []
        for channel, coil in enumerate(self.coils):
            self._settle(channel)
            left_ms, off_ms = max(coil.end_ms - self.now_ms, -STEP_MS), max(coil.off_ms - self.now_ms, 0)
            on = left_ms > -STEP_MS
            since_ms = max(coil.since_ms - self.now_ms, -self._limits.on_max_ms - 1) if on else 0
            duty = coil.duty_permille if off_ms else 0
            waited = off_ms > 0 and coil.waits != self._waits
            rest_ms = max(self._rested_ms(coil) - self.now_ms, 0)
            rows.append((left_ms, off_ms, since_ms, duty, coil.heat_uj, rest_ms, waited))
        return tuple(rows)

    def _skip(self, turns: int, turn_ms: int, sums: list[tuple[int, int, int]]) -> None:
        """Count `turns` more turns that are copies of the last one."""
        for coil, (on_ms, energy_uj, orders) in zip(self.coils, sums, strict=True):
            coil.on_ms += turns * (coil.on_ms - on_ms)
            coil.energy_uj += turns * (coil.energy_uj - energy_uj)
            coil.orders += turns * (coil.orders - orders)
            coil.end_ms += turns * turn_ms
            coil.off_ms += turns * turn_ms
            coil.since_ms += turns * turn_ms
            coil.begin_ms += turns * turn_ms
            coil.heat_at_ms += turns * turn_ms
        self.now_ms += turns * turn_ms

    def _fire(self, op: Fire) -> None:
        for channel in range(len(self.coils)):
            if op.mask >> channel & 1:
                self._settle(channel)
                self._order(channel, op)
        on = [coil for coil in self.coils if coil.end_ms > self.now_ms]
        current_ma = sum(-(-self.full_ma * coil.duty_permille // 1000) for coil in on)
        self.at_once_peak = max(self.at_once_peak, len(on))
        self.current_peak_ma = max(self.current_peak_ma, current_ma)
        supply = self._profile.supply
        if len(on) > supply.at_once_max:
            self._complain(op, "E304", f"{len(on)} coils would be on at once, at most {supply.at_once_max}")
        if current_ma > supply.current_max_ma:
            self._complain(op, "E305", f"the supply would give {current_ma} mA, at most {supply.current_max_ma} mA")

    def _order(self, channel: int, op: Fire) -> None:
        """Begin a new order on one coil, in place of the one it may have."""
        coil, label = self.coils[channel], self._profile.labels[channel]
        if coil.off_ms > self.now_ms:
            self._replace(coil)
        if coil.end_ms + STEP_MS <= self.now_ms:
            left_ms = self._rested_ms(coil) - self.now_ms
            if left_ms > 0:
                self._complain(op, "E312", f"coil {label} must rest for {left_ms} ms more before it is fired again")
            coil.since_ms = self.now_ms
        time_ms = op.time_ms + -op.time_ms % STEP_MS
        coil.begin_ms, coil.end_ms, coil.off_ms = self.now_ms, self.now_ms + op.time_ms, self.now_ms + time_ms
        coil.order, coil.waits = op, self._waits
        coil.duty_permille, coil.power_uw = op.duty_permille, -(-self.full_uw * op.duty_permille // 1000)
        coil.orders += 1
        coil.on_ms += time_ms
        coil.energy_uj += _energy_uj(coil.power_uw, time_ms)
        on_ms, most_ms = coil.end_ms - coil.since_ms, self._limits.on_max_ms
        if on_ms > most_ms:
            message = f"coil {label} would be on for {on_ms} ms without a pause, at most {most_ms} ms"
            self._complain(op, "E303", message)

    def _replace(self, coil: CoilTrial) -> None:
        """Take back what the old order has not had; if a wait came between, it may have had all of it."""
        left_ms = had_ms = coil.off_ms - self.now_ms
        if coil.end_ms > self.now_ms and coil.waits == self._waits:
            had_ms = (coil.begin_ms - self.now_ms) % STEP_MS
        coil.heat_uj += _energy_uj(coil.power_uw, had_ms)
        coil.on_ms -= left_ms - had_ms
        coil.energy_uj -= _energy_uj(coil.power_uw, left_ms - had_ms)

    def _rested_ms(self, coil: CoilTrial) -> int:
        """Return until when a coil must rest after its last time on."""
        if coil.end_ms - coil.since_ms + STEP_MS > self._limits.on_max_ms:
            return coil.end_ms + self._limits.rest_ms + STEP_MS
        return coil.end_ms

    def _settle(self, channel: int) -> None:
        """Bring the heat of one coil up to now."""
        coil = self.coils[channel]
        on_ms = min(max(coil.off_ms - coil.heat_at_ms, 0), self.now_ms - coil.heat_at_ms)
        if on_ms:
            coil.heat_uj = self._heat_uj(coil.heat_uj, coil.power_uw, on_ms)
            coil.heat_peak_uj = max(coil.heat_peak_uj, coil.heat_uj)
            self._check_heat(channel)
        off_ms = self.now_ms - coil.heat_at_ms - on_ms
        if off_ms and coil.heat_uj:
            coil.heat_uj = min(coil.heat_uj, self._heat_uj(coil.heat_uj, 0, off_ms))
        coil.heat_at_ms = self.now_ms

    def _heat_uj(self, heat_uj: int, power_uw: int, time_ms: int) -> int:
        """Return the heat after `time_ms`: the firmware's steps in closed form, with all they may round up."""
        leak_ms = self._limits.heat_leak_ms
        kept: float = (1 - STEP_MS / leak_ms) ** (time_ms / STEP_MS)
        goal_uj = power_uw * leak_ms / 1000 + leak_ms / STEP_MS
        return ceil(goal_uj + (heat_uj - goal_uj) * kept)

    def _check_heat(self, channel: int) -> None:
        coil, most_mj = self.coils[channel], self._limits.heat_budget_mj
        if coil.heat_uj > most_mj * 1000 and coil.order is not None:
            heat_mj = ceil(coil.heat_uj / 1000)
            message = f"coil {self._profile.labels[channel]} would hold {heat_mj} mJ, its heat budget is {most_mj} mJ"
            self._complain(coil.order, "E306", message)

    def _complain(self, op: Fire, code: str, message: str) -> None:
        self._problems.add(op.node.place, code, message)


def _energy_uj(power_uw: int, time_ms: int) -> int:
    return -(-power_uw * time_ms // 1000)
