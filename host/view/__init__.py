"""Pictures of runs. matplotlib is an extra of softrig and imported only when something is drawn.

check_pictures(Path("crawl.svg"))          # before the robot moves
draw_run(recording, Path("crawl.svg"))     # film strip and curves
draw_film(recording, Path("film.svg"))     # film strip, more frames, travel
draw_jump(recording, Path("jump.svg"))     # flight, release and energies of a sphere
draw_poses(recording, Path("poses.svg"))   # the ring with one coil contracted at a time
draw_grips(recording, Path("grips.svg"))   # two fingers in their poses
draw_grasp(recording, Path("grasp.svg"))   # their energy, displacements and angles over time
draw_nail(nail, radial, Path("nail.svg"))  # what the nail does, from two runs
draw_tilting(recording, Path("tilt.svg"))  # an object that tilts as they swing
draw_dents(recording, Path("dents.svg"))   # a block that was pressed, by its mesh
draw_stresses(recording, Path("s.svg"))    # the stress in it
"""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path

from host.errors import BadRequest
from host.recording import Recording

SUFFIXES = (".svg", ".png", ".pdf")


def check_pictures(path: Path) -> None:
    """Raise BadRequest when no picture could be written to `path`."""
    if path.suffix not in SUFFIXES:
        raise BadRequest(f"{path}: name the picture .svg, .png or .pdf")
    if not path.parent.is_dir():
        raise BadRequest(f"{path}: there is no folder {path.parent}, make it: mkdir -p {path.parent}")
    if find_spec("matplotlib") is None:
        raise BadRequest("pictures need matplotlib: install softrig[plot]")


def draw_run(recording: Recording, path: Path) -> None:
    """Write the picture of a run: the body along the ground where there are scenes, and its curves over time."""
    check_pictures(path)
    from host.view import runplot, style  # noqa: PLC0415

    with style.settings():
        style.save(runplot.run_figure(recording), path)


def draw_film(recording: Recording, path: Path) -> None:
    """Write the film of a run: the body along the ground, frames, travel; BadRequest without scenes."""
    _check_body(recording, path)
    from host.view import runplot, style  # noqa: PLC0415

    with style.settings():
        style.save(runplot.film_figure(recording), path)


def draw_jump(recording: Recording, path: Path) -> None:
    """Write the picture of a sphere's jump: flight, release, energies; BadRequest when there was none."""
    _check_body(recording, path)
    from host.view import jump, style  # noqa: PLC0415

    with style.settings():
        style.save(jump.jump_figure(recording), path)


def draw_poses(recording: Recording, path: Path, coils: tuple[str, ...] = ("A", "C", "E", "G")) -> None:
    """Write the picture of the body at rest and with each of `coils` at its shortest; BadRequest without scenes."""
    _check_body(recording, path)
    from host.view import poses, style  # noqa: PLC0415

    with style.settings():
        style.save(poses.poses_figure(recording, coils), path)


def draw_grips(recording: Recording, path: Path) -> None:
    """Write the picture of two fingers parallel, gripping and swung to either side; BadRequest without scenes."""
    _check_fingers(recording, path)
    from host.view import grips, style  # noqa: PLC0415

    with style.settings():
        style.save(grips.grips_figure(recording), path)


def draw_grasp(recording: Recording, path: Path) -> None:
    """Write the picture of a grasp over time: energy, displacements, angles; BadRequest without scenes."""
    _check_fingers(recording, path)
    from host.view import grasp, style  # noqa: PLC0415

    with style.settings():
        style.save(grasp.grasp_figure(recording), path)


def draw_nail(nail: Recording, radial: Recording, path: Path) -> None:
    """Write the picture of what the nail does, from a run with and a run without it; BadRequest without scenes."""
    _check_fingers(nail, path)
    _check_fingers(radial, path)
    from host.view import nail as contrast  # noqa: PLC0415
    from host.view import style  # noqa: PLC0415

    with style.settings():
        style.save(contrast.nail_figure(nail, radial), path)


def draw_tilting(recording: Recording, path: Path) -> None:
    """Write the picture of an object that tilts as the fingers swing; BadRequest without scenes."""
    _check_fingers(recording, path)
    from host.view import style, tilting  # noqa: PLC0415

    with style.settings():
        style.save(tilting.tilting_figure(recording), path)


def draw_dents(recording: Recording, path: Path) -> None:
    """Write the picture of the mesh of a block at push, hold, release and long after; BadRequest without fields."""
    _check_press(recording, path)
    from host.view import dents, style  # noqa: PLC0415

    with style.settings():
        style.save(dents.dents_figure(recording), path)


def draw_stresses(recording: Recording, path: Path, what: str = "von Mises") -> None:
    """Write the picture of the stress in that block, `what` "von Mises" or "sigma_y"; BadRequest without fields."""
    _check_press(recording, path)
    from host.view import stresses, style  # noqa: PLC0415

    with style.settings():
        style.save(stresses.stresses_figure(recording, what), path)


def _check_press(recording: Recording, path: Path) -> None:
    """Raise BadRequest when there is no block to draw, or no picture could be written."""
    _check_seen(recording, path)
    if "indenter" not in recording.scenes[0]:
        raise BadRequest("this figure shows a block under a press: run it on a robot that has one, --robot sim:press")


def _check_fingers(recording: Recording, path: Path) -> None:
    """Raise BadRequest when there are no fingers to draw, or no picture could be written."""
    _check_seen(recording, path)
    if "fingers" not in recording.scenes[0]:
        raise BadRequest("this figure shows fingers: run it on a robot that has them, --robot sim:fingers")


def _check_body(recording: Recording, path: Path) -> None:
    """Raise BadRequest when there is no body to draw, or no picture could be written."""
    _check_seen(recording, path)
    if "nodes" not in recording.scenes[0]:
        raise BadRequest("this figure shows a body that crawls or jumps, and this robot is none")


def _check_seen(recording: Recording, path: Path) -> None:
    """Raise BadRequest when there is nothing to draw of the body, or no picture could be written."""
    check_pictures(path)
    if not recording.scenes:
        raise BadRequest("this figure needs an observer: run it on the bench, --robot sim:NAME")
