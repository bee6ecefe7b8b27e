"""What a cursor points at: what a name stands for, how far a word goes on this robot, what a mistake means."""

from __future__ import annotations

import re

from host.gait.errors import BY_CODE
from host.gait.reading.syntax import FORMS, KEYWORDS
from host.lsp import words
from host.lsp.names import Symbol
from host.lsp.places import within
from host.lsp.view import View

KINDS = {"item": "name of a `for`", "let": "coil that the robot chooses"}


def hover(view: View, number: int, column: int) -> str:
    """Return what there is to say in Markdown, or an empty text; line from 1, column from 0."""
    if view.in_comment(number, column):
        return ""
    parts = [_pointed(view, number, column), *_explained(view, number, column)]
    return "\n\n---\n\n".join(part for part in parts if part)


def _explained(view: View, number: int, column: int) -> list[str]:
    """Return the rows of the codes of the mistakes at a cursor."""
    codes = [item.code for item in view.found if item.place.file == view.path and within(item.place, number, column)]
    rows = [BY_CODE[code] for code in dict.fromkeys(codes) if code in BY_CODE]
    return [f"**{row.code}** {row.cause}\n\nTo do: {row.todo}" for row in rows]


def _pointed(view: View, number: int, column: int) -> str:
    symbol = view.names.at(view.path, number, column)
    if symbol is not None:
        return _symbol(symbol, view)
    found = view.word(number, column)
    if found is None or _in_text(view.line(number), column):
        return ""
    line, word = view.line(number), found[0]
    before = line[: found.start()]
    if before.split()[:1] == ["robot"]:
        return words.robot(view.profile) if view.profile else ""
    if re.search(r"[\w\]]\.$", before):
        return _quantity(word)
    return _word(view, before, word)


def _word(view: View, before: str, word: str) -> str:
    """Return what is said of a word by itself: a coil goes before a word of the language, but not at the beginning."""
    profile = view.profile
    if re.search(r"\d\s*$", before) and words.unit(word):
        return words.unit(word)
    statement = re.findall(r"[a-z]+", before)[:1] or [word]
    if not before.strip() and word in FORMS:
        allowed = words.limit(word, word, profile) if profile else ""
        return _joined(f"```gait\n{FORMS[word]}\n```", words.STATEMENTS.get(word, ""), allowed)
    named = words.channel(word, profile) if profile else ""
    if named or word not in KEYWORDS:
        return named or (_quantity(word) if statement[0] in ("guard", "wait", "let") else "")
    allowed = words.limit(statement[0], word, profile) if profile else ""
    return _joined(f"`{word}`: {words.clause(statement[0], word)}", allowed)


def _symbol(symbol: Symbol, view: View) -> str:
    file = "" if symbol.place.file == view.path else f"in {symbol.place.file}"
    if symbol.kind == "argument":
        return _joined(f"`{symbol.name}`: argument of `{symbol.owner}`", file)
    kind = KINDS.get(symbol.kind, symbol.kind)
    return _joined(f"```gait\n{view.source(symbol)}\n```", view.comment(symbol), kind, file)


def _quantity(word: str) -> str:
    return f"`{word}`: {words.QUANTITIES[word]}" if word in words.QUANTITIES else ""


def _in_text(line: str, column: int) -> bool:
    return line[:column].count('"') % 2 == 1


def _joined(*parts: str) -> str:
    return "\n\n".join(part for part in parts if part)
