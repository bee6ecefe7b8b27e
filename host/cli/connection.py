"""A connected robot for the length of a command."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from host.cli.options import given_key
from host.link import open_link
from host.robot import Robot


@contextmanager
def connected(address: str, watch_only: bool = False, key: bytes | None = None) -> Iterator[Robot]:
    """Open the line, say hello, and leave with everything off; Ctrl-C sends stop and waits for the answer.

    Without a `key` it is that which the command was given, if any.
    """
    secret = given_key() if key is None else key
    with Robot(open_link(address), key=secret) as robot:
        robot.connect(watch_only)
        yield robot
