"""The tree of a script as JSON, and back: for tools that write scripts, and for editors that show them.

Statements stand in the order of the text, as objects whose keys are the parts of a statement; numbers are texts, so
that they stay exact: {"number": "0.5", "unit": "s"}. Comments stand with their statement: `before` it (an empty text
is a blank line), `comment` beside it, `after` the last one of a block. What the tree can hold can be said in JSON, and
nothing else is read: TreeError names the path of what is wrong. The one table below is reader, writer and schema.

    value = as_json(layout(file))        # {"version": 1, "statements": [...]}
    sheet = read(value)                  # the same layout
"""

from __future__ import annotations

import json
from typing import Any

from host.gait.forms.jsonkinds import Many, Record, TreeError, joined, require_object, shown
from host.gait.forms.layout import Sheet, tidy
from host.gait.forms.treekinds import BESIDE, KINDS, LINES, STATEMENT, STATEMENTS, tidied

VERSION = 1
WHOLE: dict[str, dict[str, Any]] = {
    "$schema": {"type": "string"},
    "version": {"const": VERSION},
    "statements": Many(STATEMENT).schema(),
    "after": LINES.schema(),
}


def as_json(sheet: Sheet) -> dict[str, Any]:
    """Return a layout as a value for JSON."""
    after = {"after": list(sheet.after)} if sheet.after else {}
    return {"version": VERSION, "statements": Many(STATEMENT).write(sheet.items), **after}


def read(value: Any) -> Sheet:
    """Return the layout that a JSON value holds, or raise TreeError."""
    require_object(value, "")
    version = value.get("version")
    if "version" in value and (isinstance(version, bool) or version != VERSION):
        raise TreeError("version", f"{shown(version)} is unknown: this softrig reads version {VERSION}")
    for key in value:
        if key not in WHOLE:
            raise TreeError(joined("", key), f"unknown key; known are {', '.join(WHOLE)}")
    for key in ("version", "statements"):
        if key not in value:
            raise TreeError(key, "is missing")
    if not isinstance(value.get("$schema", ""), str):
        raise TreeError("$schema", f"{shown(value['$schema'])} is no text")
    items = Many(STATEMENT).read(value["statements"], "statements")
    after = LINES.read(value.get("after", []), "after")
    return Sheet(tidied(items), tidy(after, not items, last=True))


def reads(text: str, file: str = "") -> Sheet:
    """Return the layout that a JSON text holds, or raise TreeError; its text then begins with the name of the file."""
    try:
        return read(json.loads(text, object_pairs_hook=_once))
    except json.JSONDecodeError as error:
        raise TreeError("", f"line {error.lineno}, column {error.colno}: {error.msg}", file) from None
    except RecursionError:
        raise TreeError("", "it is nested too deeply", file) from None
    except TreeError as error:
        raise TreeError(error.path, error.message, file) from None
    except ValueError as error:  # a number with thousands of digits
        raise TreeError("", str(error).split(";")[0], file) from None


def schema() -> dict[str, Any]:
    """Return the JSON Schema of what `read` takes."""
    statements = {name.replace(" ", "_"): _schema(name, record) for name, (_, record) in STATEMENTS.items()}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "The tree of a gait script",
        "description": "What `softrig gait export` writes and `softrig gait import` reads.",
        "type": "object",
        "properties": WHOLE,
        "required": ["version", "statements"],
        "additionalProperties": False,
        "$defs": {**{name: kind.schema() for name, kind in KINDS.items()}, **statements},
    }


def _schema(name: str, record: Record) -> dict[str, Any]:
    """Return the schema of one statement: its own keys, and those that every one has."""
    own = record.schema()
    around = {"before": LINES.schema(), "comment": BESIDE.schema()}
    if "body" in own["properties"]:
        around["after"] = LINES.schema()
    properties = {"statement": {"const": name}, **own["properties"], **around}
    return {**own, "properties": properties, "required": ["statement", *own["required"]]}


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Return an object; a key that is given twice is a mistake."""
    made = dict(pairs)
    if len(made) < len(pairs):
        twice = max(made, key=[key for key, _ in pairs].count)
        raise TreeError("", f"the key {shown(twice)} is given twice in one object")
    return made
