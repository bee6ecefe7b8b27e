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

    Coils are measured by the self-test before arming, and while they are on; joints and what a camera sees always are.
    """
    with connected(robot) as face:
        status = face.status()
        parts = face.profile.parts
        coils = face.coils() if with_coils and parts.coils else {}
        joints = _joints(face) if parts.joints else {}
        line = face.statistics()
    fields = {"coils_seen": {label: asdict(coil) for label, coil in coils.items()}} if with_coils else {}
    lines = [*_joint_lines(joints), *(f"  {label:<11} {coil}" for label, coil in coils.items())]
    if with_coils and not coils:
        lines.append("  no coils")
    emit(as_json, {**_fields(status, line), **joints, **fields}, [*_lines(status, line, parts), *lines])


def _joints(face: Robot) -> dict[str, Any]:
    """Return how each joint stands, and the object if a camera sees it; nothing from a robot that tells none."""
    face.overhear(PERIOD_MS)
    heard = next((record for record in face.listen(LISTEN_MS) if isinstance(record, Telemetry)), None)
    face.overhear(0)
    if heard is None:
        return {}
    rows = zip(face.profile.joint_labels, heard.joint_deg, heard.commanded_deg, heard.joint_ma, strict=True)
    joints = {label: {"deg": deg, "commanded_deg": told, "ma": ma} for label, deg, told, ma in rows}
    return {"joints": joints, "object_deg": heard.object_deg}


def _joint_lines(seen: dict[str, Any]) -> Iterator[str]:
    for label, joint in seen.get("joints", {}).items():
        told = "limp" if joint["commanded_deg"] is None else f"told {joint['commanded_deg']:.2f} deg"
        yield f"  {label:<11} {joint['deg']:.2f} deg, {told}, {joint['ma'] / 1000:.2f} A"
    if seen.get("object_deg") is not None:
        yield f"  object      {seen['object_deg']:.2f} deg"


def _fields(status: Status, line: dict[str, int | None]) -> dict[str, object]:
    row = causes.row(status.code)
    return {**asdict(status), "code": row.name if row else None, "link": line}


def _lines(status: Status, line: dict[str, int | None], parts: Parts) -> Iterator[str]:
    yield ", ".join([status.state, *_driven(status, parts)])
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
