"""The pairing key in a deployment: the robot lets its console be opened with the one it has, and is given another.

The console is shut while a robot has a key (firmware/start.py). So it is ordered on its own line to open it, once.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from host.deploy.console import Console
from host.errors import BadRequest, LinkLost, Mismatch, NoRobot, NotPaired
from host.keys import packed, read
from host.link import open_link
from host.robot import Robot

KEY = "/key"  # where firmware/pairing.py looks for it
STARTS = ("/starts.0", "/starts.1")  # how often the robot has started with it


class Keys(NamedTuple):
    """The key that a board is given, and the one that it has; b"": none is known. `unpair` takes it away."""

    new: bytes
    old: bytes
    unpair: bool

    @property
    def then(self) -> bytes:
        """Return the key that the board has in the end, as far as that is known."""
        return b"" if self.unpair else self.new or self.old


def chosen(key: str | None, old_key: str | None, unpair: bool) -> Keys:
    """Return the keys in these files; BadRequest when one cannot be read, or both is asked for."""
    if key and unpair:
        raise BadRequest("--key gives the robot a key and --unpair takes it away: choose one")
    return Keys(read(key) if key else b"", read(old_key) if old_key else b"", unpair)


def ask_for_console(address: str, keys: Keys) -> None:
    """Order the robot to open its console; NotPaired or Refused when it does not.

    One that does not answer, or not in this version, is left to what the console itself can do. Without an old key it
    may have the new one already, or none.
    """
    tries = [keys.old] if keys.old or not keys.new else [keys.new, b""]
    for key in tries:
        try:
            with Robot(open_link(address), key=key) as robot:
                robot.connect()
                robot.service()
            return
        except (NoRobot, Mismatch):
            return
        except NotPaired:
            if key is tries[-1]:
                raise


def settled(console: Console, keys: Keys) -> str:
    """Give the board its key, take it away, or leave it; return what was done, or nothing."""
    if keys.unpair:
        return "its pairing key was taken away" if KEY in _removed(console, (KEY, *STARTS)) else "it had no pairing key"
    if not keys.new:
        return ""
    if console.read(KEY) == packed(keys.new):
        return "it has its pairing key already"
    _give(console, packed(keys.new))
    return "it takes orders only with the pairing key now"


def _give(console: Console, key_file: bytes) -> None:
    """Put a key on the board at once and whole, and begin to count its starts anew."""
    console.write(f"{KEY}.new", key_file)
    if console.read(f"{KEY}.new") != key_file:
        raise LinkLost("the key on the board is not what was sent: deploy again")
    console.rename(f"{KEY}.new", KEY)
    _removed(console, STARTS)


def _removed(console: Console, paths: Iterable[str]) -> list[str]:
    """Remove those of the files that are there, and return them."""
    there = [path for path in paths if console.read(path) is not None]
    for path in there:
        console.remove(path)
    return there
