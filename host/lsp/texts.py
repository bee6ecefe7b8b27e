"""The texts that an editor has open, by the path under which scripts include them; all others are read from disk.

texts = Texts()
texts.put("file:///home/me/crawl.gait", "gait 1\\r\\n", 3)
texts.read("/home/me/crawl.gait")              # "gait 1\\n"
"""

from __future__ import annotations

import os
from dataclasses import dataclass

from pygls.uris import from_fs_path, to_fs_path

from host.gait.script import read_text


@dataclass(frozen=True, slots=True)
class Text:
    """One open text: as the editor has it, its number among the versions, and its lines."""

    uri: str
    source: str
    version: int

    @property
    def lines(self) -> list[str]:
        """Return the lines as the parser numbers them, without their ends."""
        return plain(self.source).split("\n")

    @property
    def line_end(self) -> str:
        """Return what this text ends its lines with."""
        return "\r\n" if "\r\n" in self.source else "\n"


class Texts:
    """All open texts; what is not open is read from disk, and raises OSError or ValueError as there."""

    def __init__(self) -> None:
        self._open: dict[str, Text] = {}
        self.state = 0  # another number as soon as any text may be another

    def put(self, uri: str, source: str, version: int) -> str:
        """Keep the newest state of a text and return its path."""
        path = path_of(uri)
        self.state += 1
        self._open[path] = Text(uri, source, version)
        return path

    def drop(self, uri: str) -> str:
        """Forget a text that the editor has closed and return its path."""
        self.state += 1
        self._open.pop(path_of(uri), None)
        return path_of(uri)

    def get(self, path: str) -> Text | None:
        """Return an open text."""
        return self._open.get(path)

    def paths(self) -> list[str]:
        """Return the paths of all open texts."""
        return list(self._open)

    def read(self, path: str) -> str:
        """Return a text with plain line ends, open or on disk."""
        text = self._open.get(path)
        return plain(text.source) if text else read_text(path)

    def uri(self, path: str) -> str:
        """Return the address of a file, as the editor wrote it if it did."""
        text = self._open.get(path)
        return text.uri if text else from_fs_path(os.path.abspath(path)) or path


def path_of(uri: str) -> str:
    """Return the path of an address; what is no file is known by its address."""
    path = to_fs_path(uri) if uri.startswith("file:") else None
    return os.path.normpath(path) if path else uri


def plain(source: str) -> str:
    """Return a text whose lines end as the parser has them."""
    return source.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n")
