"""`softrig faults`: what a robot remembers of its faults, also of those before its last reset or power cut."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict

import click

from host.cli.connection import connected
from host.cli.options import json_option, robot_option
from host.cli.output import emit
from host.errors import amount, unit_of
from host.kept import Fault
from host.profile import Parts
from protocol import causes


@click.command("faults")
@click.option("--clear", is_flag=True, help="Forget them, once they are told.")
@robot_option()
@json_option
def command(robot: str, as_json: bool, clear: bool) -> None:
    """List the last faults of a robot, newest first, also those before its last reset or power cut.

    Starts of the firmware are counted as far as they had a fault to keep; times are since that start.
    """
    with connected(robot) as face:
        faults = face.faults()
        if clear:
            face.clear_faults()
        parts = face.profile.parts
    told = [_fields(fault, parts) for fault in faults]
    emit(as_json, {"faults": told, "cleared": clear}, _lines(faults, clear, parts))


def _fields(fault: Fault, parts: Parts) -> dict[str, object]:
    row = causes.row(fault.code)
    return {**asdict(fault), "code": row.name if row else fault.code, "unit": unit_of(row, parts.unit)}


def _lines(faults: list[Fault], cleared: bool, parts: Parts) -> Iterator[str]:
    if not faults:
        yield "no faults are kept"
    for fault in faults:
        row = causes.row(fault.code)
        what = f"{row.name} {row.cause}" if row else f"code {fault.code}, unknown to this version"
        where = f", {parts.kind(fault.coil)} {fault.coil}" if fault.coil else ""
        unit = unit_of(row, parts.unit)
        figure = f" ({amount(fault.value, unit)})" if unit else ""
        yield f"start {fault.start} ({fault.cause}), {fault.now_ms / 1000:.3f} s, {fault.state}{where}: {what}{figure}"
    if cleared and faults:
        yield "cleared"
