"""`softrig fmt`: scripts in their one form."""

from __future__ import annotations

import difflib
import sys
from collections.abc import Iterator
from pathlib import Path

import click

from host.cli.options import json_option
from host.cli.output import emit, writing
from host.gait.diagnostics import Diagnostic, GaitError
from host.gait.formatting import formatted, read_script, replace_file

STDIN = "-"


@click.command("fmt")
@click.argument("files", nargs=-1, required=True, type=click.Path())
@click.option("--check", is_flag=True, help="Write nothing; exit status 1 when a file would change.")
@click.option("--diff", is_flag=True, help="Write nothing; print what would change.")
@json_option
def command(files: tuple[str, ...], check: bool, diff: bool, as_json: bool) -> int:
    """Bring scripts into their one form: indentation, blanks, columns of params and comments.

    Every comment stays, and so does what the script does: that is proved before a file is written. A folder stands for
    its scripts; with `-` a script goes from stdin to stdout. A script that cannot be read stays as it is.
    """
    stale, wrong = 0, list[Diagnostic]()
    for name in _scripts(files):
        try:
            before, exact = source(name)
            after = formatted(before, name)
        except GaitError as error:
            wrong += error.diagnostics
            continue
        changed = before != after or not exact
        stale += changed
        if changed and name != STDIN and not (check or diff):
            with writing(Path(name)):
                replace_file(Path(name), after)
        _tell(name, before, after, changed, diff, check, as_json)
    if wrong:
        raise GaitError(wrong)
    return int(check and stale > 0)


def source(name: str) -> tuple[str, bool]:
    """Return the text of a file, or of stdin for `-`, and whether it is stored as this text exactly."""
    return read_script(name, sys.stdin.buffer if name == STDIN else None)


def _scripts(names: tuple[str, ...]) -> Iterator[str]:
    """Yield each file that is named, and the scripts below each folder."""
    for name in names:
        below = sorted(Path(name).rglob("*.gait")) if name != STDIN and Path(name).is_dir() else None
        yield from [name] if below is None else map(str, below)


def _tell(name: str, before: str, after: str, changed: bool, diff: bool, check: bool, as_json: bool) -> None:
    """Print what was done, or would be done, with one file."""
    if as_json:
        emit(True, {"file": name, "changed": changed, **({"text": after} if name == STDIN else {})}, ())
    elif diff:
        click.echo("".join(_difference(name, before, after)), nl=False)
    elif name == STDIN and not check:
        click.echo(after, nl=False)
    elif changed:
        emit(False, {}, [f"{name} {'would change' if check else 'written'}"])


def _difference(name: str, before: str, after: str) -> Iterator[str]:
    """Yield the lines of a unified diff."""
    old, new = ([f"{line}\n" for line in text.removesuffix("\n").split("\n")] for text in (before, after))
    yield from difflib.unified_diff(old, new, f"{name} as it is", f"{name} as written by fmt")
