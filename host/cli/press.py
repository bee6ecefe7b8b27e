"""`softrig press`: presses with a force that the robot regulates by its load cell."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import click

from host.cli.connection import connected
from host.cli.gauge import Show, gauge
from host.cli.motion import PERIOD_MS, felt_lines, lines, watched
from host.cli.options import force_mn, json_option, robot_option, time_ms
from host.cli.output import emit
from host.errors import BadRequest, Refused
from host.records import Telemetry
from protocol import codes

NEAR_MM = 0.05  # the end of the range: the dead band of a servo


@click.command("press")
@click.argument("force", type=force_mn, metavar="FORCE")
@robot_option()
@click.option("--over", type=time_ms, default="1s", show_default=True, metavar="TIME", help="How long to take to it.")
@click.option(
    "--for", "lasting", type=time_ms, default="5s", show_default=True, metavar="TIME",
    help="Regulate so long, the time to reach the force included.",
)  # fmt: skip
@click.option("--hold", type=time_ms, default="1s", show_default=True, metavar="TIME", help="Hold so long, then limp.")
@json_option
def command(force: int, robot: str, over: int, lasting: int, hold: int, as_json: bool) -> None:
    """Press with a force: arms, has the robot regulate it by its load cell, holds the axis, disarms.

    The force rises from the present one on a straight line. The axis stays where it is when it is limp: its screw holds
    it, so lift it with `softrig move`.
    """
    if over > lasting:
        raise BadRequest(f"--for {lasting} ms is less than --over {over} ms, which it includes: give it at least that")
    with connected(robot) as face:
        profile = face.profile
        if profile.press is None:
            raise Refused("press", codes.NO_LOAD_CELL)
        face.subscribe(PERIOD_MS)
        face.arm()
        face.press(force, over, lasting, hold)
        with gauge(force / 1000, profile.parts, quiet=as_json) as show:
            regulated = _Regulated(face.now_ms() + lasting, show)
            motion = watched(face, lasting + hold, regulated.note)
        face.disarm()
    joints, felt = motion.of(profile.joint_labels), motion.felt()
    times = {"over_ms": over, "for_ms": lasting, "hold_ms": hold}
    told = {"target_n": force / 1000, "reached_n": regulated.load_n}
    most = {f"most_{profile.unit}": profile.servo.most_centi / 100}  # how far down the axis may go
    fields = {**told, **felt, **times, **most, "joints": joints}
    emit(as_json, fields, _lines(fields, profile.unit, profile.press.touch_mn / 1000))


@dataclass(slots=True)
class _Regulated:
    """The force as it was told last while the robot regulated it; each record is shown, too."""

    until_ms: int
    show: Show
    load_n: float | None = None

    def note(self, record: Telemetry) -> None:
        """Take a record."""
        self.show(record)
        if record.host_ms <= self.until_ms:
            self.load_n = record.load_n


def _lines(fields: dict[str, Any], unit: str, touch_n: float) -> Iterator[str]:
    reached, most = fields["reached_n"], fields[f"most_{unit}"]
    told = "no telemetry" if reached is None else f"at {reached:.2f} N"
    yield f"pressing {told}, told {fields['target_n']:g} N"
    yield from felt_lines(fields)
    yield from lines(fields["joints"], unit)
    for label, joint in fields["joints"].items():
        if (joint[f"reached_{unit}"] or 0) > most - NEAR_MM:
            yield f"{label} is at the end of its range, {most:g} {unit}: it presses no harder"
        if reached is not None and reached <= touch_n:
            yield f"{label} touches nothing: bring it closer with `softrig move {label}`, or regulate for longer"
        else:
            yield f"{label} stays where it is: `softrig move {label} --to 0{unit}` lifts it"
