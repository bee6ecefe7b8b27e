"""The tree of a gait script: what was written and where, before any name or unit is looked up.

Every node carries its place, so that each later complaint can point at a line and a column. Comments are kept beside
the statements, with their places, for tools that write a script back.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True, slots=True)
class Place:
    """A stretch of one source line; lines and columns count from 1, `end_column` is the first column after it."""

    file: str
    line: int
    column: int
    end_column: int

    def told(self, main: str) -> str:
        """Return the line in words, with its file where that is not `main`."""
        return f"line {self.line}" if self.file == main else f"line {self.line} of {self.file}"

    def upto(self, other: Place) -> Place:
        """Return the stretch from here to the end of `other`, within this line."""
        return Place(self.file, self.line, self.column, max(other.end_column, self.end_column))


@dataclass(frozen=True, slots=True)
class Name:
    """A word as written: a coil, a joint, a group, a parameter, a choice."""

    text: str
    place: Place


@dataclass(frozen=True, slots=True)
class Reference:
    """`$name`: the value of a parameter or an argument."""

    name: str
    place: Place


@dataclass(frozen=True, slots=True)
class Number:
    """A number and the unit written after it, if any."""

    value: Fraction
    unit: str | None
    place: Place


@dataclass(frozen=True, slots=True)
class Binary:
    """Two values joined by `+ - * /`."""

    operator: str
    left: Expression
    right: Expression
    place: Place


@dataclass(frozen=True, slots=True)
class Negative:
    """A value with a minus before it."""

    operand: Expression
    place: Place


Expression = Number | Reference | Binary | Negative
Coil = Name | Reference


@dataclass(frozen=True, slots=True)
class Coils:
    """A list of coils given as an argument of a call."""

    coils: tuple[Coil, ...]
    place: Place


@dataclass(frozen=True, slots=True)
class Clause:
    """`at 60 %`, `for 600 ms`, `timeout 4 s`: a word and its value."""

    word: str
    value: Expression
    place: Place


@dataclass(frozen=True, slots=True)
class Otherwise:
    """`else NAME`: what a wait does when its time is over, or the label it goes on at."""

    choice: Name
    place: Place


@dataclass(frozen=True, slots=True)
class Condition:
    """`A.temperature > 95 C`, `any R L.current > 500 mA`: evaluated on the robot, never on the host."""

    quantifier: Name | None
    subjects: tuple[Coil, ...]
    quantity: Name
    compare: str
    value: Expression
    place: Place


@dataclass(frozen=True, slots=True)
class Reading:
    """`roll > 30 deg`, `force > 5 N`: what there is once on a robot, evaluated on the robot."""

    quantity: Name
    compare: str
    value: Expression
    place: Place


@dataclass(frozen=True, slots=True)
class Facing:
    """`down is A10m1`: which coil points down, evaluated on the robot."""

    way: Name
    coil: Coil
    place: Place


AnyCondition = Condition | Reading | Facing


@dataclass(frozen=True, slots=True)
class Gait:
    """`gait 1`: the version of the language."""

    version: Fraction
    place: Place


@dataclass(frozen=True, slots=True)
class Robot:
    """`robot NAME`: the robot the script is written for."""

    name: str
    place: Place


@dataclass(frozen=True, slots=True)
class Param:
    """A named value that the command line may change, within its range."""

    name: Name
    value: Expression
    low: Expression | None
    high: Expression | None
    place: Place


@dataclass(frozen=True, slots=True)
class Include:
    """`include "file"`: params and defs of another file, named relative to this one."""

    path: str
    place: Place


@dataclass(frozen=True, slots=True)
class Circle:
    """Coils that point down one after another while the robot rolls, in that order."""

    name: Name
    coils: tuple[Coil, ...]
    place: Place


@dataclass(frozen=True, slots=True)
class Let:
    """`let next = roll[down + 1]`: the robot chooses a coil of a circle and keeps it under a name."""

    name: Name
    circle: Name
    way: Name
    ahead: Expression | None
    place: Place


@dataclass(frozen=True, slots=True)
class Define:
    """A named block with arguments."""

    name: Name
    parameters: tuple[Name, ...]
    body: tuple[Statement, ...]
    place: Place


class Order:
    """A statement with clauses."""

    __slots__ = ()
    clauses: tuple[Clause, ...]
    place: Place

    def clause(self, word: str) -> Clause | None:
        """Return the first clause that begins with `word`, or None."""
        return next((clause for clause in self.clauses if clause.word == word), None)


@dataclass(frozen=True, slots=True)
class Fire(Order):
    """Heat coils: the order carries its own end."""

    coils: tuple[Coil, ...]
    clauses: tuple[Clause, ...]
    place: Place


@dataclass(frozen=True, slots=True)
class Hold(Order):
    """Keep coils near a temperature for a time: a duty below it, nothing above it."""

    coils: tuple[Coil, ...]
    clauses: tuple[Clause, ...]
    place: Place


@dataclass(frozen=True, slots=True)
class Move(Order):
    """Bring joints to an angle or a depth within a time."""

    joints: tuple[Coil, ...]
    clauses: tuple[Clause, ...]
    place: Place


@dataclass(frozen=True, slots=True)
class Orient(Order):
    """Turn the object that the joints hold to an angle, and keep it there for a time."""

    target: Expression | None
    clauses: tuple[Clause, ...]
    place: Place


@dataclass(frozen=True, slots=True)
class Press(Order):
    """Bring the force of the press to a value within a time, and keep it there for a time."""

    clauses: tuple[Clause, ...]
    place: Place


@dataclass(frozen=True, slots=True)
class Repeat:
    """A block that runs a counted number of times."""

    count: Expression | None
    body: tuple[Statement, ...]
    place: Place


@dataclass(frozen=True, slots=True)
class Span:
    """`1 .. 8`: whole numbers, both ends included."""

    first: Expression
    last: Expression
    place: Place


@dataclass(frozen=True, slots=True)
class ForEach:
    """A block that runs once for each item; one list of coils alone stands for its members."""

    name: Name
    items: tuple[Expression | Coils | Span, ...]
    body: tuple[Statement, ...]
    place: Place


@dataclass(frozen=True, slots=True)
class Turn:
    """`z 90 deg`: an angle, about an axis of the body where it has axes."""

    axis: Name | None
    angle: Expression
    place: Place


@dataclass(frozen=True, slots=True)
class Sym:
    """A block whose coils are those that the turns, one after another, bring in their places."""

    turns: tuple[Turn, ...]
    body: tuple[Statement, ...]
    place: Place


@dataclass(frozen=True, slots=True)
class OnFault:
    """A block that runs when the program is aborted."""

    body: tuple[Statement, ...]
    place: Place


@dataclass(frozen=True, slots=True)
class Together:
    """A block whose statements all start at once."""

    body: tuple[Statement, ...]
    place: Place


@dataclass(frozen=True, slots=True)
class Wait:
    """Let time pass."""

    time: Expression | None
    place: Place


@dataclass(frozen=True, slots=True)
class WaitUntil:
    """Wait for a condition, for a bounded time."""

    condition: AnyCondition
    clauses: tuple[Clause | Otherwise, ...]
    place: Place


@dataclass(frozen=True, slots=True)
class Guard:
    """A condition under which the robot switches everything off."""

    condition: AnyCondition
    place: Place


@dataclass(frozen=True, slots=True)
class Note:
    """A text that is kept in the log when the robot comes here."""

    text: str
    place: Place


@dataclass(frozen=True, slots=True)
class Label:
    """A place further down that a wait may go on at."""

    name: Name
    place: Place


@dataclass(frozen=True, slots=True)
class Call:
    """Run a def with these arguments."""

    name: Name
    arguments: tuple[Expression | Coils, ...]
    place: Place


@dataclass(frozen=True, slots=True)
class Broken:
    """A line that could not be read (reported already); its block, if it heads one, is kept."""

    body: tuple[Statement, ...]
    place: Place


Statement = (
    Gait
    | Robot
    | Param
    | Include
    | Circle
    | Define
    | Let
    | Fire
    | Hold
    | Move
    | Orient
    | Press
    | Repeat
    | ForEach
    | Together
    | Sym
    | OnFault
    | Wait
    | WaitUntil
    | Guard
    | Note
    | Label
    | Call
    | Broken
)


@dataclass(frozen=True, slots=True)
class Comment:
    """A comment, from its `#` to the end of the line."""

    text: str
    place: Place


@dataclass(frozen=True, slots=True)
class File:
    """One source file: its statements, its comments and its lines as written; not `readable`: it has no tree."""

    name: str
    statements: tuple[Statement, ...]
    comments: tuple[Comment, ...]
    lines: tuple[str, ...]
    readable: bool = True

    def line(self, number: int) -> str:
        """Return the source line of that number, or an empty text."""
        return self.lines[number - 1] if 0 < number <= len(self.lines) else ""
