"""What names and values mean at one place of a script: params, arguments, coils, quantities.

A value that cannot be worked out is reported once and is None from then on, so that one mistake gives one message.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction

from host.gait import tree, units
from host.gait.diagnostics import Problems, did_you_mean
from host.gait.plan import Op
from host.gait.tree import Expression, Name, Place, Reference
from host.gait.units import Quantity, UnitError
from host.gait.working.jointunits import UNITS, JointUnit
from host.gait.working.jumps import Labels
from host.profile import Profile

EVERY = "all"
Table = tuple[int | None, ...]  # by channel


@dataclass(frozen=True, slots=True)
class CoilSet:
    """Some coils or joints, as a mask of channels."""

    mask: int


@dataclass(frozen=True, slots=True)
class CellSet:
    """Some force cells, as a mask in the order of the profile."""

    mask: int


@dataclass(frozen=True, slots=True)
class Chosen:
    """A coil that the robot chooses and keeps in its place number `kept`."""

    kept: int


OTHERS = {CellSet: "force cell", Chosen: "coil"}
Value = Quantity | CoilSet | CellSet | Chosen | None  # None: wrong, and reported already


@dataclass
class Scope:
    """The names that hold at one place; `unread` are words of lines that could not be read.

    `table` gives the coil that comes in the place of each one within a `sym`. `labels` is None where it is not known
    from where a def is called. `unsound` are ops with a mistake in them: what is known of them is held to the limits.
    """

    problems: Problems
    profile: Profile
    params: dict[str, Value] = field(default_factory=dict)
    arguments: Mapping[str, Value] = field(default_factory=dict)
    unread: frozenset[str] = frozenset()
    circles: dict[str, tuple[int, ...]] = field(default_factory=dict)
    chosen: dict[str, Chosen] = field(default_factory=dict)
    reach: dict[int, int] = field(default_factory=dict)  # mask of the coils that a place may hold
    skipped: set[str] = field(default_factory=set)  # chosen names whose let a wait may have jumped over
    table: Table | None = None
    labels: Labels | None = None
    unsound: list[Op] = field(default_factory=list)

    def inner(self, arguments: Mapping[str, Value]) -> Scope:
        """Return the scope of a def that is called with these arguments."""
        return replace(self, arguments=arguments)

    def value(self, node: Expression) -> Quantity | None:
        """Return what an expression comes to."""
        if isinstance(node, tree.Number):
            return self._number(node)
        if isinstance(node, Reference):
            return self._quantity(node)
        if isinstance(node, tree.Negative):
            operand = self.value(node.operand)
            return None if operand is None else -operand
        left, right = self.value(node.left), self.value(node.right)
        if left is None or right is None:
            return None
        try:
            return left.combine(node.operator, right)
        except UnitError as error:
            self.problems.add(node.place, error.code, str(error))
            return None

    def of_kind(self, node: Expression, kind: str) -> Quantity | None:
        """Return what an expression comes to, which must be of `kind`."""
        quantity = self.value(node)
        if quantity is None or quantity.kind == kind:
            return quantity
        self._wrong_kind(node, quantity, kind)
        return None

    def measured(self, node: Expression, kind: str, least: int, most: int, size: int = 1) -> int | None:
        """Return the whole number of `size` base units of a value that must be of `kind` and within [least, most]."""
        quantity = self.of_kind(node, kind)
        if quantity is None:
            return None
        number = round(quantity.value / size)
        if not least <= number <= most:
            low, high = (Quantity(Fraction(limit * size), kind) for limit in (least, most))
            self.problems.add(node.place, "E125", f"{quantity} is outside {low} .. {high}")
            return None
        return number

    def aimed(self, node: tree.Coil) -> int | None:
        """Return the place of a coil that the robot chooses, or None when this is another coil."""
        value = self.known.get(node.name) if isinstance(node, Reference) else None
        is_sure = isinstance(node, Reference) and node.name not in self.skipped
        return value.kept if isinstance(value, Chosen) and is_sure else None

    @property
    def known(self) -> dict[str, Value]:
        """Return every name that stands for something, with what it stands for."""
        return {**self.chosen, **self.params, **self.arguments}

    def sees(self, place: Place) -> None:
        """Report a statement that asks where down is, on a robot that does not know."""
        if self.profile.imu is None:
            message = f"the robot {self.profile.robot} has no attitude sensor"
            self.problems.add(place, "E313", message)

    def weighs(self, place: Place) -> None:
        """Report a statement about force, on a robot that does not measure it."""
        if self.profile.load is None:
            self.problems.add(place, "E322", f"the robot {self.profile.robot} has no load cell")

    def watches(self, place: Place) -> None:
        """Report a statement about the object's angle, on a robot that does not see it."""
        if self.profile.camera is None:
            self.problems.add(place, "E316", f"the robot {self.profile.robot} has no camera")

    @property
    def unit(self) -> JointUnit:
        """Return how the robot's joints are spoken of."""
        return UNITS[self.profile.unit]

    def word(self, mask: int = -1) -> str:
        """Return what the channels of `mask`, or all of the robot, are called."""
        named = self.profile.named(mask)
        kinds = (("coil", self.profile.coil_labels), ("joint", self.profile.joint_labels))
        return " or ".join(word for word, labels in kinds if set(labels) & set(named))

    def lookup(self, node: Reference) -> Value:
        """Return what `$name` stands for."""
        known = self.known
        if node.name in self.skipped and isinstance(known.get(node.name), Chosen):
            message = f"`${node.name}` may not be chosen yet: the robot may have jumped over its let"
            self.problems.add(node.place, "E176", message, "choose it again with a `let` below the label")
            return None
        if node.name in known:
            return known[node.name]
        if node.name not in self.unread:
            self.problems.add(node.place, "E160", f"`${node.name}` is not declared", did_you_mean(node.name, known))
        return None

    def declare(self, name: Name, value: Value) -> None:
        """Add a parameter; a second one of that name is reported."""
        if name.text in self.params:
            self.problems.add(name.place, "E161", f"`{name.text}` is declared twice")
        self.params[name.text] = value

    def _number(self, node: tree.Number) -> Quantity | None:
        if node.value > units.LARGEST:
            self.problems.add(node.place, "E125", "the number is too large")
            return None
        if node.unit is None:
            return Quantity(node.value, units.NUMBER)
        unit = units.UNITS.get(node.unit)
        if unit is None:
            near = units.ALIASES.get(node.unit)
            help = f"did you mean `{near}`?" if near else f"units are: {' '.join(units.UNITS)}"
            self.problems.add(node.place, "E121", f"`{node.unit}` is no unit", help)
            return None
        return Quantity(node.value * unit.factor, unit.kind)

    def _quantity(self, node: Reference) -> Quantity | None:
        value = self.lookup(node)
        if isinstance(value, CoilSet | CellSet | Chosen):
            what = self.word(value.mask) if isinstance(value, CoilSet) else OTHERS[type(value)]
            self.problems.add(node.place, "E165", f"`${node.name}` is a {what}, not a value")
            return None
        return value

    def _wrong_kind(self, node: Expression, quantity: Quantity, kind: str) -> None:
        place: Place = node.place
        if quantity.kind == units.NUMBER:
            choices = " or ".join(f"`{quantity} {unit}`" for unit in units.OF_KIND[kind])
            self.problems.add(place, "E120", f"{quantity} what? write {choices}")
        elif kind == units.NUMBER:
            self.problems.add(place, "E122", f"a plain number is needed here, not {quantity}")
        else:
            wanted = " or ".join(units.OF_KIND[kind])
            self.problems.add(place, "E122", f"{units.called(kind)} ({wanted}) is needed here, not {quantity}")
