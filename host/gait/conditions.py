"""Conditions: from what was written to what the robot evaluates on every control step."""

from __future__ import annotations

from collections.abc import Iterable

from host.gait import tree, units
from host.gait.diagnostics import did_you_mean
from host.gait.scope import Scope
from host.gait.tree import Name
from protocol import program

LEAST, MOST = -0x8000, 0x7FFF
QUANTIFIERS = {"any": program.ANY, "all": program.ALL}
COMPARE = {"<": program.BELOW, ">": program.ABOVE}
SUPPLY = {
    "current": (program.CURRENT, units.CURRENT),
    "voltage": (program.VOLTAGE, units.VOLTAGE),
}
BOARD = {"temperature": (program.BOARD, units.TEMPERATURE)}
COIL = {"temperature": (program.TEMPERATURE, units.TEMPERATURE), "heat": (program.HEAT, units.ENERGY)}
ANGLES = {"roll": (program.ROLL, units.ANGLE), "pitch": (program.PITCH, units.ANGLE)}
DOWN = "down"


def condition(node: tree.AnyCondition, scope: Scope) -> program.Condition | None:
    """Return the condition as the robot reads it, or None when something about it is wrong (and reported)."""
    match node:
        case tree.Facing():
            return _facing(node, scope)
        case tree.Angle():
            scope.sees(node.place)
            coils: tuple[int, int] | None = (program.ANY, 0)
            sources = ANGLES
        case _:
            sources = _sources(node)
            coils = _coils(node, scope) if sources is COIL else (program.ANY, 0)
    source = sources.get(node.quantity.text)
    if source is None:
        _unmeasured(node.quantity, sources, scope)
    compare = COMPARE.get(node.compare)
    if compare is None:
        choice = "<" if "<" in node.compare else ">"
        scope.problems.add(node.place, "E145", f"`{node.compare}` is no comparison here", f"write `{choice}`")
    value = scope.measured(node.value, source[1], LEAST, MOST) if source else scope.value(node.value)
    if source is None or compare is None or coils is None or not isinstance(value, int):
        return None
    return program.Condition(source[0], coils[0], compare, value, coils[1])


def _facing(node: tree.Facing, scope: Scope) -> program.Condition | None:
    """Return the condition that a coil, or one of a group, is the nearest to down."""
    scope.sees(node.place)
    kept = scope.aimed(node.coil)
    mask = scope.coil(node.coil) if kept is None else kept
    if node.way.text != DOWN:
        _unmeasured(node.way, [DOWN], scope)
        return None
    if mask is None:
        return None
    return program.Condition(program.DOWN, program.ANY if kept is None else program.CHOSEN, program.IS, 0, mask)


def _unmeasured(word: Name, known: Iterable[str], scope: Scope) -> None:
    help = did_you_mean(word.text, known) or f"it has: {' '.join(known)}"
    scope.problems.add(word.place, "E144", f"there is no `{word.text}` to compare", help)


def _sources(node: tree.Condition) -> dict[str, tuple[int, str]]:
    """Return what can be asked of the subject."""
    if isinstance(node.subject, Name) and node.subject.text in ("supply", "board"):
        return SUPPLY if node.subject.text == "supply" else BOARD
    return COIL


def _coils(node: tree.Condition, scope: Scope) -> tuple[int, int] | None:
    """Return the quantifier and the mask of the coils."""
    subject, word = node.subject, node.quantifier
    if word is None and isinstance(subject, Name) and subject.text in QUANTIFIERS:
        return QUANTIFIERS[subject.text], (1 << len(scope.profile.labels)) - 1
    kept = scope.aimed(subject)
    mask = scope.coil(subject) if kept is None else kept
    if word is not None and word.text not in QUANTIFIERS:
        scope.problems.add(word.place, "E146", f"`{word.text}` is neither any nor all")
        return None
    if kept is not None:
        return program.CHOSEN, kept
    if mask is None:
        return None
    if word is None and mask & (mask - 1):
        scope.problems.add(subject.place, "E146", "any or all of these coils?", _both(node))
        return None
    return (program.ANY if word is None else QUANTIFIERS[word.text]), mask


def _both(node: tree.Condition) -> str:
    subject = node.subject
    text = subject.text if isinstance(subject, Name) else f"${subject.name}"
    return f"write `any {text}.{node.quantity.text}` or `all {text}.{node.quantity.text}`"
