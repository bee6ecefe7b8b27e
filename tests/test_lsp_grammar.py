"""The colours of the language: the TextMate grammar of editors/ against the words of the language itself.

The engine is a port of VS Code's to Python, on the same library of regular expressions.
"""

import json
import re
from pathlib import Path

import pytest

from host.gait.reading.parser import grammar, parse_file
from host.gait.reading.syntax import FORMS, KEYWORDS
from host.gait.units import UNITS
from host.gait.working import sources
from host.gait.working.subjects import QUANTIFIERS

base = pytest.importorskip("textmate_grammar.parsers.base")  # no ready package for Linux on ARM

ROOT = Path(__file__).parents[1]
VSCODE = ROOT / "editors" / "vscode"
GRAMMAR = json.loads((VSCODE / "syntaxes" / "gait.tmLanguage.json").read_text(encoding="utf-8"))
EVERY_WORD = """gait 1
robot sphere-a
param hold = 15 % [12 % .. 18 %]
include "lib/push.gait"
circle roll = A00m1 A10m1
let next = roll[down + 1]
def pull(c):
    fire $c at 100 % for 2 s until 95 C ramp 20 ms overlap 5 ms
    hold A C at 80 C with 40 % for 5 s
for c in A C, B D:
    sym z 90 deg, x $k * 45 deg:
        pull($c)
together:
    repeat 3:
        press to 5 N over 1 s for 20 s
        orient 5 deg for 3 s
wait until any A B.temperature > 95 C timeout 4 s else recover
wait until down is A10m1 timeout 4 s else continue
guard force > 5 N
note "the foot is $warm"
label recover
on fault:
    move P to -2 mm over 2 s
"""


@pytest.fixture(scope="module")
def engine():
    """The engine with the grammar in it."""
    return base.LanguageParser(GRAMMAR)


def scopes(engine, text):
    """Return each part of a text that is not blank, with its innermost scopes."""
    return [(part, scopes[1:]) for _, part, scopes in engine.parse_string(text).flatten() if part.strip()]


def coloured(engine, text, prefix):
    return {part for part, found in scopes(engine, text) if any(scope.startswith(prefix) for scope in found)}


def test_the_words_are_those_of_the_grammar_of_the_language(engine):
    plain = {str(each.pattern.value) for each in grammar().terminals if each.name == each.name.strip("_")}
    words = {word for word in plain if re.fullmatch("[a-z]+", word)}

    shown = coloured(engine, EVERY_WORD, "keyword") | coloured(engine, EVERY_WORD, "storage")

    assert words == set(KEYWORDS)
    assert {word for word in shown if word.isalpha()} - set(UNITS) == words


def test_the_units_are_those_of_the_table(engine):
    text = "".join(f"wait 5 {unit}\nwait 5{unit}\n" for unit in UNITS)

    assert coloured(engine, text, "keyword.other.unit") == set(UNITS)
    assert coloured(engine, "wait 5 parsec\n", "keyword.other.unit") == set()
    assert words_of(GRAMMAR["repository"]["number"]["match"]) == {unit for unit in UNITS if unit.isalpha()}


def test_the_quantities_are_those_of_the_table(engine):
    asked = [*sources.COIL, *sources.JOINT, *sources.CELL, *sources.SUPPLY, *sources.BOARD]
    text = "".join(f"guard any.{quantity} > 5\n" for quantity in asked)
    text += "".join(f"guard {quantity} > 5\n" for quantity in sources.WHOLE) + "guard down is A\n"
    rules = json.dumps(GRAMMAR["repository"]["condition"])

    assert coloured(engine, text, "support.variable.quantity") == {*asked, *sources.WHOLE, "down"}
    assert set(re.findall("[a-z]+", re.search(r"\((temperature[|a-z]+)\)", rules)[1])) == set(asked)
    assert coloured(engine, "guard supply.current > 5\nguard board.temperature > 5\n", "support.variable.part") == set(
        sources.PARTS
    )
    assert coloured(engine, "guard any A B.heat > 5\nguard all.heat > 5\n", "constant.language") == set(QUANTIFIERS)


@pytest.mark.parametrize("script", sorted(ROOT.glob("gaits/**/*.gait")), ids=lambda path: path.stem)
def test_every_part_of_every_gait_has_a_colour_and_its_comments_are_the_parsers(engine, script):
    text = script.read_text(encoding="utf-8")

    parts = scopes(engine, text)
    bare = [part for part, found in parts if not found]
    comments = "".join(part for part, found in parts if found and found[0].startswith("comment"))

    assert bare == []
    assert comments == "".join(comment.text for comment in parse_file(text, script.name)[0].comments)


def test_words_that_came_later_may_still_be_names(engine):
    assert scopes(engine, "param hold = 15 %\n")[1] == ("hold", ["variable.parameter.gait"])
    assert ("hold", ["variable.parameter.reference.gait"]) in scopes(engine, "fire A at $hold for 2 s\n")


def test_the_extension_names_only_files_that_there_are():
    package = json.loads((VSCODE / "package.json").read_text(encoding="utf-8"))
    brackets = json.loads((VSCODE / "language-configuration.json").read_text(encoding="utf-8"))
    named = [package["main"], package["contributes"]["grammars"][0]["path"]]
    named.append(package["contributes"]["languages"][0]["configuration"])
    opens = re.compile(brackets["indentationRules"]["increaseIndentPattern"])

    assert all((VSCODE / name).is_file() for name in named)
    assert {word for word in FORMS if opens.match(f"{word} x:  # why")} == {
        "def",
        "repeat",
        "for",
        "together",
        "sym",
        "on",
    }


def words_of(pattern):
    """Return the words among the choices of a regular expression."""
    return set(re.findall(r"[A-Za-z]+", re.search(r"\((mohm[|A-Za-z]+)\)", pattern)[1]))
