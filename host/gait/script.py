"""A script with everything it includes: files in, trees out.

script = load("gaits/circular-crawl.gait")
script.robot_name()                            # "circular", or GaitError with all that is wrong
"""

from __future__ import annotations

import errno
import os
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from host.gait.diagnostics import Diagnostic, GaitError, Problems
from host.gait.reading.lines import LINE_MAX, LINES_MAX
from host.gait.reading.parser import parse_file
from host.gait.tree import Broken, File, Include, Place, Robot, Statement

BYTES_MAX = LINES_MAX * LINE_MAX
INCLUDES_MAX = 50  # that stand in each other

Read = Callable[[str], str]


@dataclass(frozen=True, slots=True)
class Script:
    """The main file, and all files with the included before those that include them; `found` is what is wrong."""

    main: File
    files: tuple[File, ...]
    found: tuple[Diagnostic, ...]

    @property
    def robot(self) -> Robot | None:
        """Return the `robot` statement of the main file, or None."""
        return next((item for item in self.main.statements if isinstance(item, Robot)), None)

    def robot_name(self) -> str:
        """Return the name of the robot the script is for, or raise GaitError with all that is wrong."""
        if self.robot is None:
            problems = Problems(self.files, self.found)
            if not self.found:
                problems.add(Place(self.main.name, 1, 1, 2), "E110", "the script names no robot")
            problems.raise_any()
        assert self.robot is not None
        return self.robot.name

    def unread_words(self) -> set[str]:
        """Return every word on a line that could not be read: what it declares cannot be called unknown."""
        return {
            word
            for file in self.files
            for item in walk(file.statements)
            if isinstance(item, Broken)
            for word in re.findall(r"\w+", file.line(item.place.line))
        }


def load(path: str | Path, read: Read | None = None) -> Script:
    """Return the script in the file `path`; mistakes of form are kept in `found` for the compiler to report."""
    loader = _Loader(read or read_text)
    main = loader.file(str(path), None)
    if main is None:
        raise GaitError(loader.found)
    return Script(main, tuple(loader.files.values()), tuple(loader.found))


def loads(text: str, name: str = "script.gait", read: Read | None = None) -> Script:
    """Return the script in `text`; what it includes is read from files named relative to `name`."""
    others = read or read_text
    return load(name, lambda path: text if path == name else others(path))


def read_text(path: str) -> str:
    """Return the text of a file, or raise OSError or ValueError; a device that never ends is too large."""
    with Path(path).open("rb") as file:
        return as_text(file.read(BYTES_MAX + 1))


def as_text(data: bytes) -> str:
    """Return the text of a file that holds these bytes, or raise OSError or ValueError."""
    if len(data) > BYTES_MAX:
        raise OSError(errno.EFBIG, f"it is larger than {BYTES_MAX} bytes")
    return data.decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")


def walk(statements: tuple[Statement, ...]) -> list[Statement]:
    """Return these statements and all within them, in the order of the text."""
    found: list[Statement] = []
    for item in statements:
        found.append(item)
        found += walk(getattr(item, "body", ()))
    return found


@dataclass
class _Loader:
    read: Read
    files: dict[str, File] = field(default_factory=dict)
    found: list[Diagnostic] = field(default_factory=list)
    open: list[str] = field(default_factory=list)

    def file(self, path: str, included: tuple[File, Place] | None) -> File | None:
        """Read a file and what it includes, unless that was done; None if it cannot be read."""
        if path in self.open:
            self._complain(included, "E170", f"`{path}` includes itself: {' -> '.join([*self.open, path])}", path)
            return None
        if path in self.files:
            return self.files[path]
        if len(self.open) > INCLUDES_MAX:
            self._complain(included, "E114", f"more than {INCLUDES_MAX} files that include one another", path)
            return None
        try:
            text = self.read(path)
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or "it is not UTF-8 text"
            help = "its path begins at the folder of the script that includes it" if included else ""
            self._complain(included, "E115", f"`{path}` cannot be read: {reason}", path, help)
            return None
        file, found = parse_file(text, path)
        self.found += found
        self.open.append(path)
        for item in file.statements:
            if isinstance(item, Include):
                self.file(os.path.normpath(os.path.join(os.path.dirname(path), item.path)), (file, item.place))
        self.open.pop()
        self.files[path] = file
        return file

    def _complain(
        self, included: tuple[File, Place] | None, code: str, message: str, path: str, help: str = ""
    ) -> None:
        place = included[1] if included else Place(path, 1, 1, 2)
        line = included[0].line(place.line) if included else ""
        self.found.append(Diagnostic(place, code, message, help, line))
