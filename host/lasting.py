"""A line that is opened again when it breaks: unplugged, reset by the other end, served by a bench that restarts.

While it is broken nothing arrives and what is written is lost, as on any bad line: the session sends it again. Between
two tries passes 50 ms, then twice as long each time, up to a second. After `patience_s` the break is told as LinkLost.

    link = LastingLink(open_link(address), patience_s=10)
    link.cause    # why the line is broken now, or None
"""

from __future__ import annotations

from contextlib import suppress
from typing import Any

from host.errors import LinkLost, NoRobot
from host.link import Link

FIRST_S, LONGEST_S = 0.05, 1.0  # between two tries
NEAR_S = 1e-6  # what a clock may be read short of a time that was waited for


class LastingLink:
    """The line `link`, which must have `reopen` and `pause`, for as long as breaks last no longer than `patience_s`."""

    def __init__(self, link: Any, patience_s: float) -> None:
        self.cause: LinkLost | None = None
        self.reopened = 0
        self._link = link
        self._patience_s = patience_s
        self._broke_s = self._next_s = self._between_s = 0.0

    @property
    def observer(self) -> Any:
        """Return what watches the robot from outside, or None."""
        return self._link.observer

    @property
    def repeatable(self) -> bool:
        """Return whether nothing but the address decides what passes."""
        return bool(getattr(self._link, "repeatable", False))

    def now_s(self) -> float:
        """Return the line's clock, which goes on while the line is broken."""
        return float(self._link.now_s())

    def write(self, data: bytes) -> None:
        """Send all of `data`, or lose it where the line is broken."""
        if self.cause is None:
            try:
                self._link.write(data)
            except (LinkLost, OSError) as error:
                self._break(error)

    def read(self, until_s: float) -> bytes:
        """Return bytes as soon as there are any, b"" at `until_s`; LinkLost when the line stays broken for too long."""
        if self.cause is not None:
            self._mend(self.cause, until_s)
            until_s = self.now_s()
        if self.cause is None:
            try:
                return bytes(self._link.read(until_s))
            except (LinkLost, OSError) as error:
                self._break(error)
        return b""

    def close(self) -> None:
        """Let go of the line."""
        self._link.close()

    def _break(self, error: Exception) -> None:
        self.cause = error if isinstance(error, LinkLost) else LinkLost(f"the line broke ({error})")
        self._broke_s = self.now_s()
        self._next_s, self._between_s = self._broke_s + FIRST_S, FIRST_S

    def _mend(self, cause: Any, until_s: float) -> None:
        """Wait for the next try, or until `until_s`, and try; `cause` is raised at the end of all patience."""
        end_s = self._broke_s + self._patience_s
        self._link.pause(min(until_s, self._next_s, end_s))
        now_s = self.now_s()
        if now_s >= self._next_s - NEAR_S:
            self._between_s = min(2 * self._between_s, LONGEST_S)
            self._next_s = now_s + self._between_s
            with suppress(NoRobot, LinkLost, OSError):
                self._link = self._link.reopen()
                self.cause = None
                self.reopened += 1
        if self.cause is not None and now_s >= end_s - NEAR_S:
            raise cause


def can_last(link: Link) -> bool:
    """Return whether a line can be opened again."""
    return hasattr(link, "reopen")
