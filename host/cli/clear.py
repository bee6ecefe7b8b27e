"""`softrig clear`: leaves the tripped state."""

from __future__ import annotations

import click

from host.cli.connection import connected
from host.cli.options import json_option, robot_option
from host.cli.output import emit


@click.command("clear")
@robot_option()
@json_option
def command(robot: str, as_json: bool) -> None:
    """Leave the tripped state after a stop or a fault, once its cause is gone."""
    with connected(robot) as face:
        face.clear()
        status = face.status()
    emit(as_json, {"state": status.state}, [status.state])
