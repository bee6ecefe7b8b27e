"""Parts of a statement from what Python code gives: numbers with the unit of their name, and texts in the language.

Whatever is not one whole part is refused with a ValueError that names it: `duty: "60 % for 3 s" is no value`.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from numbers import Real
from typing import Any, TypeVar, cast

from host.gait import tree
from host.gait.diagnostics import Diagnostic, GaitError
from host.gait.forms.jsonkinds import Kind, Text, TreeError
from host.gait.forms.layout import NOWHERE
from host.gait.forms.treekinds import BESIDE, IDENTIFIER, KINDS, OWN, PATH
from host.gait.forms.writer import decimal
from host.gait.reading.parser import parse_file, parse_value

T = TypeVar("T", bound=tree.Statement)
Value = str | float | Fraction
COIL = Text(f"\\$?{IDENTIFIER}", "a coil, a joint, a group or `$name`")


def value(what: str, given: Value, unit: str | None = None) -> tree.Expression:
    """Return a value: a text as it stands in a script, or a number in the unit that `what` is given in."""
    if isinstance(given, str):
        try:
            return parse_value(given, what)
        except GaitError as error:
            raise ValueError(f"{what}: {shown(given)}: {told(error.diagnostics[0])}") from None
    if isinstance(given, bool) or not isinstance(given, Real):
        raise ValueError(f"{what}: {given!r} is neither a number nor a text")
    try:
        number = Fraction(str(given))
        decimal(abs(number))
    except ValueError:
        raise ValueError(f"{what}: {given} cannot be written as a decimal") from None
    positive = tree.Number(abs(number), unit, NOWHERE)
    return positive if number >= 0 else tree.Negative(positive, NOWHERE)


def quantity(what: str, given: Value, example: str) -> tree.Expression:
    """Return a value whose unit nothing else tells: it must be in the text."""
    if not isinstance(given, str):
        raise ValueError(f'{what}: {given} has no unit; write it as a text: {what}="{example}"')
    return value(what, given)


def time(ms: Value | None, s: Value | None, other: str | None) -> tree.Expression:
    """Return the one time that is given: in ms, in s, or as a text."""
    times = {name: given for name, given in (("ms", ms), ("s", s), ("time", other)) if given is not None}
    if len(times) != 1:
        raise ValueError(f'{" and ".join(times) or "no time"} given: give one of ms=600, s=0.6, time="600 ms"')
    ((name, given),) = times.items()
    if name != "time" and isinstance(given, str):
        raise ValueError(f'{name}: {shown(given)} is no number; a text is given as time="600 ms"')
    return quantity(name, given, "600 ms") if name == "time" else value(name, given, name)


def coils(given: Sequence[str]) -> tuple[tree.Coil, ...]:
    """Return coils, joints or groups: texts with one or more names or references."""
    return tuple(_coil(each) for text in given for each in (text.split() if isinstance(text, str) else [text]))


def name(given: str) -> tree.Name:
    """Return a name that is no word of the language."""
    return cast(tree.Name, _read(KINDS["name"], given))


def own(given: str) -> tree.Name:
    """Return a name for a param or an argument."""
    return cast(tree.Name, _read(OWN, given))


def line(given: str) -> str:
    """Return a text that may stand in quotation marks."""
    return cast(str, _read(PATH, given))


def remark(given: str) -> str:
    """Return a comment."""
    return cast(str, _read(BESIDE, f"# {given}".rstrip()))


def statement(text: str, kind: type[T], what: str) -> T:
    """Return the one statement that a line is; of a block the head, with any body."""
    file, found = parse_file(f"{text}\n    wait\n" if text.endswith(":") else text, what)
    if found:
        raise ValueError(f"{what}: {shown(text)}: {told(found[0])}")
    if "\n" in text or len(file.statements) != 1 or file.comments or not isinstance(file.statements[0], kind):
        raise ValueError(f"{what}: {shown(text)} is not one statement of its kind")
    return file.statements[0]


def argument(given: Value) -> tree.Expression | tree.Coils:
    """Return an argument of a call."""
    if not isinstance(given, str):
        return value("argument", given)
    call = statement(f"f({given})", tree.Call, "argument")
    if len(call.arguments) != 1:
        raise ValueError(f"argument: {shown(given)} is not one argument")
    return call.arguments[0]


def told(item: Diagnostic) -> str:
    """Return what is wrong, and what to do about it, in one line."""
    return f"{item.message}; {item.help}" if item.help else item.message


def shown(text: str) -> str:
    """Return a text as it was given, in quotation marks."""
    return '"' + text.replace("\n", "\\n") + '"'


def _coil(given: str) -> tree.Coil:
    text = _read(COIL, given)
    return tree.Reference(text[1:], NOWHERE) if text[0] == "$" else name(text)


def _read(kind: Kind, given: str) -> Any:
    try:
        return kind.read(given, "")
    except TreeError as error:
        raise ValueError(str(error).removeprefix("the file: ")) from None
