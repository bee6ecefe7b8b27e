"""What the names of a script stand for: where each is declared, and everywhere it is used.

Params, circles and lets hold everywhere after `$`; the arguments of a def and the name of a `for` within their block;
defs where they are called; labels after `else`.

    index = Index(script)
    symbol = index.at("crawl.gait", 7, 12)
    index.uses(symbol)
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, fields, is_dataclass, replace

from host.gait import tree
from host.gait.script import Script
from host.gait.tree import File, Name, Place, Reference, Statement
from host.lsp.places import within

Env = Mapping[str, "Symbol"]


@dataclass(frozen=True, slots=True)
class Symbol:
    """One declared name: its kind is param, circle, let, argument, item (of a `for`), def or label."""

    kind: str
    name: str
    place: Place
    owner: str = ""  # the def that an argument belongs to
    takes: tuple[str, ...] = ()  # the arguments of a def


class Index:
    """All names of a script and of what it includes."""

    def __init__(self, script: Script) -> None:
        self.script = script
        self.symbols: list[Symbol] = []
        self._uses: list[tuple[Place, Symbol]] = []
        self._files = {file.name: file for file in script.files}
        for file in script.files:
            self._declare(file.statements)
        for file in script.files:
            self._block(file.statements, self._everywhere())

    def at(self, file: str, line: int, column: int) -> Symbol | None:
        """Return what the name under a cursor stands for; line from 1, column from 0."""
        known = (*((symbol.place, symbol) for symbol in self.symbols), *self._uses)
        return next((symbol for place, symbol in known if place.file == file and within(place, line, column)), None)

    def uses(self, symbol: Symbol) -> list[Place]:
        """Return every place of a name, its declaration first; a `$` before it is no part of the place."""
        return [symbol.place, *(place for place, used in self._uses if used == symbol)]

    def named(self, *kinds: str) -> list[Symbol]:
        """Return the symbols of these kinds, in the order of the text."""
        return [symbol for symbol in self.symbols if symbol.kind in kinds]

    def _declare(self, statements: Iterable[Statement], owner: str = "") -> None:
        for node in statements:
            match node:
                case tree.Param() | tree.Circle() | tree.Let() | tree.Label():
                    kind = type(node).__name__.lower()
                    if kind != "let" or node.name.text not in self._everywhere():
                        self._add(Symbol(kind, node.name.text, node.name.place, owner))
                case tree.Define():
                    takes = tuple(parameter.text for parameter in node.parameters)
                    self._add(Symbol("def", node.name.text, node.name.place, "", takes))
                    for parameter in node.parameters:
                        self._add(Symbol("argument", parameter.text, parameter.place, node.name.text))
                case tree.ForEach():
                    self._add(Symbol("item", node.name.text, node.name.place, owner))
            self._declare(getattr(node, "body", ()), node.name.text if isinstance(node, tree.Define) else owner)

    def _add(self, symbol: Symbol) -> None:
        self.symbols.append(symbol)

    def _everywhere(self) -> dict[str, Symbol]:
        return {symbol.name: symbol for symbol in self.symbols if symbol.kind in ("param", "circle", "let")}

    def _block(self, statements: Iterable[Statement], env: Env) -> None:
        for node in statements:
            inner = env
            if isinstance(node, tree.Define | tree.ForEach):
                inner = {**env, **{symbol.name: symbol for symbol in self._inside(node)}}
            self._statement(node, env)
            self._block(getattr(node, "body", ()), inner)

    def _inside(self, node: tree.Define | tree.ForEach) -> Iterator[Symbol]:
        names = node.parameters if isinstance(node, tree.Define) else (node.name,)
        places = {name.place for name in names}
        return (symbol for symbol in self.symbols if symbol.place in places)

    def _statement(self, node: Statement, env: Env) -> None:
        for part in parts(node):
            match part:
                case Reference():
                    self._use(env.get(part.name), replace(part.place, column=part.place.column + 1))
                case tree.Otherwise():
                    self._use(self._first("label", part.choice), part.choice.place)
        match node:
            case tree.Call():
                self._use(self._first("def", node.name), node.name.place)
            case tree.Let():
                self._use(self._first("circle", node.circle), node.circle.place)
                self._use(env.get(node.name.text), node.name.place)
            case tree.Note():
                self._note(node, env)

    def _note(self, node: tree.Note, env: Env) -> None:
        """Find the names that are put into the text of a note."""
        line = self._files[node.place.file].line(node.place.line)
        for found in re.compile(r"\$([A-Za-z_]\w*)").finditer(line, node.place.column, node.place.end_column - 1):
            place = replace(node.place, column=found.start(1) + 1, end_column=found.end(1) + 1)
            self._use(env.get(found[1]), place)

    def _first(self, kind: str, name: Name) -> Symbol | None:
        return next((symbol for symbol in self.symbols if (symbol.kind, symbol.name) == (kind, name.text)), None)

    def _use(self, symbol: Symbol | None, place: Place) -> None:
        if symbol is not None and place != symbol.place:
            self._uses.append((place, symbol))


def here(index: Index, file: File | None, line: int) -> list[Symbol]:
    """Return what `$` may stand before at a line: params and lets, and the names of the blocks it stands in."""
    owners = _open_blocks(file.lines if file else (), line)
    inner = [each for each in index.named("argument", "item") if file and (each.name, each.place.line) in owners]
    near = {symbol.name: symbol for symbol in (*index.named("param", "let"), *inner)}
    return list(near.values())


def _open_blocks(lines: tuple[str, ...], line: int) -> set[tuple[str, int]]:
    """Return the names that the heads of the blocks around a line declare, with their lines; read from the text."""
    found: set[tuple[str, int]] = set()
    text = lines[line - 1] if 0 < line <= len(lines) else ""
    deep = len(text) - len(text.lstrip()) if text.strip() else 1000
    for number in range(min(line - 1, len(lines)), 0, -1):
        head = lines[number - 1]
        at = len(head) - len(head.lstrip())
        if head.strip() and not head.lstrip().startswith("#") and at < deep:
            deep = at
            match = re.match(r"\s*(?:def\s+\w+\s*\((.*?)\)|for\s+(\w+))", head)
            found |= {(name, number) for name in re.findall(r"\w+", (match[1] or match[2] or "") if match else "")}
    return found


def parts(node: object) -> Iterator[object]:
    """Yield a node and all within it, but not the statements of its block."""
    yield node
    for item in fields(node) if is_dataclass(node) else ():
        if item.name in ("body", "place"):
            continue
        value = getattr(node, item.name)
        for part in value if isinstance(value, tuple) else (value,):
            if is_dataclass(part):
                yield from parts(part)
