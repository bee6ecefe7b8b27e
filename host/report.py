"""The report of a run: what came of it, what each coil was given, what the line did, what an observer saw.

On a bench in this process it is a function of script and seed alone, except the fields under "wall". On-time and
energy are summed over the telemetry, each record holding until the next one; the energy is that of the coil itself:
duty x (measured supply voltage / (coil + wiring))^2 x coil, with the resistances of the robot's profile.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from host.gait.compiler import Compiled
from host.linereport import interruption, line_lines
from host.outages import Interruption
from host.profile import Profile
from host.recording import Recording
from host.records import Event, Telemetry
from host.robot import ENDS
from host.run import Ending
from protocol import causes

ENERGY = "duty x (measured supply / (coil + wiring))^2 x coil, resistances of the profile"
SEEN = {
    "travel_mm": "{:.1f} mm",
    "lateral_mm": "{:.1f} mm",
    "rotation_deg": "{:.1f} deg",
    "apex_mm": "{:.2f} mm",
    "clearance_mm": "{:.2f} mm",
    "peak_coil_degc": "{:.1f} C",
    "peak_coil_force_n": "{:.3f} N",
}
Fields = dict[str, Any]


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
        "coils": coils(recording, facts.compiled.profile),
        "energy_is": ENERGY,
        "faults": [fault(event, recording, facts.compiled) for event in recording.events if event.code],
        "link": facts.statistics,
        "interruptions": [interruption(each, recording) for each in facts.interruptions],
    }
    if facts.observer is not None:
        observed = facts.observer.observe()
        if "trace_sha256" in observed:
            fields["trace_sha256"] = observed.pop("trace_sha256")
        fields["observed"] = _rounded(observed)
    took = facts.took
    fields["wall"] = {"time_s": round(took.wall_s, 3), "real_time_factor": round(took.line_s / took.wall_s, 1)}
    return fields


def coils(recording: Recording, profile: Profile) -> dict[str, Fields]:
    """Return on-time, energy and highest estimated temperature of each coil."""
    on_s = [0.0] * len(profile.labels)
    energy_j = [0.0] * len(profile.labels)
    for held_s, record in _held(recording.telemetry):
        for i, duty_permille in enumerate(record.duty_permille):
            on_s[i] += held_s if duty_permille else 0.0
            energy_j[i] += held_s * duty_permille / 1000 * _power_w(record.supply_mv, profile)
    peaks = [max(degc) for degc in zip(*(record.temperature_degc for record in recording.telemetry), strict=True)]
    return {
        label: {
            "on_s": round(on_s[i], 3),
            "energy_j": round(energy_j[i], 4),
            "peak_estimated_degc": peaks[i] if peaks else None,
        }
        for i, label in enumerate(profile.labels)
    }


def fault(event: Event, recording: Recording, compiled: Compiled) -> Fields:
    """Return a fault with its row of the table of codes and the line of the script that was running."""
    row, step = causes.row(event.code), compiled.step(event.step)
    return {
        "code": row.name if row else str(event.code),
        "cause": row.cause if row else "unknown to this version",
        "coil": event.coil,
        "value": event.value,
        "unit": row.unit if row else "",
        "at_s": recording.seconds(event.host_ms),
        "line": step.place.line if step else None,
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
    yield from _observed_lines(fields.get("observed", {}))
    yield "  coil    on time   energy   peak (estimate)"
    for label, coil in fields["coils"].items():
        if coil["on_s"]:
            peak = f"{coil['peak_estimated_degc']:7.1f} C" if coil["peak_estimated_degc"] is not None else ""
            yield f"  {label:<6}{coil['on_s']:7.2f} s {coil['energy_j']:6.3f} J {peak}"
    for item in fields["faults"]:
        where = f", line {item['line']}" if item["line"] else ""
        coil = f", coil {item['coil']}" if item["coil"] else ""
        value = f" {item['value']} {item['unit']}" if item["unit"] else ""
        yield f"  fault            {item['code']} at {item['at_s']:.2f} s{where}{coil}: {item['cause']}{value}"
    yield from line_lines(fields)


def _observed_lines(observed: Fields) -> Iterator[str]:
    """Yield what the observer saw of the body."""
    for name, form in SEEN.items():
        if name in observed:
            yield f"  {name.rpartition('_')[0].replace('_', ' '):<17}{form.format(observed[name])}"
    if observed.get("down"):
        yield f"  {'down':<17}{observed['down']}"
    if observed.get("jump"):
        yield f"  {'jump':<17}{_jump_line(observed['jump'])}"


def _jump_line(jump: Fields) -> str:
    """Return the line about a jump."""
    stored, released = f"stored {jump['stored_mj']:.1f} mJ", f"released {jump['released_mj']:.1f} mJ"
    takeoff = f"take-off {jump['takeoff_m_per_s']:.2f} m/s at {jump['takeoff_s']:.2f} s"
    return f"{stored}, {released}, {takeoff}, apex {jump['apex_mm']:.0f} mm, losses {jump['losses_mj']:.1f} mJ"


def _rounded(value: Any) -> Any:
    """Return the value with all its numbers to a ten-thousandth of their unit."""
    if isinstance(value, dict):
        return {name: _rounded(item) for name, item in value.items()}
    if isinstance(value, list | tuple):
        return [_rounded(item) for item in value]
    return round(float(value), 4) if isinstance(value, float) else value


def _held(records: list[Telemetry]) -> Iterator[tuple[float, Telemetry]]:
    """Yield each record with the seconds of the robot's clock until the next one."""
    for record, following in pairwise(records):
        yield (following.now_ms - record.now_ms) % (1 << 32) / 1000, record


def _power_w(supply_mv: int, profile: Profile) -> float:
    """Return the power of one coil that is fully on."""
    coil_ohm = profile.coil.resistance_mohm / 1000
    current_a = supply_mv / 1000 / (coil_ohm + profile.coil.wiring_mohm / 1000)
    return current_a * current_a * coil_ohm


def _duration_s(recording: Recording) -> float:
    """Return the time from the program's start to its end, or to the last that was heard, on the robot's clock."""
    started = [event.now_ms for event in recording.events if event.event == "started"]
    ended = [event.now_ms for event in recording.events if event.event in ENDS]
    last = [record.now_ms for record in recording.telemetry[-1:]]
    return ((ended or last)[0] - started[0]) % (1 << 32) / 1000 if started and (ended or last) else 0.0
