"""`softrig resume`: have a paused program go on."""

from __future__ import annotations

import click

from host.cli.options import json_option, robot_option
from host.cli.output import emit
from host.cli.takeover import leave_option, taken_over
from host.run import TELEMETRY_MS, IfLost, watch


@click.command("resume")
@robot_option()
@leave_option
@json_option
def command(robot: str, leave: bool, as_json: bool) -> None:
    """Take over a paused program, have it go on, and watch it to its end."""
    with taken_over(robot) as face:
        face.resume()
        if leave:
            face.leave_armed()
            emit(as_json, {"result": "running"}, ["running"])
            return
        face.subscribe(TELEMETRY_MS)
        ending = watch(face, lambda stage, done: None, IfLost())
    emit(as_json, {"result": ending.result}, [ending.result])
    error = ending.error()
    if error:
        raise error
