"""A connected robot for the length of a command."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from host.link import open_link
from host.robot import Robot


@contextmanager
def connected(address: str, watch_only: bool = False) -> Iterator[Robot]:
    """Open the line, say hello, and leave with every coil off; Ctrl-C sends stop and waits for the answer."""
    with Robot(open_link(address)) as robot:
        robot.connect(watch_only)
        yield robot
