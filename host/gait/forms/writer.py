"""Writes a script back as text, in one form: the same layout gives the same text, however it was typed.

Blocks are indented by four spaces, words stand one space apart, numbers have no needless zeros. The columns of params
that follow each other are aligned, and so are comments beside statements that stand near each other.

    written(layout(file))
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import Any

from host.gait import tree
from host.gait.forms.columns import Row, aligned
from host.gait.forms.layout import Item, Sheet

BINDS = {"+": 1, "-": 1, "*": 2, "/": 2}


def written(sheet: Sheet) -> str:
    """Return the text of a layout; it ends with a line end unless it is empty."""
    rows = [*_rows(sheet.items, 0), *_apart(sheet.after, 0, 0)]
    return "".join(f"{line}\n" for line in aligned(rows))


def statement(node: tree.Statement) -> str:
    """Return the line of a statement; of a block the head."""
    return " ".join(_cells(node))


def expression(node: tree.Expression) -> str:
    """Return a value as it is written."""
    match node:
        case tree.Number(value, unit):
            return decimal(value) if unit is None else f"{decimal(value)} {unit}"
        case tree.Reference(name):
            return f"${name}"
        case tree.Negative(operand):
            return f"-{_bound(operand, 3)}"
    binds = BINDS[node.operator]
    return f"{_bound(node.left, binds)} {node.operator} {_bound(node.right, binds + 1)}"


def decimal(value: Fraction) -> str:
    """Return the exact decimal text of a number; ValueError when it has none, or is below zero."""
    places = 0
    while value * 10**places % 1:
        places += 1
        if places > value.denominator.bit_length():
            raise ValueError(f"{value} has no end as a decimal")
    if value < 0:
        raise ValueError(f"{value} is below zero")
    digits = str(int(value * 10**places)).rjust(places + 1, "0")
    return f"{digits[:-places]}.{digits[-places:]}" if places else digits


def coils(nodes: tuple[tree.Coil, ...]) -> str:
    """Return names and references as they are written, one after another."""
    return " ".join(node.text if isinstance(node, tree.Name) else f"${node.name}" for node in nodes)


def condition(node: tree.AnyCondition) -> str:
    """Return a condition as it is written."""
    match node:
        case tree.Facing(way, coil):
            return f"{way.text} is {coils((coil,))}"
        case tree.Reading(quantity, compare, value):
            return f"{quantity.text} {compare} {expression(value)}"
    quantifier = f"{node.quantifier.text} " if node.quantifier else ""
    return f"{quantifier}{coils(node.subjects)}.{node.quantity.text} {node.compare} {expression(node.value)}"


def argument(node: tree.Expression | tree.Coils | tree.Span) -> str:
    """Return an argument of a call, or an item of a `for`, as it is written."""
    match node:
        case tree.Coils(names):
            return coils(names)
        case tree.Span(first, last):
            return f"{expression(first)} .. {expression(last)}"
    return expression(node)


def _bound(node: tree.Expression, binds: int) -> str:
    """Return a part of an expression, in brackets where it would fall apart without."""
    text = expression(node)
    return f"({text})" if isinstance(node, tree.Binary) and BINDS[node.operator] < binds else text


def _rows(items: tuple[Item, ...], depth: int, block: int = 0) -> Iterator[Row]:
    for item in items:
        yield from _apart(item.before, depth, block)
        yield Row(block, depth, _cells(item.node), item.beside)
        yield from _rows(item.body, depth + 1, id(item))
        yield from _apart(item.after, depth + 1, id(item))


def _apart(lines: tuple[str, ...], depth: int, block: int) -> Iterator[Row]:
    return (Row(block, depth, [line] if line else [], apart=True) for line in lines)


def _cells(node: tree.Statement) -> list[str]:
    """Return the columns of the line of a statement; only a param has more than one."""
    if isinstance(node, tree.Param):
        ends = () if node.low is None or node.high is None else (node.low, node.high)
        between = [f"[{' .. '.join(map(expression, ends))}]"] if ends else []
        return [f"param {node.name.text}", f"= {expression(node.value)}", *between]
    return [LINES[type(node)](node)]


def _clauses(nodes: tuple[tree.Clause | tree.Otherwise, ...]) -> str:
    """Return clauses with a blank before each."""
    return "".join(
        f" {node.word} {expression(node.value)}" if isinstance(node, tree.Clause) else f" else {node.choice.text}"
        for node in nodes
    )


def _let(node: tree.Let) -> str:
    match node.ahead:
        case None:
            ahead = ""
        case tree.Negative(operand):
            ahead = f" - {expression(operand)}"
        case value:
            ahead = f" + {expression(value)}"
    return f"let {node.name.text} = {node.circle.text}[{node.way.text}{ahead}]"


def _turn(node: tree.Turn) -> str:
    return f"{node.axis.text} {expression(node.angle)}" if node.axis else expression(node.angle)


def _words(*parts: str) -> str:
    return " ".join(part for part in parts if part)


def _optional(node: tree.Expression | None) -> str:
    return "" if node is None else expression(node)


LINES: dict[type, Callable[[Any], str]] = {
    tree.Gait: lambda node: f"gait {decimal(node.version)}",
    tree.Robot: lambda node: f"robot {node.name}",
    tree.Include: lambda node: f'include "{node.path}"',
    tree.Circle: lambda node: f"circle {node.name.text} = {coils(node.coils)}",
    tree.Let: _let,
    tree.Define: lambda node: f"def {node.name.text}({', '.join(name.text for name in node.parameters)}):",
    tree.Fire: lambda node: _words("fire", coils(node.coils)) + _clauses(node.clauses),
    tree.Hold: lambda node: _words("hold", coils(node.coils)) + _clauses(node.clauses),
    tree.Move: lambda node: _words("move", coils(node.joints)) + _clauses(node.clauses),
    tree.Orient: lambda node: _words("orient", _optional(node.target)) + _clauses(node.clauses),
    tree.Press: lambda node: "press" + _clauses(node.clauses),
    tree.Repeat: lambda node: _words("repeat", _optional(node.count)) + ":",
    tree.ForEach: lambda node: f"for {node.name.text} in {', '.join(map(argument, node.items))}:",
    tree.Together: lambda node: "together:",
    tree.Sym: lambda node: f"sym {', '.join(map(_turn, node.turns))}:",
    tree.OnFault: lambda node: "on fault:",
    tree.Wait: lambda node: _words("wait", _optional(node.time)),
    tree.WaitUntil: lambda node: f"wait until {condition(node.condition)}{_clauses(node.clauses)}",
    tree.Guard: lambda node: f"guard {condition(node.condition)}",
    tree.Note: lambda node: f'note "{node.text}"',
    tree.Label: lambda node: f"label {node.name.text}",
    tree.Call: lambda node: f"{node.name.text}({', '.join(map(argument, node.arguments))})",
}
