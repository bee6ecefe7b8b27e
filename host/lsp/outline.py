"""What a script declares, as an outline; where a name is declared and used; a new name for it."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass

from host.errors import BadRequest
from host.gait import tree
from host.gait.reading.syntax import KEYWORDS, NAMES
from host.gait.tree import Place
from host.lsp.names import Symbol
from host.lsp.places import within
from host.lsp.view import View

SOFT = {word.lower() for word in NAMES[1]}  # words of the language that `$` may still stand before
VALUES = ("param", "circle", "let", "argument", "item")


@dataclass(frozen=True, slots=True)
class Entry:
    """One line of the outline: its place, and how far its block goes."""

    kind: str
    name: str
    detail: str
    place: Place
    last_line: int


def outline(view: View) -> list[Entry]:
    """Return the params, circles, defs and labels of a text, in its order."""
    own = (each for each in view.names.named("param", "circle", "def", "label") if each.place.file == view.path)
    entries = [Entry(each.kind, each.name, view.source(each), each.place, _end(each, view)) for each in own]
    return sorted(entries, key=lambda entry: entry.place.line)


def declaration(view: View, number: int, column: int) -> Place | None:
    """Return where the name under a cursor is declared, or the beginning of the file that an include names."""
    for node in view.file.statements if view.file else ():
        if isinstance(node, tree.Include) and within(node.place, number, column):
            path = os.path.normpath(os.path.join(os.path.dirname(view.path), node.path))
            return Place(path, 1, 1, 1) if any(file.name == path for file in view.script.files) else None
    symbol = view.names.at(view.path, number, column)
    return symbol.place if symbol else None


def uses(view: View, number: int, column: int) -> list[Place]:
    """Return every place of the name under a cursor, its declaration first."""
    symbol = view.names.at(view.path, number, column)
    return view.names.uses(symbol) if symbol else []


def renamed(view: View, number: int, column: int, name: str) -> list[Place]:
    """Return the places to write a new name at; BadRequest says why it cannot be one."""
    symbol = view.names.at(view.path, number, column)
    if symbol is None:
        raise BadRequest("there is no name here that the script declares")
    if not re.fullmatch(r"[A-Za-z_][A-Za-z_0-9]*", name):
        raise BadRequest(f"`{name}` is no name: letters, digits and _, and no digit at its beginning")
    if name in KEYWORDS and not (name in SOFT and symbol.kind in ("param", "argument", "item")):
        raise BadRequest(f"`{name}` is a word of the language")
    clash = _clash(symbol, name, view)
    if clash is not None:
        raise BadRequest(f"`{name}` is declared already, in line {clash.place.line} of {clash.place.file}")
    return view.names.uses(symbol)


def _clash(symbol: Symbol, name: str, view: View) -> Symbol | None:
    """Return what has a name already that it would be taken for."""
    kinds = VALUES if symbol.kind in VALUES else (symbol.kind,)
    return next((each for each in view.names.named(*kinds) if each.name == name and each != symbol), None)


def _end(symbol: Symbol, view: View) -> int:
    """Return the last line of a def's block, of others their own."""
    line = symbol.place.line
    if symbol.kind != "def":
        return line
    last = line
    for number in range(line + 1, len(view.lines) + 1):
        text = view.line(number)
        if text.strip() and not text.startswith((" ", "#")):
            break
        last = number if text.strip() and text.startswith(" ") else last
    return last
