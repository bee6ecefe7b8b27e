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
from host.keeper import Keeper
from host.link import open_link
from host.recording import Recording
from host.robot import Robot
from host.run import TELEMETRY_MS, run
from host.view import (
    check_pictures,
    draw_dents,
    draw_film,
    draw_grasp,
    draw_grips,
    draw_jump,
    draw_nail,
    draw_poses,
    draw_stresses,
    draw_tilting,
)


class Run(NamedTuple):
    """One run that a figure is drawn from: the script, what is added to its address on the bench, its parameters."""

    script: str
    settings: str = ""
    params: tuple[str, ...] = ()


class Figure(NamedTuple):
    """One figure: what is run for it, what draws it from these recordings, what it shows."""

    runs: tuple[Run, ...]
    draw: Callable[..., None]
    shows: str


FINGERS = "fingers-figure13.gait"
PRESS = "press-hold-release.gait"
EXACT = "&set=servos.dead_band_us:0"  # so that the grip is that of the script
SLOWLY = (
    "time=10s",
)  # so that it stays so: servos that take their pulses 5 ms apart differ by that much of a movement
FIGURES = {
    "3": Figure(
        (Run("circular-poses.gait"),), draw_poses, "the circular robot with coils A, C, E and G contracted in turn"
    ),
    "6": Figure((Run("sphere-a-crawl.gait"),), draw_film, "prototype A crawling on level ground"),
    "7": Figure((Run("sphere-b-crawl.gait"),), draw_film, "prototype B crawling on level ground"),
    "8": Figure((Run("sphere-b-climb.gait", "?slope=10"),), draw_film, "prototype B climbing a slope of ten degrees"),
    "9": Figure((Run("sphere-b-jump.gait"),), draw_jump, "prototype B jumping, and its energies"),
    "12": Figure((Run(FINGERS),), draw_grips, "two soft fingers parallel, gripping, and swung to either side"),
    "13": Figure((Run(FINGERS),), draw_grasp, "the energy of their tips and both displacements"),
    "14": Figure((Run("fingers-experiment.gait"),), draw_tilting, "a cube that tilts against the swing of two fingers"),
    "15": Figure((Run(PRESS),), draw_dents, "a rheological block that is pressed, held and released, by its mesh"),
    "16": Figure((Run(PRESS),), draw_stresses, "the stress in that block"),
    "nail": Figure(
        (Run(FINGERS, "?tip=nail" + EXACT, SLOWLY), Run(FINGERS, "?tip=radial" + EXACT, SLOWLY)),
        draw_nail,
        "the paper's tip against one whose energy depends on the displacement alone",
    ),
}
HELP = "Draw a figure of the paper from the bench.\n\n\b\n" + "\n".join(f"{n}: {f.shows}." for n, f in FIGURES.items())


@click.command("figure", help=HELP)
@click.argument("number", type=click.Choice(list(FIGURES)))
@click.option("-o", "--output", type=click.Path(path_type=Path), required=True, metavar="FILE.svg")
@robot_option(required=False)
def command(number: str, output: Path, robot: str | None) -> None:
    """Draw a figure of the paper from the bench."""
    check_pictures(output)
    figure = FIGURES[number]
    if robot is not None and len(figure.runs) > 1:
        raise BadRequest(f"figure {number} compares {len(figure.runs)} robots of the bench: it takes no --robot")
    recordings = [recorded(each, robot) for each in figure.runs]
    with writing(output):
        figure.draw(*recordings, output)
    note(f"picture: {output}")


def recorded(wanted: Run, robot: str | None) -> Recording:
    """Run the script, on the bench unless a robot is given, and return what was seen; raises as a run does."""
    tree = load(script_path(wanted.script))
    address = place(tree, robot) + (wanted.settings if robot is None else "")
    link = open_link(address)
    keeper = Keeper(observer=link.observer, slice_ms=TELEMETRY_MS)
    with Robot(link, keeper, given_key()) as face:
        face.connect()
        keeper.know(face.profile.parts)
        keeper.recording.title = f"{wanted.script} on {address}"
        compiled, _ = proven(tree, face.profile, wanted.params)
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
