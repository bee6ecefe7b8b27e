"""Hosts killed at random instants: in the middle of a word, of an upload, of a program, or while they listen.

The host of each death is busy with a short job of jobs.py; at its instant it neither writes nor reads any more. What
it had put on the line still arrives. Every coil must be off, and every joint limp, a lease and one step after the last
whole frame.

    row_of(17)["wrong"]                  # sentences, none when all is well
"""

from random import Random
from typing import Any

from hil_sim.link import BOOTED_US, SimLink, open_link
from host.errors import SoftrigError
from tests.jobs import JOBS, job_of, scripts_of
from tests.trials import ALONE_S, body_of, off_ms
from tests.witness import Witness

ROBOTS = ("circular", "circular", "circular", "sphere-b", "fingers", "press")
LIFE_US = 1_500_000


class Killed(BaseException):
    """The end of a host's process."""


class MortalLink(SimLink):
    """A line whose host dies at `dies_s`: not one byte is written or read from then on."""

    def __init__(self, link: SimLink, dies_s: float) -> None:
        super().__init__(link.bench)
        self._whole = link  # closing it closes the bench
        self._dies_s = dies_s

    def read(self, until_s: float) -> bytes:
        """Return what arrives; die when the time has come."""
        data = super().read(min(until_s, self._dies_s))
        if self.now_s() >= self._dies_s:
            raise Killed
        return data


def row_of(number: int) -> dict[str, Any]:
    """Return what became of the host of that number, as a flat record."""
    draw = Random(f"death {number}")
    robot = draw.choice(ROBOTS)
    scripts = [name for name in scripts_of(robot) if "cooldown" not in name]
    job = draw.choice((*JOBS, *JOBS, *scripts))
    address, dies_us = f"sim:{robot}?{body_of(robot)}seed={number}", BOOTED_US + draw.randrange(LIFE_US)
    link = MortalLink(open_link(address), dies_us / 1e6)
    bench = link.bench
    witness = getattr(bench, "witness", None) or Witness(bench)
    error = ""
    try:
        job_of(job)(link, draw, LIFE_US)
    except Killed:
        pass
    except SoftrigError as early:
        error = f"{type(early).__name__}: {early}"
    on = [history for history in witness.driven() if history and history[-1][1]]
    bench.run(ALONE_S)
    wrong = [*witness.broken(), *(f"the firmware crashed: {crash.error}" for crash in bench.crashes)]
    link.close()
    return {
        "address": address, "job": job, "fault": "a killed host", "at_us": dies_us, "on": len(on),
        "wrong": wrong, "told": "", "error": error, "off_ms": off_ms(witness, dies_us),
    }  # fmt: skip
