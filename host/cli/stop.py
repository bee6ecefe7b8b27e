"""`softrig stop`: everything off, without asking who is there."""

from __future__ import annotations

from dataclasses import asdict

import click

from host.canlink import roll
from host.cli.options import json_option, robot_option
from host.cli.output import emit
from host.link import open_link
from host.records import Stopped
from host.robot import Robot


@click.command("stop")
@robot_option(ordered=False)
@json_option
def command(robot: str, as_json: bool) -> None:
    """Switch everything off at once, from any state; latched until `softrig clear`. On CAN: every robot on the bus."""
    with Robot(open_link(robot)) as face:
        stopped = face.stop()
        answered = roll(face.link)
    for node, each in answered.items():
        emit(as_json, {"node": node, **asdict(each)}, [f"robot {node} {_said(each)}"])
    if not answered:
        emit(as_json, asdict(stopped), [_said(stopped)])


def _said(stopped: Stopped) -> str:
    """Return what a stopped robot says; who has not asked for its labels is told the numbers of channels."""
    channels = ", ".join(f"channel {number}" for number in stopped.coils)
    return f"stopped; {channels or 'no channel'} on before, none now"
