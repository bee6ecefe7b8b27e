"""Conditions: from what was written to what the robot evaluates on every control step."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from host.gait import tree, units
from host.gait.diagnostics import did_you_mean
from host.gait.scope import Scope
from host.gait.tree import Name
from protocol import program

LEAST, MOST = -0x8000, 0x7FFF
QUANTIFIERS = {"any": program.ANY, "all": program.ALL}
COMPARE = {"<": program.BELOW, ">": program.ABOVE}


class Source(NamedTuple):
    """What the robot compares: its code, the kind of quantity, and its step in that kind's base unit."""

    code: int
    kind: str
    size: int = 1


SUPPLY = {"current": Source(program.CURRENT, units.CURRENT), "voltage": Source(program.VOLTAGE, units.VOLTAGE)}
BOARD = {"temperature": Source(program.BOARD, units.TEMPERATURE)}
COIL = {
    "temperature": Source(program.TEMPERATURE, units.TEMPERATURE),
    "heat": Source(program.HEAT, units.ENERGY),
}
JOINT = {"angle": Source(program.POSITION, units.ANGLE), "current": Source(program.LOAD, units.CURRENT)}
BODY = {"roll": Source(program.ROLL, units.ANGLE, 10), "pitch": Source(program.PITCH, units.ANGLE, 10)}
OBJECT = {"orientation": Source(program.ORIENTATION, units.ANGLE)}
PARTS = {"supply": SUPPLY, "board": BOARD}
DOWN = "down"


def condition(node: tree.AnyCondition, scope: Scope) -> program.Condition | None:
    """Return the condition as the robot reads it, or None when something about it is wrong (and reported)."""
    named: tuple[int, int] | None = (program.ANY, 0)
    match node:
        case tree.Facing():
            return _facing(node, scope)
        case tree.Angle():
            sources = _lying(node, scope)
        case _:
            sources, named = _subject(node, scope)
    source = sources.get(node.quantity.text)
    if source is None and sources:
        _unmeasured(node.quantity, sources, scope)
    compare = COMPARE.get(node.compare)
    if compare is None:
        choice = "<" if "<" in node.compare else ">"
        scope.problems.add(node.place, "E145", f"`{node.compare}` is no comparison here", f"write `{choice}`")
    value = scope.measured(node.value, source.kind, LEAST, MOST, source.size) if source else scope.value(node.value)
    if source is None or compare is None or named is None or not isinstance(value, int):
        return None
    return program.Condition(source.code, named[0], compare, value, named[1])


def _facing(node: tree.Facing, scope: Scope) -> program.Condition | None:
    """Return the condition that a coil, or one of a group, is the nearest to down."""
    scope.sees(node.place)
    kept = scope.aimed(node.coil)
    mask = scope.coils([node.coil]) if kept is None else kept
    if node.way.text != DOWN:
        _unmeasured(node.way, [DOWN], scope)
        return None
    if mask is None:
        return None
    return program.Condition(program.DOWN, program.ANY if kept is None else program.CHOSEN, program.IS, 0, mask)


def _lying(node: tree.Angle, scope: Scope) -> Mapping[str, Source]:
    """Return what can be asked about how robot and object lie; what this robot cannot tell is reported."""
    if node.quantity.text in OBJECT:
        scope.watches(node.place)
    elif node.quantity.text in BODY or scope.profile.camera is None:
        scope.sees(node.place)
    return BODY | OBJECT


def _unmeasured(word: Name, known: Iterable[str], scope: Scope) -> None:
    help = _owned(word.text, scope) or did_you_mean(word.text, known) or f"it has: {' '.join(known)}"
    scope.problems.add(word.place, "E144", f"there is no `{word.text}` to compare", help)


def _owned(quantity: str, scope: Scope) -> str:
    """Return whose quantity this is, where it is that of something else than what was asked."""
    channels = {**(COIL if scope.profile.coil_labels else {}), **(JOINT if scope.profile.joint_labels else {})}
    owners = {"any": channels, **PARTS}
    return next((f"write `{owner}.{quantity}`" for owner, measured in owners.items() if quantity in measured), "")


def _subject(node: tree.Condition, scope: Scope) -> tuple[Mapping[str, Source], tuple[int, int] | None]:
    """Return what can be asked of the subject, with the quantifier and the mask of its channels."""
    first, word = node.subjects[0], node.quantifier
    if isinstance(first, Name) and first.text in PARTS and len(node.subjects) == 1:
        if word is not None and word.text not in QUANTIFIERS:
            scope.problems.add(word.place, "E146", f"`{word.text}` is neither any nor all")
        return PARTS[first.text], (program.ANY, 0)
    profile, quantity = scope.profile, node.quantity.text
    of_joints = quantity in JOINT or (quantity not in COIL and not profile.coil_labels)
    labels = profile.joint_labels if of_joints else profile.coil_labels
    named = _channels(node, scope, profile.mask(labels))
    if named is not None and named[0] != program.CHOSEN:
        others = profile.named((named[1] or -1) & ~profile.mask(labels))
        if others and quantity in JOINT | COIL:
            _misplaced(node, others[0], scope)
            return {}, None
    sources = JOINT if of_joints else COIL
    return sources, named


def _misplaced(node: tree.Condition, label: str, scope: Scope) -> None:
    """Report a question to a joint that only a coil can answer, or the other way round."""
    quantity = node.quantity
    what, code, known = ("joint", "E148", JOINT) if quantity.text in COIL else ("coil", "E149", COIL)
    message = f"{label} is a {what}: it has no `{quantity.text}` to compare"
    scope.problems.add(quantity.place, code, message, f"it has: {' '.join(known)}")


def _channels(node: tree.Condition, scope: Scope, every: int) -> tuple[int, int] | None:
    """Return the quantifier and the mask of the channels; `any` and `all` alone are of `every` one of a kind."""
    subjects, word = node.subjects, node.quantifier
    first = subjects[0]
    if word is None and isinstance(first, Name) and first.text in QUANTIFIERS:
        return QUANTIFIERS[first.text], every
    kept = scope.aimed(first) if len(subjects) == 1 else None
    mask = scope.channels(subjects) if kept is None else kept
    if word is not None and word.text not in QUANTIFIERS:
        help = _both(node, word) if word.text in scope.groups() else ""
        scope.problems.add(word.place, "E146", f"`{word.text}` is neither any nor all", help)
        return None
    if kept is not None:
        return program.CHOSEN, kept
    if mask is None:
        return None
    if word is None and mask & (mask - 1):
        scope.problems.add(first.place, "E146", f"any or all of these {scope.word(mask)}s?", _both(node))
        return None
    return (program.ANY if word is None else QUANTIFIERS[word.text]), mask


def _both(node: tree.Condition, *before: Name) -> str:
    subjects = [part.text if isinstance(part, Name) else f"${part.name}" for part in (*before, *node.subjects)]
    text = f"{' '.join(subjects)}.{node.quantity.text}"
    return f"write `any {text}` or `all {text}`"
