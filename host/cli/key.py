"""`softrig key`: pairing keys."""

from __future__ import annotations

import click

from host.cli.options import json_option
from host.cli.output import emit
from host.keys import make


@click.group("key")
def command() -> None:
    """Make pairing keys: a robot that was given one takes orders only from hosts that have it too."""


@command.command("new")
@click.argument("file", type=click.Path())
@json_option
def new(file: str, as_json: bool) -> None:
    """Draw a new key and write it to FILE, for you alone; a file that is there stays as it is.

    `softrig deploy --key FILE` puts it on a robot, sim:NAME?key=FILE on one of the bench; all other commands take it
    by --key FILE or SOFTRIG_KEY.
    """
    make(file)
    emit(as_json, {"file": file}, [f"{file}: a new pairing key; whoever can read it can drive its robot"])
