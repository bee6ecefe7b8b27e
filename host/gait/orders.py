"""Single statements worked out: a fire, a wait, a guard, in the robot's own integers.

Each returns the ops of one statement, or none when something about it is wrong (and reported).
"""

from __future__ import annotations

from collections.abc import Sequence

from host.gait import tree, units
from host.gait.conditions import condition
from host.gait.diagnostics import did_you_mean
from host.gait.plan import Delay, Fire, Guard, Op, Wait
from host.gait.scope import Scope
from protocol import program

WAIT_MAX_MS = 24 * 3600 * 1000
FIRE_MAX_MS = 0xFFFF
CUTOFF_MAX_DECIDEGC = 0x7FFF
CHOICES = {"abort": program.ABORT, "continue": program.CONTINUE}


def fire(node: tree.Fire, scope: Scope, step: int) -> list[Op]:
    """Return the order, and the time until the next statement may start."""
    _once(node.clauses, scope)
    if not node.coils:
        scope.problems.add(node.place, "E130", "which coils?", "name them after `fire`")
    kept = scope.aimed(node.coils[0]) if len(node.coils) == 1 else None
    mask = scope.coils(node.coils) if kept is None else scope.reach.get(kept)
    duty = _clause(node, "at", scope, units.SHARE, 1, 1000)
    time_ms = _clause(node, "for", scope, units.TIME, 1, FIRE_MAX_MS)
    cutoff = _clause(node, "until", scope, units.TEMPERATURE, 1, CUTOFF_MAX_DECIDEGC)
    overlap_ms = _clause(node, "overlap", scope, units.TIME, 0, FIRE_MAX_MS) or 0
    ramp_ms = _clause(node, "ramp", scope, units.TIME, 0, FIRE_MAX_MS) or 0
    for word, code, what, form in (("at", "E132", "duty", "at 60 %"), ("for", "E133", "time", "for 600 ms")):
        if node.clause(word) is None:
            scope.problems.add(node.place, code, f"fire has no {what}", f"add `{form}`")
    if not mask or duty is None or time_ms is None or not _fits(node, time_ms, overlap_ms, ramp_ms, scope):
        return []
    order = Fire(mask, duty, time_ms, cutoff or 0, ramp_ms, step, node, kept)
    return [order, Delay(time_ms - overlap_ms, step)] if overlap_ms < time_ms else [order]


def wait(node: tree.Wait, scope: Scope, step: int) -> list[Op]:
    """Return a wait for a time."""
    if node.time is None:
        scope.problems.add(node.place, "E140", "wait for how long?", "write `wait 500 ms` or `wait until ...`")
        return []
    time_ms = scope.measured(node.time, units.TIME, 1, WAIT_MAX_MS)
    return [Delay(time_ms, step)] if time_ms else []


def wait_until(node: tree.WaitUntil, scope: Scope, step: int) -> list[Op]:
    """Return a wait for a condition, which must have a time-out and an else."""
    _once(node.clauses, scope)
    tested = condition(node.condition, scope)
    timeout_ms, otherwise = _timeout(node, scope), _otherwise(node, scope)
    if tested is None or timeout_ms is None or otherwise is None:
        return []
    return [Wait(tested, timeout_ms, otherwise, step, node)]


def guard(node: tree.Guard, scope: Scope) -> list[Op]:
    """Return a guard."""
    tested = condition(node.condition, scope)
    return [Guard(tested, node)] if tested else []


def _clause(node: tree.Fire, word: str, scope: Scope, kind: str, least: int, most: int) -> int | None:
    clause = node.clause(word)
    return None if clause is None else scope.measured(clause.value, kind, least, most)


def _once(clauses: Sequence[tree.Clause | tree.Otherwise], scope: Scope) -> None:
    seen: set[str] = set()
    for clause in clauses:
        word = clause.word if isinstance(clause, tree.Clause) else "else"
        if word in seen:
            scope.problems.add(clause.place, "E111", f"`{word}` is given twice")
        seen.add(word)


def _fits(node: tree.Fire, time_ms: int, overlap_ms: int, ramp_ms: int, scope: Scope) -> bool:
    for word, part_ms in (("overlap", overlap_ms), ("ramp", ramp_ms)):
        clause = node.clause(word)
        if clause is not None and part_ms > time_ms:
            message = f"the {word} of {part_ms} ms is longer than the fire of {time_ms} ms"
            scope.problems.add(clause.place, "E134", message)
            return False
    return True


def _timeout(node: tree.WaitUntil, scope: Scope) -> int | None:
    for clause in node.clauses:
        if isinstance(clause, tree.Clause):
            return scope.measured(clause.value, units.TIME, 1, WAIT_MAX_MS)
    scope.problems.add(node.place, "E141", "wait has no timeout", "add `timeout 4 s`")
    return None


def _otherwise(node: tree.WaitUntil, scope: Scope) -> int | None:
    clause = next((clause for clause in node.clauses if isinstance(clause, tree.Otherwise)), None)
    if clause is None:
        scope.problems.add(node.place, "E142", "wait has no else", "add `else continue` or `else abort`")
        return None
    if clause.choice.text not in CHOICES:
        near = did_you_mean(clause.choice.text, CHOICES)
        scope.problems.add(clause.place, "E142", "else what? write `else continue` or `else abort`", near)
        return None
    return CHOICES[clause.choice.text]
