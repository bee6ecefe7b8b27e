"""Plays a plan in its worst case, for all that it orders: coils that heat, joints that turn.

Loops are played until their turns repeat themselves, so that ten thousand turns cost no more than a few.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, Protocol

from host.gait.clock import Clock
from host.gait.coiltrial import CoilTrial
from host.gait.diagnostics import Problems
from host.gait.heating import Heating
from host.gait.jointtrial import JointTrial
from host.gait.plan import Loop, Op
from host.gait.turning import Turning
from host.profile import Profile

EVENTS_MAX = 100_000


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

    def sums(self) -> Any:
        """Return what `skip` needs to know of the beginning of a turn."""

    def skip(self, turns: int, turn_ms: int, most_ms: int, sums: Any) -> None:
        """Count `turns` more turns that are copies of the last one; the clock goes on afterwards."""

    def tail_ms(self) -> int:
        """Return how long it takes until every order has ended."""

    def finish(self) -> None:
        """Take it that nothing more comes."""


class Trial:
    """The worst case of a plan for the robot of `profile`; what breaks a limit is added to `problems`."""

    def __init__(self, profile: Profile, problems: Problems) -> None:
        self.clock = Clock()
        self.heating = Heating(profile, problems, self.clock)
        self.turning = Turning(profile, problems, self.clock)
        self.tail_ms = 0  # how long orders last after the last op
        self._parts: tuple[Part, ...] = (self.heating, self.turning)
        self._left = EVENTS_MAX

    @property
    def now_ms(self) -> int:
        """Return how far the plan has come if every wait is over at once."""
        return self.clock.now_ms

    @property
    def coils(self) -> list[CoilTrial]:
        """Return what each coil of the robot came to."""
        return self.heating.coils

    @property
    def joints(self) -> list[JointTrial]:
        """Return what each joint of the robot came to."""
        return self.turning.joints

    def play(self, plan: Sequence[Op]) -> None:
        """Play all of it, and let every order end."""
        for part in self._parts:
            part.expect(plan)
        self._run(plan)
        self.tail_ms = max(part.tail_ms() for part in self._parts)
        self.clock.now_ms += self.tail_ms
        for part in self._parts:
            part.finish()

    def _run(self, ops: Iterable[Op]) -> None:
        for op in ops:
            self._left -= 1
            if self._left < 0:
                raise TooLong(op)
            if isinstance(op, Loop):
                self._loop(op)
                continue
            for part in self._parts:
                part.take(op)
            self.clock.pass_by(op)

    def _loop(self, loop: Loop) -> None:
        """Play turns until one leaves everything as it found it; the rest are its copies."""
        before = [part.state() for part in self._parts]
        for turn in range(loop.count):
            now_ms, most_ms = self.clock.now_ms, self.clock.most_ms
            sums = [part.sums() for part in self._parts]
            self._run(loop.body)
            after = [part.state() for part in self._parts]
            if after == before:
                turn_ms, turn_most_ms = self.clock.now_ms - now_ms, self.clock.most_ms - most_ms
                self._skip(loop.count - turn - 1, turn_ms, turn_most_ms, sums)
                return
            before = after

    def _skip(self, turns: int, turn_ms: int, most_ms: int, sums: Sequence[Any]) -> None:
        for part, sum in zip(self._parts, sums, strict=True):
            part.skip(turns, turn_ms, most_ms, sum)
        self.clock.now_ms += turns * turn_ms
        self.clock.most_ms += turns * most_ms
