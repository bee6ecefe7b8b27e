"""Orders to joints worked out: a move, an orient and a press, in the robot's own integers."""

from __future__ import annotations

from host.gait import tree, units
from host.gait.plan import Delay, Move, Op, Orient, Press
from host.gait.working import channels, clauses
from host.gait.working.scope import Scope

CENTI_MAX = 0x7FFF
FORCE_MAX_MN = 0xFFFF


def move(node: tree.Move, scope: Scope, step: int) -> list[Op]:
    """Return the order, and the time until the next statement may start."""
    clauses.once(node.clauses, scope)
    if not node.joints:
        scope.problems.add(node.place, "E190", "which joints?", "name them after `move`")
    mask, unit = channels.joints(node.joints, scope), scope.unit
    target = clauses.value(node, "to", scope, unit.kind, -CENTI_MAX, CENTI_MAX)
    time_ms = clauses.time_ms(node, "over", scope)
    overlap_ms = clauses.part_ms(node, "overlap", scope)
    clauses.need(node, scope, ("to", "E192", unit.quantity, f"to {unit.example}"), ("over", "E193", "time", "over 2 s"))
    fits = clauses.fit(node, time_ms, {"overlap": overlap_ms}, scope)
    if target is None:
        return []
    order = Move(mask or 0, target, time_ms or 0, step, node)
    return _lasting(order, overlap_ms, bool(mask and time_ms and fits), scope)


def orient(node: tree.Orient, scope: Scope, step: int) -> list[Op]:
    """Return the order, which takes the first two joints, and the time until the next statement may start."""
    clauses.once(node.clauses, scope)
    profile, target = scope.profile, None
    scope.watches(node.place)
    if profile.camera is not None and (profile.orient is None or len(profile.joint_labels) < 2):
        scope.problems.add(node.place, "E316", f"the robot {profile.robot} turns no object")
    if node.target is None:
        scope.problems.add(node.place, "E194", "orient to which angle?", "write `orient 5 deg for 3 s`")
    else:
        target = scope.measured(node.target, units.ANGLE, -CENTI_MAX, CENTI_MAX)
    time_ms = clauses.time_ms(node, "for", scope)
    overlap_ms = clauses.part_ms(node, "overlap", scope)
    clauses.need(node, scope, ("for", "E195", "time", "for 3 s"))
    if target is None or time_ms is None or not clauses.fit(node, time_ms, {"overlap": overlap_ms}, scope):
        return []
    order = Orient(profile.mask(profile.joint_labels[:2]), target, time_ms, step, node)
    return _lasting(order, overlap_ms, True, scope)


def press(node: tree.Press, scope: Scope, step: int) -> list[Op]:
    """Return the order, which takes the only joint, and the time until the next statement may start."""
    clauses.once(node.clauses, scope)
    profile = scope.profile
    scope.weighs(node.place)
    if profile.load is not None and profile.press is None:
        scope.problems.add(node.place, "E322", f"the robot {profile.robot} regulates no force")
    force_mn = clauses.value(node, "to", scope, units.FORCE, 0, FORCE_MAX_MN)
    over_ms = clauses.time_ms(node, "over", scope)
    time_ms = clauses.time_ms(node, "for", scope, clauses.LONG_MAX_MS)
    overlap_ms = clauses.part_ms(node, "overlap", scope, clauses.LONG_MAX_MS)
    clauses.need(node, scope, ("to", "E196", "force", "to 5 N"), ("over", "E197", "time to get there", "over 1 s"))
    clauses.need(node, scope, ("for", "E198", "time", "for 20 s"))
    fits = clauses.fit(node, time_ms, {"over": over_ms or 0, "overlap": overlap_ms}, scope)
    mask = profile.mask(profile.joint_labels[:1])
    order = Press(mask, force_mn or 0, over_ms or 0, time_ms or 0, step, node)
    return _lasting(order, overlap_ms, bool(force_mn is not None and over_ms and time_ms and fits), scope)


def _lasting(order: Move | Orient | Press, overlap_ms: int, sound: bool, scope: Scope) -> list[Op]:
    """Return the order and the wait for its end, less the time by which the next statement overlaps it."""
    if not sound:
        scope.unsound.append(order)
        return []
    wait_ms = order.time_ms - overlap_ms
    return [order, Delay(wait_ms, order.step)] if wait_ms else [order]
