"""`softrig preview`: the timeline of a script with predicted temperatures, before anything moves."""

from __future__ import annotations

from pathlib import Path

import click

from host.cli.connection import connected
from host.cli.options import json_option, robot_option
from host.cli.output import emit, note, writing
from host.cli.scripts import place
from host.errors import BadRequest
from host.gait.compiler import compile_script
from host.gait.forecast import Forecast, Model, draw, model_of
from host.gait.script import load
from host.preview.compare import changes
from host.preview.drawing import THEMES
from host.preview.fields import fields
from host.preview.picture import difference, picture
from host.preview.terminal import print_changes, print_timeline
from host.profile import Profile


@click.command("preview")
@click.argument("script", type=click.Path())
@robot_option(required=False)
@click.option("-p", "--param", "params", multiple=True, metavar="NAME=VALUE", help="Give a parameter another value.")
@click.option("-o", "--output", type=click.Path(path_type=Path), metavar="FILE.svg", help="Draw it there.")
@click.option("--theme", type=click.Choice(THEMES), default="auto", show_default=True, help="Of the picture.")
@click.option("--diff", "other", type=click.Path(), metavar="SCRIPT", help="Show what changed since that one.")
@json_option
def command(
    script: str,
    robot: str | None,
    params: tuple[str, ...],
    output: Path | None,
    theme: str,
    other: str | None,
    as_json: bool,
) -> None:
    """Show what a script will do: when each coil is on and how warm it gets, joints, force, waits.

    Temperatures come from the bench's own model, from cold and at rest; limits are the part of `softrig check`.
    """
    if output is not None and output.suffix != ".svg":
        raise BadRequest(f"{output}: a picture is written as FILE.svg")
    address = place(load(script), robot)
    with connected(address, watch_only=True) as face:
        profile = face.profile
    model = model_of(address, profile)
    new = foretold(script, model, profile, params)
    old = foretold(other, model, profile, params if other == script else ()) if other is not None else None
    if output is not None:
        with writing(output):
            output.write_text(difference(old, new, theme) if old else picture(new, theme), encoding="utf-8")
        note(f"picture: {output}")
    if as_json:
        emit(True, changes(old, new).as_dict() if old else fields(new), ())
    elif output is None:
        print_changes(changes(old, new)) if old else print_timeline(new)


def foretold(script: str, model: Model, profile: Profile, params: tuple[str, ...]) -> Forecast:
    """Return the forecast of a script, with its curves."""
    return draw(compile_script(load(script), profile, params), model)
