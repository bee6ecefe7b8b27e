"""`softrig check`: a script against the limits of its robot, before anything moves."""

from __future__ import annotations

import click

from host.cli.connection import connected
from host.cli.options import json_option, robot_option
from host.cli.output import emit
from host.cli.scripts import place, proven
from host.gait.diagnostics import GaitError
from host.gait.forecast import foretell
from host.gait.script import load


@click.command("check")
@click.argument("script", type=click.Path())
@robot_option(required=False)
@click.option("-p", "--param", "params", multiple=True, metavar="NAME=VALUE", help="Give a parameter another value.")
@json_option
def command(script: str, robot: str | None, params: tuple[str, ...], as_json: bool) -> None:
    """Prove a script against the limits of its robot: worst-case time, heat and current, predicted temperatures.

    The limits are asked of the robot itself; nothing is uploaded and nothing moves.
    """
    tree = load(script)
    address = place(tree, robot)
    with connected(address, watch_only=True) as face:
        compiled, report = proven(tree, face.profile, params)
    forecast = foretell(compiled, address)
    if forecast.diagnostics:
        raise GaitError(forecast.diagnostics)
    fields = report.as_dict() | {"forecast": forecast.as_dict()}
    emit(as_json, fields, [*report.lines(), *forecast.lines()])
