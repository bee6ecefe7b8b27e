"""`softrig fire`: one order to some coils."""

from __future__ import annotations

import click

from host.cli.connection import connected
from host.cli.options import duty_permille, json_option, robot_option, time_ms, without_option
from host.cli.output import emit
from host.errors import BadRequest, RobotFault
from host.records import Event, Telemetry
from host.robot import Robot

AFTER_MS = 100
PERIOD_MS = 50


@click.command("fire")
@click.argument("coils", nargs=-1, required=True, metavar="COIL...")
@robot_option()
@click.option(
    "--duty", type=duty_permille, required=True, metavar="PERCENT", help="Share of the time that they are on."
)
@click.option("--hold", type=time_ms, required=True, metavar="TIME", help="Off again after this long.")
@without_option
@json_option
def command(coils: tuple[str, ...], robot: str, duty: int, hold: int, without: tuple[str, ...], as_json: bool) -> None:
    """Heat coils or groups for a limited time: arms, fires, watches until they are off, disarms."""
    with connected(robot) as face:
        labels = face.profile.named(face.profile.coil_mask(coils) & ~face.profile.mask(without))
        if not labels:
            raise BadRequest("nothing to fire: every coil that was named is among those of --without")
        face.subscribe(PERIOD_MS)
        face.arm(without=without)
        face.fire(labels, duty, hold)
        peaks = _peaks(face, hold + AFTER_MS)
        face.disarm()
    fired = {label: peaks.get(label) for label in labels}
    lines = [f"{label} at {duty / 10:g} % for {hold} ms: {_degc(degc)}" for label, degc in fired.items()]
    emit(as_json, {"duty_permille": duty, "hold_ms": hold, "peak_estimated_degc": fired}, lines)


def _peaks(face: Robot, time_ms: int) -> dict[str, float]:
    """Return the highest estimated temperature of each coil within that time; RobotFault when the robot trips."""
    peaks: dict[str, float] = {}
    parts = face.profile.parts
    for record in face.listen(time_ms):
        if isinstance(record, Event) and record.event == "tripped":
            raise RobotFault(record.code, record.value, record.coil, parts.kind(record.coil), parts.unit)
        if isinstance(record, Telemetry):
            for label, degc in zip(parts.coils, record.temperature_degc, strict=False):
                peaks[label] = max(degc, peaks.get(label, degc))
    return peaks


def _degc(degc: float | None) -> str:
    return "no telemetry" if degc is None else f"{degc:.1f} C at most, as the robot estimates"
