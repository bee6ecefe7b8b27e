"""The ways through a plan: waits that run out go on further down, or where the script says what a fault is to do.

Ways that come to one label alike, but for heat and for what they have summed up, are one from there on: the hotter one,
with the greater sums. So a wait in a loop of ten thousand turns makes a few ways, not ten thousand.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from host.gait.plan import Label, OnFault, Op
from host.gait.trial.clock import Clock
from protocol import program

START = -1


@dataclass(slots=True)
class Arrival:
    """How a plan comes to a label: its clock, and all parts as they are then."""

    clock: Clock
    parts: list[Any]


@dataclass(slots=True)
class Touch:
    """An arrival that happened, with what it had summed up; later turns of a loop are its copies."""

    arrival: Arrival
    sums: list[Any]


@dataclass
class Ways:
    """The arrivals at each label, by all that what follows depends on."""

    at: dict[int, dict[Any, Arrival]] = field(default_factory=dict)
    touched: list[Touch] = field(default_factory=list)

    def arrive(self, label: int, key: Any, came: Arrival, sums: list[Any], parts: Sequence[Any]) -> None:
        """Add an arrival, or raise the one that is like it."""
        known = self.at.setdefault(label, {}).setdefault(key, came)
        if known is not came:
            sooner_ms = known.clock.now_ms - min(known.clock.least_ms, came.clock.least_ms)
            known.clock.sooner_ms = sooner_ms
            for part, mine, other in zip(parts, known.parts, came.parts, strict=True):
                part.raise_to(mine, other)
        self.touched.append(Touch(known, sums))

    def leave(self, label: int) -> Iterator[Arrival]:
        """Yield the arrivals at a label, once."""
        yield from self.at.pop(label, {}).values()


def sections(plan: Sequence[Op]) -> list[tuple[int, list[Op]]]:
    """Return a plan cut at its labels: the label that each part begins with, and its ops."""
    cut: list[tuple[int, list[Op]]] = [(START, [])]
    for op in plan:
        if isinstance(op, Label):
            cut.append((op.number, []))
        elif isinstance(op, OnFault):
            cut.append((program.ON_FAULT, list(op.body)))
        else:
            cut[-1][1].append(op)
    return cut
