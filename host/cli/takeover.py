"""Orders to a program that another host has started: taken over as by `softrig attach`, then held or left.

A program lives as long as its host holds the lease. So who has taken it over stays, until another takes it over in
turn or Ctrl-C stops the robot; only a program that was started with `--outlive` may be left alone.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

import click

from host.cli.options import given_key
from host.cli.output import note
from host.errors import TakenOver
from host.link import open_link
from host.robot import Robot
from host.run import TELEMETRY_MS

F = TypeVar("F", bound=Callable[..., Any])
FOR_EVER_MS = 1 << 40


def leave_option(command: F) -> F:
    """Add --leave."""
    what = "Go at once: right for a program that was started with --outlive; any other ends with the lease."
    return click.option("--leave", is_flag=True, help=what)(command)


@contextmanager
def taken_over(address: str) -> Iterator[Robot]:
    """Take over the program that a robot runs; BadRequest when there is none."""
    with Robot(open_link(address), key=given_key()) as face:
        taken = face.attach()
        note(f"session {face.talk.session.number} has taken over from session {taken}")
        yield face


def hold(face: Robot, leave: bool) -> None:
    """Hold the lease until another host takes it, or leave the program alone."""
    if leave:
        face.leave_armed()
        return
    note("holding it: `softrig resume` and `softrig step` take it over; Ctrl-C stops the robot")
    face.subscribe(TELEMETRY_MS)
    try:
        for _ in face.listen(FOR_EVER_MS):
            pass
    except TakenOver as gone:
        note(str(gone))
