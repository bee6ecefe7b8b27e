"""Fault files: what goes wrong on a bench and when, declared in TOML, with a seed for what is left to chance.

    seed = 1

    [[fault]]
    name = "coil-open:A"        # a name of hil_sim/faults/table.py, with what stands after its colon
    at_ms = [1000, 5000]        # a time of the bench's clock, or two between which the seed draws one
    for_ms = 500                # only where the fault can end; a range is drawn, too

A file with an unknown key or a value that cannot be is refused with all its mistakes, each as file:line and what is
allowed. The same file gives the same faults at the same microseconds in each run and on each machine.
"""

import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from random import Random
from typing import Any

from hil_sim.bench import Bench
from hil_sim.faults.happening import Happening, schedule
from hil_sim.faults.table import read
from hil_sim.spelling import near

TOP = ("seed", "fault")
KEYS = ("name", "at_ms", "for_ms")
SEED_MAX = 2**32 - 1
TIME_MAX_MS = 86_400_000
SCRIPTED = "faults"  # where a mistake stands that is in no file


class FaultFileError(ValueError):
    """A fault file that cannot be used; the text has one line for each mistake."""


@dataclass(frozen=True)
class Planned:
    """One fault of a file, its times drawn."""

    name: str
    at_us: int
    for_us: int | None
    seed: str  # of what it draws while it lasts
    place: str  # file:line


def load(path: Path) -> list[Planned]:
    """Return what a file plans; FaultFileError tells all that is wrong with it."""
    try:
        text = path.read_text(encoding="utf-8")
        data = tomllib.loads(text)
    except OSError as error:
        raise FaultFileError(f"{path}: {error.strerror or error}") from None
    except (UnicodeDecodeError, RecursionError, tomllib.TOMLDecodeError) as error:
        raise FaultFileError(f"{path}: not TOML: {error}") from None
    return planned(data, str(path), line_numbers(text))


def planned(data: Mapping[str, Any], path: str = SCRIPTED, lines: Mapping[str, int] | None = None) -> list[Planned]:
    """Return what the tables of a fault file plan; FaultFileError tells all that is wrong with them."""
    check = _Check(path, lines or {})
    check.known("", data, TOP)
    seed = check.whole("", data, "seed", 1, SEED_MAX)
    faults = data.get("fault", [])
    if not isinstance(faults, list) or not all(isinstance(fault, dict) for fault in faults):
        check.say("fault", "fault: write each under [[fault]]")
        faults = []
    plans = [check.fault(index, fault, seed) for index, fault in enumerate(faults)]
    if check.mistakes:
        raise FaultFileError("\n".join(check.mistakes))
    return plans


def plan(bench: Bench, plans: Sequence[Planned]) -> list[Happening]:
    """Let all of it happen on a bench; FaultFileError when that has no such coil or part."""
    mistakes: list[str] = []
    happenings: list[Happening] = []
    for one in plans:
        try:
            happenings.append(schedule(bench, one.at_us, one.name, one.for_us, one.seed))
        except ValueError as error:
            mistakes.append(f"{one.place}: {error}")
    if mistakes:
        raise FaultFileError("\n".join(mistakes))
    return happenings


def line_numbers(text: str) -> dict[str, int]:
    """Return the line of each `key` above the tables, of the n-th [[fault]] as `n` and of its keys as `n.key`."""
    found: dict[str, int] = {}
    table, count = "", 0
    for number, line in enumerate(text.splitlines(), 1):
        if re.match(r"\s*\[", line):
            table, count = (str(count), count + 1) if re.match(r"\s*\[\[\s*fault\s*\]\]", line) else ("?", count)
            found.setdefault(table, number)
            if name := re.match(r"\s*\[+\s*([\w.-]+)", line):
                found.setdefault(name[1], number)
        elif match := re.match(r"\s*([\w-]+)\s*=", line):
            found.setdefault(f"{table}.{match[1]}" if table else match[1], number)
    return found


class _Check:
    """Reads values and notes in `mistakes` what is wrong with them, and where."""

    def __init__(self, path: str, lines: Mapping[str, int]) -> None:
        self.mistakes: list[str] = []
        self._path = path
        self._lines = lines

    def place(self, key: str) -> str:
        """Return file:line of a key, else of its table."""
        line = self._lines.get(key) or self._lines.get(key.partition(".")[0], 1)
        return f"{self._path}:{line}"

    def say(self, key: str, what: str) -> None:
        """Note a mistake."""
        self.mistakes.append(f"{self.place(key)}: {what}")

    def known(self, table: str, data: Mapping[str, Any], keys: Sequence[str]) -> None:
        """Note each key that there is not."""
        for key in data:
            if key not in keys:
                where = f"{table}.{key}" if table else key
                self.say(where, f"unknown key {key}: known are {', '.join(keys)}{near(key, keys)}")

    def whole(self, table: str, data: Mapping[str, Any], key: str, default: int, most: int) -> int:
        """Return a whole number from 0 to `most`."""
        value = data.get(key, default)
        if type(value) is int and 0 <= value <= most:
            return value
        self.say(f"{table}.{key}" if table else key, f"{key} is {value!r}, it must be a whole number up to {most}")
        return default

    def fault(self, index: int, data: Mapping[str, Any], seed: int) -> Planned:
        """Return one fault."""
        table, name = str(index), data.get("name")
        self.known(table, data, KEYS)
        drawn = f"{seed}/{index}/{name}"
        at_us = self._time(table, data, "at_ms", Random(f"{drawn}/at"))
        for_us = self._time(table, data, "for_ms", Random(f"{drawn}/for")) if "for_ms" in data else None
        for key, what in _of_the_name(name, for_us):
            self.say(f"{table}.{key}", what)
        return Planned(str(name), at_us, for_us, drawn, self.place(f"{table}.name"))

    def _time(self, table: str, data: Mapping[str, Any], key: str, draw: Random) -> int:
        """Return a time in us, drawn where two are given."""
        value: Any = data.get(key)
        times = value if isinstance(value, list) and len(value) == 2 else [value, value]
        if key not in data:
            self.say(table, f"a fault lacks {key}: write {key} = 1000, or a range as in {key} = [1000, 5000]")
        elif not all(type(time) in (int, float) and 0 <= time <= TIME_MAX_MS for time in times):
            self.say(f"{table}.{key}", f"{key} is {value!r}, it must be a time or two, up to {TIME_MAX_MS} ms")
        elif times[0] > times[1]:
            self.say(f"{table}.{key}", f"{key} is {value!r}: the earlier time comes first")
        else:
            return draw.randint(round(times[0] * 1000), round(times[1] * 1000))
        return 0


def _of_the_name(name: object, for_us: int | None) -> Iterator[tuple[str, str]]:
    """Yield key and words for what is wrong with a fault's name, and with giving an end to it."""
    if not isinstance(name, str):
        yield "name", 'a fault lacks its name: write name = "coil-open:A"'
        return
    try:
        fault, _ = read(name)
    except ValueError as error:
        yield "name", str(error)
        return
    if for_us is not None and not fault.ends:
        yield "for_ms", f"for_ms: fault {name} does not last, so it cannot end"
