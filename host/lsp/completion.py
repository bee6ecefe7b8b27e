"""What may come next at a cursor: the grammar itself says which kinds of words, the script and its robot which ones."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from lark import Token
from lark.exceptions import LarkError

from host.gait import units
from host.gait.reading.parser import grammar
from host.gait.reading.syntax import FORMS, KEYWORDS, NAMES
from host.gait.working import sources
from host.gait.working.subjects import QUANTIFIERS
from host.gait.working.turns import BACK
from host.lsp import words
from host.lsp.names import here
from host.lsp.view import View
from protocol.labels import direction

PARTIAL = re.compile(r"(?:\$\w*|[A-Za-z_]\w*)?$")
PARTIAL_ROBOT = re.compile(r"(?<=robot )\s*[\w-]*$")
CHOICES = ("continue", "abort")  # besides a label
COILS = {"FIRE", "HOLD", "CIRCLE", "IS"}


@dataclass(frozen=True, slots=True)
class Item:
    """One offer: what it is called and stands for; `text` takes the place of what was typed from `start` on."""

    text: str
    kind: str  # statement, word, name, label, quantity, unit, channel, robot or file
    start: int
    detail: str = ""
    about: str = ""


@dataclass(frozen=True, slots=True)
class _Cursor:
    """A cursor in a line: the tokens before it, and the terminals that the grammar takes next."""

    view: View
    number: int
    start: int
    tokens: tuple[Token, ...]
    accepts: frozenset[str]

    @property
    def first(self) -> str:
        return self.tokens[0].type if self.tokens else ""

    @property
    def last(self) -> str:
        return self.tokens[-1].type if self.tokens else ""

    @property
    def clause(self) -> str:
        """Return the last word of the language before the cursor."""
        return next((str(token) for token in reversed(self.tokens) if str(token) in KEYWORDS), "")


def complete(view: View, number: int, column: int) -> list[Item]:
    """Return the offers at a cursor: line from 1, column from 0."""
    before = view.line(number)[:column]
    if view.in_comment(number, column):
        return []
    if before.count('"') % 2:
        return list(_in_text(view, number, before))
    partial = PARTIAL_ROBOT.search(before) or PARTIAL.search(before)
    start = partial.start() if partial else column
    cursor = _cursor(view, number, before[:start], start)
    if cursor is None:
        return []
    names = [] if before[start : start + 1] == "$" else [*_names(cursor), *_words(cursor)]
    found = [*names, *_references(cursor)] if cursor.tokens else [*_words(cursor), *_names(cursor)]
    return list({item.text: item for item in reversed(found)}.values())[::-1]


def _cursor(view: View, number: int, before: str, start: int) -> _Cursor | None:
    """Return what stands before a cursor; None where the line is wrong already."""
    parser = grammar().parse_interactive(before.strip(), start="file")
    try:
        tokens = tuple(parser.exhaust_lexer())
    except LarkError:
        return None
    return _Cursor(view, number, start, tokens, frozenset(parser.accepts()))  # type: ignore[no-untyped-call]


def _in_text(view: View, number: int, before: str) -> Iterator[Item]:
    """Yield files within the quotation marks of an include, names within those of a note."""
    typed = before[before.rindex('"') + 1 :]
    if before.lstrip().startswith("include"):
        folder, start = os.path.join(os.path.dirname(view.path), os.path.dirname(typed)), len(before) - len(typed)
        for name in _files(folder, view.path):
            yield Item(os.path.join(os.path.dirname(typed), name), "file", start)
    elif typed and (found := re.search(r"\$\w*$", typed)):
        for symbol in here(view.names, view.file, number):
            yield Item(f"${symbol.name}", "name", len(before) - len(found[0]), symbol.kind)


def _files(folder: str, own: str) -> list[str]:
    """Return the scripts in a folder, and the folders in it that have a slash at their end."""
    try:
        with os.scandir(folder or ".") as entries:
            found = [each.name + "/" * each.is_dir() for each in entries if not each.name.startswith(".")]
    except (OSError, ValueError):
        return []
    wanted = (name for name in found if name.endswith((".gait", "/")))
    return sorted(name for name in wanted if os.path.join(folder, name) != own)


def _words(cursor: _Cursor) -> Iterator[Item]:
    """Yield the words of the language that may come next; a clause that is there already is left out."""
    if NAMES[1] <= cursor.accepts:  # a name of one's own
        return
    there = {str(token) for token in cursor.tokens}
    for word in KEYWORDS if cursor.first != "ROBOT" else ():
        if word.upper() in cursor.accepts and not (cursor.tokens and word in there):
            kind = "word" if cursor.tokens else "statement"
            about = words.clause(cursor.first.lower(), word) if cursor.tokens else words.STATEMENTS.get(word, "")
            yield Item(word, kind, cursor.start, "" if cursor.tokens else FORMS.get(word, ""), about)


def _names(cursor: _Cursor) -> Iterator[Item]:
    """Yield what a name may be here."""
    view, start = cursor.view, cursor.start
    if cursor.last == "NUMBER":
        yield from _units(cursor)
    elif "NAME" not in cursor.accepts:
        return
    elif not cursor.tokens:
        for symbol in view.names.named("def"):
            call = f"{symbol.name}({', '.join(symbol.takes)})"
            yield Item(symbol.name, "name", start, call, view.comment(symbol))
    elif cursor.last == "DOT":
        quantities = _quantities(str(cursor.tokens[-2]) if len(cursor.tokens) > 1 else "", view)
        yield from (Item(each, "quantity", start, words.QUANTITIES.get(each, "")) for each in quantities)
    elif cursor.last == "ELSE":
        yield from (Item(each, "word", start, words.CLAUSES["else"]) for each in CHOICES)
        below = (each for each in view.names.named("label") if each.place.line > cursor.number)
        yield from (Item(each.name, "label", start, "label", view.comment(each)) for each in below)
    elif cursor.first == "ROBOT":
        yield from (Item(each, "robot", start) for each in view.robots)
    else:
        yield from _named(cursor)


def _named(cursor: _Cursor) -> Iterator[Item]:
    """Yield what is named by the statement's first word and the token before the cursor."""
    first, last, view, start = cursor.first, cursor.last, cursor.view, cursor.start
    if first == "LET":
        circles = [each.name for each in view.names.named("circle")] if last == "EQUAL" else []
        yield from (Item(each, "name", start, "circle") for each in [*circles, *["down"] * (last == "LSQB")])
    elif first == "SYM":
        ball = any(direction(label) for label in (view.profile.coil_labels if view.profile else ()))
        yield from (Item(each, "word", start, "axis of the body") for each in BACK if ball)
    elif first in ("GUARD", "WAIT") and last != "IS":
        yield from _channels(cursor, ("coil", "joint", "cell"))
        yield from (Item(each, "word", start) for each in (*QUANTIFIERS, *sources.PARTS))
        if last in ("GUARD", "UNTIL"):
            yield from (Item(each, "quantity", start, words.QUANTITIES.get(each, "")) for each in _whole(view))
    elif first in COILS - {"CIRCLE"} or last == "IS" or (first == "CIRCLE" and last != "CIRCLE"):
        yield from _channels(cursor, ("coil",))
    elif first == "MOVE":
        yield from _channels(cursor, ("joint",))
    elif (first == "FOR" and last != "FOR") or first == "NAME":
        yield from _channels(cursor, ("coil", "joint", "cell"))


def _channels(cursor: _Cursor, kinds: Iterable[str]) -> Iterator[Item]:
    """Yield coils, joints, force cells and the groups of those kinds."""
    profile = cursor.view.profile
    if profile is None:
        return
    labels = {"coil": profile.coil_labels, "joint": profile.joint_labels, "cell": profile.cell_labels}
    offered = [(label, kind) for kind in kinds for label in labels[kind]]
    known = {label for label, _ in offered}
    offered += [(name, "group") for name, inner in profile.groups.items() if known & set(inner)]
    offered += [("all", "group")] if offered and "all" not in QUANTIFIERS | profile.groups else []
    offered += [("all", "group")] if offered and cursor.first not in ("GUARD", "WAIT") else []
    for label, kind in dict(offered).items():
        yield Item(label, "channel", cursor.start, kind, words.channel(label, profile))


def _references(cursor: _Cursor) -> Iterator[Item]:
    if "REFERENCE" in cursor.accepts:
        for symbol in here(cursor.view.names, cursor.view.file, cursor.number):
            source = cursor.view.source(symbol) if symbol.kind == "param" else symbol.kind
            yield Item(f"${symbol.name}", "name", cursor.start, source, cursor.view.comment(symbol))


def _units(cursor: _Cursor) -> Iterator[Item]:
    """Yield the units that a number may have where it stands."""
    if "PERCENT" in cursor.accepts:
        wanted = _compared(cursor) or _behind(cursor)
        for name, unit in units.UNITS.items():
            if wanted in (None, unit.kind):
                yield Item(name, "unit", cursor.start, unit.kind)


def _behind(cursor: _Cursor) -> str | None:
    """Return the kind of quantity that stands behind a word of the statement, where no calculation began."""
    begins = [str(token) for token in cursor.tokens[-3:-1] if token.type != "MINUS"][-1:]
    if begins != [cursor.clause]:
        return None
    return words.kind_behind(cursor.first.lower(), cursor.clause, cursor.view.profile)


def _compared(cursor: _Cursor) -> str | None:
    """Return the kind of the quantity that a condition compares with the number before the cursor."""
    if len(cursor.tokens) < 3 or cursor.tokens[-2].type != "COMPARE":
        return None
    known = {**sources.COIL, **sources.JOINT, **sources.CELL, **sources.SUPPLY, **sources.WHOLE}
    source = known.get(str(cursor.tokens[-3]))
    return source.kind if source else None


def _quantities(subject: str, view: View) -> list[str]:
    """Return what can be asked of a thing."""
    if subject in sources.PARTS:
        return list(sources.PARTS[subject])
    profile = view.profile
    if profile is None or subject in QUANTIFIERS or subject.startswith("$"):
        several: list[str] = []
        for has, known in _kinds(view):
            several += [each for each in known if has and each not in several]
        return several
    joints, members = sources.of_joint(profile), set(profile.groups.get(subject, (subject,)))
    if members & set(profile.cell_labels):
        return list(sources.CELL)
    return list(joints if members & set(profile.joint_labels) else sources.COIL)


def _kinds(view: View) -> tuple[tuple[object, sources.Sources], ...]:
    profile = view.profile
    if profile is None:
        return (True, sources.COIL), (True, sources.JOINT), (True, sources.CELL)
    joints = sources.of_joint(profile)
    return (profile.coil_labels, sources.COIL), (profile.joint_labels, joints), (profile.cells, sources.CELL)


def _whole(view: View) -> Iterator[str]:
    """Yield what can be asked of the robot as a whole."""
    profile = view.profile
    own = {
        **dict.fromkeys([*sources.BODY, "down"], profile is None or profile.imu is not None),
        **dict.fromkeys(sources.OBJECT, profile is None or profile.camera is not None),
        **dict.fromkeys(sources.LOAD, profile is None or profile.load is not None),
    }
    yield from (name for name in (*sources.WHOLE, "down") if own.get(name, True))
