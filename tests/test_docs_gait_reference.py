"""docs/gait-reference.md says what is so: its examples are sound, its clauses and ranges are those of the compiler."""

import re
from fractions import Fraction
from typing import get_args

import pytest

from docs import gaitpage
from host.gait import tree
from host.gait.checker import check
from host.gait.compiler import compile_script
from host.gait.diagnostics import GaitError
from host.gait.script import loads, walk
from host.gait.units import Quantity
from protocol.program import disassemble
from tests.gait_scripts import ROOT, profile_of

PAGE = (ROOT / "docs" / "gait-reference.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"^```gait ?([\w-]*)\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
RANGES = [(name, word, *span) for name, of in gaitpage.CLAUSES.items() for word, (span, _) in of.items()]
# Of each statement one that is whole, with the robot that it is for.
WHOLE = {
    "fire": ("circular", "fire A at 10 % for 60 s until 90 C ramp 1 s overlap 0 s"),
    "hold": ("circular", "hold A at 60 C with 10 % for 60 s overlap 0 s"),
    "move": ("fingers", "move R to 1 deg over 60 s overlap 0 s"),
    "orient": ("fingers", "orient 1 deg for 60 s overlap 0 s"),
    "press": ("press", "press to 1 N over 1 ms for 20000 s overlap 0 s"),
    "wait_until": ("circular", "wait until A.temperature < 40 C timeout 1 s else continue"),
}


def script(robot: str, text: str):
    return loads(f"gait 1\nrobot {robot or 'circular'}\n{text}\n", str(ROOT / "gaits" / "example.gait"))


def compiled(robot: str, text: str):
    return compile_script(script(robot, text), profile_of(robot or "circular"))


def codes(robot: str, text: str) -> set[str]:
    """Return the codes of what is wrong with a script."""
    try:
        return {each.code for each in check(compiled(robot, text)).diagnostics}
    except GaitError as error:
        return {each.code for each in error.diagnostics}


@pytest.mark.parametrize(("robot", "text"), EXAMPLES)
def test_every_example_of_the_reference_is_sound(robot, text):
    assert check(compiled(robot, text)).diagnostics == ()


def test_every_statement_but_those_of_the_head_stands_in_an_example():
    there = {type(node) for robot, text in EXAMPLES for node in walk(script(robot, text).main.statements)}

    assert set(get_args(tree.Statement)) - there == {tree.Broken, tree.Include}


@pytest.mark.parametrize("name", gaitpage.CLAUSES)
def test_the_clauses_of_a_statement_are_those_of_the_grammar_and_of_its_form(name):
    rules, words = gaitpage.rules(), gaitpage.words()
    clauses = "".join(rules[part] for part in re.findall(r"\w+", rules[name]) if part.islower() and part[0] != "_")
    spelled = {words[word] for word in re.findall(r"\b[A-Z]+\b", clauses) if words.get(word, "-").isalpha()}

    assert spelled - {"else"} == set(gaitpage.CLAUSES[name])
    assert spelled <= set(gaitpage.FORMS[name].text.split())


@pytest.mark.parametrize(("name", "word", "kind", "least", "most"), RANGES)
def test_a_clause_takes_its_range_and_nothing_beyond(name, word, kind, least, most):
    robot, text = WHOLE[name]

    def wrong(number):
        value = Quantity(Fraction(number), kind)
        return "E125" in codes(robot, re.sub(rf"\b{word} -?[\d.]+ \S+", f"{word} {value}", text, count=1))

    assert [wrong(number) for number in (least - 1, least, most, most + 1)] == [True, False, False, True]


def test_a_statement_of_the_grammar_without_a_form_is_an_error(monkeypatch):
    monkeypatch.setattr(gaitpage, "FORMS", {name: form for name, form in gaitpage.FORMS.items() if name != "hold"})

    with pytest.raises(ValueError, match="hold"):
        gaitpage.fields(lambda heads, rows: "")


@pytest.mark.parametrize(
    ("robot", "turn", "named"), [("sphere-b", "z 90 deg", ("A100", "A0m10")), ("circular", "45 deg", ("A", "B"))]
)
def test_a_turn_means_the_coil_that_the_reference_says(robot, turn, named):
    code = compiled(robot, f"sym {turn}:\n    fire {named[0]} at 10 % for 100 ms").code

    (mask,) = [row[2] for row in disassemble(code) if row[1] == "fire"]

    assert profile_of(robot).named(mask) == (named[1],)
    assert re.search(rf"`sym {turn}`[^.]*`{named[0]}`[^.]*`{named[1]}`|`sym {turn}` makes `{named[1]}` of", PAGE)
