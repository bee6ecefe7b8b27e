"""Compiles a gait script for one robot into the program that its sequencer runs.

compiled = compile_script(load("crawl.gait"), profile, ["duty=50%"])
compiled.program                       # header and code, as uploaded
compiled.step(event.step).text         # the line an event is about
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from host.gait.diagnostics import Problems
from host.gait.plan import Op, Step, encode
from host.gait.script import Script
from host.gait.working.bounds import hold_to_limits
from host.gait.working.expand import expand
from host.gait.working.scope import Value
from host.profile import Profile
from protocol import program


@dataclass(frozen=True, slots=True)
class Compiled:
    """A script as one robot would run it."""

    script: Script
    profile: Profile
    plan: tuple[Op, ...]
    steps: tuple[Step, ...]
    params: dict[str, Value]
    code: bytes

    @property
    def program(self) -> bytes:
        """Return the header and the code."""
        return bytes(program.header(self.code, self.profile.crc)) + self.code

    def step(self, number: int) -> Step | None:
        """Return the step of that number, or None for 0 and for numbers the script has not."""
        return self.steps[number - 1] if 0 < number <= len(self.steps) else None


def compile_script(script: Script, profile: Profile, overrides: Sequence[str] = ()) -> Compiled:
    """Return the program, or raise GaitError with everything that is wrong.

    Limits are the checker's part; but where there are mistakes, what single orders break is told with them.
    """
    problems = Problems(script.files, script.found)
    if not all(file.readable for file in script.files):
        problems.raise_any()
    expansion = expand(script, profile, overrides, problems)
    if problems.found:
        hold_to_limits((*expansion.plan, *expansion.unsound), profile, problems)
    problems.raise_any()
    code = encode(expansion.plan)
    return Compiled(script, profile, expansion.plan, expansion.steps, expansion.params, code)
