"""The channels of a robot, which orders are for: coils and joints, by label, by group, or as the argument of a def."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from host.gait import tree
from host.gait.diagnostics import did_you_mean
from host.gait.tree import Name, Reference
from host.gait.units import Quantity
from host.gait.working.scope import EVERY, CellSet, Chosen, CoilSet, Scope

FIRE_IT = "fire it: `fire {} at 60 % for 600 ms`"


def coils(nodes: Iterable[tree.Coil], scope: Scope) -> int | None:
    """Return the mask of a list of coils; a joint among them is reported."""
    help = f"move it: `move {{}} to {scope.unit.example} over 2 s`"
    return _all_of(nodes, scope.profile.coil_labels, "E139", help, scope)


def joints(nodes: Iterable[tree.Coil], scope: Scope) -> int | None:
    """Return the mask of a list of joints; a coil among them is reported."""
    return _all_of(nodes, scope.profile.joint_labels, "E191", FIRE_IT, scope)


def masked(nodes: Iterable[tree.Coil], scope: Scope) -> int | None:
    """Return the mask of a list of coils, joints, groups and arguments."""

    def named(mask: int) -> str:
        return f"{scope.word(mask)} {' '.join(scope.profile.named(mask))}"

    return union([(node, channel(node, scope)) for node in nodes], named, scope)


def union(masks: Iterable[tuple[tree.Coil, int | None]], named: Callable[[int], str], scope: Scope) -> int | None:
    """Return the mask of a list, None where a part of it is; what is in it twice, as `named`, is reported."""
    whole, sound = 0, True
    for node, mask in masks:
        if mask is None:
            sound = False
            continue
        if whole & mask:
            scope.problems.add(node.place, "E136", f"{named(whole & mask)} is named twice")
        whole |= mask
    return whole if sound else None


def channel(node: tree.Coil, scope: Scope) -> int | None:
    """Return the mask of one coil, joint, group or argument."""
    if isinstance(node, Reference):
        return _argument(node, scope)
    masks = known(scope)
    if node.text in scope.profile.cell_labels:
        _cell(node, node.text, scope)
    elif node.text not in masks:
        message = f"the robot {scope.profile.robot} has no {scope.word()} `{node.text}`"
        near = f"write `${node.text}` for what the name stands for" if node.text in scope.known else ""
        help = near or did_you_mean(node.text, masks) or f"it has: {' '.join(masks)}"
        scope.problems.add(node.place, "E131", message, help)
    return masks.get(node.text)


def known(scope: Scope) -> dict[str, int]:
    """Return the mask of every coil, joint and group by its name."""
    labels = scope.profile.labels
    masks = {label: 1 << channel for channel, label in enumerate(labels)}
    masks.setdefault(EVERY, (1 << len(labels)) - 1)
    for name in scope.profile.groups:
        masks[name] = scope.profile.mask([name])
    return masks


def _cell(node: tree.Coil, name: str, scope: Scope) -> None:
    """Report a force cell that stands where a channel is needed."""
    message, help = f"{name} is a force cell, not a {scope.word()}", f"ask it: `{name}.pressure > 5 kPa`"
    scope.problems.add(node.place, "E199", message, help)


def _argument(node: Reference, scope: Scope) -> int | None:
    """Return the mask of the channels that an argument stands for."""
    value = scope.lookup(node)
    if isinstance(value, Quantity):
        scope.problems.add(node.place, "E165", f"`${node.name}` is {value}, not a {scope.word()}")
    elif isinstance(value, CellSet):
        _cell(node, f"${node.name}", scope)
    elif isinstance(value, Chosen):
        help = "fire it by itself"
        scope.problems.add(node.place, "E138", f"`${node.name}` is chosen by the robot as it runs", help)
    return value.mask if isinstance(value, CoilSet) else None


def _all_of(nodes: Iterable[tree.Coil], labels: tuple[str, ...], code: str, help: str, scope: Scope) -> int | None:
    """Return the mask of a list whose channels must all be among `labels`; `all` is all of these."""
    allowed, nodes = scope.profile.mask(labels), tuple(nodes)
    if len(nodes) == 1 and isinstance(nodes[0], Name) and nodes[0].text == EVERY and labels:
        return known(scope)[EVERY] & allowed or None
    mask = masked(nodes, scope)
    for node in nodes if mask is not None and mask & ~allowed else ():
        others = scope.profile.named((channel(node, scope) or 0) & ~allowed)
        if others:
            what = f"{others[0]} is a {scope.word(scope.profile.mask(others))}"
            scope.problems.add(node.place, code, what, help.format(others[0]))
    return mask if mask is None or not mask & ~allowed else None
