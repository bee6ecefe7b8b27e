"""Who has done its part of a period: the watchdog is fed only when all have.

A loop that goes round without one of them, whatever the reason, is restarted.
"""

RECEIVE, CONTROL, SEND = 1, 2, 4
ALL = RECEIVE | CONTROL | SEND


class Tasks:
    """The reports since the watchdog was fed last."""

    def __init__(self) -> None:
        self._reported = 0

    def report(self, task: int) -> None:
        """Say that a task has done its part."""
        self._reported |= task

    def complete(self) -> bool:
        """Return whether all have reported; if so, the next period begins."""
        if self._reported != ALL:
            return False
        self._reported = 0
        return True
