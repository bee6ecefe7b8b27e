"""`softrig move`: one order to some joints."""

from __future__ import annotations

import click

from host.cli.connection import connected
from host.cli.motion import PERIOD_MS, felt_lines, lines, stretch_ms, watched
from host.cli.options import Position, json_option, position, robot_option, time_ms
from host.cli.output import emit


@click.command("move")
@click.argument("joints", nargs=-1, required=True, metavar="JOINT...")
@robot_option()
@click.option(
    "--to", "target", type=position, required=True, metavar="POSITION",
    help="Where to: 8deg, -8deg; left is plus. Or 4mm, -1mm; down is plus.",
)  # fmt: skip
@click.option("--over", type=time_ms, default="1s", show_default=True, metavar="TIME", help="How long to take.")
@click.option("--hold", type=time_ms, default="1s", show_default=True, metavar="TIME", help="Hold so long, then limp.")
@json_option
def command(joints: tuple[str, ...], robot: str, target: Position, over: int, hold: int, as_json: bool) -> None:
    """Bring joints or groups to a position and hold it: arms, moves, watches until they are limp again, disarms.

    Angles count counter-clockwise from the straight joint, depths downward from where a press touches. A joint takes
    longer where it would go too fast otherwise. The screw of a press holds the axis when it is limp.
    """
    with connected(robot) as face:
        labels, unit = face.profile.named(face.profile.joint_mask(joints)), face.profile.unit
        target_centi = target.of(unit)
        face.subscribe(PERIOD_MS)
        face.arm()
        face.move(labels, target_centi, over, hold)
        motion = watched(face, over + hold + stretch_ms(face.profile.servo))
        face.disarm()
    moved, felt = motion.of(labels), motion.felt()
    fields = {f"target_{unit}": target_centi / 100, "over_ms": over, "hold_ms": hold, "joints": moved, **felt}
    emit(as_json, fields, [*lines(moved, unit, target_centi / 100), *felt_lines(felt)])
