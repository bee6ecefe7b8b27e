"""Single statements worked out: a fire, a wait, a guard, in the robot's own integers.

Each returns the ops of one statement, or none when something about it is wrong (and reported).
"""

from __future__ import annotations

from host.gait import channels, clauses, tree, units
from host.gait.conditions import condition
from host.gait.diagnostics import did_you_mean
from host.gait.plan import Delay, Fire, Guard, Op, Wait
from host.gait.scope import Scope
from protocol import program

CUTOFF_MAX_DECIDEGC = 0x7FFF
CHOICES = {"abort": program.ABORT, "continue": program.CONTINUE}


def fire(node: tree.Fire, scope: Scope, step: int) -> list[Op]:
    """Return the order, and the time until the next statement may start."""
    clauses.once(node.clauses, scope)
    if not node.coils:
        scope.problems.add(node.place, "E130", "which coils?", "name them after `fire`")
    kept = scope.aimed(node.coils[0]) if len(node.coils) == 1 else None
    mask = channels.coils(node.coils, scope) if kept is None else scope.reach.get(kept)
    duty = clauses.value(node, "at", scope, units.SHARE, 1, 1000)
    time_ms = clauses.time_ms(node, "for", scope)
    cutoff = clauses.value(node, "until", scope, units.TEMPERATURE, 1, CUTOFF_MAX_DECIDEGC)
    overlap_ms, ramp_ms = clauses.part_ms(node, "overlap", scope), clauses.part_ms(node, "ramp", scope)
    clauses.need(node, scope, ("at", "E132", "duty", "at 60 %"), ("for", "E133", "time", "for 600 ms"))
    parts_ms = {"overlap": overlap_ms, "ramp": ramp_ms}
    if not mask or duty is None or time_ms is None or not clauses.fit(node, time_ms, parts_ms, scope):
        return []
    order = Fire(mask, duty, time_ms, cutoff or 0, ramp_ms, step, node, kept)
    return [order, Delay(time_ms - overlap_ms, step)] if overlap_ms < time_ms else [order]


def wait(node: tree.Wait, scope: Scope, step: int) -> list[Op]:
    """Return a wait for a time."""
    if node.time is None:
        scope.problems.add(node.place, "E140", "wait for how long?", "write `wait 500 ms` or `wait until ...`")
        return []
    time_ms = scope.measured(node.time, units.TIME, 1, clauses.LONG_MAX_MS)
    return [Delay(time_ms, step)] if time_ms else []


def wait_until(node: tree.WaitUntil, scope: Scope, step: int) -> list[Op]:
    """Return a wait for a condition, which must have a time-out and an else."""
    clauses.once(node.clauses, scope)
    tested = condition(node.condition, scope)
    timeout_ms, otherwise = _timeout(node, scope), _otherwise(node, scope)
    if tested is None or timeout_ms is None or otherwise is None:
        return []
    return [Wait(tested, timeout_ms, otherwise, step, node)]


def guard(node: tree.Guard, scope: Scope) -> list[Op]:
    """Return a guard."""
    tested = condition(node.condition, scope)
    return [Guard(tested, node)] if tested else []


def _timeout(node: tree.WaitUntil, scope: Scope) -> int | None:
    for clause in node.clauses:
        if isinstance(clause, tree.Clause):
            return scope.measured(clause.value, units.TIME, 1, clauses.LONG_MAX_MS)
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
