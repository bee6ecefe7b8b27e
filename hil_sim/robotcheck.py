"""Everything that can be wrong with a robot file, found in one pass and said as file:line and what to do."""

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from math import isfinite
from pathlib import Path
from typing import Any

from hil_sim.robotkeys import KEYS, UNITS, Key

STANDINGS = ("paper", "read", "derived", "assumed", "fitted")
KINDS = ("ring",)
CHIPS = (96, 97)  # PWM chips of the board
TEXTS = {"": ("about", "profile"), "shell": ("kind",), "coils": ("labels",), "wiring": ("outputs",)}
FOR_THE_READER = ("derived",)  # a section that is held to the form but not to the table of keys
RISING = ("martensite_finish", "martensite_start", "austenite_start", "austenite_finish")
FROM_ADDRESS = "set by the robot's address"


@dataclass(frozen=True)
class Entry:
    """One number as the file prints it."""

    name: str  # section.key
    value: float
    standing: str
    source: str


class Check:
    """The numbers of a robot file in `entries`, and in `mistakes` one line for each thing wrong with it."""

    def __init__(self, path: Path, text: str, data: dict[str, Any], overrides: Mapping[str, str]) -> None:
        self.entries: dict[str, Entry] = {}
        self.mistakes: list[str] = []
        self._path = path
        self._lines = line_numbers(text)
        self._meant: set[str] = set()  # keys that the file tried to give
        sections = {"": {key: value for key, value in data.items() if not isinstance(value, dict)}}
        sections |= {key: value for key, value in data.items() if isinstance(value, dict)}
        self._sections(sections)
        self._missing(sections)
        self._texts(sections)
        for name, value in overrides.items():
            self._override(name, value)
        self._ranges()

    def _say(self, name: str, what: str) -> None:
        """Note a mistake at the line of section.key, else of its section, else of the file."""
        section = name.partition(".")[0]
        line = self._lines.get(name) or self._lines.get(f"[{section}]") or 1
        self.mistakes.append(f"{self._path}:{line}: {what}")

    def _sections(self, sections: dict[str, dict[str, Any]]) -> None:
        known = {key.section for key in KEYS} | set(TEXTS) | set(FOR_THE_READER)
        for section, table in sections.items():
            if section not in known:
                self._say(f"[{section}]", f"unknown section [{section}]{near(section, known)}")
                self._meant |= {key.name for key in KEYS if key.section in get_close_matches(section, known, 1)}
                continue
            for key, value in table.items():
                if key not in TEXTS.get(section, ()):
                    self._number(section, key, value)

    def _number(self, section: str, key: str, value: object) -> None:
        name = f"{section}.{key}" if section else key
        rows = [row for row in KEYS if row.section == section]
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
        self._say(name, f"unknown key {key}{near(key, keys)}")

    def _standing(self, name: str, value: float, text: str) -> None:
        standing, _, source = text.partition(":")
        if standing not in STANDINGS:
            self._say(name, f"{name}: standing {standing!r} is none of {', '.join(STANDINGS)}")
        elif standing == "read" and not source.strip():
            self._say(name, f"{name}: read where? Write it as read: source")
        self.entries[name] = Entry(name, value, standing, source.strip())

    def _missing(self, sections: dict[str, dict[str, Any]]) -> None:
        for key in KEYS:
            if key.name not in self._meant:
                row = f'{key.key} = [value, "standing: source"]'
                self._say(key.section, f"[{key.section}] lacks {key.key}: add {row}")
        for section, names in TEXTS.items():
            for name in names:
                if name not in sections.get(section, {}):
                    self._say(section, f"{f'[{section}]' if section else 'the file'} lacks {name}")

    def _texts(self, sections: dict[str, dict[str, Any]]) -> None:
        shell, coils, wiring = (sections.get(name, {}) for name in ("shell", "coils", "wiring"))
        for name in TEXTS[""]:
            if not isinstance(sections[""].get(name, ""), str):
                self._say(name, f'{name}: write it as {name} = "text"')
        if shell.get("kind", "ring") not in KINDS:
            self._say("shell.kind", f"kind {shell['kind']!r} is none of {', '.join(KINDS)}")
        labels, outputs = coils.get("labels", []), wiring.get("outputs", {})
        if not (isinstance(labels, list) and all(isinstance(label, str) for label in labels)):
            self._say("coils.labels", 'labels: write them as ["A", "B", ...]')
        elif not labels:
            self._say("coils.labels", "labels: a robot has at least one coil")
        elif len(set(labels)) < len(labels):
            self._say("coils.labels", "labels: each coil needs its own")
        elif not isinstance(outputs, dict) or sorted(outputs) != sorted(labels):
            self._say("wiring.outputs", f"outputs: one [chip, output] for each of {', '.join(labels)}")
        else:
            self._outputs(outputs)

    def _outputs(self, outputs: dict[str, Any]) -> None:
        seen: dict[tuple[int, int], str] = {}
        for label, place in outputs.items():
            if not (isinstance(place, list) and len(place) == 2 and all(type(part) is int for part in place)):
                self._say("wiring.outputs", f"outputs: {label} needs [chip address, output number]")
                continue
            chip, output = place
            if chip not in CHIPS:
                known = " and ".join(map(str, CHIPS))
                self._say("wiring.outputs", f"outputs: {label} on chip {chip}, the board has {known}")
            if not 0 <= output < 16:
                self._say("wiring.outputs", f"outputs: {label} on output {output}, a chip has 0 to 15")
            if (chip, output) in seen:
                self._say("wiring.outputs", f"outputs: {label} and {seen[chip, output]} share [{chip}, {output}]")
            seen[chip, output] = label

    def _override(self, name: str, text: str) -> None:
        known = [key.name for key in KEYS]
        if name not in known:
            self.mistakes.append(f"set={name}: no such number{near(name, known)}")
            return
        try:
            self.entries[name] = Entry(name, float(text), "assumed", FROM_ADDRESS)
        except ValueError:
            self.mistakes.append(f"set={name}:{text}: {text!r} is not a number")

    def _ranges(self) -> None:
        for key in KEYS:
            entry = self.entries.get(key.name)
            if entry and not (isfinite(entry.value) and key.least <= entry.value <= key.most):
                what = f"{key.name} is {entry.value:g}, it must be {key.range}"
                if entry.source == FROM_ADDRESS:
                    self.mistakes.append(f"set={key.name}: {what}")
                else:
                    self._say(key.name, what)
        names = [f"coils.{end}_degc" for end in RISING]
        values = [self.entries[name].value for name in names if name in self.entries]
        if len(values) == len(names) and not values[0] < values[1] <= values[2] < values[3]:
            self._say(names[0], f"the temperatures must rise: {', '.join(names)}")


def line_numbers(text: str) -> dict[str, int]:
    """Return the line number of each `section.key`, `key` above the sections, and `[section]`."""
    found: dict[str, int] = {}
    section = ""
    for number, line in enumerate(text.splitlines(), 1):
        if match := re.match(r"\s*\[([\w.-]+)\]", line):
            section = match[1]
            found.setdefault(f"[{section}]", number)
        elif match := re.match(r"\s*([\w-]+)\s*=", line):
            found.setdefault(f"{section}.{match[1]}" if section else match[1], number)
    return found


def unit_of(key: str) -> str:
    """Return the longest unit that the key ends in, or nothing."""
    return max((unit for unit in UNITS if key.endswith(f"_{unit}")), key=len, default="")


def near(word: str, known: Collection[str]) -> str:
    """Return "; did you mean X?" if one of the known words is like it."""
    match = get_close_matches(word, sorted(known), 1)
    return f"; did you mean {match[0]}?" if match else ""


def is_number(value: object) -> bool:
    """Return whether this is a number of TOML, and no whole number beyond what can be counted with."""
    return isinstance(value, float) or (type(value) is int and abs(value) < 1 << 63)
