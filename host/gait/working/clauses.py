"""The clauses of an order: each at most once, those that it needs, their values in the robot's own integers."""

from __future__ import annotations

from collections.abc import Sequence

from host.gait import tree, units
from host.gait.working.scope import Scope

ORDER_MAX_MS = 0xFFFF
LONG_MAX_MS = 24 * 3600 * 1000
KINDS: dict[type[tree.Order], str] = {
    tree.Fire: "fire", tree.Hold: "hold", tree.Move: "move", tree.Orient: "orient", tree.Press: "press"
}  # fmt: skip


def once(clauses: Sequence[tree.Clause | tree.Otherwise], scope: Scope) -> None:
    """Report each clause that is there already."""
    seen: set[str] = set()
    for clause in clauses:
        word = clause.word if isinstance(clause, tree.Clause) else "else"
        if word in seen:
            scope.problems.add(clause.place, "E111", f"`{word}` is given twice")
        seen.add(word)


def value(node: tree.Order, word: str, scope: Scope, kind: str, least: int, most: int) -> int | None:
    """Return the value of a clause, or None when there is none or it is wrong (and reported)."""
    clause = node.clause(word)
    return None if clause is None else scope.measured(clause.value, kind, least, most)


def time_ms(node: tree.Order, word: str, scope: Scope, most_ms: int = ORDER_MAX_MS) -> int | None:
    """Return the time that an order takes."""
    return value(node, word, scope, units.TIME, 1, most_ms)


def part_ms(node: tree.Order, word: str, scope: Scope, most_ms: int = ORDER_MAX_MS) -> int:
    """Return the time of a part of an order, or 0 when it has no such part."""
    return value(node, word, scope, units.TIME, 0, most_ms) or 0


def need(node: tree.Order, scope: Scope, *wanted: tuple[str, str, str, str]) -> None:
    """Report each clause that is missing: its word, its code, what it gives, how it is written."""
    for word, code, what, form in wanted:
        if node.clause(word) is None:
            scope.problems.add(node.place, code, f"{KINDS[type(node)]} has no {what}", f"add `{form}`")


def fit(node: tree.Order, time_ms: int | None, parts_ms: dict[str, int], scope: Scope) -> bool:
    """Return whether each part is at most as long as the order; the first that is not is reported."""
    for word, part_ms in parts_ms.items():
        clause = node.clause(word)
        if clause is not None and time_ms is not None and part_ms > time_ms:
            message = f"the {word} of {part_ms} ms is longer than the {KINDS[type(node)]} of {time_ms} ms"
            scope.problems.add(clause.place, "E134", message)
            return False
    return True
