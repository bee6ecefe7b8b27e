"""Works a script out for one robot: params folded, defs and coil names replaced, every `together` on one timeline.

Everything that is wrong is reported before it gives up, so that one run shows all of it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from host.gait import aims, cells, channels, motions, orders, tree, units
from host.gait.declare import check_head, declare_circles, declare_defs, declare_params
from host.gait.diagnostics import Problems, did_you_mean
from host.gait.lines import code_part
from host.gait.plan import Loop, Op, Step, Wait
from host.gait.scope import CellSet, CoilSet, Scope, Value
from host.gait.script import Script
from host.gait.timeline import TooLarge, duration_ms, together
from host.gait.tree import Place, Statement
from host.profile import Profile

STATEMENTS_MAX = 50_000
COUNT_MAX = 0xFFFF
SINGLE: dict[type[Statement], Callable[[Any, Scope, int], list[Op]]] = {
    tree.Fire: orders.fire,
    tree.Move: motions.move,
    tree.Orient: motions.orient,
    tree.Press: motions.press,
    tree.Wait: orders.wait,
    tree.WaitUntil: orders.wait_until,
    tree.Let: aims.let,
}


@dataclass(frozen=True)
class Where:
    """Where a statement stands: the names that hold there, the calls that led there, what it is within."""

    scope: Scope
    calls: tuple[Place, ...] = ()
    defs: tuple[str, ...] = ()
    top: bool = True
    together: bool = False


@dataclass
class Expansion:
    """A script worked out for a robot."""

    plan: tuple[Op, ...]
    steps: tuple[Step, ...]
    params: dict[str, Value]


def expand(script: Script, profile: Profile, overrides: Sequence[str], problems: Problems) -> Expansion:
    """Return the plan and its steps; what is wrong is added to `problems`."""
    scope = Scope(problems, profile, unread=frozenset(script.unread_words()))
    check_head(script, profile, problems)
    declare_params(script, scope, overrides)
    declare_circles(script, scope)
    worker = _Expander(script, problems, declare_defs(script, scope))
    plan: list[Op] = []
    try:
        plan = worker.block(script.main.statements, Where(scope))
        worker.try_uncalled(scope)
    except TooLarge:
        problems.add(Place(script.main.name, 1, 1, 2), "E114", "the script unrolls to more than any robot holds")
    return Expansion(tuple(plan), tuple(worker.steps), scope.params)


@dataclass
class _Expander:
    script: Script
    problems: Problems
    defs: dict[str, tree.Define]
    steps: list[Step] = field(default_factory=list)
    called: set[str] = field(default_factory=set)
    left: int = STATEMENTS_MAX

    def block(self, statements: Sequence[Statement], where: Where) -> list[Op]:
        """Return the ops of statements that run one after another."""
        return [op for statement in statements for op in self.statement(statement, where)]

    def statement(self, node: Statement, where: Where) -> list[Op]:  # noqa: PLR0911  # one for each statement
        """Return the ops of one statement."""
        self.left -= 1
        if self.left < 0:
            raise TooLarge
        match node:
            case tree.WaitUntil() | tree.Let() if where.together:
                word = "a let" if isinstance(node, tree.Let) else "a wait for a condition"
                self.problems.add(node.place, "E143", f"{word} cannot stand in a together")
                return []
            case tree.Order() | tree.Wait() | tree.WaitUntil() | tree.Let():
                return SINGLE[type(node)](node, where.scope, self._step(node.place, where))
            case tree.Repeat():
                return self._repeat(node, where)
            case tree.Together():
                return self._together(node, where)
            case tree.Call():
                return self._call(node, where)
            case tree.Guard() if where.top:
                return orders.guard(node, where.scope)
            case tree.Broken():
                return self.block(node.body, replace(where, top=False))
        if not where.top:
            word = self._line(node.place).split()[0]
            self.problems.add(node.place, "E112", f"`{word}` belongs at the top level of the script")
        return []

    def try_uncalled(self, scope: Scope) -> None:
        """Look for mistakes in the defs that nobody calls; what their arguments will be is not known."""
        steps = list(self.steps)
        aside = replace(scope, chosen=dict(scope.chosen), reach=dict(scope.reach))
        for name in [name for name in self.defs if name not in self.called]:
            define = self.defs[name]
            arguments = dict.fromkeys((parameter.text for parameter in define.parameters), None)
            self.block(define.body, Where(aside.inner(arguments), defs=(name,), top=False))
        self.steps = steps

    def _repeat(self, node: tree.Repeat, where: Where) -> list[Op]:
        count = self._count(node, where.scope)
        body = self.block(node.body, replace(where, top=False))
        if count is None or not body:
            return []
        if not duration_ms(body) and not _waits(body):
            self.problems.add(node.place, "E152", "the repeat takes no time", "let something in it take time")
        return [Loop(count, tuple(body), node)]

    def _count(self, node: tree.Repeat, scope: Scope) -> int | None:
        if node.count is None:
            self.problems.add(node.place, "E150", "repeat how often?", "write `repeat 3:`")
            return None
        quantity = scope.of_kind(node.count, units.NUMBER)
        if quantity is None:
            return None
        if quantity.value.denominator != 1 or not 1 <= quantity.value <= COUNT_MAX:
            self.problems.add(node.count.place, "E151", f"{quantity} is no whole number from 1 to {COUNT_MAX}")
            return None
        return int(quantity.value)

    def _together(self, node: tree.Together, where: Where) -> list[Op]:
        inner = replace(where, top=False, together=True)
        return together([self.statement(child, inner) for child in node.body], self.problems)

    def _call(self, node: tree.Call, where: Where) -> list[Op]:
        name = node.name.text
        define = self.defs.get(name)
        self.called.add(name)
        if define is None:
            if name not in where.scope.unread:
                help = did_you_mean(name, [*self.defs, "fire", "move", "press", "wait", "repeat"])
                self.problems.add(node.name.place, "E162", f"there is no def `{name}`", help)
            return []
        if name in where.defs:
            chain = " -> ".join([*where.defs, name])
            self.problems.add(node.place, "E164", f"`{name}` calls itself: {chain}")
            return []
        given, wanted = len(node.arguments), len(define.parameters)
        if given != wanted:
            self.problems.add(node.place, "E163", f"`{name}` takes {wanted} arguments, not {given}")
            return []
        values = [self._argument(argument, where.scope) for argument in node.arguments]
        names = [parameter.text for parameter in define.parameters]
        scope = where.scope.inner(dict(zip(names, values, strict=True)))
        inner = replace(where, scope=scope, calls=(*where.calls, node.place), defs=(*where.defs, name), top=False)
        return self.block(define.body, inner)

    def _argument(self, node: tree.Expression | tree.Coils, scope: Scope) -> Value:
        if isinstance(node, tree.Coils):
            return self._named(node, scope)
        if isinstance(node, tree.Reference):
            return scope.lookup(node)
        return scope.value(node)

    def _named(self, node: tree.Coils, scope: Scope) -> Value:
        """Return the channels, or the force cells, that an argument names."""
        if all(cells.is_cell(each, scope) for each in node.coils):
            mask = cells.masked(node.coils, scope)
            return CellSet(mask) if mask else None
        mask = channels.masked(node.coils, scope)
        return CoilSet(mask) if mask else None

    def _step(self, place: Place, where: Where) -> int:
        text = code_part(self._line(place)).strip()
        self.steps.append(Step(len(self.steps) + 1, place, text, where.calls))
        return len(self.steps)

    def _line(self, place: Place) -> str:
        files = {file.name: file for file in self.script.files}
        return files[place.file].line(place.line)


def _waits(ops: Sequence[Op]) -> bool:
    return any(isinstance(op, Wait) or (isinstance(op, Loop) and _waits(op.body)) for op in ops)
