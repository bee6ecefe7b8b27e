"""`softrig status`: the state of a robot."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict

import click

from host.cli.connection import connected
from host.cli.options import json_option, robot_option
from host.cli.output import emit
from host.profile import Parts
from host.records import Status
from protocol import causes


@click.command("status")
@robot_option()
@click.option("--coils", "with_coils", is_flag=True, help="And what the resistance of each coil says of it.")
@json_option
def command(robot: str, with_coils: bool, as_json: bool) -> None:
    """Ask a robot for its state, its last fault, its supply and its line.

    Coils are measured by the self-test before arming, and while they are on.
    """
    with connected(robot) as face:
        status = face.status()
        parts = face.profile.parts
        coils = face.coils() if with_coils and parts.coils else {}
        line = face.statistics()
    fields = {"coils_seen": {label: asdict(coil) for label, coil in coils.items()}} if with_coils else {}
    lines = [f"  {label:<11} {coil}" for label, coil in coils.items()]
    if with_coils and not coils:
        lines = ["  no coils"]
    emit(as_json, {**_fields(status, line), **fields}, [*_lines(status, line, parts), *lines])


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
