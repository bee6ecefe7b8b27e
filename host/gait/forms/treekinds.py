"""The table of the nodes of a script's tree as JSON: for each its keys, and what may stand there.

`treejson` reads and writes by it and publishes it as a JSON Schema. Nodes that were read stand nowhere yet.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

from host.gait import tree
from host.gait.diagnostics import did_you_mean
from host.gait.forms.jsonkinds import (
    Either,
    Field,
    Kind,
    Many,
    Named,
    Record,
    Text,
    TreeError,
    Word,
    joined,
    require_object,
    shown,
)
from host.gait.forms.layout import NOWHERE, Item, tidy
from host.gait.forms.writer import decimal
from host.gait.reading.syntax import KEYWORDS, NAMES
from host.gait.tree import Name

IDENTIFIER = "[A-Za-z_][A-Za-z_0-9]*"
DECIMAL = "[0-9]+(?:\\.[0-9]+)?"
PRINTED = "[^\\u0000-\\u0008\\u000a-\\u001f]"  # what may stand in a line
QUOTED = PRINTED.replace("^", '^"')


def word(*free: str) -> str:
    """Return the pattern of a name: no word of the language but those that are `free`."""
    taken = "|".join(keyword for keyword in KEYWORDS if keyword not in free)
    return f"(?!(?:{taken})(?![A-Za-z_0-9])){IDENTIFIER}"


def _node(cls: type, *parts: Field, both: tuple[str, ...] = ()) -> Record:
    """Return the kind of a node that stands nowhere yet."""
    return Record(lambda **values: cls(**values, place=NOWHERE), parts, (cls.__doc__ or "").strip(), both)


def _made(text: str) -> Name:
    return Name(text, NOWHERE)


def _told(node: Name) -> str:
    return node.text


SOFT = tuple(sorted(kind.lower() for kind in NAMES[1] - {"NAME"}))
EXPRESSION, COIL, STATEMENT = (Named(name, lambda: KINDS) for name in ("expression", "coil", "statement"))
CONDITION, ARGUMENT, NAME = (Named(name, lambda: KINDS) for name in ("condition", "argument", "name"))
OWN = Text(word(*SOFT), "a name", _made, _told)  # of a param, or of an argument
NUMBER = Text(DECIMAL, 'a number like "0.5"', Fraction, decimal)
COMPARE = Word(("<", ">", "<=", ">=", "==", "!="))
LINES = Many(Text(f"|#{PRINTED}*", "a comment like `# text`, or empty"))
BESIDE = Text(f"#{PRINTED}*", "a comment like `# text`")


def clauses(*words: str) -> Many:
    """Return the kind of the clauses that an order may have."""
    return Many(_node(tree.Clause, Field("word", Word(words)), Field("value", EXPRESSION)))


class Condition(Record):
    """What is asked of coils, joints or cells; of several, the first word tells of how many it must hold."""

    def read(self, value: Any, path: str) -> Any:
        """Return the condition."""
        node = super().read(value, path)
        if node.quantifier is None and len(node.subjects) > 1 and isinstance(node.subjects[0], Name):
            raise TreeError(joined(path, "quantifier"), "is missing: any or all of these?")
        return node

    def schema(self) -> dict[str, Any]:
        """Return the object; without a quantifier it has one subject, or begins with a reference."""
        single = {"properties": {"subjects": {"maxItems": 1}}}
        referred = {"properties": {"subjects": {"prefixItems": [{"type": "object"}]}}}
        return {**super().schema(), "anyOf": [{"required": ["quantifier"]}, single, referred]}


class Items:
    """What a `for` runs for: a span of whole numbers, or a list."""

    span = _node(tree.Span, Field("first", EXPRESSION), Field("last", EXPRESSION))
    several = Many(ARGUMENT, 1)

    def read(self, value: Any, path: str) -> tuple[Any, ...]:
        """Return the items."""
        return (self.span.read(value, path),) if isinstance(value, dict) else self.several.read(value, path)

    def write(self, node: Any) -> Any:
        """Return the span, or the list."""
        return self.span.write(node[0]) if isinstance(node[0], tree.Span) else self.several.write(node)

    def schema(self) -> dict[str, Any]:
        """Return the choice."""
        return {"anyOf": [self.span.schema(), self.several.schema()]}


def tidied(items: tuple[Item, ...]) -> tuple[Item, ...]:
    """Return the items of a block without needless blank lines before them."""
    return tuple(replace(item, before=tidy(item.before, at == 0)) for at, item in enumerate(items))


class Statement:
    """A statement of any kind, told by `statement`, with its comments; of a block with those within."""

    def read(self, value: Any, path: str) -> Item:
        """Return the statement as an item of a layout."""
        require_object(value, path)
        told = value.get("statement")
        if not isinstance(told, str) or told not in STATEMENTS:
            near = did_you_mean(told, STATEMENTS) if isinstance(told, str) else ""
            what = f"{shown(told)} is no statement" if "statement" in value else "is missing"
            raise TreeError(joined(path, "statement"), f"{what}{near and f'; {near}'}")
        record, others = STATEMENTS[told][1], ["statement", "before", "comment"]
        blocks = any(field.key == "body" for field in record.fields)
        values = record.values(value, path, [*others, "after"] if blocks else others)
        body = values.get("body") or ()
        around = {key: LINES.read(value.get(key, []), joined(path, key)) for key in ("before", "after")}
        beside = BESIDE.read(value["comment"], joined(path, "comment")).rstrip() if "comment" in value else ""
        if blocks:
            values["body"] = tuple(item.node for item in body)
        return Item(
            record.node(**values), around["before"], beside, tidied(body), tidy(around["after"], False, last=True)
        )

    def write(self, node: Item) -> dict[str, Any]:
        """Return the object of an item."""
        name, record = next((name, record) for name, (cls, record) in STATEMENTS.items() if isinstance(node.node, cls))
        told = {field.key: (field.kind, getattr(node.node, field.name)) for field in record.fields}
        if "body" in told:
            told["body"] = (Many(STATEMENT), node.body)
        parts = {key: kind.write(value) for key, (kind, value) in told.items() if value is not None}
        around = {"before": list(node.before), "comment": node.beside, "after": list(node.after)}
        return {"statement": name, **parts, **{key: value for key, value in around.items() if value}}

    def schema(self) -> dict[str, Any]:
        """Return the choice of all statements."""
        return {"oneOf": [{"$ref": f"#/$defs/{name.replace(' ', '_')}"} for name in STATEMENTS]}


BODY = Field("body", Many(STATEMENT, 1))
VALUE, COILS = Field("value", EXPRESSION), Field("coils", Many(COIL))
REFERENCE = _node(tree.Reference, Field("reference", Text(IDENTIFIER, "a name"), "name"))
UNIT = Field("unit", Text(f"%|{word()}", "a unit"), needed=False)
NUMBERED = _node(tree.Number, Field("number", NUMBER, "value"), UNIT)
NEGATIVE = _node(tree.Negative, Field("negative", EXPRESSION, "operand"))
OPERATION = _node(
    tree.Binary, Field("operator", Word(("+", "-", "*", "/"))), Field("left", EXPRESSION), Field("right", EXPRESSION)
)
VALUES: dict[str, Kind] = {
    "number": NUMBERED, "reference": REFERENCE, "negative": NEGATIVE, "operator": OPERATION,
}  # fmt: skip
LISTED = _node(tree.Coils, Field("coils", Many(COIL, 1, NAME)))
EXPRESSIONS: dict[type, Kind] = {
    tree.Number: NUMBERED, tree.Reference: REFERENCE, tree.Negative: NEGATIVE, tree.Binary: OPERATION,
}  # fmt: skip
ASKED = Condition(
    lambda **values: tree.Condition(**values, place=NOWHERE),
    (
        Field("quantifier", NAME, needed=False),
        Field("subjects", Many(COIL, 1)),
        Field("quantity", NAME),
        Field("compare", COMPARE),
        VALUE,
    ),
    (tree.Condition.__doc__ or "").strip(),
)
READ = _node(tree.Reading, Field("quantity", NAME), Field("compare", COMPARE), VALUE)
FACES = _node(tree.Facing, Field("way", NAME), Field("coil", COIL))
OTHERWISE = _node(tree.Otherwise, Field("else", NAME, "choice"))
TIMEOUT = _node(tree.Clause, Field("word", Word(("timeout",))), VALUE)
UNTIL = Either({"else": OTHERWISE, "word": TIMEOUT}, {tree.Otherwise: OTHERWISE, tree.Clause: TIMEOUT})
TURN = _node(tree.Turn, Field("axis", NAME, needed=False), Field("angle", EXPRESSION))
PATH = Text(f"{QUOTED}*", "a text for one line without quotation marks")
LABEL = f"{word('press')}(?:-(?:{word('press')}|{DECIMAL}))*"
KINDS: dict[str, Kind] = {
    "name": Text(word(), "a name", _made, _told),
    "expression": Either(VALUES, EXPRESSIONS),
    "coil": Either({"reference": REFERENCE}, {tree.Reference: REFERENCE, Name: NAME}, ((str, NAME),)),
    "argument": Either({"coils": LISTED, **VALUES}, {tree.Coils: LISTED, **EXPRESSIONS}),
    "condition": Either(
        {"subjects": ASKED, "way": FACES, "quantity": READ},
        {tree.Condition: ASKED, tree.Facing: FACES, tree.Reading: READ},
    ),
    "statement": Statement(),
}
STATEMENTS: dict[str, tuple[type, Record]] = {
    name: (cls, _node(cls, *parts, both=("low", "high") if cls is tree.Param else ()))
    for name, cls, *parts in (
        ("gait", tree.Gait, Field("version", NUMBER)),
        ("robot", tree.Robot, Field("name", Text(LABEL, "the name of a robot"))),
        (
            "param",
            tree.Param,
            Field("name", OWN),
            VALUE,
            Field("low", EXPRESSION, needed=False),
            Field("high", EXPRESSION, needed=False),
        ),
        ("include", tree.Include, Field("path", PATH)),
        ("circle", tree.Circle, Field("name", NAME), Field("coils", Many(COIL, 1))),
        (
            "let",
            tree.Let,
            Field("name", NAME),
            Field("circle", NAME),
            Field("way", NAME),
            Field("ahead", EXPRESSION, needed=False),
        ),
        ("def", tree.Define, Field("name", NAME), Field("parameters", Many(OWN)), BODY),
        ("fire", tree.Fire, COILS, Field("clauses", clauses("at", "for", "until", "overlap", "ramp"))),
        ("hold", tree.Hold, COILS, Field("clauses", clauses("at", "with", "for", "overlap"))),
        ("move", tree.Move, Field("joints", Many(COIL)), Field("clauses", clauses("to", "over", "overlap"))),
        (
            "orient",
            tree.Orient,
            Field("target", EXPRESSION, needed=False),
            Field("clauses", clauses("for", "overlap")),
        ),
        ("press", tree.Press, Field("clauses", clauses("to", "over", "for", "overlap"))),
        ("repeat", tree.Repeat, Field("count", EXPRESSION, needed=False), BODY),
        ("for", tree.ForEach, Field("name", OWN), Field("items", Items()), BODY),
        ("together", tree.Together, BODY),
        ("sym", tree.Sym, Field("turns", Many(TURN, 1)), BODY),
        ("on fault", tree.OnFault, BODY),
        ("wait", tree.Wait, Field("time", EXPRESSION, needed=False)),
        ("wait until", tree.WaitUntil, Field("condition", CONDITION), Field("clauses", Many(UNTIL))),
        ("guard", tree.Guard, Field("condition", CONDITION)),
        ("note", tree.Note, Field("text", PATH)),
        ("label", tree.Label, Field("name", NAME)),
        ("call", tree.Call, Field("name", NAME), Field("arguments", Many(ARGUMENT))),
    )
}
