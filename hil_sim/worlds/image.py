"""The image on the emulated flash: every file by its path, as `softrig deploy` puts them on a board.

    boot.py main.py                                  what the board runs after each reset
    a/firmware/... a/protocol/... a/robot.json       one slot; b/... would be the other

Folders are read as files and never imported, so a bench can run any version of them. A file is compiled once per
process, however many boards run it.

    image = Image.installed(profile_text)
    image.read("a/robot.json")
"""

import importlib.util
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from types import CodeType

AT_ROOT = {"firmware/boot.py": "boot.py", "firmware/start.py": "main.py"}
PACKAGES = ("firmware", "protocol")
KINDS = (".py", ".txt")  # of the files of a package that a board needs
PROFILE = "robot.json"
SLOT = "a"


class Image:
    """Files by their path on the flash, such as `a/firmware/main.py`, read when the image is made."""

    def __init__(self, files: Mapping[str, bytes | Path]) -> None:
        self._origins = {path: str(place) for path, place in files.items() if isinstance(place, Path)}
        self._files = {path: file.read_bytes() if isinstance(file, Path) else file for path, file in files.items()}
        self._folders = {str(folder) for path in files for folder in Path(path).parents}

    @classmethod
    def installed(cls, profile: bytes) -> "Image":
        """Return the image of the installed firmware in slot a, with a robot's profile."""
        files: dict[str, bytes | Path] = {f"{SLOT}/{PROFILE}": profile}
        for package in PACKAGES:
            folder = _folder(package)
            for place in sorted(place for place in folder.rglob("*") if place.suffix in KINDS):
                path = f"{package}/{place.relative_to(folder).as_posix()}"
                files[AT_ROOT.get(path) or f"{SLOT}/{path}"] = place
        return cls(files)

    @classmethod
    def of_folder(cls, folder: Path) -> "Image":
        """Return the image that a folder holds, laid out as a flash is."""
        return cls({place.relative_to(folder).as_posix(): place for place in folder.rglob("*") if place.is_file()})

    def paths(self) -> list[str]:
        """Return the path of every file, in order."""
        return sorted(self._files)

    def read(self, path: str) -> bytes:
        """Return a file's bytes; OSError(2, "ENOENT") as on the board when there is none."""
        try:
            return self._files[path.lstrip("/")]
        except KeyError:
            raise OSError(2, "ENOENT") from None

    def code(self, path: str) -> CodeType | None:
        """Return the compiled code of a .py file, or None when there is no such file."""
        path = path.lstrip("/")
        source = self._files.get(path)
        return None if source is None else _compiled(self._origins.get(path, path), source)

    def has_folder(self, path: str) -> bool:
        """Return whether there is such a folder: MicroPython imports one also without __init__.py."""
        return path.lstrip("/") in self._folders


def _folder(name: str) -> Path:
    spec = importlib.util.find_spec(name)
    if spec is None or not spec.submodule_search_locations:
        raise LookupError(f"the package {name!r} is not installed: the bench has no firmware to run")
    return Path(next(iter(spec.submodule_search_locations)))


@cache
def _compiled(name: str, source: bytes) -> CodeType:
    return compile(source, name, "exec", dont_inherit=True)
