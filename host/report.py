"""The report of a run: what came of it, what coils and joints did, what the line did, what an observer saw.

On a bench in this process it is a function of script and seed alone, except the fields under "wall".
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from host.drivenreport import driven, driven_lines
from host.errors import amount, unit_of
from host.gait.compiler import Compiled
from host.linereport import interruption, line_lines
from host.observed import observed, observed_lines
from host.outages import Interruption
from host.recording import Recording
from host.records import Event
from host.robot import ENDS
from host.run import Ending
from host.stepreport import CAUGHT, step_lines, steps
from protocol import causes, program

Fields = dict[str, Any]
PRESS = program.NAMES[program.PRESS]


@dataclass(frozen=True, slots=True)
class Took:
    """How long a run took: on the wall's clock, and on the line's."""

    wall_s: float
    line_s: float


@dataclass(frozen=True, slots=True)
class Facts:
    """What a report is made of, beside the record of the run."""

    compiled: Compiled
    address: str
    info: Fields
    statistics: Fields
    observer: Any
    took: Took
    interruptions: Sequence[Interruption] = ()


def report(ending: Ending | None, recording: Recording, facts: Facts) -> Fields:
    """Return the report as it stands on `--json`; without an ending it is that of a dry run."""
    fields: Fields = {
        "result": ending.result if ending else "dry run",
        "script": facts.compiled.script.main.name,
        "parameters": {name: str(value) for name, value in facts.compiled.params.items()},
        "address": facts.address,
        **{name: facts.info[name] for name in ("robot", "firmware", "protocol", "dictionary", "session")},
        "duration_s": _duration_s(recording),
        **_driven(recording, facts.compiled),
        **steps(recording, facts.compiled, is_done=ending is None or ending.result == "done"),
        "faults": [fault(event, recording, facts.compiled) for event in _faults(recording.events)],
        "link": facts.statistics,
        "interruptions": [interruption(each, recording) for each in facts.interruptions],
    }
    if facts.observer is not None:
        seen = observed(facts.observer, recording)
        if "trace_sha256" in seen:
            fields["trace_sha256"] = seen.pop("trace_sha256")
        fields["observed"] = _rounded(seen)
    took = facts.took
    fields["wall"] = {"time_s": round(took.wall_s, 3), "real_time_factor": round(took.line_s / took.wall_s, 1)}
    return fields


def _driven(recording: Recording, compiled: Compiled) -> Fields:
    """Return the fields about coils, joints and cells, with the greatest force that the program asks for."""
    fields = driven(recording, compiled.profile)
    if "force" in fields:
        ops = program.disassemble(compiled.code)
        fields["force"]["asked_n"] = max((op[2] / 1000 for op in ops if op[1] == PRESS), default=None)
    return fields


def _faults(events: Sequence[Event]) -> list[Event]:
    """Return the events that have a fault to tell; one that was caught is not told again when the program ends."""
    caught = next((event.code for event in events if event.event == CAUGHT), None)
    return [event for event in events if event.code and (event.event != "aborted" or event.code != caught)]


def fault(event: Event, recording: Recording, compiled: Compiled) -> Fields:
    """Return a fault with its row of the table of codes and the line of the script that was running."""
    row, step = causes.row(event.code), compiled.step(event.step)
    return {
        "code": row.name if row else str(event.code),
        "cause": row.cause if row else "unknown to this version",
        "coil": event.coil,
        "value": event.value,
        "unit": unit_of(row, compiled.profile.unit),
        "at_s": recording.seconds(event.host_ms),
        "file": step.place.file if step else None,
        "line": step.place.line if step else None,
        "where": step.where if step else None,
    }


def lines(fields: Fields) -> Iterator[str]:
    """Yield the report as a user reads it."""
    yield f"{fields['script']} on {fields['address']}: {fields['result']}"
    yield f"  robot            {fields['robot']}, {fields['firmware']}, dictionary {fields['dictionary']}"
    for name, value in fields["parameters"].items():
        yield f"  parameter        {name} = {value}"
    wall = fields["wall"]
    factor = f"{wall['real_time_factor']:g} x real time"
    yield f"  time             {fields['duration_s']:.2f} s, took {wall['time_s']:.2f} s ({factor})"
    yield from observed_lines(fields.get("observed", {}))
    yield from driven_lines(fields)
    for item in fields["faults"]:
        where = f", {item['where']}" if item["where"] else ""
        kind = "joint" if item["coil"] in fields.get("joints", ()) else "coil"
        coil = f", {kind} {item['coil']}" if item["coil"] else ""
        value = f" {amount(item['value'], item['unit'])}" if item["unit"] else ""
        yield f"  fault            {item['code']} at {item['at_s']:.2f} s{where}{coil}: {item['cause']}{value}"
    yield from step_lines(fields)
    yield from line_lines(fields)


def _rounded(value: Any) -> Any:
    """Return the value with all its numbers to a ten-thousandth of their unit."""
    if isinstance(value, dict):
        return {name: _rounded(item) for name, item in value.items()}
    if isinstance(value, list | tuple):
        return [_rounded(item) for item in value]
    return round(float(value), 4) if isinstance(value, float) else value


def _duration_s(recording: Recording) -> float:
    """Return the time from the program's start to its end, or to the last that was heard, on the robot's clock."""
    started = [event.now_ms for event in recording.events if event.event == "started"]
    ended = [event.now_ms for event in recording.events if event.event in ENDS]
    last = [record.now_ms for record in recording.telemetry[-1:]]
    return ((ended or last)[0] - started[0]) % (1 << 32) / 1000 if started and (ended or last) else 0.0
