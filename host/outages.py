"""When the line to a robot was interrupted in a session that went on: since when, for how long, why, what was missed.

outages = Outages()
outages.note(now_ms, cause, heard_ms, missed)   # "interrupted", "resumed" or None, after each reading of the line
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple


@dataclass(frozen=True, slots=True)
class Interruption:
    """One interruption that is over, on the host's clock; events and answers come later, telemetry does not."""

    host_ms: int
    for_ms: int
    cause: str
    telemetry_missed: int


@dataclass(frozen=True, slots=True)
class LinkNews:
    """What became of the line: "begins", "interrupted", "resumed" or "ends", and how the clocks stand then."""

    host_ms: int
    now_ms: int | None  # the robot's clock
    session: int
    what: str
    cause: str
    clock_offset_ms: float | None
    clock_drift_ppm: float | None
    clock_bound_ms: float | None


class Outages:
    """The interruptions of one session."""

    def __init__(self) -> None:
        self.over: list[Interruption] = []
        self._present: _Outage | None = None

    def lasting_ms(self, now_ms: int) -> int:
        """Return for how long the line has been interrupted, 0: it is not."""
        return now_ms - self._present.since_ms if self._present else 0

    def cause(self) -> str:
        """Return why the line is interrupted, or was at last."""
        if self._present:
            return self._present.cause
        return self.over[-1].cause if self.over else ""

    def note(self, now_ms: int, cause: str | None, heard_ms: int | None, missed: int) -> str | None:
        """Take why the line is interrupted, None: it is not, and when the robot was heard last; return what is new."""
        if self._present is None:
            if cause is None:
                return None
            self._present = _Outage(now_ms, cause, missed)
            return "interrupted"
        outage = self._present
        if cause is not None or heard_ms is None or heard_ms <= outage.since_ms:
            return None
        self._present = None
        self.over.append(Interruption(outage.since_ms, now_ms - outage.since_ms, outage.cause, missed - outage.missed))
        return "resumed"


class _Outage(NamedTuple):
    since_ms: int
    cause: str
    missed: int  # records of telemetry that had not come before
