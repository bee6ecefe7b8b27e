"""`softrig step`: have a paused program go on by one step."""

from __future__ import annotations

import click

from host.cli.options import json_option, robot_option
from host.cli.output import emit
from host.cli.takeover import hold, leave_option, taken_over
from host.records import Event
from host.robot import Robot


@click.command("step")
@click.argument("count", type=click.IntRange(min=1), default=1)
@robot_option()
@leave_option
@json_option
def command(count: int, robot: str, leave: bool, as_json: bool) -> None:
    """Take over the program that a robot runs and have it go on by one step, or COUNT of them.

    One that is not paused stands still at the end of the step it is in.
    """
    with taken_over(robot) as face:
        for _ in range(count):
            face.step()
            event = _stands(face)
            emit(as_json, {"event": event.event, "step": event.step}, [f"{event.event} in step {event.step}"])
            if event.event != "paused":
                face.disarm()
                return
        hold(face, leave)


def _stands(face: Robot) -> Event:
    """Return the event that the program stands still, or has ended."""
    last = None
    for record in face.watch():
        last = record
        if isinstance(record, Event) and record.event == "paused":
            break
    assert isinstance(last, Event)
    return last
