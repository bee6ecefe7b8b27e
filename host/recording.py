"""A run as pictures and reports look back on it: the robot's telemetry and events, and what an observer saw.

A scene is what the address's observer (the bench; a motion-capture system) says of one instant: `snapshot()` (hub,
nodes and coils in the plane's own axes, of two coordinates or three, mm and degrees Celsius), `observe()` under
"observed" (travel_mm, ...) and the host's clock at that time. A real robot has no observer and its recording no scenes.
One that sees inside a body (`fields()`) gives slices of it over its mesh, see `fields`.

    recording = Recording(robot.profile.coil_labels, "circular-crawl.gait on sim:circular")
    recording.note(record)                    # each Telemetry and Event
    recording.look(link.observer, host_ms)    # beside each telemetry, where there is an observer
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from host.records import Event, Telemetry

if TYPE_CHECKING:
    from host.fields import Mesh, Slice  # numpy is slow to import, and most robots have none

Scene = dict[str, Any]


@dataclass(slots=True)
class Recording:
    """What was seen of one run; `labels` are the coils, `joints` the joints, `cells` the force cells of the telemetry.

    `unit` is that of the joints' positions.
    """

    labels: tuple[str, ...]
    title: str = ""
    telemetry: list[Telemetry] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    scenes: list[Scene] = field(default_factory=list)
    joints: tuple[str, ...] = ()
    unit: str = "deg"
    cells: tuple[str, ...] = ()
    at_end: Scene | None = None  # of joints: what the observer observed when the program ended, and they still held
    mesh: Mesh | None = None  # of the body, where an observer sees inside it
    slices: list[Slice] = field(default_factory=list)

    def note(self, record: object) -> None:
        """Keep a record that pictures need; others are passed over."""
        if isinstance(record, Telemetry):
            self.telemetry.append(record)
        elif isinstance(record, Event):
            self.events.append(record)

    def look(self, observer: Any, host_ms: int) -> None:
        """Keep what `observer` sees now; nothing when there is none."""
        if observer is not None:
            self.scenes.append({**observer.snapshot(), "observed": observer.observe(), "host_ms": host_ms})

    def start_ms(self) -> int:
        """Return the host's clock when the program started, else when the record begins."""
        started = [event.host_ms for event in self.events if event.event == "started"]
        if started:
            return started[0]
        begun = [record.host_ms for record in self.telemetry[:1]] + [scene["host_ms"] for scene in self.scenes[:1]]
        return min(begun, default=0)

    def seconds(self, host_ms: int) -> float:
        """Return the time since the start in seconds."""
        return (host_ms - self.start_ms()) / 1000

    def driven(self, host_ms: int) -> tuple[str, ...]:
        """Return the coils that were on by the telemetry of that time, or the last before it."""
        found = bisect_right(self.telemetry, host_ms, key=lambda row: row.host_ms)
        duties = self.telemetry[found - 1].duty_permille if found else ()
        return tuple(label for label, duty in zip(self.labels, duties, strict=False) if duty)
