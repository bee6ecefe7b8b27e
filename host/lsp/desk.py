"""All open texts, what is wrong with each, and the views that questions are answered from; knows no protocol.

Nothing here is thread-safe: one worker does all of it, in turn.

    desk = Desk(Robots())
    path = desk.texts.put(uri, source, version)
    desk.judge(path, desk.robots.ask(desk.address(path)))
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from host.cli.scripts import place
from host.gait.diagnostics import Diagnostic, GaitError, in_order
from host.gait.script import Script
from host.gait.tree import Include
from host.lsp.names import Index
from host.lsp.robots import Robots
from host.lsp.texts import Texts
from host.lsp.verdicts import Unasked, Verdict, foretold, is_library, judge, read_script
from host.lsp.view import View
from host.profile import Profile


@dataclass(frozen=True, slots=True)
class _Judged:
    """A script as it was last looked at."""

    script: Script
    verdict: Verdict


class Desk:
    """The open texts and their verdicts; `robot` is the address of every script's robot, else its own on the bench."""

    def __init__(self, robots: Robots, robot: str | None = None) -> None:
        self.texts = Texts()
        self.robots = robots
        self._robot = robot
        self._judged: dict[str, _Judged] = {}
        self._names: dict[str, Index] = {}
        self._scripts: dict[str, tuple[int, Script]] = {}

    def address(self, path: str) -> str | None:
        """Return the address of the robot that a script is for, or None when it needs none or names none."""
        return self._address(self._read(path))

    def judge(self, path: str, robot: Profile | str | None) -> set[str]:
        """Look at a script anew; return the paths of the texts of which something else may be wrong now."""
        script = self._read(path)
        before = self._judged.get(path)
        self._judged[path] = _Judged(script, judge(script, robot))
        return {path, *_about(self._judged[path]), *(_about(before) if before else ())}

    def foretold(self, path: str, address: str) -> tuple[Diagnostic, ...]:
        """Return what a model of a script's robot adds to its verdict; takes a while, and changes nothing."""
        judged = self._judged.get(path)
        return foretold(judged.verdict, address) if judged else ()

    def add(self, path: str, found: tuple[Diagnostic, ...]) -> set[str]:
        """Add to what is wrong with a script; return the paths of the texts that it is said of."""
        judged = self._judged[path]
        self._judged[path] = replace(judged, verdict=replace(judged.verdict, found=(*judged.verdict.found, *found)))
        return {item.place.file for item in found}

    def forget(self, path: str) -> set[str]:
        """Leave out a script that was closed; return the paths of which something else may be wrong now."""
        judged = self._judged.pop(path, None)
        return {path, *(_about(judged) if judged else ())}

    def depending(self, path: str) -> list[str]:
        """Return the open scripts that include a text, itself among them."""
        others = [each for each, judged in list(self._judged.items()) if _includes(judged.script, path)]
        return [path, *(each for each in others if each != path)]

    def found(self, path: str) -> tuple[Diagnostic, ...]:
        """Return everything that is wrong with a text, whichever open script tells."""
        several = (judged.verdict.found for judged in self._judged.values())
        return in_order(item for found in several for item in found if item.place.file == path)

    def renew(self) -> None:
        """Take it that files on disk are others now, and that robots can be reached again."""
        self.texts.state += 1
        self.robots.forget_lost()

    def unasked(self, path: str) -> Unasked | None:
        """Return why the limits of this script's robot are not known."""
        return self._judged[path].verdict.unasked if path in self._judged else None

    def lines(self, path: str) -> list[str]:
        """Return the lines of a text, open or not; none when it cannot be read."""
        try:
            return self.texts.read(path).split("\n")
        except (OSError, ValueError):
            return []

    def view(self, path: str) -> View:
        """Return a text as it is now, within the script that it belongs to."""
        main = path
        script = self._read(path)
        if is_library(script):
            main = next((each for each in self.depending(path) if each != path), path)
            script = self._read(main)
        profile = self.robots.known(self._address(script))
        return View(path, self.lines(path), script, self._index(main, script), profile, self.found(path))

    def _read(self, path: str) -> Script:
        """Return a script as it is now, read once for each state of the texts."""
        state = self.texts.state
        if path not in self._scripts or self._scripts[path][0] != state:
            self._scripts[path] = state, read_script(path, self.texts.read)
        return self._scripts[path][1]

    def _address(self, script: Script) -> str | None:
        try:
            return None if is_library(script) else place(script, self._robot)
        except GaitError:
            return None

    def _index(self, path: str, script: Script) -> Index:
        """Return the names of a script, or of its last state that could be read."""
        last = self._names.get(path)
        if last is None or (script.main.readable and last.script is not script):
            self._names[path] = Index(script)
        return self._names[path]


def _about(judged: _Judged) -> Iterable[str]:
    """Return the paths of the files of which a verdict says something."""
    return {item.place.file for item in judged.verdict.found}


def _includes(script: Script, path: str) -> bool:
    return any(file.name == path for file in script.files) or any(
        isinstance(item, Include) and path.endswith(item.path) for item in script.main.statements
    )
