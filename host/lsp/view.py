"""One text as an editor looks at it: the script it belongs to, its names, and the robot's profile if there is one."""

from __future__ import annotations

import re
from dataclasses import dataclass

from host.gait.diagnostics import Diagnostic
from host.gait.reading.lines import COMMENT
from host.gait.script import Script
from host.gait.tree import File
from host.lsp.names import Index, Symbol
from host.profile import Profile

WORD = re.compile(r"\$?[A-Za-z_]\w*|[0-9]+(?:\.[0-9]+)?|%")


@dataclass(frozen=True)
class View:
    """What is known of the text at `path` while it is edited; `names` may be of its last readable state."""

    path: str
    lines: list[str]
    script: Script
    names: Index
    profile: Profile | None
    found: tuple[Diagnostic, ...] = ()
    robots: tuple[str, ...] = ()

    @property
    def file(self) -> File | None:
        """Return the tree of this text, without statements if it cannot be read."""
        return next((file for file in self.script.files if file.name == self.path), None)

    def line(self, number: int) -> str:
        """Return a line, counted from 1."""
        return self.lines[number - 1] if 0 < number <= len(self.lines) else ""

    def in_comment(self, number: int, column: int) -> bool:
        """Return whether a cursor stands in a comment."""
        found = COMMENT.match(self.line(number))
        return found is not None and column > found.start(1)

    def word(self, number: int, column: int) -> re.Match[str] | None:
        """Return the word, number or sign of a unit that a cursor stands in or at the end of."""
        found = [each for each in WORD.finditer(self.line(number)) if each.start() <= column <= each.end()]
        return found[-1] if found else None

    def source(self, symbol: Symbol) -> str:
        """Return the line that declares a name, without its comment."""
        return _code(self._lines(symbol)[symbol.place.line - 1 :]).strip()

    def comment(self, symbol: Symbol) -> str:
        """Return what its author wrote about a name: beside it, or in the lines right above."""
        lines, at = self._lines(symbol), symbol.place.line - 1
        beside = COMMENT.match(lines[at]) if at < len(lines) else None
        if beside:
            return _bare(beside[1])
        above: list[str] = []
        while 0 < at <= len(lines) and lines[at - 1].lstrip().startswith("#"):
            at -= 1
            above.insert(0, _bare(lines[at].strip()))
        return "\n".join(above)

    def _lines(self, symbol: Symbol) -> tuple[str, ...]:
        """Return the lines among which a name was declared, which may be those of an earlier state."""
        return next((file.lines for file in self.names.script.files if file.name == symbol.place.file), ())


def _code(lines: tuple[str, ...]) -> str:
    line = lines[0] if lines else ""
    found = COMMENT.match(line)
    return line[: found.start(1)] if found else line


def _bare(comment: str) -> str:
    return comment.lstrip("#").strip()
