"""The log of a session: an MCAP file with every byte both ways, telemetry, events and what an observer saw.

Messages are JSON with named fields and a schema each; times are the host's clock, and both clocks stand in every row.
A chunk is closed at 64 KiB, once a second, and at every fault, and handed to the system at once: a host that is killed
loses less than a second. Attached are the script, the robot's dictionary and the versions of everything.

    with LogWriter("run.mcap") as log:
        robot = Robot(link, log)
"""

from __future__ import annotations

import json
from base64 import b64encode
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext, suppress
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mcap.writer import Writer

from host.errors import BadRequest
from host.outages import LinkNews
from host.profile import Parts
from host.recording import Scene
from host.records import Event, Record, Sample, Telemetry, row_of
from host.topics import TOPICS

if TYPE_CHECKING:
    from host.fields import Mesh, Slice
    from host.gait.plan import Step

CHUNK_BYTES = 64 * 1024
CHUNK_MS = 1000
NS_PER_MS = 1_000_000


class LogWriter:
    """Writes one log; BadRequest, once, when the file cannot be made or the disk is full.

    `parts` name its coils and joints once the robot is known.
    """

    def __init__(self, path: str | Path) -> None:
        self.parts = Parts()
        self._path = path
        self._broken = False
        with self._writing():
            self._file = open(path, "wb")  # noqa: SIM115  # closed by close()
        self._writer = Writer(self._file, chunk_size=CHUNK_BYTES)
        with self._writing():
            self._writer.start(library="softrig")
            self._channels = {topic: self._channel(topic, fields) for topic, fields in TOPICS.items()}
        self._chunk_ms: int | None = None

    def __enter__(self) -> LogWriter:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        with suppress(BadRequest) if kind else nullcontext():  # what went wrong first is what is told
            self.close()

    def line(self, direction: str, data: bytes, host_ms: int, robot_ms: int | None) -> None:
        """Keep bytes that went "out" or came "in"."""
        row = {"host_ms": host_ms, "now_ms": robot_ms, "direction": direction, "data": b64encode(data).decode()}
        self._add("bytes", host_ms, row)

    def record(self, record: Record) -> None:
        """Keep what the robot told; a fault closes the chunk."""
        row = row_of(record, self.parts)
        if isinstance(record, Telemetry):
            self._add("telemetry", record.host_ms, row)
        elif isinstance(record, Sample):
            self._add("samples", record.host_ms, row)
        elif isinstance(record, Event):
            self._add("events", record.host_ms, row)
            if record.code:
                self._flush(record.host_ms)
        else:
            self._add("stops", record.host_ms, row)
            self._flush(record.host_ms)

    def note(self, event: Event, step: Step) -> None:
        """Keep what a note of the script says, when the robot has come to it."""
        row = {"host_ms": event.host_ms, "now_ms": event.now_ms, "step": step.number}
        place = {"file": step.place.file, "line": step.place.line}
        self._add("notes", event.host_ms, {**row, **place, "text": step.note})

    def link(self, news: LinkNews) -> None:
        """Keep what became of the line, and how the clocks stood."""
        self._add("line", news.host_ms, asdict(news))

    def scene(self, scene: Scene) -> None:
        """Keep what an observer saw."""
        self._add("scenes", scene["host_ms"], scene)

    def mesh(self, mesh: Mesh, host_ms: int) -> None:
        """Keep the mesh of a body that an observer sees inside, before its slices."""
        from host.fields import mesh_row  # noqa: PLC0415  (numpy, which most logs do not need)

        self._add("mesh", host_ms, mesh_row(mesh, host_ms))

    def slice(self, taken: Slice) -> None:
        """Keep what an observer saw inside a body."""
        from host.fields import slice_row  # noqa: PLC0415

        self._add("fields", taken.host_ms, slice_row(taken))

    def attach(self, name: str, data: bytes, media_type: str = "text/plain") -> None:
        """Attach a file: the script, the dictionary, the versions, the report."""
        if self._broken:
            return
        with self._writing():
            self._writer.add_attachment(create_time=0, log_time=0, name=name, media_type=media_type, data=data)
            self._file.flush()

    def close(self) -> None:
        """End the file; closing twice does nothing."""
        if self._file.closed:
            return
        try:
            if not self._broken:
                with self._writing():
                    self._writer.finish()  # type: ignore[no-untyped-call]
                    self._file.flush()
        finally:
            with suppress(OSError):
                self._file.close()

    @contextmanager
    def _writing(self) -> Iterator[None]:
        """Say that the log cannot be written, and write no more: the robot must still be left with everything off."""
        try:
            yield
        except OSError as error:
            self._broken = True
            raise BadRequest(f"cannot write the log {self._path}: {error.strerror}") from error

    def _channel(self, topic: str, properties: dict[str, Any]) -> int:
        schema = {"type": "object", "title": f"softrig.{topic}", "properties": properties}
        number = self._writer.register_schema(f"softrig.{topic}", "jsonschema", json.dumps(schema).encode())
        return int(self._writer.register_channel(topic, "json", number))

    def _add(self, topic: str, host_ms: int, row: dict[str, Any]) -> None:
        if self._broken:
            return
        time_ns = host_ms * NS_PER_MS
        data = json.dumps(row, separators=(",", ":")).encode()
        with self._writing():
            self._writer.add_message(self._channels[topic], log_time=time_ns, data=data, publish_time=time_ns)
        if self._chunk_ms is None:
            self._chunk_ms = host_ms
        elif host_ms - self._chunk_ms >= CHUNK_MS:
            self._flush(host_ms)

    def _flush(self, host_ms: int) -> None:
        if self._broken:
            return
        with self._writing():
            self._writer.flush()  # type: ignore[no-untyped-call]
        self._chunk_ms = host_ms
