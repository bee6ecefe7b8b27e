"""`softrig figure`: figures of the paper, drawn from what the bench did."""

from __future__ import annotations

from pathlib import Path

import click

import host
from host.cli.options import robot_option
from host.cli.output import note, writing
from host.cli.scripts import place, proven
from host.errors import BadRequest
from host.gait.script import load
from host.link import open_link
from host.robot import Robot
from host.run import Keeper, run
from host.view import check_pictures, draw_poses

SCRIPTS = {"3": "circular-poses.gait"}


@click.command("figure")
@click.argument("number", type=click.Choice(sorted(SCRIPTS)))
@click.option("-o", "--output", type=click.Path(path_type=Path), required=True, metavar="FILE.svg")
@robot_option(required=False)
def command(number: str, output: Path, robot: str | None) -> None:
    """Draw a figure of the paper from the bench.

    3: the circular robot with coils A, C, E and G contracted one after another.
    """
    check_pictures(output)
    tree = load(script_path(SCRIPTS[number]))
    address = place(tree, robot)
    link = open_link(address)
    keeper = Keeper(observer=link.observer)
    with Robot(link, keeper) as face:
        face.connect()
        keeper.name_coils(face.profile.labels)
        keeper.recording.title = f"{SCRIPTS[number]} on {address}"
        compiled, _ = proven(tree, face.profile)
        ending = run(face, compiled.program, lambda stage, done: None)
    error = ending.error()
    if error:
        raise error
    with writing(output):
        draw_poses(keeper.recording, output)
    note(f"picture: {output}")


def script_path(name: str) -> Path:
    """Return where the script of that name lies: in gaits/ here, or beside the installed sources."""
    for folder in (Path("gaits"), Path(host.__file__).parents[1] / "gaits"):
        if (folder / name).is_file():
            return folder / name
    raise BadRequest(f"there is no gaits/{name} here: go to the folder of the sources")
