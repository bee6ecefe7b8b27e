"""Reads logs, also those whose writer was killed: whatever is whole is read, and `complete` says whether all was.

log = read_log("run.mcap")
log.write_csv(file, "telemetry")
picture = draw(log.recording())
"""

from __future__ import annotations

import csv
import json
import struct
from collections import Counter
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any

from mcap.exceptions import McapError
from mcap.records import Attachment, Channel, Message
from mcap.stream_reader import StreamReader
from zstandard import ZstdError

from host.errors import BadRequest
from host.limits import UNITS
from host.recording import Recording
from host.records import PER_CELL, PER_COIL, PER_JOINT, Event, Telemetry, column

Row = dict[str, Any]
RECORD_MAX = 1 << 28  # bytes; a greater length is damage


@dataclass
class Log:
    """What a log holds: rows by topic in the order of arrival, and the attached files."""

    path: Path
    rows: dict[str, list[Row]] = field(default_factory=dict)
    attachments: dict[str, bytes] = field(default_factory=dict)
    complete: bool = False

    def labels(self, name: str = "duty_permille") -> tuple[str, ...]:
        """Return the coils, or whatever a value of that name is told of, that the telemetry names."""
        rows = self.rows.get("telemetry", ())
        return tuple(rows[0].get(name, ())) if rows else ()

    def unit(self) -> str:
        """Return the unit of the joints' positions."""
        return next((unit for unit in UNITS if self.labels(column("joint_position", unit))), UNITS[0])

    def recording(self) -> Recording:
        """Return the run as pictures look back on it."""
        recording = Recording(self.labels(), title=self.title(), joints=self.labels("joint_ma"))
        recording.unit, recording.cells = self.unit(), self.labels("cell_kpa")
        recording.scenes += self.rows.get("scenes", ())
        recording.telemetry += [_telemetry(row, recording.unit) for row in self.rows.get("telemetry", ())]
        recording.events += [Event(**row) for row in self.rows.get("events", ())]
        self._see_inside(recording)
        return recording

    def _see_inside(self, recording: Recording) -> None:
        """Add mesh and slices, where the log has them; rows that are damaged end them."""
        if "mesh" not in self.rows:
            return
        from host.fields import mesh_from, slice_from  # noqa: PLC0415  (numpy, which most logs do not need)

        with suppress(KeyError, TypeError, ValueError):
            recording.mesh = mesh_from(self.rows["mesh"][0])
            for row in self.rows.get("fields", ()):
                recording.slices.append(slice_from(row, recording.mesh))

    def title(self) -> str:
        """Return what the run was: its script and address, or the name of the file."""
        versions = json.loads(self.attachments.get("versions.json", b"{}"))
        return f"{Path(versions['script']).name} on {versions['address']}" if "script" in versions else self.path.name

    def info(self) -> Row:
        """Return what is in the log."""
        times = [row["host_ms"] for rows in self.rows.values() for row in rows]
        return {
            "file": str(self.path),
            "complete": self.complete,
            "duration_s": (max(times) - min(times)) / 1000 if times else 0.0,
            "rows": {topic: len(rows) for topic, rows in sorted(self.rows.items())},
            "events": dict(Counter(row["event"] for row in self.rows.get("events", ()))),
            "attachments": {name: len(data) for name, data in self.attachments.items()},
            "versions": json.loads(self.attachments.get("versions.json", b"{}")),
        }

    def write_csv(self, file: IO[str], topic: str) -> int:
        """Write one topic as CSV, nested values as `duty_permille.A`, and return the number of rows."""
        if topic not in self.rows:
            raise BadRequest(f"{self.path} has no {topic}: it holds {', '.join(sorted(self.rows)) or 'no rows'}")
        rows = [dict(_flat(row)) for row in self.rows[topic]]
        columns = dict.fromkeys(name for row in rows for name in row)
        writer = csv.DictWriter(file, list(columns), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
        return len(rows)


def read_log(path: str | Path) -> Log:
    """Return what can be read of the log at `path`; BadRequest when it is no log at all."""
    log = Log(Path(path))
    try:
        with log.path.open("rb") as file:
            log.complete = _read(file, log)
    except OSError as error:
        raise BadRequest(f"cannot read {path}: {error.strerror}") from error
    return log


def _read(file: IO[bytes], log: Log) -> bool:
    """Fill `log` from the file; return whether its end was reached in good order."""
    topics: dict[int, str] = {}
    if file.read(8) != b"\x89MCAP0\r\n":
        raise BadRequest(f"{log.path} is no log of softrig (it is not MCAP)")
    file.seek(0)
    reader = StreamReader(file, validate_crcs=True, record_size_limit=RECORD_MAX)
    try:
        for record in reader.records:
            if isinstance(record, Channel):
                topics[record.id] = record.topic
            elif isinstance(record, Message):
                log.rows.setdefault(topics[record.channel_id], []).append(json.loads(record.data))
            elif isinstance(record, Attachment):
                log.attachments[record.name] = record.data
    except (McapError, EOFError, ValueError, KeyError, struct.error, ZstdError):
        return False
    return True


def _telemetry(row: Row, unit: str) -> Telemetry:
    named = {name: column(name, unit) for name in (*PER_COIL, *PER_JOINT, *PER_CELL)}
    by_label = {name: tuple(row.get(told, {}).values()) for name, told in named.items()}
    rest = {name: value for name, value in row.items() if name not in named.values()}
    return Telemetry(**{**rest, **by_label})


def _flat(row: Row, before: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in row.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{before}{name}.")
        else:
            yield before + name, json.dumps(value) if isinstance(value, list) else value
