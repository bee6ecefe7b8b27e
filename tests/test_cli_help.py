"""`softrig --help` is quick: it imports nothing that it does not print."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

from host.cli import COMMANDS, main, plugins

HEAVY = {
    "numpy",
    "numba",
    "lark",
    "rich",
    "serial",
    "mcap",
    "matplotlib",
    "can",
    "greenlet",
    "hil_sim.command",
    "importlib.metadata",
}
LIST_MODULES = """
import atexit, sys
atexit.register(lambda: print(*sys.modules, sep="\\n"))
from host.cli import main
main(["--help"])
"""


@pytest.fixture(scope="module")
def shown() -> str:
    """What --help prints, followed by the modules it imported."""
    return subprocess.run([sys.executable, "-c", LIST_MODULES], capture_output=True, text=True, check=True).stdout


def test_help_imports_nothing_heavy(shown):
    assert not HEAVY & set(shown.splitlines())


def test_help_imports_no_command(shown):
    assert not {f"host.cli.{name}" for name in COMMANDS} & set(shown.splitlines())


def test_help_lists_every_command_with_what_it_does(shown):
    assert all(f"  {name} " in shown and help_text in shown for name, help_text in COMMANDS.items())


def test_commands_of_other_packages_are_listed_with_their_own_words(shown):
    assert "sim Run robots on the bench" in " ".join(shown.split())
    assert "robots List the robots" in " ".join(shown.split())


def test_every_command_has_a_file_of_its_own_name():
    files = {path.stem for path in Path(plugins.__file__).parent.glob("*.py")}

    assert set(COMMANDS) <= files
    assert all(main.get_command(None, name).name == name for name in COMMANDS)


def test_no_command_catches_an_exception():
    for name in set(COMMANDS) - {"log"}:  # log names the table that cannot be written
        tree = ast.parse((Path(plugins.__file__).parent / f"{name}.py").read_text())

        assert not [node for node in ast.walk(tree) if isinstance(node, ast.Try)], name


def test_a_plugin_that_cannot_be_imported_is_still_listed(monkeypatch):
    monkeypatch.setattr(plugins, "points", lambda: {"broken": "no_such_package.command:broken"})

    assert plugins.names() == ["broken"]
    assert plugins.summary("broken") == "Added by no_such_package.command."
