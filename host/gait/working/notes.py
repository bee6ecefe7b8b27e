"""What a note says: its text, with the values of params and arguments put in where `$name` stands."""

from __future__ import annotations

import re

from host.gait import tree
from host.gait.tree import Place, Reference
from host.gait.working import turns
from host.gait.working.scope import CellSet, Chosen, CoilSet, Scope, Value

NAMED = re.compile(r"\$([A-Za-z_][A-Za-z_0-9]*)")


def told(node: tree.Note, scope: Scope) -> str:
    """Return what a note says, of coils within a sym those that are meant by their names there.

    A name that is not declared, or not known before the robot runs, is reported.
    """
    return NAMED.sub(lambda match: _shown(_reference(node, match), scope), node.text)


def _reference(node: tree.Note, match: re.Match[str]) -> Reference:
    """Return what stands in the text as a reference with its own place."""
    place = node.place
    begin = place.end_column - 1 - len(node.text)
    return Reference(match[1], Place(place.file, place.line, begin + match.start(), begin + match.end()))


def _shown(node: Reference, scope: Scope) -> str:
    value: Value = scope.lookup(node)
    if isinstance(value, CoilSet):
        return " ".join(scope.profile.named(turns.meant(value.mask, scope)))
    if isinstance(value, CellSet):
        return " ".join(label for cell, label in enumerate(scope.profile.cell_labels) if value.mask >> cell & 1)
    if isinstance(value, Chosen):
        message = f"`${node.name}` is chosen by the robot as it runs"
        scope.problems.add(node.place, "E138", message, "the events of the run tell which coil it was")
    return "" if value is None else str(value)
