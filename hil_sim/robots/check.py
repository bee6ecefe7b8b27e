"""Everything that can be wrong with a robot file, found in one pass and said as file:line and what to do."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from hil_sim.robots.bonds import odd
from hil_sim.robots.keys import BATTERY, BENCH, KEYS, KINDS, UNITS, Key, features_of, keys_of
from hil_sim.robots.texts import CHOICES, TEXTS, Sections, Text, mistakes_in, texts_of
from hil_sim.spelling import many, near

STANDINGS = ("paper", "read", "measured", "derived", "assumed", "fitted")
NAMED = {"read": "read where", "measured": "measured on what"}  # standings that need a source
FOR_THE_READER = ("derived",)  # a section that is held to the form but not to the table of keys
ALSO = {"ground.friction_ratio": "object.friction_ratio"}  # by which name a robot without ground has the same
FROM_ADDRESS = "set by the robot's address"


@dataclass(frozen=True)
class Entry:
    """One number as the file prints it."""

    name: str  # section.key
    value: float
    standing: str
    source: str


class Check:
    """The numbers of a robot file in `entries`, and in `mistakes` one line for each thing wrong with it.

    `kind` is that of the robot, `rows` are the keys that it has, `choices` the texts that an address may set.
    """

    def __init__(self, path: Path, text: str, data: dict[str, Any], overrides: Mapping[str, str]) -> None:
        self.entries: dict[str, Entry] = {}
        self.mistakes: list[str] = []
        self._path = path
        self._overrides = overrides
        self._lines = line_numbers(text)
        self._meant: set[str] = set()  # keys that the file tried to give
        sections = {"": {key: value for key, value in data.items() if not isinstance(value, dict)}}
        sections |= {key: value for key, value in data.items() if isinstance(value, dict)}
        self.kind = kind_of(sections)
        power, meshed = BATTERY if "battery" in sections else BENCH, bool(given(sections, "press.mesh"))
        features = features_of(self.kind, power, meshed)
        self.rows = keys_of(features)
        self._texts = texts_of(features)
        self._all: list[Key | Text] = [*self.rows, *self._texts]
        self.choices = {text.name: given(sections, text.name) for text in self._texts if text.name in CHOICES}
        self._sections(sections)
        self._missing()
        for name, what in mistakes_in(sections, features):
            self._say(name, what)
        for name, value in overrides.items():
            self._override(name, value)
        self._ranges()
        values = {name: entry.value for name, entry in self.entries.items()}
        for name, what in odd(values, self.choices):
            self._blame(name, what)
        if self.choices.get("press.indenter") == "polygon" and "corners_mm" not in sections.get("press", {}):
            self._say("[press]", "indenter polygon needs corners_mm = [[x, y], ...] in [press], x from the axis")

    def _say(self, name: str, what: str) -> None:
        """Note a mistake at the line of section.key, else of its section, else of the file."""
        section = name.partition(".")[0]
        line = self._lines.get(name) or self._lines.get(f"[{section}]") or 1
        self.mistakes.append(f"{self._path}:{line}: {what}")

    def _sections(self, sections: dict[str, dict[str, Any]]) -> None:
        known = {row.section for row in self._all} | set(FOR_THE_READER)
        texts = {(text.section, text.key) for text in self._texts}
        for section, table in sections.items():
            if section not in known:
                why = self._elsewhere(section) or near(section, known)
                self._say(f"[{section}]", f"unknown section [{section}]{why}")
                self._meant |= {key.name for key in self.rows if key.section in get_close_matches(section, known, 1)}
                continue
            for key, value in table.items():
                if (section, key) not in texts:
                    self._number(section, key, value)

    def _elsewhere(self, name: str) -> str:
        """Return which robots have a section, a number or a text that this one has not."""
        here = {row.only for row in self._all}
        everywhere: list[Key | Text] = [*KEYS, *TEXTS]
        only = [row.only for row in everywhere if name in (row.section, row.name) and row.only not in here]
        return f": it belongs to a robot with {'' if many(only[0]) else 'a '}{only[0]}" if only else ""

    def _number(self, section: str, key: str, value: object) -> None:
        name = f"{section}.{key}" if section else key
        rows = [row for row in self.rows if row.section == section]
        if section not in FOR_THE_READER and key not in {row.key for row in rows}:
            self._unknown(name, key, rows)
            return
        self._meant.add(name)
        if not unit_of(key):
            self._say(name, f"{key} has no unit: end it in one, as in {key}_mm")
        elif not (isinstance(value, list) and len(value) == 2 and is_number(value[0]) and isinstance(value[1], str)):
            self._say(name, f'{key}: write it as {key} = [value, "standing: source"]')
        else:
            self._standing(name, float(value[0]), value[1])

    def _unknown(self, name: str, key: str, rows: list[Key]) -> None:
        unit = unit_of(key)
        stem = key.removesuffix(f"_{unit}") if unit else key
        for row in rows:
            if row.key.removesuffix(f"_{unit_of(row.key)}") == stem:
                self._meant.add(row.name)
                what = f"{key}: this number is kept as" if unit else f"{key} has no unit: write"
                self._say(name, f"{what} {row.key}")
                return
        keys = [row.key for row in rows]
        self._meant |= {f"{name.removesuffix(key)}{match}" for match in get_close_matches(key, keys, 1)}
        self._say(name, f"unknown key {key}{self._elsewhere(name) or near(key, keys)}")

    def _standing(self, name: str, value: float, text: str) -> None:
        standing, _, source = text.partition(":")
        if standing not in STANDINGS:
            self._say(name, f"{name}: standing {standing!r} is none of {', '.join(STANDINGS)}")
        elif standing in NAMED and not source.strip():
            self._say(name, f"{name}: {NAMED[standing]}? Write it as {standing}: source")
        self.entries[name] = Entry(name, value, standing, source.strip())

    def _missing(self) -> None:
        for key in self.rows:
            if key.needed and key.name not in self._meant:
                row = f'{key.key} = [value, "standing: source"]'
                self._say(key.section, f"[{key.section}] lacks {key.key}: add {row}")

    def _override(self, name: str, text: str) -> None:
        known = [key.name for key in self.rows]
        if name in self.choices:
            self.choices[name] = text
            return
        if name not in known and ALSO.get(name) in known:
            name = ALSO[name]
        if name not in known:
            chosen = f"{name.partition('.')[2]}={text}: no such choice"
            what = chosen if name in CHOICES else f"set={name}: no such number"
            self.mistakes.append(f"{what}{self._elsewhere(name) or near(name, known)}")
            return
        try:
            self.entries[name] = Entry(name, float(text), "assumed", FROM_ADDRESS)
        except ValueError:
            self.mistakes.append(f"set={name}:{text}: {text!r} is not a number")

    def _ranges(self) -> None:
        for key in self.rows:
            entry = self.entries.get(key.name)
            if entry and not key.allows(entry.value):
                self._blame(key.name, f"{key.name} is {entry.value:g}, it must be {key.range}")

    def _blame(self, name: str, what: str) -> None:
        """Note a mistake at a number or choice of the file, or at what the address has put in its place."""
        key, choice = name.partition(".")[2], self.choices.get(name)
        if choice is not None and name in self._overrides:
            self.mistakes.append(f"{key}={choice} {what}")
        elif choice is not None:
            self._say(name, f"{key} {choice} {what}")
        elif self.entries[name].source == FROM_ADDRESS:
            self.mistakes.append(f"set={name}: {what}")
        else:
            self._say(name, what)


def kind_of(sections: Sections) -> str:
    """Return the kind of robot that a file describes: by name, or where that is none by most of its keys."""
    for name in ("kind", "shell.kind"):
        if (kind := given(sections, name)) in KINDS:
            return kind
    found = {f"{section}.{key}" for section, table in sections.items() for key in table}
    return max(KINDS, key=lambda kind: len(found & {key.name for key in keys_of(features_of(kind))}))


def given(sections: Sections, name: str) -> str:
    """Return the text that a file gives for section.key, or nothing."""
    section, _, key = name.rpartition(".")
    text = sections.get(section, {}).get(key)
    return text if isinstance(text, str) else ""


def line_numbers(text: str) -> dict[str, int]:
    """Return the line number of each `section.key`, `key` above the sections, and `[section]`."""
    found: dict[str, int] = {}
    section = ""
    for number, line in enumerate(text.splitlines(), 1):
        if match := re.match(r"\s*\[([\w.-]+)\]", line):
            section = match[1]
            found.setdefault(f"[{section}]", number)
            found.setdefault(section, number)  # [a.b] is the value of b in [a], too
        elif match := re.match(r"\s*([\w-]+)\s*=", line):
            found.setdefault(f"{section}.{match[1]}" if section else match[1], number)
    return found


def unit_of(key: str) -> str:
    """Return the longest unit that the key ends in, or nothing."""
    return max((unit for unit in UNITS if key.endswith(f"_{unit}")), key=len, default="")


def is_number(value: object) -> bool:
    """Return whether this is a number of TOML, and no whole number beyond what can be counted with."""
    return isinstance(value, float) or (type(value) is int and abs(value) < 1 << 63)
