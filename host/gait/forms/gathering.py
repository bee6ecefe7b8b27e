"""Statements gathered one after another, with their blocks and comments: what a script from Python grows in."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from textwrap import dedent
from typing import Self

from host.gait import tree
from host.gait.diagnostics import GaitError
from host.gait.forms import phrases
from host.gait.forms.formatting import made
from host.gait.forms.layout import BLANK, Item, Sheet, layout, tidy
from host.gait.forms.writer import statement as head
from host.gait.reading.parser import parse_file

NAME = "script.gait"


@dataclass
class _Block:
    """Statements so far, and the comments and blank lines that wait for the next one."""

    items: list[Item] = field(default_factory=list)
    waiting: list[str] = field(default_factory=list)

    def put(self, item: Item) -> None:
        """Add a statement after what waits for it."""
        before = tidy((*self.waiting, *item.before), not self.items)
        self.items.append(replace(item, before=before))
        self.waiting = []


class Gathering:
    """The statements so far; the innermost open block takes the next one."""

    def __init__(self) -> None:
        self._blocks = [_Block()]

    def add(self, text: str) -> Self:
        """Add statements as they stand in a script, with their comments."""
        file, found = parse_file(dedent(text).strip("\n"), "text")
        with plain():
            if found:
                raise GaitError(found)
        sheet, block = layout(file), self._blocks[-1]
        for item in sheet.items:
            block.put(item)
        block.waiting += sheet.after
        return self

    def comment(self, text: str) -> Self:
        """Put a comment before what comes next, on as many lines as the text has."""
        self._blocks[-1].waiting += [phrases.remark(line) for line in text.split("\n")]
        return self

    def blank(self) -> Self:
        """Put a blank line before what comes next."""
        self._blocks[-1].waiting.append(BLANK)
        return self

    @property
    def is_open(self) -> bool:
        """Return whether a block is open."""
        return len(self._blocks) > 1

    def line(self) -> str:
        """Return the last statement as it is written; of a block its head."""
        return head(self._blocks[-1].items[-1].node)

    def sheet(self) -> Sheet:
        """Return the statements with their comments; ValueError while a block is open."""
        if self.is_open:
            raise ValueError("a block is open: a script is whole after its `with`")
        block = self._blocks[0]
        return Sheet(tuple(block.items), tidy(tuple(block.waiting), False, True))

    def text(self) -> str:
        """Return the script as `softrig fmt` would write it."""
        with plain():
            return made(self.sheet(), NAME)

    def __repr__(self) -> str:
        """Return the text; while a block is open, the lines before it."""
        return "\n".join(head(item.node) for item in self._blocks[0].items) if self.is_open else self.text()

    def _put(self, node: tree.Statement) -> Self:
        self._blocks[-1].put(Item(node))
        return self

    @contextmanager
    def _block(self, node: Callable[[tuple[tree.Statement, ...]], tree.Statement], what: str) -> Iterator[None]:
        """Collect the statements of a block; none of it is kept when something in it is wrong."""
        depth = len(self._blocks)
        self._blocks.append(_Block())
        try:
            yield
            block = self._blocks[depth]
            if not block.items:
                raise ValueError(f"the block of this {what} is empty")
        finally:
            del self._blocks[depth:]
        head_of = node(tuple(item.node for item in block.items))
        self._blocks[-1].put(Item(head_of, (), "", tuple(block.items), tidy(tuple(block.waiting), False, True)))


@contextmanager
def plain() -> Iterator[None]:
    """Turn what is wrong with a script into a ValueError with the same text."""
    try:
        yield
    except GaitError as error:
        raise ValueError(str(error)) from None
