"""Builds the typed tree from what the grammar matched: one method per rule, nothing looked up yet."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, cast

from lark import Token, Transformer

from host.gait import tree
from host.gait.tree import Expression, Name, Place

Items = list[Any]


class Builder(Transformer[Token, Any]):
    """Turns the parse tree of one file into the tree of `host.gait.tree`; `shifts` are columns by line."""

    def __init__(self, file: str, shifts: Sequence[int]) -> None:
        super().__init__(visit_tokens=False)
        self._file = file
        self._shifts = shifts

    def file(self, items: Items) -> tuple[tree.Statement, ...]:
        """Return the statements of a file."""
        return tuple(item for item in items if not isinstance(item, Token))

    body = file

    def value(self, items: Items) -> Expression:
        """Return the expression of a text that is one value."""
        return cast(Expression, items[0])

    def gait(self, items: Items) -> tree.Gait:
        """Return `gait 1`."""
        return tree.Gait(Fraction(items[1]), self._place(items[0], items[1]))

    def robot(self, items: Items) -> tree.Robot:
        """Return the `robot` statement; a name may hold hyphens."""
        return tree.Robot("".join(items[1:]), self._place(items[0], items[-1]))

    def param(self, items: Items) -> tree.Param:
        """Return a parameter with its range, if it has one."""
        word, name, value, low, high = items
        return tree.Param(self._name(name), value, low, high, self._place(word, name))

    def include(self, items: Items) -> tree.Include:
        """Return an `include` with its path."""
        return tree.Include(str(items[1])[1:-1], self._place(items[0], items[1]))

    def circle(self, items: Items) -> tree.Circle:
        """Return a circle with its coils as written."""
        word, name, *coils = items
        return tree.Circle(self._name(name), tuple(self._coil(item) for item in coils), self._place(word, coils[-1]))

    def let(self, items: Items) -> tree.Let:
        """Return a choice of a coil."""
        word, name, circle, way, ahead = items
        place = self._place(word, way) if ahead is None else self._place(word).upto(ahead.place)
        return tree.Let(self._name(name), self._name(circle), self._name(way), ahead, place)

    def ahead(self, items: Items) -> Expression:
        """Return by how many places to go on; to go back counts below zero."""
        sign, value = items
        return value if sign == "+" else tree.Negative(value, self._place(sign).upto(value.place))

    def define(self, items: Items) -> tree.Define:
        """Return a def with its argument names and body."""
        word, name, *parameters, body = items
        names = tuple(self._name(item) for item in parameters if item is not None)
        return tree.Define(self._name(name), names, body, self._place(word, name))

    def repeat(self, items: Items) -> tree.Repeat:
        """Return a counted block."""
        word, count, body = items
        return tree.Repeat(count, body, self._place(word))

    def for_each(self, items: Items) -> tree.ForEach:
        """Return a block with the items it runs for."""
        word, name, inside, *given, body = items
        return tree.ForEach(self._name(name), tuple(given), body, self._place(word, inside).upto(given[-1].place))

    def span(self, items: Items) -> tree.Span:
        """Return whole numbers from one to another."""
        first, last = items
        return tree.Span(first, last, first.place.upto(last.place))

    def sym(self, items: Items) -> tree.Sym:
        """Return a block whose coils are turned."""
        word, *turns, body = items
        return tree.Sym(tuple(turns), body, self._place(word).upto(turns[-1].place))

    def turn(self, items: Items) -> tree.Turn:
        """Return an angle, about an axis."""
        axis, angle = items
        place = angle.place if axis is None else self._place(axis).upto(angle.place)
        return tree.Turn(None if axis is None else self._name(axis), angle, place)

    def on_fault(self, items: Items) -> tree.OnFault:
        """Return what runs when the program is aborted."""
        return tree.OnFault(items[2], self._place(items[0], items[1]))

    def together(self, items: Items) -> tree.Together:
        """Return a block whose statements start at once."""
        return tree.Together(items[1], self._place(items[0]))

    def fire(self, items: Items) -> tree.Fire:
        """Return a `fire` with its coils and clauses as written."""
        return tree.Fire(*self._order(items))

    def hold(self, items: Items) -> tree.Hold:
        """Return a `hold` with its coils and clauses as written."""
        return tree.Hold(*self._order(items))

    def move(self, items: Items) -> tree.Move:
        """Return a `move` with its joints and clauses as written."""
        return tree.Move(*self._order(items))

    def orient(self, items: Items) -> tree.Orient:
        """Return an `orient` with its angle and clauses as written."""
        word, target, *clauses = items
        last = clauses[-1] if clauses else target
        place = self._place(word)
        return tree.Orient(target, tuple(clauses), place.upto(last.place) if last else place)

    def press(self, items: Items) -> tree.Press:
        """Return a `press` with its clauses as written."""
        word, *clauses = items
        place = self._place(word)
        return tree.Press(tuple(clauses), place.upto(clauses[-1].place) if clauses else place)

    def clause(self, items: Items) -> tree.Clause:
        """Return a word and its value."""
        word, value = items
        return tree.Clause(str(word), value, self._place(word).upto(value.place))

    timeout = motion = course = stroke = keeping = clause

    def otherwise(self, items: Items) -> tree.Otherwise:
        """Return `else NAME`."""
        return tree.Otherwise(self._name(items[1]), self._place(items[0], items[1]))

    def wait(self, items: Items) -> tree.Wait:
        """Return a wait for a time."""
        place = self._place(items[0])
        return tree.Wait(items[1], place.upto(items[1].place) if items[1] else place)

    def wait_until(self, items: Items) -> tree.WaitUntil:
        """Return a wait for a condition."""
        word, _, condition, *clauses = items
        last = clauses[-1] if clauses else condition
        return tree.WaitUntil(condition, tuple(clauses), self._place(word).upto(last.place))

    def guard(self, items: Items) -> tree.Guard:
        """Return a guard."""
        return tree.Guard(items[1], self._place(items[0]).upto(items[1].place))

    def note(self, items: Items) -> tree.Note:
        """Return a note with its text."""
        return tree.Note(str(items[1])[1:-1], self._place(items[0], items[1]))

    def label(self, items: Items) -> tree.Label:
        """Return a label."""
        return tree.Label(self._name(items[1]), self._place(items[0], items[1]))

    def condition(self, items: Items) -> tree.Condition:
        """Return a condition."""
        *words, quantity, compare, value = items
        quantified = len(words) > 1 and words[0].type != "REFERENCE"
        return tree.Condition(
            self._name(words[0]) if quantified else None,
            tuple(self._coil(item) for item in words[quantified:]),
            self._name(quantity),
            str(compare),
            value,
            self._place(words[0]).upto(value.place),
        )

    def reading(self, items: Items) -> tree.Reading:
        """Return a condition on what there is once on a robot."""
        quantity, compare, value = items
        return tree.Reading(self._name(quantity), str(compare), value, self._place(quantity).upto(value.place))

    def facing(self, items: Items) -> tree.Facing:
        """Return a condition on which coil points down."""
        way, _, coil = items
        return tree.Facing(self._name(way), self._coil(coil), self._place(way, coil))

    def call(self, items: Items) -> tree.Call:
        """Return a call with its arguments."""
        name, *arguments = items
        given = tuple(item for item in arguments if item is not None)
        place = self._place(name)
        return tree.Call(self._name(name), given, place.upto(given[-1].place) if given else place)

    def coils(self, items: Items) -> tree.Coils:
        """Return coils given as one argument."""
        return tree.Coils(tuple(self._coil(item) for item in items), self._place(items[0], items[-1]))

    def broken(self, items: Items) -> tree.Broken:
        """Return the mark of a line that was set aside, with its block."""
        body = items[1] if len(items) > 1 else ()
        return tree.Broken(body, self._place(items[0]))

    broken_block = broken

    def add(self, items: Items) -> tree.Binary:
        """Return two values joined by an operator."""
        left, operator, right = items
        return tree.Binary(str(operator), left, right, left.place.upto(right.place))

    multiply = add

    def number(self, items: Items) -> tree.Number:
        """Return a number and its unit."""
        digits, unit = items
        written = None if unit is None else str(unit)
        return tree.Number(Fraction(digits), written, self._place(digits, unit or digits))

    def reference(self, items: Items) -> tree.Reference:
        """Return `$name`."""
        return tree.Reference(items[0][1:], self._place(items[0]))

    def negative(self, items: Items) -> tree.Negative:
        """Return a value with a minus before it."""
        return tree.Negative(items[1], self._place(items[0]).upto(items[1].place))

    def _order(self, items: Items) -> tuple[tuple[tree.Coil, ...], tuple[tree.Clause, ...], Place]:
        """Return what an order is for, its clauses and its place."""
        named = tuple(self._coil(item) for item in items[1:] if isinstance(item, Token))
        clauses = tuple(item for item in items[1:] if isinstance(item, tree.Clause))
        last = clauses[-1] if clauses else named[-1] if named else None
        place = self._place(items[0])
        return named, clauses, place.upto(last.place) if last else place

    def _name(self, token: Token) -> Name:
        return Name(str(token), self._place(token))

    def _coil(self, token: Token) -> tree.Coil:
        return self.reference([token]) if token.type == "REFERENCE" else self._name(token)

    def _place(self, first: Token, last: Token | None = None) -> Place:
        end = last if last is not None else first
        line, column, end_column = first.line or 1, first.column or 1, end.end_column or 2
        shift = self._shifts[line - 1]
        return Place(self._file, line, column + shift, end_column + shift)
