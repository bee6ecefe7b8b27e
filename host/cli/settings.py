"""`softrig settings`: what a robot keeps of itself, and how to change it."""

from __future__ import annotations

import re
from collections.abc import Iterator

import click

from host.cli.connection import connected
from host.cli.options import json_option, robot_option
from host.cli.output import emit
from host.errors import BadRequest
from host.kept import Settings
from host.robot import Robot

DEFAULT = "default"
SOURCES = {
    "defaults": "the defaults: none was ever set",
    "stored": "as stored",
    "damaged": "the defaults (F23): what was stored is damaged; set them again",
}


@click.command("settings", context_settings={"ignore_unknown_options": True})  # an offset may begin with a minus
@click.argument("name", required=False)
@click.argument("value", required=False)
@robot_option()
@json_option
def command(robot: str, as_json: bool, name: str | None, value: str | None) -> None:
    """List what a robot keeps of itself, or change one: NAME VALUE.

    \b
    node          its number on a shared bus, 1 to 126
    board-offset  added to what the board's thermometer reads, -10 to 10 K
    resistance.A  of the cold coil A in ohm, half to twice the profile's, or
                  `default`; `softrig calibrate` measures them all
    """
    with connected(robot) as face:
        if name is not None:
            _change(face, name, value)
        settings = face.settings()
        limits = face.profile.coil_limits
    nominal_mohm = limits.resistance_mohm if limits else 0
    emit(as_json, _fields(settings), _lines(settings, nominal_mohm))


def _change(face: Robot, name: str, value: str | None) -> None:
    if value is None:
        raise BadRequest(f"{name} has no value: write softrig settings {name} VALUE, or no name to list them all")
    if name == "node":
        face.change("node", _number(name, value, "", 1))
    elif name == "board-offset":
        face.change("board_offset_decidegc", _number(name, value, "K", 10))
    elif name.startswith("resistance."):
        coils = name.removeprefix("resistance.")
        mohm = 0 if value == DEFAULT else max(1, _number(name, value, "ohm", 1000))
        for coil in face.profile.groups.get(coils, (coils,)):
            face.change("resistance_mohm", mohm, coil)
    else:
        raise BadRequest(f"no setting {name!r}: there are node, board-offset and resistance.COIL")


def _number(name: str, value: str, unit: str, factor: int) -> int:
    """Return the number of an operator's value in the wire's unit; BadRequest when it is none, or falls between two."""
    match = re.fullmatch(rf"\s*([+-]?\d{{1,6}}(?:\.\d*)?)\s*(?:{unit})?\s*", value, re.ASCII)
    if match is None or round(float(match[1]) * factor, 6) % 1:
        steps = f" in {unit}, in steps of {1 / factor:g}" if unit else ""
        raise BadRequest(f"{name} {value!r}: write a {'number' if unit else 'whole number'}{steps}")
    return round(float(match[1]) * factor)


def _fields(settings: Settings) -> dict[str, object]:
    return {
        "source": settings.source,
        "node": settings.node,
        "board_offset_k": settings.board_offset_decidegc / 10,
        "resistance_ohm": {coil: mohm / 1000 or None for coil, mohm in settings.resistance_mohm.items()},
    }


def _lines(settings: Settings, nominal_mohm: int) -> Iterator[str]:
    yield f"settings {SOURCES.get(settings.source, settings.source)}"
    yield f"  node          {settings.node}"
    yield f"  board-offset  {settings.board_offset_decidegc / 10:g} K"
    for coil, mohm in settings.resistance_mohm.items():
        yield (
            f"  resistance.{coil:<4} {mohm / 1000:.3f} ohm"
            if mohm
            else (f"  resistance.{coil:<4} {nominal_mohm / 1000:.3f} ohm, of the profile")
        )
