"""Kinds of JSON values: each reads a value, writes one, and gives the JSON Schema of what it reads.

So reader, writer and schema of a format cannot differ: they are one table of these. What is wrong is a TreeError that
names the place in the value, in one line: `statements[3].clauses[0].word: "att" is none of at, for`.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from host.errors import BadRequest
from host.gait.diagnostics import did_you_mean

SHOWN_MAX = 40  # characters of a wrong value
TEXT_MAX = 1_000


class TreeError(BadRequest):
    """A JSON value that is no tree of a script; the text begins with its file, if known, and the path in it."""

    def __init__(self, path: str, message: str, file: str = "") -> None:
        self.path, self.message = path, message
        where = [part for part in (file, path) if part] or ["the file"]
        super().__init__(": ".join([*where, message]))


class Kind(Protocol):
    """A kind of value, in JSON and in the tree."""

    def read(self, value: Any, path: str) -> Any:
        """Return what stands in the tree for a JSON value, or raise TreeError."""

    def write(self, node: Any) -> Any:
        """Return the JSON value of what stands in the tree."""

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema of the values that `read` takes."""


@dataclass(frozen=True)
class Text:
    """A text of a form; `made` and `told` turn it into what stands in the tree, and back."""

    pattern: str
    what: str
    made: Callable[[str], Any] = str
    told: Callable[[Any], str] = str

    def read(self, value: Any, path: str) -> Any:
        """Return what the text makes."""
        if not isinstance(value, str):
            raise TreeError(path, f"{shown(value)} is no text: {self.what} is wanted")
        if len(value) > TEXT_MAX:
            raise TreeError(path, f"a text of {len(value)} characters, at most {TEXT_MAX}")
        if not re.fullmatch(self.pattern, value) or any("\ud800" <= sign <= "\udfff" for sign in value):
            raise TreeError(path, f"{shown(value)} is not {self.what}")
        return self.made(value)

    def write(self, node: Any) -> str:
        """Return the text."""
        return self.told(node)

    def schema(self) -> dict[str, Any]:
        """Return a pattern; it ends where the text ends, also for those to whom `$` stands before a line end."""
        return {"type": "string", "pattern": f"^(?:{self.pattern})(?![\\s\\S])", "maxLength": TEXT_MAX}


@dataclass(frozen=True)
class Word:
    """One of some words."""

    words: tuple[str, ...]

    def read(self, value: Any, path: str) -> str:
        """Return the word."""
        if not isinstance(value, str) or value not in self.words:
            near = did_you_mean(value, self.words) if isinstance(value, str) else ""
            raise TreeError(path, f"{shown(value)} is none of {', '.join(self.words)}{near and f'; {near}'}")
        return value

    def write(self, node: str) -> str:
        """Return the word."""
        return node

    def schema(self) -> dict[str, Any]:
        """Return an enumeration."""
        return {"enum": list(self.words)}


@dataclass(frozen=True)
class Many:
    """A list of at least so many; `first` is the kind of the first one, if it is another."""

    kind: Kind
    least: int = 0
    first: Kind | None = None

    def read(self, value: Any, path: str) -> tuple[Any, ...]:
        """Return the things of the list."""
        if not isinstance(value, list):
            raise TreeError(path, f"{shown(value)} is no list")
        if len(value) < self.least:
            raise TreeError(path, "the list is empty")
        kinds = [self.first or self.kind, *[self.kind] * (len(value) - 1)]
        return tuple(
            kind.read(each, f"{path}[{at}]") for at, (kind, each) in enumerate(zip(kinds, value, strict=False))
        )

    def write(self, node: Sequence[Any]) -> list[Any]:
        """Return the list."""
        return [self.kind.write(each) for each in node]

    def schema(self) -> dict[str, Any]:
        """Return an array."""
        first = {"prefixItems": [self.first.schema()]} if self.first else {}
        least = {"minItems": self.least} if self.least else {}
        return {"type": "array", **first, "items": self.kind.schema(), **least}


@dataclass(frozen=True)
class Named:
    """A kind that is defined under a name, so that kinds may hold each other."""

    name: str
    kinds: Callable[[], dict[str, Kind]]

    def read(self, value: Any, path: str) -> Any:
        """Return what the kind of that name reads."""
        return self.kinds()[self.name].read(value, path)

    def write(self, node: Any) -> Any:
        """Return what the kind of that name writes."""
        return self.kinds()[self.name].write(node)

    def schema(self) -> dict[str, Any]:
        """Return a reference to the definition."""
        return {"$ref": f"#/$defs/{self.name}"}


@dataclass(frozen=True)
class Field:
    """A key of an object, with the attribute of the node that it stands for; another is absent where that is None."""

    key: str
    kind: Kind
    attribute: str = ""
    needed: bool = True

    @property
    def name(self) -> str:
        """Return the name of the attribute."""
        return self.attribute or self.key


@dataclass(frozen=True)
class Record:
    """An object with these keys and no others, which makes a node; `both` are keys that come together or not at all."""

    node: Callable[..., Any]
    fields: tuple[Field, ...]
    about: str = ""
    both: tuple[str, ...] = ()

    def read(self, value: Any, path: str) -> Any:
        """Return the node."""
        return self.node(**self.values(value, path))

    def values(self, value: Any, path: str, others: Sequence[str] = ()) -> dict[str, Any]:
        """Return the values of the attributes; keys of `others` are left to the caller."""
        require_object(value, path)
        known = [field.key for field in self.fields]
        for key in value:
            if key not in known and key not in others:
                near = did_you_mean(key, known) or f"known are {', '.join([*others, *known])}"
                raise TreeError(joined(path, key), f"unknown key; {near}")
        for field in self.fields:
            together = field.key in self.both and any(key in value for key in self.both)
            if field.key not in value and (field.needed or together):
                raise TreeError(joined(path, field.key), "is missing")
        return {
            field.name: field.kind.read(value[field.key], joined(path, field.key)) if field.key in value else None
            for field in self.fields
        }

    def write(self, node: Any) -> dict[str, Any]:
        """Return the object."""
        told = {field.key: (field.kind, getattr(node, field.name)) for field in self.fields}
        return {key: kind.write(value) for key, (kind, value) in told.items() if value is not None}

    def schema(self) -> dict[str, Any]:
        """Return an object that takes no other keys."""
        pairs = {key: [other for other in self.both if other != key] for key in self.both}
        return {
            "type": "object",
            **({"description": self.about} if self.about else {}),
            "properties": {field.key: field.kind.schema() for field in self.fields},
            "required": [field.key for field in self.fields if field.needed],
            **({"dependentRequired": pairs} if pairs else {}),
            "additionalProperties": False,
        }


@dataclass(frozen=True)
class Either:
    """One of several kinds: of an object, told by a key that it has; `others` are of values that are no objects.

    `of` are the kinds by class of the node.
    """

    marks: dict[str, Kind]
    of: dict[type, Kind]
    others: tuple[tuple[type, Kind], ...] = ()

    def read(self, value: Any, path: str) -> Any:
        """Return what the kind of the value reads."""
        for shape, kind in self.others:
            if isinstance(value, shape):
                return kind.read(value, path)
        require_object(value, path)
        mark = next((mark for mark in self.marks if mark in value), None)
        if mark is None:
            raise TreeError(path, f"one of the keys {', '.join(self.marks)} is missing")
        return self.marks[mark].read(value, path)

    def write(self, node: Any) -> Any:
        """Return what the kind of the node writes."""
        return self.of[type(node)].write(node)

    def schema(self) -> dict[str, Any]:
        """Return the choice."""
        kinds = [*(kind for _, kind in self.others), *self.marks.values()]
        return {"anyOf": [kind.schema() for kind in kinds]}


def require_object(value: Any, path: str) -> None:
    """Raise TreeError unless the value is an object."""
    if not isinstance(value, dict):
        raise TreeError(path, f"{shown(value)} is no object")


def joined(path: str, key: str) -> str:
    """Return the path of a key below a path."""
    word = key if key.replace("$", "_").isidentifier() and key.isascii() and len(key) <= SHOWN_MAX else shown(key)
    return f"{path}.{word}" if path else word


def shown(value: Any) -> str:
    """Return a value as JSON in one line, shortened."""
    text = json.dumps(value)
    return text if len(text) <= SHOWN_MAX else f"{text[: SHOWN_MAX - 3]}..."
