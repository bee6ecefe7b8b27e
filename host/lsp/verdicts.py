"""What is wrong with a script, as an editor is told: the mistakes of host.gait, for the script's own robot.

A file that names no robot and only declares is a library: what it does is said by the scripts that include it.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from host.gait import tree
from host.gait.checker import check
from host.gait.compiler import Compiled, compile_script
from host.gait.diagnostics import Diagnostic, GaitError
from host.gait.forecast import foretell
from host.gait.script import Read, Script, loads
from host.gait.tree import Place
from host.gait.working.declare import DECLARATIONS
from host.lsp.standin import of_the_language, stand_in
from host.profile import Profile


@dataclass(frozen=True, slots=True)
class Unasked:
    """Why the limits of a script's robot are not known, and where the script names it."""

    place: Place
    reason: str


@dataclass(frozen=True, slots=True)
class Verdict:
    """What there is to say about a script; `sound` is its program when nothing is wrong with it so far."""

    found: tuple[Diagnostic, ...]
    unasked: Unasked | None = None
    sound: Compiled | None = None


def read_script(path: str, read: Read) -> Script:
    """Return the script at `path`; one that cannot be read has no statements."""
    try:
        text = read(path)
    except (OSError, ValueError):
        text = ""
    return loads(text, path, read)


def is_library(script: Script) -> bool:
    """Return whether a file is only there to be included."""
    main = script.main
    declares = any(isinstance(item, tree.Param | tree.Define | tree.Circle) for item in main.statements)
    return script.robot is None and declares and all(isinstance(item, DECLARATIONS) for item in main.statements)


def judge(script: Script, robot: Profile | str | None) -> Verdict:
    """Return the mistakes of a script for a robot, or, with the reason why it cannot be asked, those of any robot."""
    if is_library(script):
        return Verdict(script.found)
    if isinstance(robot, Profile):
        return _judged(script, robot)
    found = of_the_language(_judged(script, stand_in(script)).found)
    if robot is None:
        return Verdict(tuple(found))
    place = script.robot.place if script.robot else Place(script.main.name, 1, 1, 2)
    return Verdict(tuple(found), Unasked(place, f"limits are not checked: {robot}"))


def foretold(verdict: Verdict, address: str) -> tuple[Diagnostic, ...]:
    """Return what a model of the robot at an address foretells of a sound script: the lines that make it too hot."""
    return foretell(verdict.sound, address).diagnostics if verdict.sound else ()


def code_page(code: str) -> str | None:
    """Return the address of the page that explains a code, where the pages stand beside the package."""
    page = Path(__file__).parents[2] / "docs" / "codes.md"
    return f"{page.as_uri()}#{code.lower()}" if page.is_file() else None


def _judged(script: Script, profile: Profile) -> Verdict:
    """Return what `softrig check` would say of a script before it asks a model of the robot."""
    try:
        compiled = compile_script(script, profile)
    except GaitError as error:
        return Verdict(error.diagnostics)
    found = check(compiled).diagnostics
    return Verdict(found, sound=None if found else compiled)
