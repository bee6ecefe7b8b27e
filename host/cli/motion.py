"""What `move` and `orient` share: watching joints to the end of their hold, and telling how they came out."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from host.errors import RobotFault, ScriptFailed
from host.limits import ServoLimits
from host.records import Event, Telemetry
from host.robot import Robot
from protocol import causes

PERIOD_MS = 20
AFTER_MS = 200  # what joints may take beyond their orders, by the line and the telemetry


@dataclass(slots=True)
class Motion:
    """How joints stood when they were driven last, by label, and the largest current that each took."""

    reached_deg: dict[str, float] = field(default_factory=dict)
    commanded_deg: dict[str, float] = field(default_factory=dict)
    peak_ma: dict[str, int] = field(default_factory=dict)
    object_deg: float | None = None

    def note(self, record: Telemetry, labels: tuple[str, ...]) -> bool:
        """Take a record of all joints, named by `labels`; return whether any is driven."""
        driven = False
        rows = zip(labels, record.joint_deg, record.commanded_deg, record.joint_ma, strict=False)
        for label, deg, commanded, ma in rows:
            self.peak_ma[label] = max(ma, self.peak_ma.get(label, 0))
            if commanded is not None:
                driven = True
                self.reached_deg[label], self.commanded_deg[label] = deg, commanded
        if driven:
            self.object_deg = record.object_deg
        return driven

    def of(self, labels: tuple[str, ...]) -> dict[str, dict[str, Any]]:
        """Return what there is to tell of these joints."""
        return {
            label: {"reached_deg": self.reached_deg.get(label), "peak_ma": self.peak_ma.get(label)} for label in labels
        }


def watched(face: Robot, time_ms: int) -> Motion:
    """Watch until every joint is limp again, or has had that much time and some more.

    RobotFault when the robot trips; ScriptFailed when it gives up for want of its camera.
    """
    motion, driven = Motion(), False
    for record in face.listen(time_ms + AFTER_MS):
        if isinstance(record, Event):
            _check(record, face)
        elif isinstance(record, Telemetry):
            before, driven = driven, motion.note(record, face.profile.joint_labels)
            if before and not driven:
                break
    return motion


def stretch_ms(limits: ServoLimits) -> int:
    """Return what a limp joint may take longer than ordered: it crosses its whole range as fast as it may."""
    return 1000 * (limits.most_centi - limits.least_centi) // limits.slew_centi_per_s + 1


def lines(joints: dict[str, dict[str, Any]], target_deg: float | None = None) -> Iterator[str]:
    """Yield a line for each joint."""
    told = "" if target_deg is None else f", told {target_deg:g} deg"
    for label, joint in joints.items():
        if joint["reached_deg"] is None:
            yield f"{label} no telemetry"
        else:
            yield f"{label} reached {joint['reached_deg']:.2f} deg{told}; {joint['peak_ma'] / 1000:.2f} A at most"


def _check(event: Event, face: Robot) -> None:
    """Raise what an event means for a motion."""
    if event.event == "tripped":
        raise RobotFault(event.code, event.value, event.coil, face.profile.parts.kind(event.coil))
    if event.event == "lost":
        row = causes.row(event.code)
        told = f"{row.name} {row.cause} {row.todo}" if row else f"code {event.code}"
        raise ScriptFailed(f"the robot gave up turning the object: {told}")
