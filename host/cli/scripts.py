"""A script held against the limits of a connected robot, as `check`, `run` and `figure` need it."""

from __future__ import annotations

from collections.abc import Sequence

from host.gait.checker import check
from host.gait.compiler import Compiled, compile_script
from host.gait.diagnostics import GaitError
from host.gait.script import Script
from host.gait.verdict import Report
from host.profile import Profile


def place(script: Script, robot: str | None) -> str:
    """Return the address that was given, or else the script's own robot on the bench."""
    return f"sim:{script.robot_name()}" if robot is None else robot


def proven(script: Script, profile: Profile, overrides: Sequence[str] = ()) -> tuple[Compiled, Report]:
    """Return the program and its worst case; GaitError lists what is wrong, or every limit it would break."""
    compiled = compile_script(script, profile, overrides)
    report = check(compiled)
    if not report.sound:
        raise GaitError(report.diagnostics)
    return compiled, report
