"""Brings scripts into their one form, and makes texts of layouts; neither ever changes what a script says.

formatted(text, "crawl.gait")         # GaitError when it cannot be read
made(sheet)                           # the text of a layout that was never one
"""

from __future__ import annotations

import errno
import os
import tempfile
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from host.errors import BadRequest
from host.gait.diagnostics import Diagnostic, GaitError
from host.gait.forms.layout import Sheet, layout, same
from host.gait.forms.writer import written
from host.gait.reading.parser import parse_file
from host.gait.script import BYTES_MAX, as_text
from host.gait.tree import Place


@dataclass(frozen=True, slots=True)
class Formatted:
    """A file with its text in its one form, or with what is `wrong` with it; `exact`: it holds just the text."""

    name: str
    before: str = ""
    after: str = ""
    exact: bool = True
    wrong: tuple[Diagnostic, ...] = ()

    @property
    def changed(self) -> bool:
        """Return whether the file would be another one."""
        return not self.wrong and (self.before != self.after or not self.exact)


def tried(name: str, stream: BinaryIO | None = None) -> Formatted:
    """Return a file, or a stream that is called so, with its one form; nothing is written."""
    try:
        before, exact = read_script(name, stream)
        return Formatted(name, before, formatted(before, name), exact)
    except GaitError as error:
        return Formatted(name, wrong=error.diagnostics)


def formatted(text: str, name: str) -> str:
    """Return the text in its one form; GaitError tells why it cannot be read, or not be written within the bounds."""
    file, found = parse_file(text, name)
    if found:
        raise GaitError(found)
    return made(layout(file), name)


def made(sheet: Sheet, name: str = "script.gait") -> str:
    """Return the text of a layout, which reads as just that layout; GaitError when a line or a block is too much."""
    text = written(sheet)
    file, found = parse_file(text, name)
    if found:
        raise GaitError(map(_of_the_made, found))
    if not same(sheet, layout(file)):
        raise BadRequest(f"{name}: its text would not say the same; nothing was written")
    return text


def read_script(name: str, stream: BinaryIO | None = None) -> tuple[str, bool]:
    """Return the text of a file, or of a stream that is called so, and whether it is stored as that text exactly.

    A byte order mark and carriage returns are dropped; GaitError tells why there is no text.
    """
    try:
        data = stream.read(BYTES_MAX + 1) if stream else _bytes(Path(name))
        text = as_text(data)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "it is not UTF-8 text"
        raise GaitError([Diagnostic(Place(name, 1, 1, 2), "E115", f"`{name}` cannot be read: {reason}")]) from None
    return text, data == text.encode()


def _bytes(path: Path) -> bytes:
    if path.exists() and not path.is_file():
        raise OSError(errno.EINVAL, "it is no file")
    with path.open("rb") as file:
        return file.read(BYTES_MAX + 1)


def replace_file(path: Path, text: str) -> None:
    """Put a text in place of a file at once: whoever reads it, or stops us, finds the old one or the new one.

    What is no file, such as a pipe, is written to.
    """
    target = path.resolve()
    if path.exists() and not path.is_file():
        path.write_text(text, encoding="utf-8", newline="\n")
        return
    file, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}-")
    try:
        with open(file, "w", encoding="utf-8", newline="\n") as stream:
            stream.write(text)
        os.chmod(name, target.stat().st_mode & 0o7777 if target.exists() else 0o666 & ~_umask())
        os.replace(name, target)
    except BaseException:
        with suppress(OSError):
            os.unlink(name)
        raise


def _umask() -> int:
    """Return the mask of the rights that new files are not given; it can only be read by setting it."""
    mask = os.umask(0o077)
    os.umask(mask)
    return mask


def _of_the_made(item: Diagnostic) -> Diagnostic:
    """Return a complaint about a text that is nowhere but here: its line is told in full, with what it is about."""
    return Diagnostic(item.place, item.code, f"as it would be written: {item.message}", item.help, item.source_line)
