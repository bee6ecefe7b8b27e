"""Works a script out for one robot: params folded, defs and coil names replaced, every `together` on one timeline.

Everything that is wrong is reported before it gives up, so that one run shows all of it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from host.gait import tree, units
from host.gait.diagnostics import Problems, did_you_mean
from host.gait.plan import Label, Loop, Note, OnFault, Op, Step, Wait
from host.gait.reading.lines import code_part
from host.gait.script import Script
from host.gait.tree import Place, Statement
from host.gait.working import aims, motions, orders, turns
from host.gait.working.arguments import argument, items
from host.gait.working.declare import check_head, declare_circles, declare_defs, declare_params
from host.gait.working.jumps import check_last, labelled
from host.gait.working.notes import told
from host.gait.working.scope import Scope, Value
from host.gait.working.timeline import TooLarge, duration_ms, together
from host.profile import Profile

STATEMENTS_MAX = 50_000
DEPTH_MAX = 100  # of blocks and calls in each other
COUNT_MAX = 0xFFFF
SINGLE: dict[type[Statement], Callable[[Any, Scope, int], list[Op]]] = {
    tree.Fire: orders.fire,
    tree.Hold: orders.hold,
    tree.Move: motions.move,
    tree.Orient: motions.orient,
    tree.Press: motions.press,
    tree.Wait: orders.wait,
    tree.WaitUntil: orders.wait_until,
    tree.Let: aims.let,
}


class TooDeep(Exception):
    """Calls and blocks that stand in too many others, which was reported."""


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
    """A script worked out for a robot; `unsound` are ops that are not in the plan for a mistake in them."""

    plan: tuple[Op, ...]
    steps: tuple[Step, ...]
    params: dict[str, Value]
    unsound: tuple[Op, ...]


def expand(script: Script, profile: Profile, overrides: Sequence[str], problems: Problems) -> Expansion:
    """Return the plan and its steps; what is wrong is added to `problems`."""
    labels = labelled(script.main.statements, problems)
    scope = Scope(problems, profile, unread=frozenset(script.unread_words()), labels=labels)
    check_head(script, profile, problems)
    declare_params(script, scope, overrides)
    declare_circles(script, scope)
    check_last(script.main.statements, problems)
    worker = _Expander(script, problems, declare_defs(script, scope))
    plan: list[Op] = []
    try:
        plan = worker.block(script.main.statements, Where(scope))
        worker.try_uncalled(scope)
    except TooDeep:
        pass
    except TooLarge:
        problems.add(Place(script.main.name, 1, 1, 2), "E114", "the script unrolls to more than any robot holds")
    return Expansion(tuple(plan), tuple(worker.steps), scope.params, tuple(scope.unsound))


@dataclass
class _Expander:
    script: Script
    problems: Problems
    defs: dict[str, tree.Define]
    steps: list[Step] = field(default_factory=list)
    called: set[str] = field(default_factory=set)
    left: int = STATEMENTS_MAX
    depth: int = 0
    files: dict[str, tree.File] = field(init=False)

    def __post_init__(self) -> None:
        self.files = {file.name: file for file in self.script.files}

    def block(self, statements: Sequence[Statement], where: Where) -> list[Op]:
        """Return the ops of statements that run one after another."""
        if self.depth == DEPTH_MAX:
            self.problems.add(statements[0].place, "E114", "calls and blocks are nested too deeply")
            raise TooDeep
        self.depth += 1
        ops = [op for statement in statements for op in self.statement(statement, where)]
        self.depth -= 1
        return ops

    def statement(self, node: Statement, where: Where) -> list[Op]:
        """Return the ops of one statement."""
        self.left -= 1
        if self.left < 0:
            raise TooLarge
        if where.together and isinstance(node, tree.WaitUntil | tree.Let):
            word = "a let" if isinstance(node, tree.Let) else "a wait for a condition"
            self.problems.add(node.place, "E143", f"{word} cannot stand in a together")
            return []
        if type(node) in SINGLE:
            return SINGLE[type(node)](node, where.scope, self._step(node.place, where))
        if type(node) in WITHIN:
            return WITHIN[type(node)](self, node, where)
        if where.top:
            return AT_TOP[type(node)](self, node, where) if type(node) in AT_TOP else []
        word = self._line(node.place).split()[0]
        self.problems.add(node.place, "E112", f"`{word}` belongs at the top level of the script")
        return []

    def try_uncalled(self, scope: Scope) -> None:
        """Look for mistakes in the defs that nobody calls; what their arguments will be is not known."""
        steps = list(self.steps)
        chosen, reach, skipped = dict(scope.chosen), dict(scope.reach), set(scope.skipped)
        aside = replace(scope, chosen=chosen, reach=reach, skipped=skipped, labels=None, unsound=[])
        for name in [name for name in self.defs if name not in self.called]:
            define = self.defs[name]
            arguments = dict.fromkeys((parameter.text for parameter in define.parameters), None)
            self.block(define.body, Where(aside.inner(arguments), defs=(name,), top=False))
        self.steps = steps

    def guard(self, node: tree.Guard, where: Where) -> list[Op]:
        """Return a guard."""
        return orders.guard(node, where.scope)

    def broken(self, node: tree.Broken, where: Where) -> list[Op]:
        """Return the block below a line that could not be read."""
        return self.block(node.body, replace(where, top=False))

    def repeat(self, node: tree.Repeat, where: Where) -> list[Op]:
        """Return a loop."""
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

    def for_each(self, node: tree.ForEach, where: Where) -> list[Op]:
        """Return the block once for each item, one after another."""
        scope, name = where.scope, node.name.text
        if name in scope.known:
            scope.problems.add(node.name.place, "E161", f"`{name}` is declared twice", "choose another name")
        plan: list[Op] = []
        for value in items(node, scope):
            inner = scope.inner({**scope.arguments, name: value})
            plan += self.block(node.body, replace(where, scope=inner, top=False))
        return plan

    def sym(self, node: tree.Sym, where: Where) -> list[Op]:
        """Return the block for a body that is turned."""
        table = turns.turned(node, where.scope)
        scope = where.scope if table is None else replace(where.scope, table=table)
        return self.block(node.body, replace(where, scope=scope, top=False))

    def note(self, node: tree.Note, where: Where) -> list[Op]:
        """Return a note, whose text its step keeps."""
        return [Note(self._step(node.place, where, told(node, where.scope)), node)]

    def label(self, node: tree.Label, where: Where) -> list[Op]:
        """Return a label; what is chosen below it is what is chosen on every way to it."""
        labels, scope = where.scope.labels, where.scope
        if labels is None or node.name.text not in labels.numbers:
            return []
        chosen = set(scope.chosen)
        scope.skipped |= chosen - labels.arrive(node.name.text, chosen - scope.skipped)
        return [Label(labels.numbers[node.name.text], self._step(node.place, where), node)]

    def on_fault(self, node: tree.OnFault, where: Where) -> list[Op]:
        """Return what runs after an abort, which may come before anything was chosen."""
        where.scope.skipped |= set(where.scope.chosen)
        step = self._step(node.place, where)
        return [OnFault(tuple(self.block(node.body, replace(where, top=False))), step, node)]

    def together(self, node: tree.Together, where: Where) -> list[Op]:
        """Return the block laid on one timeline."""
        inner = replace(where, top=False, together=True)
        return together([self.statement(child, inner) for child in node.body], self.problems)

    def call(self, node: tree.Call, where: Where) -> list[Op]:
        """Return the body of a def with its arguments put in."""
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
        count, wanted = len(node.arguments), len(define.parameters)
        if count != wanted:
            self.problems.add(node.place, "E163", f"`{name}` takes {wanted} arguments, not {count}")
            return []
        values = [argument(given, where.scope) for given in node.arguments]
        names = [parameter.text for parameter in define.parameters]
        scope = where.scope.inner(dict(zip(names, values, strict=True)))
        inner = replace(where, scope=scope, calls=(*where.calls, node.place), defs=(*where.defs, name), top=False)
        return self.block(define.body, inner)

    def _step(self, place: Place, where: Where, note: str = "") -> int:
        text = code_part(self._line(place)).strip()
        self.steps.append(Step(len(self.steps) + 1, place, text, where.calls, note))
        return len(self.steps)

    def _line(self, place: Place) -> str:
        return self.files[place.file].line(place.line)


Work = Callable[[_Expander, Any, Where], list[Op]]
WITHIN: dict[type[Statement], Work] = {  # a block, and at the top level
    tree.Repeat: _Expander.repeat,
    tree.ForEach: _Expander.for_each,
    tree.Sym: _Expander.sym,
    tree.Together: _Expander.together,
    tree.Call: _Expander.call,
    tree.Note: _Expander.note,
    tree.Broken: _Expander.broken,
}
AT_TOP: dict[type[Statement], Work] = {
    tree.Guard: _Expander.guard,
    tree.Label: _Expander.label,
    tree.OnFault: _Expander.on_fault,
}


def _waits(ops: Sequence[Op]) -> bool:
    return any(isinstance(op, Wait) or (isinstance(op, Loop) and _waits(op.body)) for op in ops)
