"""Conditions: from what was written to what the robot evaluates on every control step."""

from __future__ import annotations

from collections.abc import Iterable

from host.gait import tree
from host.gait.diagnostics import did_you_mean
from host.gait.tree import Name
from host.gait.working import channels, sources, turns
from host.gait.working.clauses import LONG_MAX_MS
from host.gait.working.scope import Scope
from host.gait.working.sources import Sources
from host.gait.working.subjects import Asked, subject
from protocol import program

LEAST, MOST = -0x8000, 0x7FFF
COMPARE = {"<": program.BELOW, ">": program.ABOVE}
DOWN = "down"


def condition(node: tree.AnyCondition, scope: Scope) -> program.Condition | None:
    """Return the condition as the robot reads it, or None when something about it is wrong (and reported)."""
    named: Asked = (program.ANY, 0)
    match node:
        case tree.Facing():
            return _facing(node, scope)
        case tree.Reading():
            known = _whole(node, scope)
        case _:
            known, named = subject(node, scope)
    source = known.get(node.quantity.text)
    if source is None and known:
        _unmeasured(node.quantity, known, scope)
    compare = COMPARE.get(node.compare)
    if compare is None:
        choice = "<" if "<" in node.compare else ">"
        scope.problems.add(node.place, "E145", f"`{node.compare}` is no comparison here", f"write `{choice}`")
    ends = (0, LONG_MAX_MS) if source and source.code == program.TIME else (LEAST, MOST)
    value = scope.measured(node.value, source.kind, *ends, source.size) if source else scope.value(node.value)
    if source is None or compare is None or named is None or not isinstance(value, int):
        return None
    if source.code == program.TIME:  # more than the room for a value holds
        return program.Condition(source.code, named[0], compare, 0, value)
    return program.Condition(source.code, named[0], compare, value, named[1])


def _facing(node: tree.Facing, scope: Scope) -> program.Condition | None:
    """Return the condition that a coil, or one of a group, is the nearest to down."""
    scope.sees(node.place)
    kept = scope.aimed(node.coil)
    mask = turns.masked(channels.coils([node.coil], scope), [node.coil], scope) if kept is None else kept
    if node.way.text != DOWN:
        _unmeasured(node.way, [DOWN], scope)
        return None
    if mask is None:
        return None
    return program.Condition(program.DOWN, program.ANY if kept is None else program.CHOSEN, program.IS, 0, mask)


def _whole(node: tree.Reading, scope: Scope) -> Sources:
    """Return what can be asked about the robot as a whole; what this one cannot tell is reported."""
    quantity = node.quantity.text
    if quantity in sources.OBJECT:
        scope.watches(node.place)
    elif quantity in sources.LOAD:
        scope.weighs(node.place)
    elif quantity in sources.BODY:
        scope.sees(node.place)
    return sources.WHOLE


def _unmeasured(word: Name, known: Iterable[str], scope: Scope) -> None:
    owned = sources.owner(word.text, scope.profile)
    help = owned or did_you_mean(word.text, known) or f"it has: {' '.join(known)}"
    scope.problems.add(word.place, "E144", f"there is no `{word.text}` to compare", help)
