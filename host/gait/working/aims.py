"""Coils that the robot chooses as it runs, by where down is: the circles of a script and its lets."""

from __future__ import annotations

from fractions import Fraction

from host.gait import tree, units
from host.gait.diagnostics import did_you_mean
from host.gait.plan import Aim, Op
from host.gait.tree import Place
from host.gait.working import channels, turns
from host.gait.working.scope import Chosen, Scope
from protocol import program
from protocol.labels import direction

DOWN = "down"
LET_FORM = "the form is: let NAME = CIRCLE[down + 1]"


def declare_circle(node: tree.Circle, scope: Scope) -> None:
    """Add the circle to those that a let may name; one that is none is reported."""
    name = node.name.text
    if name in scope.circles:
        scope.problems.add(node.name.place, "E161", f"`{name}` is declared twice")
    masks = [channels.channel(coil, scope) for coil in node.coils]
    scope.circles[name] = ()  # known, and reported if nothing better follows
    if None in masks or channels.coils(node.coils, scope) is None:
        return
    numbers = tuple(mask.bit_length() - 1 for mask in masks if mask is not None and mask & (mask - 1) == 0)
    labels = [scope.profile.labels[channel] for channel in numbers]
    aimless = [label for label in labels if direction(label) is None]
    if aimless and scope.profile.imu is not None:
        scope.problems.add(node.place, "E137", f"coil {aimless[0]} has no direction")
    elif len(numbers) != len(masks):
        scope.problems.add(node.place, "E137", "a circle is made of single coils, not of groups")
    elif not 2 <= len(numbers) <= program.CIRCLE_MAX:
        scope.problems.add(node.place, "E137", f"{len(numbers)} coils, a circle has 2 to {program.CIRCLE_MAX}")
    else:
        scope.circles[name] = numbers


def let(node: tree.Let, scope: Scope, step: int) -> list[Op]:
    """Return the choice of a coil; from here on its name stands for it."""
    scope.sees(node.place)
    circle, ahead, kept = turns.circle(_circle(node, scope), node, scope), _ahead(node, scope), _kept(node, scope)
    if not circle or ahead is None or kept is None:
        return []
    mask = sum(1 << channel for channel in circle)
    scope.reach[kept] = scope.reach.get(kept, 0) | mask
    return [Aim(kept, ahead % len(circle), circle, step, node)]


def _circle(node: tree.Let, scope: Scope) -> tuple[int, ...]:
    name = node.circle.text
    if node.way.text != DOWN:
        scope.problems.add(node.way.place, "E147", f"the robot cannot count from `{node.way.text}`", LET_FORM)
    if name not in scope.circles and name not in scope.unread:
        near = did_you_mean(name, scope.circles) or "declare it: circle NAME = COILS"
        scope.problems.add(node.circle.place, "E160", f"there is no circle `{name}`", near)
    return scope.circles.get(name, ())


def _ahead(node: tree.Let, scope: Scope) -> int | None:
    if node.ahead is None:
        return 0
    quantity = scope.of_kind(node.ahead, units.NUMBER)
    if quantity is None:
        return None
    if quantity.value != Fraction(quantity.rounded()):
        scope.problems.add(_place(node), "E147", f"{quantity} is no whole number of places")
        return None
    return quantity.rounded()


def _kept(node: tree.Let, scope: Scope) -> int | None:
    """Return the place on the robot that keeps the coil of this name."""
    name = node.name.text
    if name in scope.params or name in scope.arguments:
        scope.problems.add(node.name.place, "E161", f"`{name}` is declared twice")
        return None
    if name not in scope.chosen:
        kept = len(scope.chosen)
        if kept >= program.AIMS_MAX:
            most = f"the robot keeps {program.AIMS_MAX} coils, this is one more"
            scope.problems.add(node.name.place, "E314", most)
        scope.chosen[name] = Chosen(kept)
    scope.skipped.discard(name)
    return scope.chosen[name].kept


def _place(node: tree.Let) -> Place:
    return node.ahead.place if node.ahead is not None else node.place
