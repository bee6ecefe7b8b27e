"""Plays a plan in its worst case, for all that it orders: coils that heat, joints that turn.

Loops are played until their turns repeat themselves, so that ten thousand turns cost no more than a few. A wait that
goes on elsewhere when it runs out makes one more way through the plan; each of them is played to its end.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any, Protocol

from host.gait.diagnostics import Problems
from host.gait.plan import Guard, Loop, OnFault, Op, Orient, Wait, walk
from host.gait.trial.clock import Clock
from host.gait.trial.coiltrial import STEP_MS, CoilTrial
from host.gait.trial.heating import Heating
from host.gait.trial.jointtrial import JointTrial
from host.gait.trial.turning import Turning
from host.gait.trial.ways import START, Arrival, Touch, Ways, sections
from host.profile import Profile
from protocol import program

EVENTS_MAX = 100_000
BRANCH_EVENTS = 10  # that following a way costs as much as


class TooLong(Exception):
    """A plan whose worst case takes too much work; `op` is where it was given up."""

    def __init__(self, op: Op) -> None:
        super().__init__()
        self.op = op


class Part(Protocol):
    """What is tried: the coils of a robot, or its joints."""

    def expect(self, plan: Sequence[Op]) -> None:
        """Look at all that will come."""

    def take(self, op: Op) -> None:
        """Take an op, before its time has passed."""

    def state(self) -> tuple[tuple[object, ...], ...]:
        """Return all that the next turn of a loop depends on, as seen from now."""

    def key(self) -> tuple[tuple[object, ...], ...]:
        """Return all of it in which two ways must be alike to be taken as one."""

    def sums(self) -> Any:
        """Return what is summed up so far, as `skip` and `lengthen` need it."""

    def skip(self, turns: int, turn_ms: int, most_ms: int, sums: Any) -> None:
        """Count `turns` more turns that are copies of the last one; the clock goes on afterwards."""

    def abort(self) -> None:
        """Take it that the program is aborted now: coils off, joints stand."""

    def lose(self) -> None:
        """Take it that the program was aborted, nobody knows when."""

    def save(self) -> Any:
        """Return a copy of all that goes on, for `restore`."""

    def restore(self, saved: Any) -> None:
        """Go on from what was saved, once."""

    def raise_to(self, mine: Any, other: Any) -> None:
        """Take over into one save what is more in another that is like it."""

    def lengthen(self, saved: Any, sums: Any) -> None:
        """Raise the sums of a save to these."""

    def tail_ms(self) -> int:
        """Return how long it takes until every order has ended."""

    def least_tail_ms(self) -> int:
        """Return how long that takes if whatever may end early does."""

    def finish(self) -> None:
        """Take it that nothing more comes."""

    def keep(self) -> None:
        """Keep what this way came to, where it is more than the ways before."""


class Trial:
    """The worst case of a plan for the robot of `profile`; what breaks a limit is added to `problems`."""

    def __init__(self, profile: Profile, problems: Problems) -> None:
        self.clock = Clock()
        self.heating = Heating(profile, problems, self.clock)
        self.turning = Turning(profile, problems, self.clock)
        self.tail_ms = 0  # how long orders last after the last op
        self._parts: tuple[Part, ...] = (self.heating, self.turning)
        self._ways = Ways()
        self._catches = False
        self._shortest_ms: int | None = None
        self._left = EVENTS_MAX

    @property
    def shortest_ms(self) -> int:
        """Return how long the shortest way takes if every wait that need not run out is over at once."""
        return self.clock.least_ms if self._shortest_ms is None else self._shortest_ms

    @property
    def coils(self) -> list[CoilTrial]:
        """Return what each coil of the robot came to."""
        return self.heating.most

    @property
    def joints(self) -> list[JointTrial]:
        """Return what each joint of the robot came to."""
        return self.turning.most

    def play(self, plan: Sequence[Op]) -> None:
        """Play all ways through it, and let every order end."""
        for part in self._parts:
            part.expect(plan)
        self._catches = any(isinstance(op, OnFault) for op in plan)
        ways = sections(plan)
        self._arrive(START)
        for place, (label, ops) in enumerate(ways):
            following = ways[place + 1][0] if place + 1 < len(ways) else program.ON_FAULT
            if label == program.ON_FAULT:
                self._catches = False
                self._lose(plan)
            for arrival in self._ways.leave(label):
                self._take_up(arrival)
                self._run(ops)
                if following == program.ON_FAULT:
                    self._end(label)
                else:
                    self._arrive(following)

    def _run(self, ops: Iterable[Op]) -> None:
        for op in ops:
            self._left -= 1
            if self._left < 0:
                raise TooLong(op)
            if isinstance(op, Loop):
                self._loop(op)
                continue
            if isinstance(op, Wait):
                self._branch(op)
            for part in self._parts:
                part.take(op)
            self.clock.pass_by(op)

    def _loop(self, loop: Loop) -> None:
        """Play turns until one leaves everything as it found it; the rest are its copies."""
        before = [part.state() for part in self._parts]
        for turn in range(loop.count):
            now_ms, most_ms = self.clock.now_ms, self.clock.most_ms
            sums, touched = [part.sums() for part in self._parts], len(self._ways.touched)
            self._run(loop.body)
            after = [part.state() for part in self._parts]
            if after == before:
                turns = loop.count - turn - 1
                self._lengthen(self._ways.touched[touched:], turns, sums)
                self._skip(turns, self.clock.now_ms - now_ms, self.clock.most_ms - most_ms, sums)
                return
            before = after

    def _skip(self, turns: int, turn_ms: int, most_ms: int, sums: Sequence[Any]) -> None:
        for part, sum in zip(self._parts, sums, strict=True):
            part.skip(turns, turn_ms, most_ms, sum)
        self.clock.now_ms += turns * turn_ms
        self.clock.most_ms += turns * most_ms

    def _lengthen(self, touched: Iterable[Touch], turns: int, before: Sequence[Any]) -> None:
        """Have the ways that leave the last turn of a loop leave the last of its copies too."""
        after = [part.sums() for part in self._parts]
        for touch in touched:
            for place, part in enumerate(self._parts):
                rows = zip(touch.sums[place], after[place], before[place], strict=True)
                touch.sums[place] = [_copied(*row, turns) for row in rows]
                part.lengthen(touch.arrival.parts[place], touch.sums[place])

    def _branch(self, op: Wait) -> None:
        """Follow a wait that runs out to where it goes on, if that is somewhere else."""
        aborts = op.otherwise == program.ABORT
        if op.otherwise == program.CONTINUE or (aborts and not self._catches):
            return
        self._left -= BRANCH_EVENTS
        clock, saved = replace(self.clock), [part.save() for part in self._parts]
        self.clock.run_out(op)
        for part in self._parts if aborts else ():
            part.abort()
        self.clock.waits += 1
        self._arrive(program.ON_FAULT if aborts else op.otherwise - program.JUMP)
        self._take_up(Arrival(clock, saved))

    def _lose(self, plan: Iterable[Op]) -> None:
        """Come to what a fault does from anywhere, if the camera may be lost."""
        if any(isinstance(op, Orient) or _asks_camera(op) for op in walk(plan)):
            for part in self._parts:
                part.lose()
            self._arrive(program.ON_FAULT)

    def _arrive(self, label: int) -> None:
        """Add the way that was played to those that come to a label."""
        key = tuple(part.key() for part in self._parts)
        came = Arrival(replace(self.clock), [part.save() for part in self._parts])
        self._ways.arrive(label, key, came, [part.sums() for part in self._parts], self._parts)

    def _take_up(self, arrival: Arrival) -> None:
        """Go on from there."""
        self.clock.go_to(arrival.clock)
        for part, saved in zip(self._parts, arrival.parts, strict=True):
            part.restore(saved)

    def _end(self, label: int) -> None:
        """Let every order of a way end; what runs after an abort does not count as a way of the script."""
        tail_ms = max(part.tail_ms() for part in self._parts)
        least_tail_ms = max(part.least_tail_ms() for part in self._parts)
        self.tail_ms = max(self.tail_ms, tail_ms)
        self.clock.now_ms += tail_ms
        for part in self._parts:
            part.finish()
            part.keep()
        if label != program.ON_FAULT:
            least_ms = self.clock.least_ms - tail_ms + least_tail_ms
            least_ms -= (
                least_ms % STEP_MS if least_tail_ms else 0
            )  # an order may end that much sooner than its whole steps
            self._shortest_ms = least_ms if self._shortest_ms is None else min(self._shortest_ms, least_ms)


def _copied(sums: Sequence[int], now: Sequence[int], before: Sequence[int], turns: int) -> tuple[int, ...]:
    """Return sums after that many more turns, each of which adds what has come since `before`."""
    return tuple(own + turns * (new - old) for own, new, old in zip(sums, now, before, strict=True))


def _asks_camera(op: Op) -> bool:
    return isinstance(op, Guard | Wait) and op.condition.source == program.ORIENTATION
