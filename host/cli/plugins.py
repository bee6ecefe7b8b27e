"""Commands of other packages, from the entry points `softrig.commands`; their names need no import.

The entry points are read from the installed packages' files directly: importlib.metadata alone would double the time
that `softrig --help` takes.
"""

from __future__ import annotations

import ast
import sys
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import click

from host.errors import BadRequest

SECTION = "[softrig.commands]"


@cache
def points() -> dict[str, str]:
    """Return `module:attribute` of every added command by its name."""
    found: dict[str, str] = {}
    for folder in sys.path:
        for file in Path(folder or ".").glob("*.*-info/entry_points.txt"):
            found = {**_section(file), **found}  # what comes first on the path wins
    return found


def names() -> list[str]:
    """Return the names of all added commands."""
    return sorted(points())


def load(name: str) -> click.Command | None:
    """Import and return an added command; None when there is none, BadRequest when it cannot be imported."""
    if name not in points():
        return None
    module, _, attribute = points()[name].partition(":")
    try:
        command: click.Command = getattr(import_module(module), attribute)
    except (ImportError, AttributeError) as error:
        raise BadRequest(f"the command {name} of {module} cannot be loaded: {error}") from error
    return command


def summary(name: str) -> str:
    """Return the first line of the command's docstring, read from its source without running it."""
    module, _, attribute = points()[name].partition(":")
    try:
        spec = find_spec(module)
        tree = ast.parse(Path(spec.origin or "").read_text(encoding="utf-8")) if spec else ast.Module([], [])
    except (OSError, ImportError, SyntaxError, ValueError):
        return f"Added by {module}."
    for node in tree.body:
        if isinstance(node, ast.FunctionDef) and node.name == attribute:
            return (ast.get_docstring(node) or "").partition("\n")[0]
    return f"Added by {module}."


def _section(file: Path) -> dict[str, str]:
    """Return the lines `name = module:attribute` of our section of one file."""
    try:
        text = file.read_text(encoding="utf-8")
    except OSError:
        return {}
    _, _, after = text.partition(f"{SECTION}\n")
    lines = after.partition("\n[")[0].splitlines()
    pairs = [line.partition("=") for line in lines if "=" in line]
    return {name.strip(): value.split("[")[0].strip() for name, _, value in pairs}
