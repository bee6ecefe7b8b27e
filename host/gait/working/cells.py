"""The force cells of a robot, which a condition asks for their pressure: `any C1 C2.pressure > 5 kPa`.

Cells are named like channels, but no order is for them and no group holds them; `all` is all of them.
"""

from __future__ import annotations

from collections.abc import Iterable

from host.gait import tree
from host.gait.diagnostics import did_you_mean
from host.gait.tree import Name
from host.gait.units import Quantity
from host.gait.working import channels
from host.gait.working.scope import EVERY, CellSet, Chosen, Scope


def known(scope: Scope) -> dict[str, int]:
    """Return the mask of every force cell by its name, and that of all."""
    labels = scope.profile.cell_labels
    masks = {label: 1 << cell for cell, label in enumerate(labels)}
    return {**masks, EVERY: (1 << len(labels)) - 1} if labels else {}


def is_cell(node: tree.Coil, scope: Scope) -> bool:
    """Return whether a name, or what an argument stands for, is a force cell."""
    if isinstance(node, Name):
        return node.text in scope.profile.cell_labels
    return isinstance(scope.known.get(node.name), CellSet)


def masked(nodes: Iterable[tree.Coil], scope: Scope) -> int | None:
    """Return the mask of a list of force cells and arguments; what is none of them is reported."""

    def named(mask: int) -> str:
        labels = (label for cell, label in enumerate(scope.profile.cell_labels) if mask >> cell & 1)
        return f"force cell {' '.join(labels)}"

    return channels.union([(node, _mask(node, scope)) for node in nodes], named, scope)


def _mask(node: tree.Coil, scope: Scope) -> int | None:
    if isinstance(node, Name):
        if node.text in known(scope):
            return known(scope)[node.text]
        if node.text in channels.known(scope):
            kind = scope.word(channels.known(scope)[node.text])
            scope.problems.add(node.place, "E199", f"{node.text} is a {kind}, not a force cell", _offer(scope))
        else:
            message = f"the robot {scope.profile.robot} has no force cell `{node.text}`"
            scope.problems.add(node.place, "E131", message, did_you_mean(node.text, known(scope)) or _offer(scope))
        return None
    value = scope.lookup(node)
    if isinstance(value, CellSet):
        return value.mask
    if value is not None:
        code = "E165" if isinstance(value, Quantity) else "E199"
        what = "coil" if isinstance(value, Chosen) else value if isinstance(value, Quantity) else scope.word(value.mask)
        scope.problems.add(node.place, code, f"`${node.name}` is {what}, not a force cell", _offer(scope))
    return None


def _offer(scope: Scope) -> str:
    return f"force cells are: {' '.join(scope.profile.cell_labels)}"
