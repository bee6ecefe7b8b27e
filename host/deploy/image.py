"""The files that a board gets: those of a slot by their path in it, and the two at the root of its flash.

image = Image("circular")
image.slot["firmware/main.py"], image.root["boot.py"]
"""

from __future__ import annotations

import importlib.util
from pathlib import Path

from host.errors import BadRequest

AT_ROOT = {"firmware/boot.py": "boot.py", "firmware/start.py": "main.py"}
PACKAGES = ("firmware", "protocol")
KINDS = (".py", ".txt")  # of the files of a package that a board needs
PROFILE = "robot.json"


class Image:
    """The installed firmware with the profile of one robot: the name of one, or the path of a profile."""

    def __init__(self, robot_name: str) -> None:
        self.slot = {PROFILE: _profile(robot_name).read_bytes()}
        self.root: dict[str, bytes] = {}
        for package in PACKAGES:
            folder = _folder(package)
            for place in sorted(place for place in folder.rglob("*") if place.suffix in KINDS):
                path = f"{package}/{place.relative_to(folder).as_posix()}"
                if path in AT_ROOT:
                    self.root[AT_ROOT[path]] = place.read_bytes()
                else:
                    self.slot[path] = place.read_bytes()


def robot_names() -> list[str]:
    """Return the names of the robots whose profiles are installed."""
    return sorted(place.stem for place in _folder("firmware").glob("robots/*.json"))


def _profile(robot_name: str) -> Path:
    named = Path(robot_name)
    if named.suffix == ".json":
        if not named.is_file():
            raise BadRequest(f"there is no profile {robot_name}")
        return named
    if robot_name not in robot_names():
        raise BadRequest(f"no robot {robot_name!r}: write {', '.join(robot_names())}, or the path of a profile (.json)")
    return _folder("firmware") / "robots" / f"{robot_name}.json"


def _folder(package: str) -> Path:
    spec = importlib.util.find_spec(package)
    if spec is None or not spec.submodule_search_locations:
        raise BadRequest(f"the package {package!r} is not installed: there is no firmware to deploy")
    return Path(next(iter(spec.submodule_search_locations)))
