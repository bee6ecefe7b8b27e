"""`softrig gait`: the tree of a script as JSON, and back."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import click

from host.cli.fmt import STDIN
from host.cli.options import json_option
from host.cli.output import emit, json_line, writing
from host.gait.diagnostics import GaitError
from host.gait.forms.formatting import made, read_script, replace_file
from host.gait.forms.layout import layout
from host.gait.forms.treejson import as_json as in_json
from host.gait.forms.treejson import reads, schema
from host.gait.reading.parser import parse_file

F = TypeVar("F", bound=Callable[..., Any])


def output_option(command: F) -> F:
    """Add --output."""
    return click.option("-o", "--output", type=click.Path(), metavar="FILE", help="Instead of stdout.")(command)


@click.group("gait")
def command() -> None:
    """Exchange scripts with other programs: the tree of a script as JSON, with a published JSON Schema."""


@command.command("export")
@click.argument("script", type=click.Path())
@output_option
@json_option
def export(script: str, output: str | None, as_json: bool) -> None:
    """Write the tree of a script as JSON, with its comments; --json puts it on one line.

    What the script includes is not looked at; `-` is a script on stdin.
    """
    file, found = parse_file(_text(script), script)
    if found:
        raise GaitError(found)
    tree = in_json(layout(file))
    _put(f"{json_line(tree, None if as_json else 2)}\n", output)


@command.command("import")
@click.argument("file", type=click.Path())
@output_option
@json_option
def import_(file: str, output: str | None, as_json: bool) -> None:
    """Write the script whose tree is in a JSON file; what is wrong there is told with its path."""
    text = made(reads(_text(file), file), output or "script.gait")
    if as_json:
        emit(True, {"script": output, "text": text}, ())
    if output is not None or not as_json:
        _put(text, output)


@command.command("schema")
@output_option
def schema_(output: str | None) -> None:
    """Write the JSON Schema of these trees."""
    _put(f"{json_line(schema(), 2)}\n", output)


def _put(text: str, output: str | None) -> None:
    """Write a text to a file at once, or to stdout."""
    if output is None:
        click.echo(text, nl=False)
        return
    with writing(Path(output)):
        replace_file(Path(output), text)


def _text(name: str) -> str:
    """Return the text of a file, or of stdin for `-`."""
    return read_script(name, sys.stdin.buffer if name == STDIN else None)[0]
