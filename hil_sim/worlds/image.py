"""The image on the emulated flash: the firmware's and the protocol's folders, and the robot's profile.

Folders are read as files and never imported, so a bench can run any version of them. A file is compiled once per
process, however many boards run it.

    image = Image.installed(profile_text)
    image.read("robot.json")
"""

import importlib.util
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from types import CodeType

PACKAGES = ("firmware", "protocol")
PROFILE = "robot.json"


class Image:
    """Files by their path on the flash, such as `firmware/main.py`."""

    def __init__(self, roots: Sequence[Path], files: Mapping[str, bytes] | None = None) -> None:
        self._roots = {root.name: root for root in roots}
        self._files = dict(files or {})

    @classmethod
    def installed(cls, profile: bytes) -> "Image":
        """Return the image of the installed firmware with a robot's profile on it."""
        return cls([_folder(name) for name in PACKAGES], {PROFILE: profile})

    def read(self, path: str) -> bytes:
        """Return a file's bytes; OSError(2, "ENOENT") as on the board when there is none."""
        if path.lstrip("/") in self._files:
            return self._files[path.lstrip("/")]
        place = self._place(path)
        if place is None or not place.is_file():
            raise OSError(2, "ENOENT")
        return place.read_bytes()

    def code(self, path: str) -> CodeType | None:
        """Return the compiled code of a .py file, or None when there is no such file."""
        place = self._place(path)
        if place is None or not place.is_file():
            return None
        return _compiled(place, place.stat().st_mtime_ns)

    def has_folder(self, path: str) -> bool:
        """Return whether there is such a folder: MicroPython imports one also without __init__.py."""
        place = self._place(path)
        return place is not None and place.is_dir()

    def _place(self, path: str) -> Path | None:
        top, _, rest = path.lstrip("/").partition("/")
        root = self._roots.get(top)
        return root / rest if root is not None and ".." not in rest.split("/") else None


def _folder(name: str) -> Path:
    spec = importlib.util.find_spec(name)
    if spec is None or not spec.submodule_search_locations:
        raise LookupError(f"the package {name!r} is not installed: the bench has no firmware to run")
    return Path(next(iter(spec.submodule_search_locations)))


@cache
def _compiled(place: Path, _changed_ns: int) -> CodeType:
    return compile(place.read_bytes(), str(place), "exec", dont_inherit=True)
