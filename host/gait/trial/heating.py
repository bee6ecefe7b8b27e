"""The coils in the worst case of a plan: every wait for a condition over at once, so that no coil has time to cool.

The arithmetic is the firmware's, rounded against the script: power from the nominal supply, the heat budget as energy
that leaks with its own time constant, orders that end on the control step after their time. Cut-offs are taken as never
reached.

A coil that the robot chooses may be any of its circle, and the same one each time. What it is given is played on a
coil of its own, one for each place that keeps one, and added to each coil that it may be: the sum of two peaks is never
less than the peak of the sum.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from copy import copy
from fractions import Fraction
from math import ceil

from host.gait import tree
from host.gait.diagnostics import Problems
from host.gait.plan import Aim, Fire, Op, Wait, walk
from host.gait.trial.clock import Clock
from host.gait.trial.coiltrial import STEP_MS, CoilTrial, energy_uj, heat_uj
from host.gait.trial.lag import Lag
from host.profile import Profile
from protocol import program

Sums = list[tuple[int, ...]]


class Heating:
    """The coils of a robot; one that has none takes no order."""

    def __init__(self, profile: Profile, problems: Problems, clock: Clock) -> None:
        self._count = len(profile.coil_labels)
        self._all = [CoilTrial(reach=1 << channel) for channel in range(self._count)]
        self.at_once_peak = 0
        self.current_peak_ma = 0
        self.full_uw = 0
        self._profile, self._problems, self._clock = profile, problems, clock
        self._best: list[CoilTrial] = []
        self._lag_ms = 0  # by which an order may begin late, while the one before goes on
        if not self._count:
            return
        self._limits = profile.coil
        self._all += [CoilTrial() for _ in range(program.AIMS_MAX)]
        supply_mv, coil_mohm = profile.supply_mv, profile.coil.resistance_mohm
        loop_mohm = coil_mohm + profile.coil.wiring_mohm
        self.full_uw = ceil(Fraction(1000 * supply_mv * supply_mv * coil_mohm, loop_mohm * loop_mohm))

    @property
    def coils(self) -> list[CoilTrial]:
        """Return each coil of the robot as it is now."""
        return self._all[: self._count]

    @property
    def most(self) -> list[CoilTrial]:
        """Return the most that each coil of the robot came to on any way."""
        return (self._best or self._all)[: self._count]

    def expect(self, plan: Sequence[Op]) -> None:
        """Learn which coils each name may stand for, and how late an order may come."""
        self._lag_ms = Lag().play(plan).peak_ms
        for op in walk(plan):
            if isinstance(op, Aim):
                self._all[self._count + op.kept].reach |= sum(1 << channel for channel in op.circle)

    def take(self, op: Op) -> None:
        """Take what is for coils, and a wait, which may leave one cooler."""
        if isinstance(op, Fire):
            self._fire(op)
        elif isinstance(op, Aim):
            self._aim(op)
        elif isinstance(op, Wait):
            self._wait(op)

    def tail_ms(self) -> int:
        """Return how long it takes until every coil is off."""
        return max(
            (coil.off_ms - self._clock.now_ms for coil in self._all if coil.off_ms > self._clock.now_ms), default=0
        )

    def least_tail_ms(self) -> int:
        """Return how long that takes at least: some end at their cut-off, or when another order takes their place."""
        sure = [
            coil.off_ms
            for channel, coil in enumerate(self._all)
            if coil.order
            and (coil.order.holds or not coil.order.cutoff_decidegc)
            and len(list(self._kin(channel))) == 1
        ]
        return max(0, max(sure, default=0) - self._clock.now_ms)

    def finish(self) -> None:
        """Let every coil end."""
        for channel in range(len(self._all)):
            self._settle(channel)
        self._share()

    def abort(self) -> None:
        """Switch every coil off; it may have been on until its order ended, if a wait came before this one."""
        for channel, coil in enumerate(self._all):
            self._settle(channel)
            if coil.off_ms > self._clock.now_ms:
                self._switch_off(coil)
                self._check_heat(channel)

    def lose(self) -> None:
        """Take it that an abort may come at any time: every coil is as hot as it ever was, and has been on as long."""
        self._all = [copy(coil) for coil in self._best]
        for coil in self._all:
            coil.heat_uj = coil.heat_peak_uj
            coil.heat_at_ms = coil.end_ms = coil.off_ms = self._clock.now_ms
            coil.since_ms = self._clock.now_ms - coil.longest_ms

    def save(self) -> list[CoilTrial]:
        """Return copies of the coils as they are now."""
        return [copy(coil) for coil in self._all]

    def restore(self, saved: list[CoilTrial]) -> None:
        """Go on from what was saved."""
        self._all = saved

    def raise_to(self, mine: list[CoilTrial], other: list[CoilTrial]) -> None:
        """Take over into one save what is more in another that is like it."""
        for coil, more in zip(mine, other, strict=True):
            coil.raise_to(more)

    def lengthen(self, saved: list[CoilTrial], sums: Sums) -> None:
        """Raise the sums of a save to these."""
        for coil, (on_ms, taken_uj, orders) in zip(saved, sums, strict=True):
            coil.on_ms, coil.energy_uj = max(coil.on_ms, on_ms), max(coil.energy_uj, taken_uj)
            coil.orders = max(coil.orders, orders)

    def keep(self) -> None:
        """Keep what the coils came to on this way, where it is more than on those before."""
        if self._best:
            self.raise_to(self._best, self._all)
        else:
            self._best = self.save()

    def key(self) -> tuple[tuple[int, ...], ...]:
        """Return all but heat and sums that what comes depends on."""
        return tuple(row[:-2] for row in self.state())

    def sums(self) -> Sums:
        """Return what each coil has come to so far."""
        return [(coil.on_ms, coil.energy_uj, coil.orders) for coil in self._all]

    def state(self) -> tuple[tuple[int, ...], ...]:
        """Return all that the next turn depends on, as seen from now."""
        rows = []
        for channel, coil in enumerate(self._all):
            self._settle(channel)
            coil.settle_others(self._clock.now_ms, self._limits)
            left_ms, off_ms = max(coil.end_ms - self._clock.now_ms, -STEP_MS), max(coil.off_ms - self._clock.now_ms, 0)
            on = left_ms > -STEP_MS
            since_ms = max(coil.since_ms - self._clock.now_ms, -self._limits.on_max_ms - 1) if on else 0
            duty = coil.duty_permille if off_ms else 0
            waited = off_ms > 0 and coil.waits != self._clock.waits
            rest_ms = max(coil.rested_ms(self._limits) - self._clock.now_ms, 0)
            rows.append((left_ms, off_ms, since_ms, duty, rest_ms, waited, coil.heat_uj, coil.others_uj))
        return tuple(rows)

    def skip(self, turns: int, turn_ms: int, most_ms: int, sums: Sums) -> None:
        """Count `turns` more turns that are copies of the last one."""
        for coil, (on_ms, taken_uj, orders) in zip(self._all, sums, strict=True):
            coil.on_ms += turns * (coil.on_ms - on_ms)
            coil.energy_uj += turns * (coil.energy_uj - taken_uj)
            coil.orders += turns * (coil.orders - orders)
            coil.shift(turns * turn_ms)

    def _fire(self, op: Fire) -> None:
        chosen = [] if op.kept is None else [self._count + op.kept]
        for channel in chosen or [channel for channel in range(self._count) if op.mask >> channel & 1]:
            self._settle(channel)
            self._order(channel, op)
        on = [coil for coil in self._all if coil.end_ms > self._clock.now_ms]
        supply_mv = self._profile.supply_mv
        current_ma = sum(self._limits.current_ma(supply_mv, coil.duty_permille) for coil in on)
        self.at_once_peak = max(self.at_once_peak, len(on))
        self.current_peak_ma = max(self.current_peak_ma, current_ma)
        supply = self._profile.supply
        if len(on) > supply.at_once_max:
            self._complain(op, "E304", f"{len(on)} coils would be on at once, at most {supply.at_once_max}")
        if current_ma > supply.current_max_ma:
            self._complain(op, "E305", f"the supply would give {current_ma} mA, at most {supply.current_max_ma} mA")

    def _order(self, channel: int, op: Fire) -> None:
        """Begin a new order on one coil, in place of the one it may have."""
        coil, kin = self._all[channel], list(self._kin(channel))
        label = self._label(channel, op)
        if coil.off_ms > self._clock.now_ms:
            self._replace(coil)
            self._check_heat(channel)
        on = [each for each in kin if each.end_ms + STEP_MS > self._clock.now_ms]
        left_ms = max((each.rested_ms(self._limits) - self._clock.now_ms for each in kin if each not in on), default=0)
        if left_ms > 0 and (coil not in on or len(kin) > 1):
            self._complain(op, "E312", f"coil {label} must rest for {left_ms} ms more before it is fired again")
        coil.since_ms = min((self._since_ms(each) for each in on), default=self._clock.now_ms)
        time_ms = op.time_ms + -op.time_ms % STEP_MS
        coil.begin_ms, coil.end_ms, coil.off_ms = (
            self._clock.now_ms,
            self._clock.now_ms + op.time_ms,
            self._clock.now_ms + time_ms,
        )
        coil.order, coil.waits = op, self._clock.waits
        coil.duty_permille, coil.power_uw = op.duty_permille, -(-self.full_uw * op.duty_permille // 1000)
        coil.orders += 1
        coil.on_ms += time_ms
        coil.energy_uj += energy_uj(coil.power_uw, time_ms)
        on_ms, most_ms = coil.end_ms - coil.since_ms, self._limits.on_max_ms
        coil.longest_ms = max(coil.longest_ms, on_ms)
        if on_ms > most_ms:
            message = f"coil {label} would be on for {on_ms} ms without a pause, at most {most_ms} ms"
            self._complain(op, "E303", message)

    def _since_ms(self, coil: CoilTrial) -> int:
        """Return since when a coil is on; if a wait came in between, it may be as long as its orders say."""
        left_ms = coil.end_ms - self._clock.now_ms
        return coil.since_ms - (max(left_ms, 0) if coil.waits != self._clock.waits else 0)

    def _kin(self, channel: int) -> Iterator[CoilTrial]:
        """Yield this coil and all that may stand for the same one."""
        coil = self._all[channel]
        for other, each in enumerate(self._all):
            if other == channel or (each.reach & coil.reach and max(other, channel) >= self._count):
                yield each

    def _label(self, channel: int, op: Fire) -> str:
        """Return the coil as the script names it."""
        node = op.node.coils[0]
        if channel < self._count or not isinstance(node, tree.Reference):
            return self._profile.labels[channel]
        return f"${node.name}"

    def _aim(self, op: Aim) -> None:
        """Let a name stand for another coil, at worst for the hottest of those it has stood for."""
        channel = self._count + op.kept
        coil = self._all[channel]
        self._settle(channel)
        coil.settle_others(self._clock.now_ms, self._limits)
        if coil.end_ms > self._clock.now_ms:
            left_ms = coil.end_ms - self._clock.now_ms
            message = f"`{op.node.name.text}` may still be on for {left_ms} ms when another coil is chosen"
            self._problems.add(op.node.place, "E315", message)
        coil.heat_uj = coil.others_uj = max(coil.heat_uj, coil.others_uj)

    def _wait(self, op: Wait) -> None:
        """Take the wait as over at once; one for less heat, without which the script ends, leaves no more than that."""
        asked = op.condition
        if (asked.source, asked.compare, op.otherwise) != (program.HEAT, program.BELOW, program.ABORT):
            return
        single = asked.quantifier == program.ALL or asked.mask & (asked.mask - 1) == 0
        chosen = [self._count + asked.mask] if asked.quantifier == program.CHOSEN else []
        for channel in chosen or [each for each in range(self._count) if single and asked.mask >> each & 1]:
            coil = self._all[channel]
            self._settle(channel)
            coil.settle_others(self._clock.now_ms, self._limits)
            self._stay(channel, op.timeout_ms + STEP_MS)
            coil.heat_uj = min(coil.heat_uj, max(asked.value, 0) * 1000)

    def _stay(self, channel: int, time_ms: int) -> None:
        """Count what a coil comes to that stays on during a wait of that time, at most."""
        coil = self._all[channel]
        on_ms = min(coil.off_ms - self._clock.now_ms, time_ms)
        if on_ms > 0:
            coil.heat_uj = max(coil.heat_uj, heat_uj(coil.heat_uj, coil.power_uw, on_ms, self._limits))
            coil.heat_peak_uj = max(coil.heat_peak_uj, coil.heat_uj)
            self._check_heat(channel)

    def _share(self) -> None:
        """Add what chosen coils came to to each coil that they may be."""
        for chosen in self._all[self._count :]:
            for coil in self.coils:
                if coil.reach & chosen.reach and chosen.order is not None:
                    coil.orders += chosen.orders
                    coil.on_ms += chosen.on_ms
                    coil.energy_uj += chosen.energy_uj
                    coil.heat_peak_uj += chosen.heat_peak_uj
                    self._hold(chosen.order, self._profile.labels[coil.reach.bit_length() - 1], coil.heat_peak_uj)

    def _replace(self, coil: CoilTrial) -> None:
        """Take back what the old order has not had; if a wait came between, it may have had all of it."""
        left_ms = had_ms = coil.off_ms - self._clock.now_ms
        if coil.end_ms > self._clock.now_ms and coil.waits == self._clock.waits:
            had_ms = min(left_ms, (coil.begin_ms - self._clock.now_ms) % STEP_MS + self._lag_ms)
        coil.cut(left_ms, had_ms)

    def _switch_off(self, coil: CoilTrial) -> None:
        """End an order one control step from now, or when a wait has come in between, at its end."""
        left_ms = had_ms = coil.off_ms - self._clock.now_ms
        coil.since_ms = self._since_ms(coil)
        if coil.waits == self._clock.waits:
            had_ms = min(left_ms, 2 * STEP_MS + self._lag_ms)
        coil.cut(left_ms, had_ms)
        coil.end_ms = coil.off_ms = self._clock.now_ms

    def _settle(self, channel: int) -> None:
        """Bring the heat of one coil up to now."""
        coil = self._all[channel]
        on_ms = min(max(coil.off_ms - coil.heat_at_ms, 0), self._clock.now_ms - coil.heat_at_ms)
        if on_ms:
            coil.heat_uj = heat_uj(coil.heat_uj, coil.power_uw, on_ms, self._limits)
            coil.heat_peak_uj = max(coil.heat_peak_uj, coil.heat_uj)
            self._check_heat(channel)
        off_ms = self._clock.now_ms - coil.heat_at_ms - on_ms
        if off_ms and coil.heat_uj:
            coil.heat_uj = min(coil.heat_uj, heat_uj(coil.heat_uj, 0, off_ms, self._limits))
        coil.heat_at_ms = self._clock.now_ms

    def _check_heat(self, channel: int) -> None:
        coil = self._all[channel]
        if coil.order is not None:
            self._hold(coil.order, self._label(channel, coil.order), coil.heat_uj)

    def _hold(self, op: Fire, label: str, heat_uj: int) -> None:
        """Report a coil that would hold more heat than its budget."""
        most_mj = self._limits.heat_budget_mj
        if heat_uj > most_mj * 1000:
            message = f"coil {label} would hold {ceil(heat_uj / 1000)} mJ, its heat budget is {most_mj} mJ"
            self._complain(op, "E306", message)

    def _complain(self, op: Fire, code: str, message: str) -> None:
        self._problems.add(op.node.place, code, message)
