"""Reads gait scripts: text to tree, with every mistake of form reported at once.

A line that cannot be read is reported, set aside and the rest is read again, so that one slip does not hide the next.
Nothing that a text contains raises anything but GaitError.

    script = load("gaits/circular-crawl.gait")
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import cast

from lark import Lark, Token
from lark.exceptions import UnexpectedInput
from lark.indenter import Indenter

from host.gait import tree
from host.gait.diagnostics import Diagnostic, GaitError
from host.gait.reading import syntax
from host.gait.reading.build import Builder
from host.gait.reading.lines import COMMENT, holds_statement, indent, next_indent, unreadable
from host.gait.reading.syntax import BROKEN, BadIndent
from host.gait.tree import Comment, Expression, File, Place

DEPTH_MAX = 30
REPORTS_MAX = 20


class Blocks(Indenter):
    """Tells where blocks begin and end; a step back to no open block is a BadIndent."""

    NL_type = "_NL"
    OPEN_PAREN_types: list[str] = []  # noqa: RUF012  # lark reads these names on the class
    CLOSE_PAREN_types: list[str] = []  # noqa: RUF012
    INDENT_type = "_INDENT"
    DEDENT_type = "_DEDENT"
    tab_len = 8

    def handle_NL(self, token: Token) -> Iterator[Token]:
        """Yield the tokens of a line end, and of the blocks it opens or closes."""
        column = len(token.rsplit("\n", 1)[1])
        if (column < self.indent_level[-1] and column not in self.indent_level) or len(self.indent_level) > DEPTH_MAX:
            raise BadIndent(token.end_line or 1, len(self.indent_level) > DEPTH_MAX)
        yield from super().handle_NL(token)


@cache
def grammar() -> Lark:
    """Return the parser of the one grammar file; built once."""
    return Lark.open(
        "gait.lark",
        rel_to=__file__,
        parser="lalr",
        lexer="basic",
        postlex=Blocks(),
        start=["file", "value"],
        maybe_placeholders=True,
    )


def parse_file(text: str, name: str) -> tuple[File, list[Diagnostic]]:
    """Return the tree of one file, unread lines as Broken, and what is wrong with their form."""
    lines = text.replace("\r\n", "\n").split("\n")
    found = unreadable(lines, name)
    if found:
        return File(name, (), (), tuple(lines), readable=False), found
    readable = list(lines)
    while len(found) < REPORTS_MAX:
        try:
            parsed = grammar().parse("\n".join(readable) + "\n", start="file")
        except (UnexpectedInput, BadIndent) as error:
            diagnostic = syntax.say(error, _shifts(lines, readable), lines, name)
            found.append(diagnostic)
            if isinstance(error, BadIndent) or not _set_aside(readable, diagnostic):
                break
            continue
        statements = cast(tuple[tree.Statement, ...], Builder(name, _shifts(lines, readable)).transform(parsed))
        return File(name, statements, tuple(_comments(lines, name)), tuple(lines)), found
    return File(name, (), (), tuple(lines), readable=False), found


def parse_value(text: str, name: str) -> Expression:
    """Return the expression that `text` is, or raise GaitError; places are in a file called `name`."""
    found = unreadable([text], name)
    if found:
        raise GaitError(found)
    try:
        return cast(Expression, Builder(name, [0]).transform(grammar().parse(text, start="value")))
    except UnexpectedInput as error:
        raise GaitError([syntax.say(error, [0], [text], name)]) from None


def _set_aside(lines: list[str], diagnostic: Diagnostic) -> bool:
    """Make the line that `diagnostic` names readable: shifted to its place or replaced; False if nothing helps."""
    at = diagnostic.place.line - 1
    if not 0 <= at < len(lines) or BROKEN in lines[at]:
        return False
    opens = next_indent(lines, at) > indent(lines[at])
    if diagnostic.code == "E105" and (opens or not lines[at].rstrip().endswith(":")):
        _shift_left(lines, at)
    else:
        lines[at] = " " * indent(lines[at]) + BROKEN + (":" if opens else "")
    return True


def _shift_left(lines: list[str], at: int) -> None:
    """Move a block that is indented for no reason back to the column of the statement above it."""
    above = next((line for line in reversed(lines[:at]) if holds_statement(line)), "")
    deep = indent(lines[at])
    excess = deep - indent(above)
    for number in range(at, len(lines)):
        if holds_statement(lines[number]) and indent(lines[number]) < deep:
            break
        lines[number] = lines[number][min(excess, indent(lines[number])) :]


def _shifts(lines: list[str], readable: list[str]) -> list[int]:
    """Return by how many columns each line was moved to the left to be readable."""
    return [indent(line) - indent(moved) for line, moved in zip(lines, readable, strict=True)]


def _comments(lines: list[str], name: str) -> Iterator[Comment]:
    for number, line in enumerate(lines, 1):
        match = COMMENT.match(line)
        if match:
            column = match.start(1) + 1
            yield Comment(match[1], Place(name, number, column, len(line) + 1))
