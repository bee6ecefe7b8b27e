"""Lays blocks that start at once onto one timeline, so that the robot needs no threads."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from host.gait.diagnostics import Problems
from host.gait.plan import Delay, Fire, Loop, Move, Note, Op, Order, Orient, Press

EVENTS_MAX = 5_000
CONFLICTS = {
    Fire: "a coil of this order is on already",
    Move: "a joint of this order has another one already",
    Orient: "a joint has another order already, and orient takes both",
    Press: "the joint has another order already, and press takes it",
}


Event = tuple[int, int, Order | Note]  # when, child, what


class TooLarge(Exception):
    """A script that unrolls to more than any robot could hold."""


@dataclass
class _Timeline:
    """Orders and notes at their times [ms], each with the number of the statement it came from."""

    events: list[Event] = field(default_factory=list)
    turns: int = 0

    def lay(self, ops: Iterable[Op], at_ms: int, child: int) -> int:
        """Put down `ops` from `at_ms` on; return when they end."""
        for op in ops:
            if isinstance(op, Order | Note):
                self.events.append((at_ms, child, op))
            elif isinstance(op, Delay):
                at_ms += op.time_ms
            elif isinstance(op, Loop):
                for _ in range(op.count):
                    at_ms = self.lay(op.body, at_ms, child)
            self.turns += 1
            if self.turns > EVENTS_MAX:
                raise TooLarge
        return at_ms


def together(children: Iterable[list[Op]], problems: Problems) -> list[Op]:
    """Return the ops of `children`, all starting now and ending with the longest; who is in two at once is reported."""
    timeline = _Timeline()
    end_ms = max((timeline.lay(ops, 0, child) for child, ops in enumerate(children)), default=0)
    timeline.events.sort(key=lambda event: event[:2])
    _report_conflicts(timeline.events, problems)
    return list(_with_delays(timeline.events, end_ms))


def duration_ms(ops: Iterable[Op]) -> int:
    """Return how long `ops` take, with waits for conditions at no time at all."""
    total = 0
    for op in ops:
        if isinstance(op, Delay):
            total += op.time_ms
        elif isinstance(op, Loop):
            total += op.count * duration_ms(op.body)
    return total


def _with_delays(events: Iterable[Event], end_ms: int) -> Iterator[Op]:
    now_ms, step = 0, 0
    for at_ms, _, order in events:
        if at_ms > now_ms:
            yield Delay(at_ms - now_ms, step or order.step)
        yield order
        now_ms, step = at_ms, order.step
    if end_ms > now_ms:
        yield Delay(end_ms - now_ms, step)


def _report_conflicts(events: Iterable[Event], problems: Problems) -> None:
    busy: list[tuple[int, int, Order]] = []  # end, child, order
    for at_ms, child, order in events:
        if isinstance(order, Note):
            continue
        busy = [entry for entry in busy if entry[0] > at_ms]
        for _, other, earlier in busy:
            if other != child and _kept(earlier) == _kept(order) and earlier.mask & order.mask:
                help = f"the other order is on {earlier.node.place.told(order.node.place.file)}"
                problems.add(order.node.place, "E135", CONFLICTS[type(order)], help)
        busy.append((at_ms + order.time_ms, child, order))


def _kept(order: Order) -> int | None:
    return order.kept if isinstance(order, Fire) else None
