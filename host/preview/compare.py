"""What changed from one script to another: time, steps, and for each coil its time on, energy and predicted peak."""

from __future__ import annotations

from dataclasses import dataclass
from difflib import SequenceMatcher

from host.errors import BadRequest
from host.gait.forecast import Forecast
from host.gait.model.course import Track
from host.gait.plan import Step

Lines = tuple[tuple[int, str], ...]  # number and text


@dataclass(frozen=True, slots=True)
class Pair:
    """A figure before and after."""

    old: float
    new: float

    @property
    def change(self) -> float:
        """Return by how much it grew."""
        return self.new - self.old


@dataclass(frozen=True, slots=True)
class CoilChange:
    """One coil before and after."""

    label: str
    on_ms: Pair
    energy_mj: Pair
    peak_degc: Pair

    @property
    def same(self) -> bool:
        """Return whether nothing changed that can be told apart."""
        return not self.on_ms.change and abs(self.energy_mj.change) < 0.5 and abs(self.peak_degc.change) < 0.5


@dataclass(frozen=True, slots=True)
class Changes:
    """Two scripts for one robot, side by side; where waits are not foreseen, as if they were over at once."""

    old: Forecast
    new: Forecast
    length_ms: Pair
    coils: tuple[CoilChange, ...]
    added: Lines
    removed: Lines

    @property
    def summary(self) -> str:
        """Return the whole in one line."""
        changed = [coil.label for coil in self.coils if not coil.same]
        coils = f"{len(changed)} of {len(self.coils)} coils changed" if self.coils else "no coils"
        steps = f"{len(self.added)} steps added, {len(self.removed)} removed"
        return f"{self.length_ms.old / 1000:.1f} s → {self.length_ms.new / 1000:.1f} s · {coils} · {steps}"

    def as_dict(self) -> dict[str, object]:
        """Return the fields for JSON."""
        return {
            "old": self.old.compiled.script.main.name,
            "new": self.new.compiled.script.main.name,
            "robot": self.new.compiled.profile.robot,
            "predicted": not self.new.why_not,
            "length_ms": _pair(self.length_ms),
            "coils": {coil.label: _fields(coil) for coil in self.coils},
            "added": [{"line": line, "text": text} for line, text in self.added],
            "removed": [{"line": line, "text": text} for line, text in self.removed],
        }


def changes(old: Forecast, new: Forecast) -> Changes:
    """Return what changed; BadRequest when the scripts are for different robots."""
    robots = [forecast.compiled.profile for forecast in (old, new)]
    if robots[0].labels != robots[1].labels:
        raise BadRequest(f"{robots[0].robot} and {robots[1].robot} are different robots: nothing to compare")
    before = {track.label: track for track in old.early.tracks}
    after = {track.label: track for track in new.early.tracks}
    labels = [label for label in {**after, **before} if _driven(before.get(label)) or _driven(after.get(label))]
    coils = tuple(_coil(label, before.get(label), after.get(label)) for label in labels)
    added, removed = _steps(old.compiled.steps, new.compiled.steps)
    return Changes(old, new, Pair(old.early.end_ms, new.early.end_ms), coils, added, removed)


def _driven(track: Track | None) -> bool:
    return track is not None and track.orders > 0


def _coil(label: str, old: Track | None, new: Track | None) -> CoilChange:
    tracks = [track or Track(label) for track in (old, new)]
    on, energy, peak = ([getattr(track, name) for track in tracks] for name in ("on_ms", "energy_mj", "peak_degc"))
    return CoilChange(label, Pair(*on), Pair(*energy), Pair(*peak))


def _steps(old: tuple[Step, ...], new: tuple[Step, ...]) -> tuple[Lines, Lines]:
    """Return the steps that are only in the new script, and those only in the old one."""
    before, after = ([_text(step) for step in steps] for steps in (old, new))
    added: list[tuple[int, str]] = []
    removed: list[tuple[int, str]] = []
    for kind, a, b, c, d in SequenceMatcher(None, before, after, autojunk=False).get_opcodes():
        if kind != "equal":
            removed += [(step.place.line, _text(step)) for step in old[a:b]]
            added += [(step.place.line, _text(step)) for step in new[c:d]]
    return tuple(added), tuple(removed)


def _text(step: Step) -> str:
    """Return a step as it is written, blanks aside."""
    return " ".join(step.text.split())


def _pair(pair: Pair) -> dict[str, float]:
    return {"old": round(pair.old, 2), "new": round(pair.new, 2)}


def _fields(coil: CoilChange) -> dict[str, object]:
    return {name: _pair(getattr(coil, name)) for name in ("on_ms", "energy_mj", "peak_degc")}
