"""How `sym` changes which coils are meant: the body is turned, and other coils come to stand where the named ones did.

On a sphere the turns are quarter turns about the axes x (forward), y (left) and z (up), one after another, by the
right hand: within `sym z 90 deg` the coil that the turn brings to the place of A100 is meant by `A100`, which is A0m10.
On a ring the coils have no direction but an order, that of the profile: a turn by one place brings the next one.

A table gives for each channel the one that comes in its place; None: there is no such coil.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from fractions import Fraction

from host.gait import tree, units
from host.gait.diagnostics import did_you_mean
from host.gait.units import Quantity
from host.gait.working import channels
from host.gait.working.scope import Scope, Table
from protocol.labels import direction

Direction = tuple[int, ...]

ROUND_CENTIDEG = 36000
# A quarter turn by the left hand about each axis: it takes a place to where what comes there was before.
BACK: dict[str, Callable[[int, int, int], Direction]] = {
    "x": lambda x, y, z: (x, z, -y),
    "y": lambda x, y, z: (-z, y, x),
    "z": lambda x, y, z: (y, -x, z),
}


def turned(node: tree.Sym, scope: Scope) -> Table | None:
    """Return the table that holds within a sym, those around it included; None when it is wrong (and reported)."""
    profile = scope.profile
    if not profile.coil_labels:
        scope.problems.add(node.place, "E326", f"the robot {profile.robot} has no coils to turn")
        return None
    is_ring = all(direction(label) is None for label in profile.coil_labels)
    own = _ring(node, scope) if is_ring else _sphere(node, scope)
    if own is None or scope.table is None:
        return own
    return tuple(None if other is None else scope.table[other] for other in own)


def masked(mask: int | None, nodes: Iterable[tree.Coil], scope: Scope) -> int | None:
    """Return the mask of the coils that are meant by those of `mask`; one that is not there is reported."""
    if not mask or scope.table is None:
        return mask
    pairs = [(channel, scope.table[channel]) for channel in range(mask.bit_length()) if mask >> channel & 1]
    missing = sum(1 << channel for channel, other in pairs if other is None)
    for node in nodes if missing else ():
        lost = (channels.channel(node, scope) or 0) & missing
        if lost:
            label = scope.profile.named(lost)[0]
            help = "name coils that stand in every place where the turns bring them"
            scope.problems.add(node.place, "E158", f"the turn brings no coil to the place of {label}", help)
    return None if missing else sum(1 << other for _, other in pairs if other is not None)


def meant(mask: int, scope: Scope) -> int:
    """Return the mask of the coils that are meant, for a reader: where there is none, the one that is named."""
    named = [channel for channel in range(mask.bit_length()) if mask >> channel & 1]
    others = [scope.table[channel] for channel in named] if scope.table else named
    return sum(1 << (own if other is None else other) for own, other in zip(named, others, strict=True))


def circle(numbers: tuple[int, ...], node: tree.Let, scope: Scope) -> tuple[int, ...]:
    """Return the circle that is meant by one of these channels; () when a coil of it is not there (and reported)."""
    if scope.table is None:
        return numbers
    others = [scope.table[channel] for channel in numbers]
    for channel, other in zip(numbers, others, strict=True):
        if other is None:
            message = f"the turn brings no coil to the place of {scope.profile.labels[channel]}"
            scope.problems.add(node.circle.place, "E158", message)
            return ()
    return tuple(other for other in others if other is not None)


def _ring(node: tree.Sym, scope: Scope) -> Table | None:
    """Return the table of a ring, turned by whole places."""
    coils = [scope.profile.labels.index(label) for label in scope.profile.coil_labels]
    places, sound = 0, True
    for turn in node.turns:
        if turn.axis is not None:
            help = f"write the angle alone: `sym {ROUND_CENTIDEG / 100 / len(coils):g} deg:`"
            message = f"the coils of {scope.profile.robot} are a ring, without axes"
            scope.problems.add(turn.axis.place, "E157", message, help)
            sound = False
        steps = _steps(turn, len(coils), scope)
        places, sound = places + (steps or 0), sound and steps is not None
    if not sound:
        return None
    table: list[int | None] = list(range(len(scope.profile.labels)))
    for place, channel in enumerate(coils):
        table[channel] = coils[(place + places) % len(coils)]
    return tuple(table)


def _sphere(node: tree.Sym, scope: Scope) -> Table | None:
    """Return the table of a sphere, turned by quarters; a letter of a label stays what it is."""
    quarters, sound = [], True
    for turn in node.turns:
        axis = _axis(turn, scope)
        steps = _steps(turn, 4, scope)
        sound = sound and axis is not None and steps is not None
        quarters.append((axis or "x", (steps or 0) % 4))
    if not sound:
        return None
    labels = scope.profile.labels
    places = {(label[0], direction(label)): channel for channel, label in enumerate(labels)}
    table: list[int | None] = list(range(len(labels)))
    for channel, label in enumerate(labels):
        way = direction(label)
        if way is not None:
            table[channel] = places.get((label[0], _back(way, quarters)))
    return tuple(table)


def _back(way: Direction, quarters: list[tuple[str, int]]) -> Direction:
    """Return where that stood which these turns, one after another, bring to `way`."""
    for axis, steps in reversed(quarters):
        for _ in range(steps):
            way = BACK[axis](*way)
    return way


def _axis(turn: tree.Turn, scope: Scope) -> str | None:
    if turn.axis is None:
        scope.problems.add(turn.place, "E157", "about which axis?", "write `x`, `y` or `z` before the angle")
        return None
    if turn.axis.text not in BACK:
        help = did_you_mean(turn.axis.text, BACK) or "axes are: x (forward), y (left), z (up)"
        scope.problems.add(turn.axis.place, "E157", f"there is no axis `{turn.axis.text}`", help)
        return None
    return turn.axis.text


def _steps(turn: tree.Turn, places: int, scope: Scope) -> int | None:
    """Return by how many places of a round a turn goes on; one that ends between two of them is reported."""
    quantity = scope.of_kind(turn.angle, units.ANGLE)
    if quantity is None:
        return None
    steps = quantity.value * places / ROUND_CENTIDEG
    if steps.denominator != 1:
        place = Quantity(Fraction(ROUND_CENTIDEG, places), units.ANGLE)
        scope.problems.add(turn.angle.place, "E156", f"{quantity} is no multiple of {place}")
        return None
    return int(steps)
