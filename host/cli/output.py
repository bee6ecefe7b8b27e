"""What commands print: with --json one object per line on stdout, else lines for a reader."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click

from host.errors import BadRequest, SoftrigError

_UNPRINTED = re.compile(r"[^ -~\n\t]")  # what may not be printable


def emit(as_json: bool, fields: Any, lines: Iterable[str]) -> None:
    """Print `fields` as one line of JSON, or `lines` as they are."""
    if as_json:
        click.echo(json_line(fields))
        return
    for line in lines:
        click.echo(printable(line))


def note(text: str) -> None:
    """Print a line for the reader that is no result."""
    click.echo(printable(text), err=True)


def printable(text: str) -> str:
    """Return text with what a terminal would obey, or cannot show, as numbers: some of it is what a robot says."""
    return _UNPRINTED.sub(_number, text)


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """Say in one line that a file cannot be written."""
    try:
        yield
    except OSError as error:
        raise BadRequest(f"cannot write {path}: {error.strerror}") from error


def json_line(fields: Any, indent: int | None = None) -> str:
    """Return `fields` on one line, or indented; names in their order, numbers as they are."""
    text = json.dumps(fields, ensure_ascii=False, allow_nan=False, default=float, indent=indent)
    return _UNPRINTED.sub(_json_number, text)


def error_line(error: SoftrigError) -> str:
    """Return an error as a line of JSON."""
    return json_line(error_fields(error))


def error_fields(error: SoftrigError) -> dict[str, Any]:
    """Return an error as the fields of an object."""
    fields: dict[str, Any] = {"error": type(error).__name__, "message": str(error), "exit_code": error.exit_code}
    row = getattr(error, "row", None)
    if row is not None:
        fields["code"] = row.name
    diagnostics = getattr(error, "diagnostics", None)
    if diagnostics:
        fields["diagnostics"] = [item.as_dict() for item in diagnostics]
    return fields


def _number(match: re.Match[str]) -> str:
    character = match[0]
    return character if character.isprintable() else character.encode("unicode_escape").decode()


def _json_number(match: re.Match[str]) -> str:
    return match[0] if match[0].isprintable() else json.dumps(match[0])[1:-1]
