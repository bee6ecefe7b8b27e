"""`softrig figure`: figures of the paper, drawn from what the bench did."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import click

import host
from host.cli.options import given_key, robot_option
from host.cli.output import note, writing
from host.cli.scripts import place, proven
from host.errors import BadRequest
from host.gait.script import load
from host.link import open_link
from host.recording import Recording
from host.robot import Robot
from host.run import Keeper, run
from host.view import check_pictures, draw_film, draw_jump, draw_poses


class Figure(NamedTuple):
    """One figure: the script that is run, what is added to its address on the bench, what draws it, what it shows."""

    script: str
    settings: str
    draw: Callable[[Recording, Path], None]
    shows: str


FIGURES = {
    "3": Figure(
        "circular-poses.gait", "", draw_poses, "the circular robot with coils A, C, E and G contracted in turn"
    ),
    "6": Figure("sphere-a-crawl.gait", "", draw_film, "prototype A crawling on level ground"),
    "7": Figure("sphere-b-crawl.gait", "", draw_film, "prototype B crawling on level ground"),
    "8": Figure("sphere-b-climb.gait", "?slope=10", draw_film, "prototype B climbing a slope of ten degrees"),
    "9": Figure("sphere-b-jump.gait", "", draw_jump, "prototype B jumping, and its energies"),
}
HELP = "Draw a figure of the paper from the bench.\n\n\b\n" + "\n".join(f"{n}: {f.shows}." for n, f in FIGURES.items())


@click.command("figure", help=HELP)
@click.argument("number", type=click.Choice(sorted(FIGURES)))
@click.option("-o", "--output", type=click.Path(path_type=Path), required=True, metavar="FILE.svg")
@robot_option(required=False)
def command(number: str, output: Path, robot: str | None) -> None:
    """Draw a figure of the paper from the bench."""
    check_pictures(output)
    figure = FIGURES[number]
    recording = recorded(figure, robot)
    with writing(output):
        figure.draw(recording, output)
    note(f"picture: {output}")


def recorded(figure: Figure, robot: str | None) -> Recording:
    """Run the figure's script, on the bench unless a robot is given, and return what was seen; raises as a run does."""
    tree = load(script_path(figure.script))
    address = place(tree, robot) + (figure.settings if robot is None else "")
    link = open_link(address)
    keeper = Keeper(observer=link.observer)
    with Robot(link, keeper, given_key()) as face:
        face.connect()
        keeper.know(face.profile.parts)
        keeper.recording.title = f"{figure.script} on {address}"
        compiled, _ = proven(tree, face.profile)
        ending = run(face, compiled.program, lambda stage, done: None)
    error = ending.error()
    if error:
        raise error
    return keeper.recording


def script_path(name: str) -> Path:
    """Return where the script of that name lies: in gaits/ here, or beside the installed sources."""
    for folder in (Path("gaits"), Path(host.__file__).parents[1] / "gaits"):
        if (folder / name).is_file():
            return folder / name
    raise BadRequest(f"there is no gaits/{name} here: go to the folder of the sources")
