"""What is wrong with a script, said so that it can be put right.

crawl.gait:7:5: error E141: wait has no timeout
    wait until A.temperature > 95 C else abort
    ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
    help: add `timeout 4 s` before `else`
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass

from host.errors import SoftrigError
from host.gait.errors import BY_CODE, USAGE
from host.gait.tree import File, Place


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One mistake: where, which code, what, and what to do about it."""

    place: Place
    code: str
    message: str
    help: str = ""
    source_line: str = ""

    @property
    def exit_code(self) -> int:
        """Return 2 for a mistake in the text, 4 for a limit that the script would break."""
        return BY_CODE[self.code].exit_code

    def __str__(self) -> str:
        place = self.place
        lines = [f"{place.file}:{place.line}:{place.column}: error {self.code}: {self.message}"]
        if self.source_line.strip():
            lines += [f"    {part}" for part in _caret(self.source_line, place)]
        if self.help:
            lines.append(f"    help: {self.help}")
        return "\n".join(lines)

    def as_dict(self) -> dict[str, object]:
        """Return the fields for JSON."""
        return {
            "file": self.place.file,
            "line": self.place.line,
            "column": self.place.column,
            "end_column": self.place.end_column,
            "severity": "error",
            "code": self.code,
            "message": self.message,
            "help": self.help,
        }


class GaitError(SoftrigError):
    """A script that cannot be compiled; `diagnostics` lists every mistake found, in the order of the text."""

    def __init__(self, diagnostics: Iterable[Diagnostic]) -> None:
        self.diagnostics = in_order(diagnostics)
        self.exit_code = exit_code(self.diagnostics)
        super().__init__("\n".join(str(item) for item in self.diagnostics))


class Problems:
    """Collects what is found wrong in some files, each with its source line."""

    def __init__(self, files: Iterable[File], found: Iterable[Diagnostic] = ()) -> None:
        self.found = list(found)
        self._files = {file.name: file for file in files}

    def add(self, place: Place, code: str, message: str, help: str = "") -> None:
        """Note one more."""
        file = self._files.get(place.file)
        line = file.line(place.line) if file else ""
        self.found.append(Diagnostic(place, code, message, help, line))

    def raise_any(self) -> None:
        """Raise GaitError if there is anything to tell."""
        if self.found:
            raise GaitError(self.found)


def exit_code(diagnostics: Iterable[Diagnostic]) -> int:
    """Return the exit status for these: 0 for none, 2 if the text is wrong anywhere, else 4."""
    codes = {item.exit_code for item in diagnostics}
    return USAGE if USAGE in codes else max(codes, default=0)


def in_order(diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return them by file, line and column; of those with one place and code, the first."""
    unique: dict[tuple[Place, str], Diagnostic] = {}
    for item in diagnostics:
        unique.setdefault((item.place, item.code), item)
    return tuple(sorted(unique.values(), key=_by_place))


def _by_place(item: Diagnostic) -> tuple[str, int, int, str]:
    return item.place.file, item.place.line, item.place.column, item.code


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Return `did you mean ...?` for the nearest known word, or an empty text."""
    choices = {item.lower(): item for item in known}
    near = difflib.get_close_matches(word.lower(), choices, n=1, cutoff=0.6)
    return f"did you mean `{choices[near[0]]}`?" if near else ""


def _caret(source: str, place: Place) -> tuple[str, str]:
    indent = len(source) - len(source.lstrip())
    text = source.strip()
    start = max(place.column - 1 - indent, 0)
    width = max(min(place.end_column - place.column, len(text) - start), 1)
    return text, " " * start + "^" * width
