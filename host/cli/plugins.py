"""Commands of other packages, from the entry points `softrig.commands`; their names need no import."""

from __future__ import annotations

import ast
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from importlib.util import find_spec
from pathlib import Path

import click

from host.errors import BadRequest


@cache
def points() -> dict[str, EntryPoint]:
    """Return the entry points by name."""
    return {point.name: point for point in entry_points(group="softrig.commands")}


def names() -> list[str]:
    """Return the names of all added commands."""
    return sorted(points())


def load(name: str) -> click.Command | None:
    """Import and return an added command; None when there is none, BadRequest when it cannot be imported."""
    point = points().get(name)
    if point is None:
        return None
    try:
        command: click.Command = point.load()
    except (ImportError, AttributeError) as error:
        raise BadRequest(f"the command {name} of {point.module} cannot be loaded: {error}") from error
    return command


def summary(name: str) -> str:
    """Return the first line of the command's docstring, read from its source without running it."""
    module, _, attribute = points()[name].value.partition(":")
    try:
        spec = find_spec(module)
        tree = ast.parse(Path(spec.origin or "").read_text(encoding="utf-8")) if spec else ast.Module([], [])
    except (OSError, ImportError, SyntaxError, ValueError):
        return f"Added by {module}."
    for node in tree.body:
        if isinstance(node, ast.FunctionDef) and node.name == attribute:
            return (ast.get_docstring(node) or "").partition("\n")[0]
    return f"Added by {module}."
