"""What `softrig check` finds in scripts, one after another: for a reader, as JSON, or as GitHub's workflow commands."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import click

from host.cli.output import emit, error_fields, json_line, note, printable
from host.errors import SoftrigError
from host.gait.diagnostics import Diagnostic
from host.gait.errors import USAGE

FORMATS = ("text", "json", "github")


class Findings:
    """Prints what is found and keeps the exit status that it comes to."""

    def __init__(self, form: str) -> None:
        self._form = form
        self._codes: set[int] = set()

    @property
    def exit_code(self) -> int:
        """Return 0, or 2 when a text is wrong anywhere, or else the greatest status of a refusal."""
        return USAGE if USAGE in self._codes else max(self._codes, default=0)

    @contextmanager
    def about(self, script: str) -> Iterator[None]:
        """Tell of what a script is refused for, and go on with the next."""
        try:
            yield
        except SoftrigError as error:
            self._refused(script, error)

    def sound(self, fields: dict[str, object], lines: Sequence[str]) -> None:
        """Tell of a script that keeps every limit."""
        emit(self._form == "json", fields, lines)

    def _refused(self, script: str, error: SoftrigError) -> None:
        """Tell of a script that breaks a limit, is wrong, or cannot be held against its robot."""
        self._codes.add(error.exit_code)
        diagnostics: Sequence[Diagnostic] = getattr(error, "diagnostics", ())
        if self._form == "github":
            for item in diagnostics:
                click.echo(printable(_command(item)))
            if not diagnostics:
                click.echo(printable(f"::error file={_property(script)},title={type(error).__name__}::{_data(error)}"))
            return
        if self._form == "json":
            click.echo(json_line({"script": script, "sound": False, **error_fields(error)}))
        note(str(error) if diagnostics else f"softrig: {error}")


def _command(item: Diagnostic) -> str:
    """Return a mistake as the workflow command that marks its line."""
    place = item.place
    where = f"file={_property(place.file)},line={place.line},col={place.column},endColumn={place.end_column}"
    text = f"{item.message}; {item.help}" if item.help else item.message
    return f"::error {where},title={item.code}::{_data(text)}"


def _data(text: object) -> str:
    """Return text with what would end a command written as numbers."""
    return str(text).replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: object) -> str:
    """Return text with what would end a property written as numbers."""
    return _data(text).replace(":", "%3A").replace(",", "%2C")
