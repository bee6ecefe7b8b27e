"""The numpydoc of the physics: names and order are those of the signature, and every number has its unit."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

PHYSICS = Path(__file__).parent.parent / "hil_sim" / "physics"
HAND = PHYSICS / "hand"
HEADING = re.compile(r"^(\w+)\n-{3,}\n", re.MULTILINE)
ENTRY = re.compile(r"^(\S.*)\n((?:    .*(?:\n|$))+)", re.MULTILINE)
NUMBER = re.compile(r"(int|float|(tuple of |sequence of )?(float|array))\b")
UNIT = re.compile(r"\[[^\]]+\]")
SCRATCH = re.compile(r"Scratch|[Ww]orkspace")
NO_TABLE = ("str", "None", "HandError")  # what words or refusals come back from says all in a sentence


def functions(folder: Path) -> Iterator[tuple[str, ast.FunctionDef]]:
    """Yield module.name and the code of all public functions below a folder."""
    for path in sorted(folder.rglob("*.py")):
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
                yield f"{path.parent.name}.{path.stem}.{node.name}", node


def tables(node: ast.FunctionDef) -> dict[str, list[tuple[str, str]]]:
    """Return the entries of each section of a docstring: its head, and what is said below it."""
    parts = HEADING.split(ast.get_docstring(node) or "")[1:]
    return {title: ENTRY.findall(body) for title, body in zip(parts[::2], parts[1::2], strict=True)}


def arguments(node: ast.FunctionDef) -> list[str]:
    """Return the names of a function's arguments."""
    every = (*node.args.posonlyargs, *node.args.args, node.args.vararg, *node.args.kwonlyargs)
    return [argument.arg for argument in every if argument]


def imported(folder: Path) -> set[str]:
    """Return module.name of all that is imported from a folder's modules, there and elsewhere."""
    taken = set()
    for path in PHYSICS.parent.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and f".{folder.name}." in str(node.module):
                taken |= {f"{folder.name}.{str(node.module).rpartition('.')[2]}.{each.name}" for each in node.names}
    return taken


EVERY = dict(functions(PHYSICS))
TABLED = [name for name, node in EVERY.items() if "Parameters" in tables(node)]
TAKEN = imported(HAND)


@pytest.mark.parametrize("name", TABLED)
def test_a_table_of_parameters_follows_the_signature(name):
    heads = [head.partition(" : ")[0] for head, _ in tables(EVERY[name])["Parameters"]]

    assert [each for head in heads for each in head.split(", ")] == arguments(EVERY[name])


@pytest.mark.parametrize("name", TABLED)
def test_every_number_in_and_out_of_the_physics_has_its_unit(name):
    """A workspace, which holds numbers of all kinds, needs none."""
    entries = tables(EVERY[name])
    given = [(head.partition(" : ")[2], text) for head, text in entries["Parameters"]]
    numbers = [text for kind, text in (*given, *entries.get("Returns", [])) if NUMBER.match(kind)]

    assert [text for text in numbers if not UNIT.search(text) and not SCRATCH.search(text)] == []


@pytest.mark.parametrize("name", [name for name, _ in functions(HAND) if name in TAKEN])
def test_what_other_modules_take_from_the_fingers_has_its_tables(name):
    node = EVERY[name]
    if ast.unparse(node.returns or ast.Constant(None)) not in NO_TABLE:
        assert {"Parameters", "Returns"} <= set(tables(node))


def test_the_fingers_say_where_their_equations_are_from_and_tested():
    for path in HAND.glob("*.py"):
        doc = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
        if ".. math::" in doc:
            assert re.search(r"\([A-Z]\d\)", doc), f"{path.name}: its equations have no labels"
            assert re.search(r"[Dd]erived here|Source: ", doc), f"{path.name}: where are its equations from?"
            assert "tests/test_physics_hand_" in doc, f"{path.name}: where are its equations tested?"
