"""The lines of a source text, before any grammar: code and comment, indentation, and what cannot be read at all."""

from __future__ import annotations

import re

from host.gait.diagnostics import Diagnostic
from host.gait.tree import Place

COMMENT = re.compile(r'(?:[^"#]|"[^"]*")*(#.*)')
LINES_MAX = 20_000
LINE_MAX = 1_000
OPERATORS_MAX = 60


def code_part(line: str) -> str:
    """Return `line` without its comment and the blanks before it."""
    match = COMMENT.match(line)
    return (line[: match.start(1)] if match else line).rstrip()


def indent(line: str) -> int:
    """Return the number of spaces that `line` begins with."""
    return len(line) - len(line.lstrip(" "))


def holds_statement(line: str) -> bool:
    """Return whether there is more on a line than blanks and a comment."""
    return bool(line.strip()) and not line.lstrip().startswith("#")


def next_indent(lines: list[str], at: int) -> int:
    """Return the indentation of the next line that holds a statement, or 0."""
    for line in lines[at + 1 :]:
        if holds_statement(line):
            return indent(line)
    return 0


def unreadable(lines: list[str], name: str) -> list[Diagnostic]:
    """Return what keeps a text from being read at all: its size, tabs, control characters."""
    count = len(lines) - (lines[-1:] == [""])  # the last line has an end as well
    if count > LINES_MAX:
        return [Diagnostic(Place(name, LINES_MAX + 1, 1, 2), "E114", f"{count} lines, at most {LINES_MAX}")]
    found = []
    for number, line in enumerate(lines, 1):
        lead = len(line) - len(line.lstrip())
        strange = next((at for at, sign in enumerate(line) if ord(sign) < 32 and sign != "\t"), None)
        if len(line) > LINE_MAX:
            found.append(_at(name, number, 1, "E114", f"a line of {len(line)} characters, at most {LINE_MAX}", ""))
        elif strange is not None:
            found.append(_at(name, number, strange + 1, "E108", "a control character has no meaning here", ""))
        elif sum(map(code_part(line).count, "+-*/(")) > OPERATORS_MAX:
            found.append(_at(name, number, 1, "E114", f"more than {OPERATORS_MAX} operators in one line", ""))
        elif "\t" in line[:lead] and line.strip():
            found.append(_at(name, number, line.index("\t") + 1, "E106", "a tab in the indentation", line))
    first = next((number for number, line in enumerate(lines, 1) if line.strip() and line.lstrip()[0] != "#"), 0)
    if not found and first and indent(lines[first - 1]):
        line = lines[first - 1]
        found.append(_at(name, first, indent(line) + 1, "E105", "the first statement is indented", line))
    return found


def _at(name: str, line: int, column: int, code: str, message: str, source: str) -> Diagnostic:
    return Diagnostic(Place(name, line, column, column + 1), code, message, "", source)
