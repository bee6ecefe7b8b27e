"""A script as it is laid out: its statements with the comments and blank lines around them, wherever they came from.

The tree of a text keeps comments by their places. Here each stands with a statement: before it, beside it, or after
the last one of a block, as its column tells. A tree that was never a text (from JSON, from Python) has a layout too.

    sheet = layout(file)                  # of what the parser read, if it read all of it
    same(sheet, layout(other))            # the same statements and comments, wherever they stand
"""

from __future__ import annotations

from dataclasses import dataclass, fields, is_dataclass
from itertools import pairwise
from typing import Any

from host.gait.reading.lines import indent
from host.gait.script import walk
from host.gait.tree import File, Place, Statement

NOWHERE = Place("", 1, 1, 2)
BLANK = ""  # stands for a blank line among comments


@dataclass(frozen=True, slots=True)
class Item:
    """A statement with the lines before it (comments, and at most one BLANK in a row) and the comment beside it.

    A block has the items of its body, and the lines that stand after the last of them.
    """

    node: Statement
    before: tuple[str, ...] = ()
    beside: str = ""
    body: tuple[Item, ...] = ()
    after: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Sheet:
    """A whole script: its items, and the lines after the last one."""

    items: tuple[Item, ...]
    after: tuple[str, ...] = ()


def layout(file: File) -> Sheet:
    """Return the layout of a file that was read without mistakes."""
    return _Layout(file).sheet()


def same(one: Any, other: Any) -> bool:
    """Return whether two trees, or two layouts, say the same, wherever they stand."""
    if type(one) is not type(other):
        return False
    if isinstance(one, tuple):
        return len(one) == len(other) and all(map(same, one, other))
    if is_dataclass(one):
        names = [field.name for field in fields(one) if field.name != "place"]
        return all(same(getattr(one, name), getattr(other, name)) for name in names)
    return bool(one == other)


def tidy(lines: tuple[str, ...], first: bool, last: bool = False) -> tuple[str, ...]:
    """Return comments and blank lines without needless blanks: none doubled, none at either end of a block."""
    kept: list[str] = []
    for line in lines:
        if line.rstrip() or (kept[-1:] != [BLANK] and not (first and not kept)):
            kept.append(line.rstrip())
    while last and kept[-1:] == [BLANK]:
        kept.pop()
    return tuple(kept)


class _Layout:
    """Shares out the lines of a file that hold no statement."""

    def __init__(self, file: File) -> None:
        self._lines = file.lines
        self._comments = {comment.place.line: comment for comment in file.comments}
        self._statements = file.statements
        order = [0, *(node.place.line for node in walk(file.statements)), len(file.lines) + 1]
        self._next = dict(pairwise(order))

    def sheet(self) -> Sheet:
        """Return the layout of the whole file."""
        items, rest = self._block(self._statements, self._after(0))
        return Sheet(items, tidy(self._texts(rest), not items, last=True))

    def _block(self, nodes: tuple[Statement, ...], before: list[int]) -> tuple[tuple[Item, ...], list[int]]:
        """Return the items of a block that begins with the lines `before`, and the lines that follow its last one."""
        items: list[Item] = []
        for node in nodes:
            line, body = node.place.line, getattr(node, "body", ())
            rest = self._after(line)
            children: tuple[Item, ...] = ()
            after: list[int] = []
            if body:
                children, rest = self._block(body, rest)
                after, rest = self._inside(rest, indent(self._lines[body[0].place.line - 1]))
            lead, closing = tidy(self._texts(before), not items), tidy(self._texts(after), False)
            beside = self._comments[line].text.rstrip() if line in self._comments else ""
            items.append(Item(node, lead, beside, children, closing))
            before = rest
        return tuple(items), before

    def _inside(self, lines: list[int], column: int) -> tuple[list[int], list[int]]:
        """Return those of the lines after a block that belong to it, by their column, and the rest."""
        count = 0
        for at, number in enumerate(lines, 1):
            if number in self._comments:
                if indent(self._lines[number - 1]) < column:
                    break
                count = at
        return lines[:count], lines[count:]

    def _after(self, line: int) -> list[int]:
        """Return the lines between a statement and the next one."""
        return list(range(line + 1, self._next[line]))

    def _texts(self, lines: list[int]) -> tuple[str, ...]:
        return tuple(self._comments[line].text if line in self._comments else BLANK for line in lines)
