"""A robot that takes any name: for what can be told of a script whose own robot cannot be asked.

Its coils, joints and force cells are the names that the script uses as such. What it says of them, and every limit,
is left out: only mistakes of the language remain.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import fields
from typing import Any, TypeVar

from host.gait import tree
from host.gait.diagnostics import Diagnostic
from host.gait.script import Script, walk
from host.gait.tree import Coil as Named
from host.gait.tree import Name
from host.gait.working import sources
from host.limits import (
    CameraLimits,
    Cell,
    CellLimits,
    Coil,
    CoilLimits,
    Joint,
    LoadLimits,
    OrientLimits,
    PressLimits,
    ProgramLimits,
    ServoLimits,
    SessionLimits,
    SupplyLimits,
)
from host.lsp.names import parts
from host.profile import MASK_BITS, Profile

T = TypeVar("T")
ABOUT_THE_ROBOT = {
    "E131", "E136", "E137", "E138", "E139", "E144", "E146", "E148", "E149", "E153", "E156", "E157", "E158", "E165",
    "E176", "E191", "E199",
}  # fmt: skip
WIDE = 30_000


def stand_in(script: Script) -> Profile:
    """Return a profile in which every name of a script is something."""
    coils, joints, cells = _used(script)
    channels: tuple[Coil | Joint, ...] = (
        *(Coil(each, "sma", 0, 0) for each in coils),
        *(Joint(each, "servo", 0, 0, 0) for each in joints),
    )
    targets = (clause.value for clause in _clauses(script) if clause.word == "to")
    lengths = any(isinstance(part, tree.Number) and part.unit == "mm" for value in targets for part in parts(value))
    return Profile(
        robot=script.robot.name if script.robot else "",
        supply_mv=WIDE,
        channels=channels,
        groups={},
        coil_limits=_wide(CoilLimits),
        servo_limits=_wide(ServoLimits, unit="mm" if lengths else "deg"),
        supply=_wide(SupplyLimits),
        session=_wide(SessionLimits),
        program=_wide(ProgramLimits),
        crc=0,
        imu={},
        camera=_wide(CameraLimits),
        orient=_wide(OrientLimits),
        load=_wide(LoadLimits),
        press=_wide(PressLimits),
        cells=tuple(Cell(each, 0) for each in cells),
        cell=_wide(CellLimits),
    )


def of_the_language(found: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Return those that would be said of any robot."""
    return [item for item in found if item.exit_code == 2 and item.code not in ABOUT_THE_ROBOT]


def _used(script: Script) -> tuple[list[str], list[str], list[str]]:
    """Return the names that stand where coils, joints and force cells do; each is one of them, at most 32 in all."""
    kinds: dict[str, str] = {}
    for kind, names in _roles(script):
        for name in names:
            if isinstance(name, Name) and len(kinds) < MASK_BITS:
                kinds.setdefault(name.text, kind)
    coils, joints, cells = (
        [name for name, each in kinds.items() if each == kind] for kind in ("coil", "joint", "cell")
    )
    return coils or ["A"], joints, cells


def _roles(script: Script) -> Iterator[tuple[str, tuple[Named, ...]]]:
    for node in _statements(script):
        match node:
            case tree.Fire() | tree.Hold() | tree.Circle():
                yield "coil", node.coils
            case tree.Move():
                yield "joint", node.joints
            case tree.Call():
                for part in node.arguments:
                    yield "coil", part.coils if isinstance(part, tree.Coils) else ()
            case tree.Guard(condition=condition) | tree.WaitUntil(condition=condition):
                if isinstance(condition, tree.Condition):
                    yield _kind(condition.quantity.text), condition.subjects


def _kind(quantity: str) -> str:
    return "cell" if quantity in sources.CELL else "joint" if quantity in sources.JOINT else "coil"


def _clauses(script: Script) -> Iterator[tree.Clause]:
    return (clause for node in _statements(script) if isinstance(node, tree.Move) for clause in node.clauses)


def _statements(script: Script) -> Iterator[tree.Statement]:
    return (node for file in script.files for node in walk(file.statements))


def _wide(kind: type[T], **given: Any) -> T:
    """Return limits that nothing breaks."""
    names = (item.name for item in fields(kind))  # type: ignore[arg-type]
    return kind(**{**dict.fromkeys(names, WIDE), **given})
