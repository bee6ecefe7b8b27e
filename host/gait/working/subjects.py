"""Of whom a condition asks: a part of the board, coils, joints or force cells, any or all of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from host.gait import tree
from host.gait.tree import Name
from host.gait.working import cells, channels, sources, turns
from host.gait.working.scope import EVERY, Scope
from host.gait.working.sources import Sources
from protocol import program

QUANTIFIERS = {"any": program.ANY, "all": program.ALL}

Asked = tuple[int, int] | None  # quantifier and mask; None: wrong, and reported


@dataclass(frozen=True, slots=True)
class Kin:
    """Things that may be asked together: their masks by name, that of every one, how names become a mask."""

    known: dict[str, int]
    every: int
    masked: Callable[[Iterable[tree.Coil]], int | None]
    word: Callable[[int], str]


def subject(node: tree.Condition, scope: Scope) -> tuple[Sources, Asked]:
    """Return what can be asked of the subject, with the quantifier and the mask of its channels or cells."""
    first, word = node.subjects[0], node.quantifier
    if isinstance(first, Name) and first.text in sources.PARTS and len(node.subjects) == 1:
        if word is not None and word.text not in QUANTIFIERS:
            scope.problems.add(word.place, "E146", f"`{word.text}` is neither any nor all")
        return sources.PARTS[first.text], (program.ANY, 0)
    if node.quantity.text in sources.CELL or all(cells.is_cell(each, scope) for each in node.subjects):
        return sources.CELL, _cells(node, scope)
    return _channels(node, scope)


def _cells(node: tree.Condition, scope: Scope) -> Asked:
    if not scope.profile.cells:
        scope.problems.add(node.place, "E322", f"the robot {scope.profile.robot} has no force cells")
        return None
    known = cells.known(scope)
    kin = Kin(known, known[EVERY], lambda nodes: cells.masked(nodes, scope), lambda _: "force cell")
    return _quantified(node, scope, kin)


def _channels(node: tree.Condition, scope: Scope) -> tuple[Sources, Asked]:
    profile, quantity = scope.profile, node.quantity.text
    of_joints = quantity in sources.JOINT or (quantity not in sources.COIL and not profile.coil_labels)
    every = profile.mask(profile.joint_labels if of_joints else profile.coil_labels)

    def masked(nodes: Iterable[tree.Coil]) -> int | None:
        return turns.masked(channels.masked(nodes, scope), nodes, scope)

    named = _quantified(node, scope, Kin(channels.known(scope), every, masked, scope.word))
    if named is not None and named[0] != program.CHOSEN:
        others = profile.named((named[1] or -1) & ~every)
        if others and quantity in sources.JOINT | sources.COIL:
            _misplaced(node, others[0], scope)
            return {}, None
    return (sources.of_joint(profile) if of_joints else sources.COIL), named


def _misplaced(node: tree.Condition, label: str, scope: Scope) -> None:
    """Report a question to a joint that only a coil can answer, or the other way round."""
    quantity, joint = node.quantity, sources.of_joint(scope.profile)
    what, code, known = ("joint", "E148", joint) if quantity.text in sources.COIL else ("coil", "E149", sources.COIL)
    message = f"{label} is a {what}: it has no `{quantity.text}` to compare"
    scope.problems.add(quantity.place, code, message, f"it has: {' '.join(known)}")


def _quantified(node: tree.Condition, scope: Scope, kin: Kin) -> Asked:
    """Return the quantifier and the mask; `any` and `all` alone are of every one of a kind."""
    subjects, word = node.subjects, node.quantifier
    first = subjects[0]
    if word is None and isinstance(first, Name) and first.text in QUANTIFIERS:
        return QUANTIFIERS[first.text], kin.every
    kept = scope.aimed(first) if len(subjects) == 1 else None
    mask = kin.masked(subjects) if kept is None else kept
    if word is not None and word.text not in QUANTIFIERS:
        help = _both(node, word) if word.text in kin.known else ""
        scope.problems.add(word.place, "E146", f"`{word.text}` is neither any nor all", help)
        return None
    if kept is not None:
        return program.CHOSEN, kept
    if mask is None:
        return None
    if word is None and mask & (mask - 1):
        scope.problems.add(first.place, "E146", f"any or all of these {kin.word(mask)}s?", _both(node))
        return None
    return (program.ANY if word is None else QUANTIFIERS[word.text]), mask


def _both(node: tree.Condition, *before: Name) -> str:
    subjects = [part.text if isinstance(part, Name) else f"${part.name}" for part in (*before, *node.subjects)]
    text = f"{' '.join(subjects)}.{node.quantity.text}"
    return f"write `any {text}` or `all {text}`"
