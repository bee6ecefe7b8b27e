"""Single statements worked out: a fire, a hold, a wait, a guard, in the robot's own integers.

Each returns the ops of one statement, or none when something about it is wrong (and reported).
"""

from __future__ import annotations

from host.gait import tree, units
from host.gait.diagnostics import did_you_mean
from host.gait.plan import Delay, Fire, Guard, Op, Wait
from host.gait.working import channels, clauses, turns
from host.gait.working.conditions import condition
from host.gait.working.jumps import CHOICES
from host.gait.working.scope import Scope
from protocol import program

CUTOFF_MAX_DECIDEGC = 0x7FFF


def fire(node: tree.Fire, scope: Scope, step: int) -> list[Op]:
    """Return the order, and the time until the next statement may start."""
    clauses.once(node.clauses, scope)
    mask, kept = _coils(node, scope)
    duty = clauses.value(node, "at", scope, units.SHARE, 1, 1000)
    time_ms = clauses.time_ms(node, "for", scope)
    cutoff = clauses.value(node, "until", scope, units.TEMPERATURE, 1, CUTOFF_MAX_DECIDEGC)
    overlap_ms, ramp_ms = clauses.part_ms(node, "overlap", scope), clauses.part_ms(node, "ramp", scope)
    clauses.need(node, scope, ("at", "E132", "duty", "at 60 %"), ("for", "E133", "time", "for 600 ms"))
    order = Fire(mask or 0, duty or 0, time_ms or 0, cutoff or 0, ramp_ms, step, node, kept)
    fits = clauses.fit(node, time_ms, {"overlap": overlap_ms, "ramp": ramp_ms}, scope)
    return _lasting(order, overlap_ms, bool(mask and duty and time_ms and fits), scope)


def hold(node: tree.Hold, scope: Scope, step: int) -> list[Op]:
    """Return the order to keep coils near a temperature, and the time until the next statement may start."""
    clauses.once(node.clauses, scope)
    mask, kept = _coils(node, scope)
    temperature = clauses.value(node, "at", scope, units.TEMPERATURE, 1, CUTOFF_MAX_DECIDEGC)
    duty = clauses.value(node, "with", scope, units.SHARE, 1, 1000)
    time_ms = clauses.time_ms(node, "for", scope)
    overlap_ms = clauses.part_ms(node, "overlap", scope)
    clauses.need(node, scope, ("at", "E126", "temperature", "at 80 C"), ("with", "E132", "duty", "with 40 %"))
    clauses.need(node, scope, ("for", "E133", "time", "for 5 s"))
    order = Fire(mask or 0, duty or 0, time_ms or 0, temperature or 0, 0, step, node, kept, holds=True)
    fits = clauses.fit(node, time_ms, {"overlap": overlap_ms}, scope)
    return _lasting(order, overlap_ms, bool(mask and temperature and duty and time_ms and fits), scope)


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
    if tested is None:
        return []
    wait = Wait(tested, timeout_ms or 0, otherwise or 0, step, node)
    if timeout_ms is None or otherwise is None:
        scope.unsound.append(wait)
        return []
    return [wait]


def guard(node: tree.Guard, scope: Scope) -> list[Op]:
    """Return a guard."""
    tested = condition(node.condition, scope)
    return [Guard(tested, node)] if tested else []


def _coils(node: tree.Fire | tree.Hold, scope: Scope) -> tuple[int | None, int | None]:
    """Return the mask of the coils that are meant, and the place of one that the robot chooses."""
    if not node.coils:
        scope.problems.add(node.place, "E130", "which coils?", f"name them after `{clauses.KINDS[type(node)]}`")
        return None, None
    kept = scope.aimed(node.coils[0]) if len(node.coils) == 1 else None
    if kept is not None:
        return scope.reach.get(kept), kept
    return turns.masked(channels.coils(node.coils, scope), node.coils, scope), None


def _lasting(order: Fire, overlap_ms: int, sound: bool, scope: Scope) -> list[Op]:
    """Return the order and the wait for its end, less the time by which the next statement overlaps it."""
    if not sound:
        scope.unsound.append(order)
        return []
    wait_ms = order.time_ms - overlap_ms
    return [order, Delay(wait_ms, order.step)] if wait_ms else [order]


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
    name, labels = clause.choice, scope.labels
    if name.text in CHOICES or labels is None:
        return CHOICES.get(name.text, program.CONTINUE)
    if name.text in labels.passed:
        help = "a wait goes on further down: move the label below it, or use `repeat`"
        scope.problems.add(name.place, "E173", f"label `{name.text}` is not further on", help)
    elif name.text in labels.numbers:
        return labels.jump(name.text, set(scope.chosen) - scope.skipped)
    elif name.text not in scope.unread | labels.misplaced:
        help = did_you_mean(name.text, [*CHOICES, *labels.numbers]) or "write `abort`, `continue`, or a label"
        scope.problems.add(name.place, "E172", f"there is no label `{name.text}`", help)
    return None
