"""What a plan came to on a model of its robot: who did what when, from the begin of the program on."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

from host.gait.tree import Place

DONE, ABORTED, GUARDED, GIVEN_UP = "done", "aborted", "guarded", "given up"


class Bar(NamedTuple):
    """One order on one coil: to its end, or to its cut-off, or to the order in its place."""

    begin_ms: int
    end_ms: int
    duty_permille: int
    ramp_ms: int
    keep_decidegc: int  # 0: it is not kept near a temperature
    step: int


class Mark(NamedTuple):
    """A step begins."""

    at_ms: int
    step: int


class Pause(NamedTuple):
    """A wait for a condition; what is not `known` to the model is met at once or not at all."""

    begin_ms: int
    end_ms: int
    met: bool
    known: bool
    step: int


class Motion(NamedTuple):
    """An order to joints: to a position, to an angle of what they hold, or to a force."""

    kind: str  # "move", "orient" or "press"
    mask: int
    begin_ms: int
    arrive_ms: int
    end_ms: int
    target: int  # hundredths of the joint's unit or of a degree, thousandths of a newton
    step: int


class Gap(NamedTuple):
    """Turns of a loop that are copies of the one before and are not told again."""

    begin_ms: int
    end_ms: int
    turns: int


@dataclass(slots=True)
class Track:
    """One coil; `reach` are the labels that one chosen by the robot may have."""

    label: str
    reach: tuple[str, ...] = ()
    orders: int = 0
    on_ms: int = 0
    energy_mj: float = 0.0
    peak_degc: float = 0.0
    peak_ms: int = 0
    peak_step: int = 0
    bars: list[Bar] = field(default_factory=list)
    curve: list[tuple[int, float]] = field(default_factory=list)  # ms, degC


@dataclass(slots=True)
class Course:
    """One way through a script."""

    tracks: list[Track]
    marks: list[Mark] = field(default_factory=list)
    pauses: list[Pause] = field(default_factory=list)
    motions: list[Motion] = field(default_factory=list)
    gaps: list[Gap] = field(default_factory=list)
    end_ms: int = 0
    outcome: str = DONE
    where: Place | None = None  # it was aborted or guarded
    hot: dict[int, tuple[str, float, int]] = field(default_factory=dict)  # by step: coil, degC, ms beyond the trip

    @property
    def told_ms(self) -> int:
        """Return how long it takes without the turns that are not told."""
        return self.end_ms - sum(gap.end_ms - gap.begin_ms for gap in self.gaps)

    @property
    def settled_ms(self) -> int:
        """Return when the last order to joints ends that no other takes the place of."""
        ends = [0]
        for i, motion in enumerate(self.motions):
            if not any(later.mask & motion.mask for later in self.motions[i + 1 :]):
                ends.append(motion.end_ms)
        return max(ends)

    @property
    def driven(self) -> list[Track]:
        """Return the coils that have an order."""
        return [track for track in self.tracks if track.orders]
