"""`softrig fmt`: scripts in their one form."""

from __future__ import annotations

import difflib
import sys
from collections.abc import Iterator
from pathlib import Path

import click

from host.cli.options import json_option
from host.cli.output import emit, writing
from host.gait.diagnostics import GaitError
from host.gait.forms.formatting import Formatted, replace_file, tried

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
    done = [tried(name, sys.stdin.buffer if name == STDIN else None) for name in _scripts(files)]
    for each in done:
        if each.changed and each.name != STDIN and not (check or diff):
            with writing(Path(each.name)):
                replace_file(Path(each.name), each.after)
        if not each.wrong:
            _tell(each, diff, check, as_json)
    wrong = [item for each in done for item in each.wrong]
    if wrong:
        raise GaitError(wrong)
    return int(check and any(each.changed for each in done))


def _scripts(names: tuple[str, ...]) -> Iterator[str]:
    """Yield each file that is named, and the scripts below each folder."""
    for name in names:
        below = sorted(Path(name).rglob("*.gait")) if name != STDIN and Path(name).is_dir() else None
        yield from [name] if below is None else map(str, below)


def _tell(done: Formatted, diff: bool, check: bool, as_json: bool) -> None:
    """Print what was done, or would be done, with one file."""
    if as_json:
        text = {"text": done.after} if done.name == STDIN else {}
        emit(True, {"file": done.name, "changed": done.changed, **text}, ())
    elif diff:
        click.echo("".join(_difference(done)), nl=False)
    elif done.name == STDIN and not check:
        click.echo(done.after, nl=False)
    elif done.changed:
        emit(False, {}, [f"{done.name} {'would change' if check else 'written'}"])


def _difference(done: Formatted) -> Iterator[str]:
    """Yield the lines of a unified diff."""
    texts = (done.before, done.after)
    old, new = ([f"{line}\n" for line in text.removesuffix("\n").split("\n")] for text in texts)
    yield from difflib.unified_diff(old, new, f"{done.name} as it is", f"{done.name} as written by fmt")
