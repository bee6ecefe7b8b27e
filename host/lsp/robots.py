"""The robots that scripts are for: each is asked once for its profile, through its address, as `softrig check` does.

A robot that cannot be reached is not asked again at every key: `forget_lost` lets the next look try again.
"""

from __future__ import annotations

import json
from contextlib import redirect_stdout
from io import StringIO

from host.cli import plugins
from host.errors import SoftrigError
from host.link import open_link
from host.profile import Profile
from host.robot import Robot


class Robots:
    """Profiles by address; `key` is the pairing key of robots that have one."""

    def __init__(self, key: bytes = b"") -> None:
        self._key = key
        self._profiles: dict[str, Profile] = {}
        self._lost: dict[str, str] = {}
        self._names: list[str] | None = None

    def ask(self, address: str) -> Profile | str:
        """Return the profile of the robot at `address`, or why there is none."""
        if address not in self._profiles and address not in self._lost:
            try:
                with Robot(open_link(address), key=self._key) as robot:
                    robot.connect(watch_only=True)
                    self._profiles[address] = robot.profile
            except SoftrigError as error:
                self._lost[address] = str(error)
        return self._profiles.get(address) or self._lost[address]

    def known(self, address: str | None) -> Profile | None:
        """Return the profile of a robot that has been asked already."""
        return self._profiles.get(address or "")

    def forget_lost(self) -> None:
        """Let robots that could not be reached be asked again."""
        self._lost.clear()

    def names(self) -> list[str]:
        """Return the names of the robots of the bench, if one is installed."""
        if self._names is None:
            self._names = _names()
        return self._names


def _names() -> list[str]:
    """Return what the command `softrig robots` lists."""
    try:
        command = plugins.load("robots")
        if command is None:
            return []
        with redirect_stdout(StringIO()) as told:
            command.main(["--json"], standalone_mode=False)
        return [str(json.loads(line)["robot"]) for line in told.getvalue().splitlines()]
    except (SoftrigError, RuntimeError, OSError, ValueError, KeyError):
        return []
