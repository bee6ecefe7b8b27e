"""`softrig disarm`: everything off, lease returned."""

from __future__ import annotations

import click

from host.cli.connection import connected
from host.cli.options import json_option, robot_option
from host.cli.output import emit


@click.command("disarm")
@robot_option()
@json_option
def command(robot: str, as_json: bool) -> None:
    """Switch all coils off, let all joints go limp, and return the lease."""
    with connected(robot) as face:
        face.disarm()
        status = face.status()
    emit(as_json, {"state": status.state}, [status.state])
