"""`softrig check`: scripts against the limits of their robots, before anything moves."""

from __future__ import annotations

import click

from host.cli.connection import connected
from host.cli.findings import FORMATS, Findings
from host.cli.options import json_option, robot_option
from host.cli.scripts import place, proven
from host.gait.diagnostics import GaitError
from host.gait.forecast import foretell
from host.gait.script import load
from host.profile import Profile


@click.command("check")
@click.argument("scripts", metavar="SCRIPT...", type=click.Path(), nargs=-1, required=True)
@robot_option(required=False)
@click.option("-p", "--param", "params", multiple=True, metavar="NAME=VALUE", help="Give a parameter another value.")
@click.option(
    "--format",
    "form",
    type=click.Choice(FORMATS),
    default="text",
    show_default=True,
    help="For a reader, as one JSON object a script, or as workflow commands that GitHub shows beside the lines.",
)
@json_option
@click.pass_context
def command(
    ctx: click.Context, scripts: tuple[str, ...], robot: str | None, params: tuple[str, ...], form: str, as_json: bool
) -> None:  # fmt: skip
    """Prove scripts against the limits of their robot: worst-case time, heat and current, predicted temperatures.

    The limits are asked of the robot itself; nothing is uploaded and nothing moves. The exit status is 2 when a text is
    wrong anywhere, else 4 when a limit would be broken.
    """
    findings = Findings("json" if as_json else form)
    profiles: dict[str, Profile] = {}
    for script in scripts:
        with findings.about(script):
            _check(script, robot, params, profiles, findings)
    ctx.exit(findings.exit_code)


def _check(
    script: str, robot: str | None, params: tuple[str, ...], profiles: dict[str, Profile], findings: Findings
) -> None:
    """Prove one script; each robot is asked once."""
    tree = load(script)
    address = place(tree, robot)
    if address not in profiles:
        with connected(address, watch_only=True) as face:
            profiles[address] = face.profile
    compiled, report = proven(tree, profiles[address], params)
    forecast = foretell(compiled, address)
    if forecast.diagnostics:
        raise GaitError(forecast.diagnostics)
    findings.sound(report.as_dict() | {"forecast": forecast.as_dict()}, [*report.lines(), *forecast.lines()])
