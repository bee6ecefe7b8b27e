"""What `move`, `orient` and `press` share: watching joints to the end of their hold, telling how they came out."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

from host.errors import RobotFault, ScriptFailed
from host.limits import ServoLimits
from host.profile import Parts
from host.records import Event, Telemetry
from host.robot import Robot
from protocol import causes

PERIOD_MS = 20
AFTER_MS = 200  # what joints may take beyond their orders, by the line and the telemetry

Joints = dict[str, dict[str, Any]]


@dataclass(slots=True)
class Motion:
    """How joints stood when they were driven last, by label, the largest current that each took, and what was felt."""

    parts: Parts
    reached: dict[str, float] = field(default_factory=dict)  # in the unit of the joints, as what was commanded
    commanded: dict[str, float] = field(default_factory=dict)
    peak_ma: dict[str, int] = field(default_factory=dict)
    object_deg: float | None = None
    load_peak_n: float | None = None
    cell_peak_kpa: dict[str, float] = field(default_factory=dict)

    def note(self, record: Telemetry) -> bool:
        """Take a record; return whether any joint is driven."""
        driven = False
        rows = zip(self.parts.joints, record.joint_position, record.commanded_position, record.joint_ma, strict=False)
        for label, position, commanded, ma in rows:
            self.peak_ma[label] = max(ma, self.peak_ma.get(label, 0))
            if commanded is not None:
                driven = True
                self.reached[label], self.commanded[label] = position, commanded
        if driven:
            self.object_deg = record.object_deg
        self._feel(record)
        return driven

    def of(self, labels: tuple[str, ...]) -> Joints:
        """Return what there is to tell of these joints."""
        name = f"reached_{self.parts.unit}"
        return {label: {name: self.reached.get(label), "peak_ma": self.peak_ma.get(label)} for label in labels}

    def felt(self) -> dict[str, Any]:
        """Return what load cell and force cells felt; nothing on a robot that has none."""
        load = {"load_peak_n": self.load_peak_n} if self.parts.loads else {}
        return {**load, **({"cell_peak_kpa": self.cell_peak_kpa} if self.parts.cells else {})}

    def _feel(self, record: Telemetry) -> None:
        """Take note of the greatest force and pressures."""
        if record.load_n is not None:
            self.load_peak_n = record.load_n if self.load_peak_n is None else max(record.load_n, self.load_peak_n)
        for label, kpa in zip(self.parts.cells, record.cell_kpa, strict=False):
            self.cell_peak_kpa[label] = max(kpa, self.cell_peak_kpa.get(label, kpa))


def watched(face: Robot, time_ms: int, show: Callable[[Telemetry], None] | None = None) -> Motion:
    """Watch until every joint is limp again, or has had that much time and some more; `show` is given each record.

    RobotFault when the robot trips; ScriptFailed when it gives up for want of its camera.
    """
    motion, driven = Motion(face.profile.parts), False
    for record in face.listen(time_ms + AFTER_MS):
        if isinstance(record, Event):
            _check(record, face)
        elif isinstance(record, Telemetry):
            if show:
                show(record)
            before, driven = driven, motion.note(record)
            if before and not driven:
                break
    return motion


def stretch_ms(limits: ServoLimits) -> int:
    """Return what a limp joint may take longer than ordered: it crosses its whole range as fast as it may."""
    return 1000 * (limits.most_centi - limits.least_centi) // limits.slew_centi_per_s + 1


def lines(joints: Joints, unit: str, target: float | None = None) -> Iterator[str]:
    """Yield a line for each joint, of positions in that unit."""
    told = "" if target is None else f", told {target:g} {unit}"
    for label, joint in joints.items():
        reached = joint[f"reached_{unit}"]
        if reached is None:
            yield f"{label} no telemetry"
        else:
            yield f"{label} reached {reached:.2f} {unit}{told}; {joint['peak_ma'] / 1000:.2f} A at most"


def felt_lines(felt: dict[str, Any]) -> Iterator[str]:
    """Yield a line of the force, and one of the pressures, as far as anything was felt."""
    if felt.get("load_peak_n") is not None:
        yield f"force {felt['load_peak_n']:.2f} N at most"
    if felt.get("cell_peak_kpa"):
        peaks = ", ".join(f"{label} {kpa:.2f}" for label, kpa in felt["cell_peak_kpa"].items())
        yield f"cells at most {peaks} kPa"


def _check(event: Event, face: Robot) -> None:
    """Raise what an event means for a motion."""
    if event.event == "tripped":
        parts = face.profile.parts
        raise RobotFault(event.code, event.value, event.coil, parts.kind(event.coil), parts.unit)
    if event.event == "lost":
        row = causes.row(event.code)
        told = f"{row.name} {row.cause} {row.todo}" if row else f"code {event.code}"
        raise ScriptFailed(f"the robot gave up turning the object: {told}")
