"""`softrig move`: one order to some joints."""

from __future__ import annotations

import click

from host.cli.connection import connected
from host.cli.motion import PERIOD_MS, lines, stretch_ms, watched
from host.cli.options import angle_centideg, json_option, robot_option, time_ms
from host.cli.output import emit


@click.command("move")
@click.argument("joints", nargs=-1, required=True, metavar="JOINT...")
@robot_option()
@click.option(
    "--to", "target", type=angle_centideg, required=True, metavar="ANGLE", help="Where to: 8deg, -8deg; left is plus."
)
@click.option("--over", type=time_ms, default="1s", show_default=True, metavar="TIME", help="How long to take.")
@click.option("--hold", type=time_ms, default="1s", show_default=True, metavar="TIME", help="Hold so long, then limp.")
@json_option
def command(joints: tuple[str, ...], robot: str, target: int, over: int, hold: int, as_json: bool) -> None:
    """Turn joints or groups to an angle and hold it: arms, moves, watches until they are limp again, disarms.

    Angles count counter-clockwise from the straight joint. A joint takes longer where it would turn too fast otherwise.
    """
    with connected(robot) as face:
        labels = face.profile.named(face.profile.joint_mask(joints))
        face.subscribe(PERIOD_MS)
        face.arm()
        face.move(labels, target, over, hold)
        motion = watched(face, over + hold + stretch_ms(face.profile.servo))
        face.disarm()
    moved = motion.of(labels)
    fields = {"target_deg": target / 100, "over_ms": over, "hold_ms": hold, "joints": moved}
    emit(as_json, fields, lines(moved, target / 100))
