"""Says in plain words why a line could not be read."""

from __future__ import annotations

import re

from lark import Token
from lark.exceptions import UnexpectedCharacters, UnexpectedInput, UnexpectedToken

from host.gait.diagnostics import Diagnostic, did_you_mean
from host.gait.reading.lines import code_part, holds_statement, indent
from host.gait.tree import Place

BROKEN = "\x01"  # stands for a line that was reported and set aside
FORMS = {
    "gait": "gait 1",
    "robot": "robot NAME",
    "param": "param NAME = 60 % [5 % .. 90 %]",
    "include": 'include "file"',
    "circle": "circle NAME = COILS",
    "let": "let NAME = CIRCLE[down + 1]",
    "def": "def NAME(ARGUMENTS):",
    "fire": "fire COILS at 60 % for 600 ms [until 95 C] [overlap 200 ms] [ramp 100 ms]",
    "hold": "hold COILS at 80 C with 40 % for 5 s [overlap 1 s]",
    "move": "move JOINTS to 28 deg over 2 s [overlap 500 ms]",
    "orient": "orient 5 deg for 3 s [overlap 3 s]",
    "press": "press to 5 N over 1 s for 20 s [overlap 5 s]",
    "repeat": "repeat 3:",
    "for": "for NAME in A B C:, or for NAME in 20 %, 40 %:, or for NAME in 1 .. 8:",
    "together": "together:",
    "sym": "sym z 90 deg:, or sym 45 deg: on a ring",
    "wait": "wait 500 ms, or wait until A.temperature > 95 C timeout 4 s else continue",
    "guard": "guard any.temperature > 110 C",
    "note": 'note "text"',
    "label": "label NAME",
    "on": "on fault:",
}
BLOCKS = ("def", "repeat", "for", "together", "sym", "on")
CLAUSES = ("at", "with", "for", "until", "overlap", "ramp", "to", "over", "timeout", "else", "is", "in", "fault")
KEYWORDS = (*FORMS, *CLAUSES)
NAMED = {"NUMBER": "a number", "NAME": "a name", "TEXT": "a text in quotation marks"}
NAMES = (  # a robot may be called as a statement is, a parameter as a word that came later
    {"NAME", "PRESS"},
    {"NAME", "IN", "HOLD", "WITH", "NOTE", "LABEL", "ON", "FAULT", "SYM"},
)
SIGNS = {
    "EQUAL": "=", "LPAR": "(", "RPAR": ")", "LSQB": "[", "RSQB": "]", "COLON": ":", "COMMA": ",",
    "DOT": ".", "__ANON_0": "..",
}  # fmt: skip

FOREIGN = {  # what other languages call it, and what is written here
    "if": "a robot chooses by `wait until ... timeout ... else LABEL`",
    "while": "use `repeat 3:`, or `wait until ... timeout ... else continue`",
    "loop": "use `repeat 3:`",
    "//": "a comment begins with `#`",
}
LOOKALIKES = {
    "°": "write `95 C` or `5 deg`", "Ω": "write `ohm`", "\u2126": "write `ohm`", "\u2212": "write `-`",
    "\u2013": "write `-`, or `..` in a range", "'": 'write `"`', "\u201c": 'write `"`', "\u201e": 'write `"`',
    "\u00a0": "write an ordinary blank", ";": "one statement a line, and nothing at its end",
}  # fmt: skip


class BadIndent(Exception):
    """A line steps back to a column where no block is open, or blocks are nested too deeply."""

    def __init__(self, line: int, deep: bool) -> None:
        super().__init__(line)
        self.line = line
        self.deep = deep


def say(error: UnexpectedInput | BadIndent, shifts: list[int], lines: list[str], name: str) -> Diagnostic:
    """Return the diagnostic for what the parser met, quoting `lines` as they were written.

    `shifts` are the columns by which each line was moved to the left before it was read.
    """
    if isinstance(error, BadIndent):
        return _say_indent(error, lines, name)
    if isinstance(error, UnexpectedCharacters):
        return _say_character(error, shifts, lines, name)
    assert isinstance(error, UnexpectedToken)
    return _Reader(error, shifts, lines, name).say()


class _Reader:
    """Puts one unexpected token into words."""

    def __init__(self, error: UnexpectedToken, shifts: list[int], lines: list[str], name: str) -> None:
        token: Token = error.token
        self.kind = token.type
        self.text = str(token)
        self.ends = self.kind in ("_NL", "$END", "_DEDENT")
        self.accepts = set(error.accepts or error.expected)
        if self.accepts in NAMES:
            self.accepts = {"NAME"}
        self.lines, self.name = lines, name
        self.line, self.column = token.line or len(lines), token.column or 1
        if self.kind == "$END":
            self.line = max((n for n, line in enumerate(lines, 1) if line.strip()), default=1)
        self.column += shifts[self.line - 1]
        words = lines[self.line - 1].split()
        self.first = words[0].split("(")[0].rstrip(":") if words else ""

    def say(self) -> Diagnostic:
        """Return the first description that fits."""
        for describe in (self._block, self._colon, self._statement, self._missing, self._bracket, self._keyword):
            found = describe()
            if found:
                return found
        return self._any()

    def _block(self) -> Diagnostic | None:
        if self.kind == "_INDENT":
            line = self._indented_line()
            source = self.lines[line - 1]
            column, under = indent(source) + 1, code_part(source).strip()
            return self._at("E105", "this line is indented, but the line above opens no block", line, column, under)
        if "_INDENT" in self.accepts:
            line = self._line_above()
            head = self.lines[line - 1].strip()
            return self._at("E105", "the block below this line is empty", line, indent(self.lines[line - 1]) + 1, head)
        if self.accepts == {"_NL"} and self._before().endswith(":"):
            return self._here("E101", "a block begins on a line of its own", "start a new line after `:`")
        return None

    def _colon(self) -> Diagnostic | None:
        if self.ends and "COLON" in self.accepts and self.first in BLOCKS:
            return self._here("E104", "a `:` is missing at the end of the line", f"the form is: {FORMS[self.first]}")
        return None

    def _statement(self) -> Diagnostic | None:
        """A line that begins with a word which is no statement."""
        word = self.first
        lost = word == "for" and self.kind == "NUMBER" and self.accepts == {"NAME"}
        if lost or (word in KEYWORDS and word not in FORMS):
            help = "this word belongs to a statement: put it on the line of its `fire`, `move`, `press` or `wait`"
            return self._word("E107", f"`{word}` does not begin a statement", help)
        if word.isidentifier() and word not in FORMS and self.accepts == {"LPAR"}:
            near = FOREIGN.get(word) or did_you_mean(word, FORMS) or self._instead(word)
            return self._word("E107", f"`{word}` is no statement", near or f"statements are: {', '.join(FORMS)}")
        return None

    def _instead(self, word: str) -> str:
        if self.kind == "EQUAL":
            return f"name a value with `param {word} = ...`"
        alone = code_part(self.lines[self.line - 1]).strip() == word
        return f"to call a def, write `{word}()`" if alone else ""

    def _missing(self) -> Diagnostic | None:
        what = "a value" if "NUMBER" in self.accepts and "NAME" not in self.accepts else ""
        if self.ends and {"NAME", "REFERENCE"} <= self.accepts and self.first in ("guard", "wait"):
            what = "a condition"
        if not what and self.accepts in ({"NUMBER"}, {"NAME"}, {"TEXT"}):
            what = NAMED[next(iter(self.accepts))]
        if what and (self.ends or self.text in KEYWORDS or self.text in ("]", ")", "..")):
            if not self.ends and what == "a name":
                return None
            where = "at the end of the line" if self.ends else f"before `{self.text}`"
            return self._here("E109", f"{what} is missing {where}", self._form())
        return None

    def _bracket(self) -> Diagnostic | None:
        for kind, sign in (("RPAR", ")"), ("RSQB", "]")):
            if self.ends and kind in self.accepts:
                return self._here("E113", f"a `{sign}` is missing", self._form())
        return None

    def _keyword(self) -> Diagnostic | None:
        if self.text in KEYWORDS and "NAME" in self.accepts and self.first in ("param", "def", "circle", "let"):
            return self._here("E161", f"`{self.text}` is a word of the language", "choose another name")
        return None

    def _any(self) -> Diagnostic:
        thing = "the end of the line" if self.ends else f"`{self.text}`"
        near = did_you_mean(self.text, [word.lower() for word in self.accepts if word.lower() in KEYWORDS])
        near = self._sign() or near or FOREIGN.get(self.first, "")
        return self._here("E101", f"{thing} is not expected here", near or self._form() or self._expected())

    def _sign(self) -> str:
        """Return what to write for a comma, or for a name where a value is needed."""
        before, after = self._before(), self.lines[self.line - 1][self.column :]
        whole, part = re.search(r"\d+$", before), re.match(r"\d+", after)
        if self.text == "," and whole and part:
            return f"write decimals with a point: {whole[0]}.{part[0]}"
        if self.text == "," and self.first in ("fire", "hold", "move") and before.split()[1:]:
            return "name them one after another, without commas: `A B`"
        if self.kind == "NAME" and "REFERENCE" in self.accepts and "NAME" not in self.accepts:
            return f"write `${self.text}` for the value of a name"
        return ""

    def _expected(self) -> str:
        if "FIRE" in self.accepts:
            return f"statements are: {', '.join(FORMS)}"
        named = [SIGNS.get(kind, kind.lower()) for kind in sorted(self.accepts) if not kind.startswith("_NL")]
        return f"expected one of: {' '.join(named[:8])}" if named else ""

    def _form(self) -> str:
        form = FORMS.get(self.first)
        return f"the form is: {form}" if form else ""

    def _before(self) -> str:
        return self.lines[self.line - 1][: self.column - 1].rstrip()

    def _indented_line(self) -> int:
        return next(n for n in range(self.line + 1, len(self.lines) + 1) if holds_statement(self.lines[n - 1]))

    def _line_above(self) -> int:
        last = self.line if self.kind == "$END" else self.line - 1
        return next((n for n in range(last, 0, -1) if holds_statement(self.lines[n - 1])), 1)

    def _word(self, code: str, message: str, help: str) -> Diagnostic:
        line = self.lines[self.line - 1]
        return self._at(code, message, self.line, indent(line) + 1, self.first, help)

    def _here(self, code: str, message: str, help: str) -> Diagnostic:
        column = len(code_part(self.lines[self.line - 1])) + 1 if self.ends else self.column
        return self._at(code, message, self.line, column, " " if self.ends else self.text, help)

    def _at(self, code: str, message: str, line: int, column: int, under: str, help: str = "") -> Diagnostic:
        place = Place(self.name, line, column, column + max(len(under), 1))
        return Diagnostic(place, code, message, help, self.lines[line - 1])


def _say_indent(error: BadIndent, lines: list[str], name: str) -> Diagnostic:
    line = lines[error.line - 1]
    column = indent(line) + 1
    if error.deep:
        return _at(name, error.line, column, "E114", "blocks are nested too deeply", line)
    return _at(name, error.line, column, "E105", "this line steps back to a column where no block began", line)


def _say_character(error: UnexpectedCharacters, shifts: list[int], lines: list[str], name: str) -> Diagnostic:
    line, column = lines[error.line - 1], error.column + shifts[error.line - 1]
    sign = line[column - 1 : column]
    if sign == '"':
        return _at(name, error.line, column, "E113", "the text is not closed", line, 'close it with `"`')
    if sign == "$":
        return _at(name, error.line, column, "E109", "a name is missing after `$`", line)
    return _at(name, error.line, column, "E108", f"`{sign}` has no meaning here", line, LOOKALIKES.get(sign, ""))


def _at(name: str, line: int, column: int, code: str, message: str, source: str, help: str = "") -> Diagnostic:
    return Diagnostic(Place(name, line, column, column + 1), code, message, help, source)
