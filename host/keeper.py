"""What passes during a run, kept: what the robot tells, and what an observer sees of the body and inside it.

keeper = Keeper(log, link.observer)
with Robot(link, keeper) as robot:
    robot.connect()
    keeper.know(robot.profile.parts)
    run(robot, compiled.program, progress)
keeper.recording
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from host.attention import Attention
from host.log import LogWriter
from host.outages import LinkNews
from host.profile import Parts
from host.recording import Recording, Scene
from host.records import Event, Record, Telemetry
from host.robot import ENDS
from host.slicing import EVERY_MS, Slicing

if TYPE_CHECKING:
    from host.fields import Mesh, Slice
    from host.gait.plan import Step


class Keeper:
    """Keeps what passes during a run: in a Recording, and in a log if there is one; with `scenes` also what is seen.

    A long run shows much: unless it is to be `drawn`, that goes to the log alone.
    """

    def __init__(
        self,
        log: LogWriter | None = None,
        observer: Any = None,
        scenes: bool = True,
        slice_ms: int = EVERY_MS,
        drawn: bool = True,
    ) -> None:
        self.recording = Recording(())
        self.steps: Sequence[Step] = ()  # of the script that runs, for its notes
        self._log = log
        self._observer = observer
        self._scenes = scenes
        self._drawn = drawn
        self._seen: Scene | None = None  # last
        self._attention = Attention()
        self._slicing = Slicing(observer if scenes else None, self._keep_slice, slice_ms)
        if scenes and hasattr(observer, "watch"):
            observer.watch(self.glance)

    def know(self, parts: Parts) -> None:
        """Take the labels of what the robot has, once it has told them."""
        self.recording.labels, self.recording.joints = parts.coils, parts.joints
        self.recording.unit, self.recording.cells = parts.unit, parts.cells
        if self._log:
            self._log.parts = parts

    def line(self, direction: str, data: bytes, host_ms: int, robot_ms: int | None) -> None:
        """Keep bytes that went "out" or came "in"."""
        if self._log:
            self._log.line(direction, data, host_ms, robot_ms)

    def record(self, record: Record) -> None:
        """Keep what the robot told, and beside each telemetry what the observer sees."""
        self.recording.note(record)
        if self._log:
            self._log.record(record)
            if isinstance(record, Event) and record.event == "noted" and 0 < record.step <= len(self.steps):
                self._log.note(record, self.steps[record.step - 1])
        if self._observer is None:
            return
        if self._scenes and isinstance(record, Telemetry):
            self._keep(self._observer.snapshot(), record.host_ms)
            self._slicing.look(record.host_ms)
        if isinstance(record, Event) and record.event in ("started", *ENDS):
            self._slicing.take(record.host_ms)
        if self.recording.joints and isinstance(record, Event) and record.event in ENDS and not self.recording.at_end:
            self.recording.at_end = self._observer.observe()

    def link(self, news: LinkNews) -> None:
        """Keep what became of the line."""
        if self._log:
            self._log.link(news)

    def glance(self, host_ms: int) -> None:
        """Keep what the observer sees, once telemetry comes: slices when due, else if the body moves quickly."""
        if not self.recording.telemetry:
            return
        self._slicing.look(host_ms)
        snapshot = self._observer.snapshot()
        if self._attention.stirs(snapshot):
            self._keep(snapshot, host_ms)

    def _keep(self, snapshot: Scene, host_ms: int) -> None:
        """Keep what the observer sees, unless no time has passed for the body since it was last seen."""
        if self._seen is not None and self._seen["t_s"] == snapshot["t_s"]:
            return
        self._attention.keep(snapshot)
        self._seen = {**snapshot, "observed": self._observer.observe(), "host_ms": host_ms}
        if self._drawn:
            self.recording.scenes.append(self._seen)
        if self._log:
            self._log.scene(self._seen)

    def _keep_slice(self, mesh: Mesh, taken: Slice) -> None:
        """Keep what the observer sees inside the body."""
        if self._log and self.recording.mesh is None:
            self._log.mesh(mesh, taken.host_ms)
        self.recording.mesh = mesh
        if self._drawn:
            self.recording.slices.append(taken)
        if self._log:
            self._log.slice(taken)
