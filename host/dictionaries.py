"""The dictionaries of robots met before, kept by their checksum, so that a known robot is connected at once.

They lie in the user's cache folder, XDG_CACHE_HOME/softrig or ~/.cache/softrig, and are only ever trusted when length
and CRC-32 are those that the robot names. A folder that cannot be written, or a file that is damaged, costs a reading
of the robot's own and is no error.

    dictionaries = Dictionaries(cache_folder())
    text = dictionaries.find(identity.dictionary_crc, identity.dictionary_bytes)
"""

from __future__ import annotations

import os
import tempfile
from binascii import crc32
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Protocol

KEPT_MAX = 64  # dictionaries; the one not used for longest gives way
BYTES_MAX = 0xFFFF  # of a dictionary, as an identity can name it


class Known(Protocol):
    """Whoever remembers the dictionaries of robots."""

    def find(self, crc: int, size: int) -> bytes | None:
        """Return the dictionary of that checksum and length, or None."""

    def keep(self, text: bytes) -> None:
        """Remember a dictionary."""


class Unknown:
    """Remembers nothing: for a line on which every run must be like the first."""

    def find(self, crc: int, size: int) -> bytes | None:
        """Return None."""
        return None

    def keep(self, text: bytes) -> None:
        """Forget it."""


class Dictionaries:
    """Remembers dictionaries in files of `folder`; None: nowhere."""

    def __init__(self, folder: Path | None) -> None:
        self._folder = folder

    def find(self, crc: int, size: int) -> bytes | None:
        """Return the dictionary of that checksum and length, or None when there is none that is whole."""
        if self._folder is None:
            return None
        path = self._path(self._folder, crc)
        try:
            with path.open("rb") as file:
                text = file.read(BYTES_MAX + 1)
        except OSError:
            return None
        if len(text) != size or crc32(text) != crc:
            return None
        with suppress(OSError):
            os.utime(path)
        return text

    def keep(self, text: bytes) -> None:
        """Write a dictionary where `find` looks for it: as a whole or not at all."""
        if self._folder is None:
            return
        with suppress(OSError):
            self._folder.mkdir(parents=True, exist_ok=True)
            with _whole(self._path(self._folder, crc32(text))) as file:
                os.write(file, text)
            self._forget_some(self._folder)

    def _forget_some(self, folder: Path) -> None:
        files = sorted(folder.glob("*.dictionary"), key=lambda path: path.stat().st_mtime)
        for path in files[:-KEPT_MAX]:
            path.unlink(missing_ok=True)

    def _path(self, folder: Path, crc: int) -> Path:
        return folder / f"{crc:08x}.dictionary"


def cache_folder() -> Path | None:
    """Return where this user's caches lie, or None where nobody says so."""
    named = os.environ.get("XDG_CACHE_HOME", "")
    if os.path.isabs(named):  # any other is to be ignored (XDG Base Directory Specification)
        return Path(named) / "softrig"
    try:
        return Path.home() / ".cache" / "softrig"
    except RuntimeError:
        return None


@contextmanager
def _whole(path: Path) -> Iterator[int]:
    """Give a new file that takes the place of `path` once it is written."""
    file, name = tempfile.mkstemp(dir=path.parent, prefix=".new-")
    try:
        try:
            yield file
        finally:
            os.close(file)
        os.replace(name, path)
    except OSError:
        with suppress(OSError):
            os.unlink(name)
        raise
