"""A script held against the limits of a connected robot, as `check`, `run` and `figure` need it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from host.gait.checker import check
from host.gait.compiler import Compiled, compile_script
from host.gait.cut import cut
from host.gait.diagnostics import GaitError
from host.gait.script import Script
from host.gait.verdict import Report
from host.profile import Profile

OF_SIZE = ("E307", "E308")  # limits of a program that the robot keeps whole: its bytes, and how deep its loops nest


def place(script: Script, robot: str | None) -> str:
    """Return the address that was given, or else the script's own robot on the bench."""
    return f"sim:{script.robot_name()}" if robot is None else robot


def proven(
    script: Script, profile: Profile, overrides: Sequence[str] = (), begin: int = 1, streamed: bool = False
) -> tuple[Compiled, Report]:
    """Return the program and its worst case; GaitError lists what is wrong, or every limit it would break.

    It begins with the step of number `begin`; one that is `streamed` need not fit into the robot.
    """
    compiled = compile_script(script, profile, overrides)
    if begin != 1:
        compiled = cut(compiled, begin)
    report = check(compiled)
    if streamed:
        sound = tuple(item for item in report.diagnostics if item.code not in OF_SIZE)
        report = replace(report, diagnostics=sound)
    if not report.sound:
        raise GaitError(report.diagnostics)
    return compiled, report
