"""Pictures of runs. matplotlib is an extra of softrig and imported only when something is drawn.

check_pictures(Path("crawl.svg"))          # before the robot moves
draw_run(recording, Path("crawl.svg"))     # film strip and curves
draw_poses(recording, Path("poses.svg"))   # the ring with one coil contracted at a time
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
        raise BadRequest(f"{path}: there is no folder {path.parent}")
    if find_spec("matplotlib") is None:
        raise BadRequest("pictures need matplotlib: install softrig[plot]")


def draw_run(recording: Recording, path: Path) -> None:
    """Write the picture of a run: the body along the ground where there are scenes, and its curves over time."""
    check_pictures(path)
    from host.view import runplot, style  # noqa: PLC0415

    with style.settings():
        style.save(runplot.run_figure(recording), path)


def draw_poses(recording: Recording, path: Path, coils: tuple[str, ...] = ("A", "C", "E", "G")) -> None:
    """Write the picture of the body at rest and with each of `coils` at its shortest; BadRequest without scenes."""
    check_pictures(path)
    if not recording.scenes:
        raise BadRequest("this figure needs an observer: run it on the bench, --robot sim:circular")
    from host.view import poses, style  # noqa: PLC0415

    with style.settings():
        style.save(poses.poses_figure(recording, coils), path)
