"""`softrig attach`: take over the program that a robot runs, from a host that has gone."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path
from typing import Any

import click

from host.cli.options import given_key, if_lost_options, json_option, robot_option
from host.cli.output import emit, note
from host.drivenreport import driven
from host.errors import BadRequest
from host.keeper import Keeper
from host.linereport import interruption, line_lines
from host.link import open_link
from host.log import LogWriter
from host.records import as_json as fields_of
from host.robot import Robot
from host.run import TELEMETRY_MS, Ending, IfLost, watch

Fields = dict[str, Any]


@click.command("attach")
@robot_option()
@click.option("--session", type=int, default=0, metavar="N", help="That `softrig run` printed; else whichever it is.")
@click.option("--stop", is_flag=True, help="End the program and disarm the robot.")
@click.option("--log", "log_path", type=click.Path(path_type=Path), metavar="FILE.mcap", help="Record everything.")
@if_lost_options
@json_option
def command(
    robot: str, session: int, stop: bool, log_path: Path | None, if_lost: str, patience: int, as_json: bool
) -> None:
    """Take over the program that a robot runs: watch it to its end and report, or stop it.

    The host that started it gives no orders any more. Ctrl-C sends stop.
    """
    with LogWriter(log_path) if log_path else nullcontext() as log:
        keeper = Keeper(log)
        with Robot(open_link(robot), keeper, given_key()) as face:
            taken = face.attach(session)
            keeper.know(face.profile.parts)
            note(f"session {face.talk.session.number} has taken over from session {taken}")
            ending = _stopped(face) if stop else _watched(face, IfLost(if_lost == "stop", patience))
            fields = {"result": ending.result, "address": robot, "attached_to": taken, **_fields(face, keeper)}
    emit(as_json, fields, [f"{fields['robot']} on {robot}: {ending.result}", *line_lines(fields)])
    error = ending.error()
    if error:
        raise error


def _stopped(face: Robot) -> Ending:
    face.cancel()
    face.disarm()
    return Ending("cancelled")


def _watched(face: Robot, if_lost: IfLost) -> Ending:
    state = face.info()["state"]
    if state != "running":
        raise BadRequest(f"no program runs, the robot is {state}: it has been disarmed now")
    face.subscribe(TELEMETRY_MS)
    return watch(face, lambda stage, done: None, if_lost)


def _fields(face: Robot, keeper: Keeper) -> Fields:
    """Return what was seen since the robot was taken over."""
    recording, info = keeper.recording, face.info()
    return {
        **{name: info[name] for name in ("robot", "firmware", "protocol", "dictionary", "session")},
        **{name: rows for name, rows in driven(recording, face.profile).items() if name != "energy_is"},
        "events": [fields_of(event) for event in recording.events],
        "link": face.statistics(),
        "interruptions": [interruption(each, recording) for each in face.interruptions()],
    }
