"""What a call gives to a def, and what a `for` gives its name, turn by turn."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction

from host.gait import tree, units
from host.gait.units import Quantity
from host.gait.working import cells, channels
from host.gait.working.scope import CellSet, CoilSet, Scope, Value

TURNS_MAX = 0xFFFF


def argument(node: tree.Expression | tree.Coils, scope: Scope) -> Value:
    """Return what one argument stands for."""
    if isinstance(node, tree.Coils):
        return _named(node, scope)
    if isinstance(node, tree.Reference):
        return scope.lookup(node)
    return scope.value(node)


def items(node: tree.ForEach, scope: Scope) -> Iterable[Value]:
    """Return the values that a `for` goes through; where they cannot be worked out it is one that is not known."""
    first = node.items[0]
    if isinstance(first, tree.Span):
        return _numbers(first, scope)
    values = [argument(item, scope) for item in node.items if not isinstance(item, tree.Span)]
    if len(values) > 1 or not isinstance(values[0], CoilSet | CellSet):
        return values
    members = list(_members(first.coils if isinstance(first, tree.Coils) else (), values[0], scope))
    if not members:
        scope.problems.add(first.place, "E153", "there is nothing to go through")
        return [None]
    return members


def _named(node: tree.Coils, scope: Scope) -> Value:
    """Return the channels, or the force cells, that an argument names."""
    if all(cells.is_cell(each, scope) for each in node.coils):
        mask = cells.masked(node.coils, scope)
        return None if mask is None else CellSet(mask)
    mask = channels.masked(node.coils, scope)
    return None if mask is None else CoilSet(mask)


def _members(nodes: Iterable[tree.Coil], whole: CoilSet | CellSet, scope: Scope) -> Iterator[CoilSet | CellSet]:
    """Yield the members of a list as it is written; those of a group in the order of the profile."""
    if isinstance(whole, CellSet):
        masks = [cells.masked([node], scope) or 0 for node in nodes] or [whole.mask]
        yield from (CellSet(bit) for mask in masks for bit in _bits(mask))
    else:
        masks = [channels.channel(node, scope) or 0 for node in nodes] or [whole.mask]
        yield from (CoilSet(bit) for mask in masks for bit in _bits(mask))


def _bits(mask: int) -> list[int]:
    return [1 << place for place in range(mask.bit_length()) if mask >> place & 1]


def _numbers(node: tree.Span, scope: Scope) -> Iterable[Value]:
    ends = [_whole(end, scope) for end in (node.first, node.last)]
    first, last = ends
    if first is None or last is None:
        return [None]
    if last < first:
        scope.problems.add(node.place, "E155", f"it goes from {first} down to {last}", f"write `{last} .. {first}`")
        return [None]
    if last - first >= TURNS_MAX:
        scope.problems.add(node.place, "E154", f"{last - first + 1} turns, at most {TURNS_MAX}")
        return [None]
    return (Quantity(Fraction(number), units.NUMBER) for number in range(first, last + 1))


def _whole(node: tree.Expression, scope: Scope) -> int | None:
    quantity = scope.of_kind(node, units.NUMBER)
    if quantity is None:
        return None
    if quantity.value.denominator != 1:
        scope.problems.add(node.place, "E154", f"{quantity} is no whole number")
        return None
    return int(quantity.value)
