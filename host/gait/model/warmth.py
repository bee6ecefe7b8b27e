"""Coils under the orders of a plan, on a model of the robot: what is on until when, how warm it gets.

Orders end as on the robot: by their time, by their cut-off, by the order in their place. The heat budget is counted
as the robot counts it. A coil that the robot chooses is played on a coil of its own, which begins as the hottest of
those it may be.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, exp, inf, log

from host.gait.model.course import Bar, Course
from host.gait.plan import Aim, Fire
from host.gait.tree import Place
from host.gait.trial.coiltrial import STEP_MS
from host.predictors import Coils, Passed
from host.profile import Profile
from protocol import program

RAMP_PIECES = 16
CALLS_MAX = 40_000
LOOK_MS = 50  # how often heat is looked at while it rises
NOT_HOT = "", 0.0, 0
Asked = tuple[int, bool, float, bool]  # mask of coils, above, degC, all


class Endless(Exception):
    """The plan takes too much work."""


@dataclass(slots=True)
class Order:
    """What a coil is doing."""

    op: Fire
    begin_ms: int
    end_ms: int

    def duty(self, now_ms: int) -> int:
        """Return the duty of the piece of a ramp that begins now, or the full one."""
        ramp_ms, passed_ms = self.op.ramp_ms, now_ms - self.begin_ms
        if passed_ms >= ramp_ms:
            return self.op.duty_permille
        piece = passed_ms * RAMP_PIECES // ramp_ms
        return self.op.duty_permille * (2 * piece + 1) // (2 * RAMP_PIECES)

    def change_ms(self, now_ms: int) -> int:
        """Return when its duty changes next."""
        ramp_ms, passed_ms = self.op.ramp_ms, now_ms - self.begin_ms
        if passed_ms >= ramp_ms:
            return self.end_ms
        piece = passed_ms * RAMP_PIECES // ramp_ms + 1
        return min(self.end_ms, self.begin_ms - (-piece * ramp_ms // RAMP_PIECES))


class Warmth:
    """The coils of a robot; what they do is written to the tracks of `course`, temperatures each `every_ms`, if any."""

    def __init__(self, profile: Profile, coils: Coils, course: Course, every_ms: int) -> None:
        self.now_ms = 0
        self.guards: list[tuple[int, float, Place]] = []  # mask, degC, where it stands
        self._coils, self._course, self._every_ms = coils, course, every_ms
        limits = profile.coil_limits
        self._trip_degc = limits.trip_degc if limits else inf
        self._leak_ms = limits.heat_leak_ms if limits else 1
        self._count = len(profile.coil_labels)
        places = self._count + program.AIMS_MAX
        self._orders: list[Order | None] = [None] * places
        self._last = [0] * places  # step of the last order of each
        self._heat_mj = [0.0] * places
        self._energy_mj = [0.0] * places  # as of the last look
        self._calls = 0
        for track, degc in zip(course.tracks, coils.degc.tolist(), strict=True):
            track.peak_degc = degc
            track.curve += [(0, degc)] if every_ms and degc else []

    @property
    def busy_ms(self) -> int:
        """Return when the last order ends, or now."""
        return max((order.end_ms for order in self._orders if order), default=self.now_ms)

    def fire(self, op: Fire) -> None:
        """Begin an order, in place of those that its coils may have."""
        chosen = [] if op.kept is None else [self._count + op.kept]
        for place in chosen or [channel for channel in range(self._count) if op.mask >> channel & 1]:
            self._end(place)
            if op.duty_permille and op.time_ms:
                self._orders[place] = Order(op, self.now_ms, self.now_ms + op.time_ms)
                self._last[place] = op.step
                self._course.tracks[place].orders += 1

    def aim(self, op: Aim, reach: tuple[str, ...]) -> None:
        """Let a chosen coil be as the hottest of its circle, or as it is, if that is hotter."""
        place = self._count + op.kept
        self._end(place)
        track = self._course.tracks[place]
        track.label, track.reach = f"${op.node.name.text}", tuple(dict.fromkeys(track.reach + reach))
        degc = self._coils.degc
        hottest = max(op.circle, key=lambda channel: float(degc[channel]))
        if degc[hottest] >= degc[place]:
            self._coils.copy(place, hottest)
        self._heat_mj[place] = max(self._heat_mj[place], *(self._heat_mj[channel] for channel in op.circle))

    def off(self) -> None:
        """Switch every coil off."""
        for place in range(len(self._orders)):
            self._end(place)

    def pass_until(self, until_ms: int, asked: Asked | None = None) -> bool:
        """Let time pass; return early, and True, when what is asked of temperatures holds."""
        while True:
            if asked and self._holds(asked):
                return True
            if self.now_ms >= until_ms or self.guarded() is not None:
                return False
            self._advance(until_ms, asked)

    def pass_cooler(self, until_ms: int, mask: int, above: bool, value_mj: float, want_all: bool) -> bool:
        """Let time pass; return early, and True, when what is asked of heat budgets holds."""
        places = [place for place in range(len(self._orders)) if mask >> place & 1]
        while True:
            met = [(self._heat_mj[place] > value_mj) == above for place in places]
            if all(met) if want_all else any(met):
                return True
            if self.now_ms >= until_ms or self.guarded() is not None:
                return False
            waits_ms = [
                self._cooled_ms(place, value_mj) for place, is_met in zip(places, met, strict=True) if not is_met
            ]
            self.pass_until(min(until_ms, self.now_ms + min(waits_ms)))

    def guarded(self) -> Place | None:
        """Return the guard that trips now."""
        degc = self._coils.degc
        for mask, most_degc, where in self.guards:
            if any(mask >> place & 1 and degc[place] >= most_degc for place in range(len(self._orders))):
                return where
        return None

    def state(self) -> tuple[tuple[int, ...], ...]:
        """Return all that the next turn of a loop depends on, as seen from now and to what can be told apart."""
        orders = [(o.op.step, o.end_ms - self.now_ms, o.begin_ms - self.now_ms) if o else () for o in self._orders]
        warmth = zip(self._coils.degc.tolist(), self._heat_mj, strict=True)
        return *orders, *((round(5 * degc), round(heat_mj)) for degc, heat_mj in warmth)

    def sums(self) -> list[tuple[int, float, int]]:
        """Return what each coil has come to so far."""
        return [(track.on_ms, track.energy_mj, track.orders) for track in self._course.tracks]

    def skip(self, turns: int, turn_ms: int, sums: list[tuple[int, float, int]]) -> None:
        """Count `turns` more turns that are copies of the last one."""
        for track, (on_ms, energy_mj, orders) in zip(self._course.tracks, sums, strict=True):
            track.on_ms += turns * (track.on_ms - on_ms)
            track.energy_mj += turns * (track.energy_mj - energy_mj)
            track.orders += turns * (track.orders - orders)
        self.now_ms += turns * turn_ms
        for order in self._orders:
            if order:
                order.begin_ms, order.end_ms = order.begin_ms + turns * turn_ms, order.end_ms + turns * turn_ms

    def _advance(self, until_ms: int, asked: Asked | None) -> None:
        """Let time pass to the next change of a duty, at most."""
        self._calls += 1
        if self._calls > CALLS_MAX:
            raise Endless
        duties, limits, kept = [0] * len(self._orders), [inf] * len(self._orders), 0
        for place, order in enumerate(self._orders):
            if order is None:
                continue
            until_ms = min(until_ms, order.change_ms(self.now_ms))
            duties[place] = order.duty(self.now_ms)
            limits[place] = order.op.cutoff_decidegc / 10 or inf
            kept |= order.op.holds << place
        for mask, most_degc, _ in self.guards:
            for place in range(len(self._orders)):
                if mask >> place & 1 and not kept >> place & 1:
                    limits[place] = min(limits[place], most_degc)
        passed = self._coils.advance(duties, until_ms - self.now_ms, limits, kept, asked, self._every_ms)
        self._keep(passed)
        self.now_ms += passed.ms
        degc = self._coils.degc
        for place, order in enumerate(self._orders):
            if order and (order.end_ms <= self.now_ms or (degc[place] >= limits[place] and not kept >> place & 1)):
                self._end(place)

    def _keep(self, passed: Passed) -> None:
        """Take temperatures, energies and heat of a stretch of time into the tracks."""
        leaked, leak_s = exp(-passed.ms / self._leak_ms), self._leak_ms / 1000
        rows = passed.trace.tolist()
        peaks, peaks_ms, energies = passed.peak_degc.tolist(), passed.peak_ms.tolist(), self._coils.energy_mj.tolist()
        for place, track in enumerate(self._course.tracks):
            taken_mj = energies[place] - self._energy_mj[place]
            if taken_mj or self._heat_mj[place]:
                track.energy_mj += taken_mj
                goal_mj = 1000 * taken_mj / passed.ms * leak_s if passed.ms else 0.0
                self._heat_mj[place] = goal_mj + (self._heat_mj[place] - goal_mj) * leaked
            if peaks[place] > track.peak_degc:
                track.peak_degc, track.peak_step = peaks[place], self._last[place]
                track.peak_ms = self.now_ms + int(peaks_ms[place])
            if self._trip_degc <= peaks[place] > self._course.hot.get(self._last[place], NOT_HOT)[1]:
                self._course.hot[self._last[place]] = track.label, peaks[place], self.now_ms + int(peaks_ms[place])
            track.curve += [(self.now_ms + int(row[0]), row[place + 1]) for row in rows]
        self._energy_mj = energies

    def _holds(self, asked: Asked) -> bool:
        mask, above, value_degc, want_all = asked
        degc = self._coils.degc
        met = [(degc[i] > value_degc) == above for i in range(len(self._orders)) if mask >> i & 1]
        return all(met) if want_all else any(met)

    def _cooled_ms(self, place: int, value_mj: float) -> int:
        """Return in how many control steps [ms] a coil's heat may come to a value, at least one."""
        heat_mj = self._heat_mj[place]
        if self._orders[place] or not 0 < value_mj < heat_mj:
            return LOOK_MS
        return STEP_MS * max(1, ceil(self._leak_ms * log(heat_mj / value_mj) / STEP_MS))

    def _end(self, place: int) -> None:
        """End the order of a coil, if it has one."""
        order = self._orders[place]
        if order is None:
            return
        self._orders[place] = None
        op, track = order.op, self._course.tracks[place]
        if self.now_ms > order.begin_ms:
            track.on_ms += self.now_ms - order.begin_ms
            keep = op.cutoff_decidegc if op.holds else 0
            track.bars.append(Bar(order.begin_ms, self.now_ms, op.duty_permille, op.ramp_ms, keep, op.step))
