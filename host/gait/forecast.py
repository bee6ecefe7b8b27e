"""Foretells what a script does to the coils of its robot: when each is on, how warm it gets, where it gets too hot.

A model of the robot (`host.predictors`) says how coils warm and cool, at rest in the body, from cold. What it cannot
know, such as where down is, is taken twice: waits for it are over at once, and only when their time is. So the
temperatures are those of two runs among many, a preview and no proof; the worst case is the checker's part.

    forecast = foretell(compiled, "sim:circular")
    print(*forecast.lines(), sep="\\n")
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from host.gait.compiler import Compiled
from host.gait.diagnostics import Diagnostic, Problems, in_order
from host.gait.model.course import ABORTED, GIVEN_UP, GUARDED, Course, Track
from host.gait.model.play import Play
from host.gait.plan import Step
from host.gait.tree import Place
from host.predictors import Coils, Unpredicted, predictor
from host.profile import Profile

Model = Coils | str  # or why there is none
POINTS = 900  # of a curve: as many as can be seen
LEAST_MS = 10  # from one to the next
WAYS = {"early": "if every other wait is over at once", "late": "if every other wait runs out"}


@dataclass(frozen=True, slots=True)
class Peak:
    """The highest temperature of a coil in both ways, when it is reached, and the order that heats it."""

    track: Track
    degc: float
    at_ms: int
    way: str
    step: Step | None


@dataclass(frozen=True, slots=True)
class Forecast:
    """What is foretold of a script; `why_not` says in one line why there are no temperatures."""

    compiled: Compiled
    early: Course
    late: Course
    why_not: str = ""

    @property
    def forked(self) -> bool:
        """Return whether the script waits for what no model knows, so that its two ways differ."""
        return self.early is not self.late

    @property
    def ways(self) -> dict[str, Course]:
        """Return the ways through the script by name; where both are one, that one alone."""
        return {"early": self.early, "late": self.late} if self.forked else {"": self.early}

    def peaks(self) -> list[Peak]:
        """Return the peak of each coil that has an order."""
        found = []
        for i in range(len(self.early.tracks)):
            ways = [(way, course.tracks[i]) for way, course in self.ways.items() if course.tracks[i].orders]
            if ways:
                way, track = max(ways, key=lambda each: each[1].peak_degc)
                step = self.compiled.step(track.peak_step)
                found.append(Peak(track, track.peak_degc, track.peak_ms, way, step))
        return found

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Return each line that heats a coil to the robot's own trip."""
        if self.why_not:
            return ()
        problems = Problems(self.compiled.script.files)
        for step, (label, degc, at_ms) in self._hot().items():
            trip = f"the robot trips at {self.compiled.profile.coil.trip_degc} C"
            found = self.compiled.step(step)
            place = found.place if found else Place(self.compiled.script.main.name, 1, 1, 2)
            problems.add(place, "E328", f"coil {label} would come to {degc:.0f} C after {at_ms / 1000:.1f} s: {trip}")
        return in_order(problems.found)

    def as_dict(self) -> dict[str, object]:
        """Return the fields for JSON."""
        if self.why_not:
            return {"known": False, "why_not": self.why_not}
        return {
            "known": True,
            "trip_degc": self.compiled.profile.coil.trip_degc,
            "ways": {way or "only": {"end_ms": course.end_ms, "outcome": course.outcome, **_place(course.where)}
                     for way, course in self.ways.items()},
            "coils": {peak.track.label: _fields(peak) for peak in self.peaks()},
        }  # fmt: skip

    def lines(self) -> Iterator[str]:
        """Yield the peak of each coil as a user reads it."""
        if self.why_not:
            yield from [f"  {self.why_not}"] if self.compiled.profile.coil_labels else []
            return
        peaks = self.peaks()
        if peaks:
            yield f"  coil  predicted peak (trip {self.compiled.profile.coil.trip_degc} C)"
        for peak in peaks:
            at = f"at {peak.at_ms / 1000:.1f} s, {_written(peak.step)}"
            reach = f", any of {' '.join(peak.track.reach)}, the hottest way" if peak.track.reach else ""
            yield f"  {peak.track.label:<6}{peak.degc:6.1f} C  {at}{reach}"
        yield from self.remarks()

    def remarks(self) -> Iterator[str]:
        """Yield how the script would end otherwise than at its end, and what the two ways are."""
        for way, course in self.ways.items():
            told = f" {WAYS[way]}" if way else ""
            where = course.where.told(self.compiled.script.main.name) if course.where else ""
            if course.outcome == ABORTED:
                yield f"  predicted: the wait on {where} runs out, the script is aborted{told}"
            if course.outcome == GUARDED:
                yield f"  predicted: the guard on {where} trips after {course.end_ms / 1000:.1f} s{told}"
            if course.outcome == GIVEN_UP:
                yield f"  predicted for the first {course.end_ms / 1000:.0f} s only: the rest takes too much work"

    def _hot(self) -> dict[int, tuple[str, float, int]]:
        """Return the hottest coil beyond the trip by the step that heats it."""
        found: dict[int, tuple[str, float, int]] = {}
        for course in self.ways.values():
            for step, hot in course.hot.items():
                if step not in found or hot[1] > found[step][1]:
                    found[step] = hot
        return found


def foretell(compiled: Compiled, address: str) -> Forecast:
    """Return the forecast for the robot at an address, without curves."""
    return follow(compiled, model_of(address, compiled.profile))


def model_of(address: str, profile: Profile) -> Model:
    """Return the model of the robot at an address, or in one line why there is none."""
    try:
        return predictor(address, profile)
    except Unpredicted as reason:
        return str(reason)


def draw(compiled: Compiled, model: Model) -> Forecast:
    """Return the forecast by a model, with as much of the curves as a picture shows."""
    told_ms = max(course.told_ms for course in follow(compiled, model).ways.values())
    return follow(compiled, model, max(LEAST_MS, told_ms // POINTS))


def follow(compiled: Compiled, model: Model, every_ms: int = 0) -> Forecast:
    """Return the forecast by a model, with temperatures each `every_ms` at least, if not 0."""
    coils, why_not = (None, model) if isinstance(model, str) else (model, "")
    first = _play(compiled, coils, True, every_ms)
    early = late = first.run(compiled.plan)
    if first.unknown:
        late = _play(compiled, coils, False, every_ms).run(compiled.plan)
    return Forecast(compiled, early, late, why_not)


def _play(compiled: Compiled, coils: Coils | None, early: bool, every_ms: int) -> Play:
    if coils is not None:
        coils.restart()
    return Play(compiled.profile, coils, early, every_ms)


def _fields(peak: Peak) -> dict[str, object]:
    track = peak.track
    fields: dict[str, object] = {"peak_degc": round(peak.degc, 2), "at_ms": peak.at_ms, "way": peak.way or "only"}
    fields |= {**_place(peak.step.place if peak.step else None), "on_ms": track.on_ms}
    fields |= {"energy_mj": round(track.energy_mj, 1)}
    return fields | ({"any_of": list(track.reach)} if track.reach else {})


def _written(step: Step | None) -> str:
    """Return the line of a step."""
    return step.where if step else "before any order"


def _place(place: Place | None) -> dict[str, object]:
    return {"file": place.file if place else None, "line": place.line if place else None}
