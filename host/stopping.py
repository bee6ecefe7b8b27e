"""The stop pattern: sent until it is answered, on any line, to any robot, without a hello."""

from __future__ import annotations

from protocol import frames

AGAIN_US = 100_000
TIMES = 3  # in a row, so that one damaged byte costs nothing


class Stopping:
    """Says when the pattern is due."""

    def __init__(self) -> None:
        self.due_us: int | None = None  # None: nobody asked for a stop, or it was answered

    def begin(self, now_us: int) -> None:
        """Have the pattern sent from now on."""
        self.due_us = now_us

    def end(self) -> None:
        """Send it no more."""
        self.due_us = None

    def poll(self, now_us: int) -> bytes:
        """Return the bytes to write now."""
        if self.due_us is None or now_us < self.due_us:
            return b""
        self.due_us = now_us + AGAIN_US
        return frames.STOP * TIMES
