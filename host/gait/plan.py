"""A compiled gait before it becomes bytes: orders in the robot's own integers, each with the line it came from."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from host.gait import tree
from host.gait.tree import Place
from protocol import program


@dataclass(frozen=True, slots=True)
class Step:
    """One line of the script as the robot counts them; `calls` are the lines that led to it, outermost first."""

    number: int
    place: Place
    text: str
    calls: tuple[Place, ...] = ()
    note: str = ""  # what a note says, with its params put in

    @property
    def outer(self) -> Place:
        """Return the place in the script itself: that of the outermost call, if any."""
        return self.calls[0] if self.calls else self.place

    @property
    def where(self) -> str:
        """Return the line in words; of a line in an included file also the line of the script that led there."""
        own, outer = self.place.told(self.outer.file), self.outer
        return own if self.place.file == outer.file else f"{own}, called on line {outer.line}"

    def __str__(self) -> str:
        places = [self.place, *reversed(self.calls)]
        return f"{self.text} ({', called from '.join(f'{place.file}:{place.line}' for place in places)})"


@dataclass(frozen=True, slots=True)
class Fire:
    """Heat the coils of `mask`, or the one of them that the robot chose and keeps in place `kept`; does not wait.

    One that `holds` keeps them near the cut-off for the whole time instead of ending there.
    """

    mask: int
    duty_permille: int
    time_ms: int
    cutoff_decidegc: int
    ramp_ms: int
    step: int
    node: tree.Fire | tree.Hold
    kept: int | None = None
    holds: bool = False

    @property
    def cutoff(self) -> int:
        """Return the cut-off as it stands in the code."""
        return self.cutoff_decidegc | (program.KEEP if self.holds else 0)


@dataclass(frozen=True, slots=True)
class Move:
    """Bring the joints of `mask` to an angle or depth within `time_ms`, and hold them there; does not wait."""

    mask: int
    target_centi: int
    time_ms: int
    step: int
    node: tree.Move


@dataclass(frozen=True, slots=True)
class Orient:
    """Turn the object with the two joints of `mask` for `time_ms`, then hold; does not wait."""

    mask: int
    target_centideg: int
    time_ms: int
    step: int
    node: tree.Orient


@dataclass(frozen=True, slots=True)
class Press:
    """Regulate the force of the press, the joint of `mask`, for `time_ms`, then hold; does not wait."""

    mask: int
    target_mn: int
    over_ms: int
    time_ms: int
    step: int
    node: tree.Press


@dataclass(frozen=True, slots=True)
class Aim:
    """Choose the coil `ahead` places after the one nearest to down in `circle`, a list of channels, and keep it."""

    kept: int
    ahead: int
    circle: tuple[int, ...]
    step: int
    node: tree.Let


@dataclass(frozen=True, slots=True)
class Delay:
    """Let time pass."""

    time_ms: int
    step: int


@dataclass(frozen=True, slots=True)
class Wait:
    """Wait for a condition, for at most `timeout_ms`."""

    condition: program.Condition
    timeout_ms: int
    otherwise: int
    step: int
    node: tree.WaitUntil


@dataclass(frozen=True, slots=True)
class Guard:
    """From here on, trip when the condition holds."""

    condition: program.Condition
    node: tree.Guard


@dataclass(frozen=True, slots=True)
class Loop:
    """Run the body `count` times."""

    count: int
    body: tuple[Op, ...]
    node: tree.Repeat


@dataclass(frozen=True, slots=True)
class Note:
    """Tell the host that the robot has come here."""

    step: int
    node: tree.Note


@dataclass(frozen=True, slots=True)
class Label:
    """A place at the top of the plan that waits further up may go on at; labels count from 0."""

    number: int
    step: int
    node: tree.Label


@dataclass(frozen=True, slots=True)
class OnFault:
    """What runs when the program is aborted; it stands at the end of a plan and is passed over otherwise."""

    body: tuple[Op, ...]
    step: int
    node: tree.OnFault


Order = Fire | Move | Orient | Press
Op = Order | Aim | Delay | Wait | Guard | Loop | Note | Label | OnFault


def walk(plan: Iterable[Op]) -> Iterator[Op]:
    """Yield every op of a plan once, those within loops and what runs after an abort after what holds them."""
    for op in plan:
        yield op
        if isinstance(op, Loop | OnFault):
            yield from walk(op.body)


def encode(plan: Iterable[Op]) -> bytes:
    """Return the op-codes of a plan, with a step mark wherever the line changes."""
    return _block(plan) + program.halt()


def _block(plan: Iterable[Op]) -> bytes:
    parts = []
    step = 0
    for op in plan:
        if isinstance(op, Loop):
            parts += [program.repeat(op.count), _block(op.body), program.next_()]
        elif isinstance(op, Label):
            parts += [program.label(op.number), program.step(op.step)]
            step = op.step
        elif isinstance(op, OnFault):
            parts += [program.halt(), program.label(program.ON_FAULT), program.step(op.step), _block(op.body)]
        else:
            if not isinstance(op, Guard) and op.step != step:
                step = op.step
                parts.append(program.step(step))
            parts.append(_op(op))
    return b"".join(parts)


def _op(op: Order | Aim | Delay | Wait | Guard | Note) -> bytes:  # noqa: PLR0911  # one for each op
    if isinstance(op, Delay):
        return bytes(program.delay(op.time_ms))
    if isinstance(op, Note):
        return bytes(program.note(op.step))
    if isinstance(op, Wait):
        return bytes(program.wait(op.condition, op.timeout_ms, op.otherwise))
    if isinstance(op, Guard):
        return bytes(program.guard(op.condition))
    if isinstance(op, Aim):
        return bytes(program.aim(op.kept, op.ahead, list(op.circle)))
    if isinstance(op, Move):
        return bytes(program.move(op.mask, op.target_centi, op.time_ms))
    if isinstance(op, Orient):
        return bytes(program.orient(op.target_centideg, op.time_ms))
    if isinstance(op, Press):
        return bytes(program.press(op.target_mn, op.over_ms, op.time_ms))
    if op.kept is not None:
        return bytes(program.aimed(op.kept, op.duty_permille, op.time_ms, op.cutoff, op.ramp_ms))
    if op.ramp_ms:
        return bytes(program.ramp(op.mask, op.duty_permille, op.time_ms, op.cutoff, op.ramp_ms))
    return bytes(program.fire(op.mask, op.duty_permille, op.time_ms, op.cutoff))
