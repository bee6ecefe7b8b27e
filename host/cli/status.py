"""`softrig status`: the state of a robot."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

import click

from host.cli.connection import connected
from host.cli.options import json_option, robot_option
from host.cli.output import emit
from host.profile import Parts
from host.records import Status, Telemetry
from host.robot import Robot
from protocol import causes

PERIOD_MS, LISTEN_MS = 50, 500


@click.command("status")
@robot_option()
@click.option("--coils", "with_coils", is_flag=True, help="And what the resistance of each coil says of it.")
@json_option
def command(robot: str, with_coils: bool, as_json: bool) -> None:
    """Ask a robot for its state, its last fault, its supply and its line.

    Coils are measured by the self-test before arming, and while they are on; what else the robot feels always is.
    """
    with connected(robot) as face:
        status = face.status()
        parts = face.profile.parts
        coils = face.coils() if with_coils and parts.coils else {}
        felt = _felt(face) if parts.joints or parts.loads or parts.cells else {}
        line = face.statistics()
    fields = {"coils_seen": {label: asdict(coil) for label, coil in coils.items()}} if with_coils else {}
    lines = [*_felt_lines(felt, parts.unit), *(f"  {label:<11} {coil}" for label, coil in coils.items())]
    if with_coils and not coils:
        lines.append("  no coils")
    emit(as_json, {**_fields(status, line), **felt, **fields}, [*_lines(status, line, parts), *lines])


def _felt(face: Robot) -> dict[str, Any]:
    """Return how each joint stands, and what camera, load cell and force cells tell; nothing where none is heard."""
    face.overhear(PERIOD_MS)
    heard = next((record for record in face.listen(LISTEN_MS) if isinstance(record, Telemetry)), None)
    face.overhear(0)
    if heard is None:
        return {}
    parts = face.profile.parts
    rows = zip(parts.joints, heard.joint_position, heard.commanded_position, heard.joint_ma, strict=True)
    told = {
        "joints": {label: {parts.unit: at, f"commanded_{parts.unit}": to, "ma": ma} for label, at, to, ma in rows},
        "object_deg": heard.object_deg,
        "load_n": heard.load_n,
        "cell_kpa": dict(zip(parts.cells, heard.cell_kpa, strict=True)),
    }
    present = {"joints": parts.joints, "object_deg": parts.cameras, "load_n": parts.loads, "cell_kpa": parts.cells}
    return {name: value for name, value in told.items() if present[name]}


def _felt_lines(felt: dict[str, Any], unit: str) -> Iterator[str]:
    for label, joint in felt.get("joints", {}).items():
        commanded = joint[f"commanded_{unit}"]
        told = "limp" if commanded is None else f"told {commanded:.2f} {unit}"
        yield f"  {label:<11} {joint[unit]:.2f} {unit}, {told}, {joint['ma'] / 1000:.2f} A"
    if felt.get("object_deg") is not None:
        yield f"  object      {felt['object_deg']:.2f} deg"
    if felt.get("load_n") is not None:
        yield f"  force       {felt['load_n']:.2f} N"
    if felt.get("cell_kpa"):
        yield f"  cells       {', '.join(f'{label} {kpa:.2f}' for label, kpa in felt['cell_kpa'].items())} kPa"


def _fields(status: Status, line: dict[str, int | None]) -> dict[str, object]:
    row = causes.row(status.code)
    return {**asdict(status), "code": row.name if row else None, "link": line}


def _lines(status: Status, line: dict[str, int | None], parts: Parts) -> Iterator[str]:
    yield ", ".join([status.state, *_driven(status, parts)])
    if status.step or status.paused:
        yield f"  program     {'paused in ' if status.paused else ''}step {status.step}"
    row = causes.row(status.code)
    if row:
        yield f"  last fault  {row.name} {row.cause} {row.todo}"
    yield f"  supply      {status.supply_mv / 1000:.2f} V, {status.current_ma} mA; board {status.board_degc:.1f} C"
    if status.down is not None:
        yield f"  attitude    {status.down} down, pitch {status.pitch_deg:.1f} deg, roll {status.roll_deg:.1f} deg"
    yield f"  lease       {f'{status.lease_ms} ms left' if status.lease_ms else 'free'}"
    yield f"  up          {status.uptime_ms / 1000:.1f} s, {status.overruns} late control steps"
    trip = "-" if line["round_trip_ms"] is None else line["round_trip_ms"]
    forged = f", {status.forged} forged" if status.forged else ""
    yield f"  line        {status.dropped} frames damaged on their way to the robot{forged}, round trip {trip} ms"


def _driven(status: Status, parts: Parts) -> Iterator[str]:
    """Yield which coils are on and which joints are driven, of a robot that has such."""
    for what, labels in (("coils on", parts.coils), ("joints driven", parts.joints)):
        if labels:
            yield f"{what}: {' '.join(label for label in labels if label in status.coils) or 'none'}"
