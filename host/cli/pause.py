"""`softrig pause`: have the program that runs stand still."""

from __future__ import annotations

import click

from host.cli.options import json_option, robot_option
from host.cli.output import emit
from host.cli.takeover import hold, leave_option, taken_over


@click.command("pause")
@robot_option()
@leave_option
@json_option
def command(robot: str, leave: bool, as_json: bool) -> None:
    """Take over the program that a robot runs and have it stand still: nothing new begins.

    What is on its way ends by itself, and guards go on guarding. `softrig resume` has it go on, `softrig step` by one
    step. It needs a line for two hosts, as CAN is: a serial port belongs to the run that opened it, and a `sim:`
    address to one command. There `softrig run --step` does the same with keys.
    """
    with taken_over(robot) as face:
        face.pause()
        status = face.status()
        emit(as_json, {"paused": status.paused, "step": status.step}, [f"paused in step {status.step}"])
        hold(face, leave)
