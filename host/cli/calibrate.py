"""`softrig calibrate`: measures the resistance of every cold coil and has the robot keep it."""

from __future__ import annotations

from collections.abc import Iterator

import click

from host.cli.connection import connected
from host.cli.options import json_option, robot_option, without_option
from host.cli.output import emit


@click.command("calibrate")
@robot_option()
@without_option
@json_option
def command(robot: str, without: tuple[str, ...], as_json: bool) -> None:
    """Measure the resistance of every coil and have the robot keep it: the coils must be cold.

    Each coil is on alone for 2 ms. The robot then knows a coil's phase by its resistance also after a reset, when it
    cannot know which coil is cold.
    """
    with connected(robot) as face:
        nominal = face.profile.coil.resistance_mohm
        face.calibrate(without)
        measured = face.settings().resistance_mohm
    emit(as_json, {"resistance_ohm": {coil: mohm / 1000 for coil, mohm in measured.items()}}, _lines(measured, nominal))


def _lines(measured: dict[str, int], nominal_mohm: int) -> Iterator[str]:
    for coil, mohm in measured.items():
        if mohm:
            yield f"{coil:<6} {mohm / 1000:.3f} ohm, {100 * mohm / nominal_mohm - 100:+.1f} % of the profile's"
        else:
            yield f"{coil:<6} not measured"
