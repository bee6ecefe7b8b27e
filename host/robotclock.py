"""The robot's clock as the host reckons it, and the one sign of a reset that nothing can hide: it begins anew.

A robot time arrives late and never early, so the quickest frame tells the difference of the clocks best. It is
trusted less the older it is, for the two clocks do not run alike. Robot times are 32 bits and wrap.

    clock.read(telemetry.now_ms, now_ms)
    clock.at(now_ms)
"""

from __future__ import annotations

WRAP = 1 << 32
DRIFT_AGE = 2000  # one millisecond in so many, 500 ppm: ten times what a poor crystal is off


class RobotClock:
    """The difference of two clocks, robot's minus host's, from below: `at` is never ahead of the robot."""

    def __init__(self) -> None:
        self._ahead_ms: int | None = None
        self._read_ms = 0

    def at(self, now_ms: int) -> int | None:
        """Return the robot's clock at the host's `now_ms`, or None before any robot time was read."""
        if self._ahead_ms is None:
            return None
        return now_ms + self._ahead_ms - max(0, now_ms - self._read_ms) // DRIFT_AGE

    def read(self, robot_ms: int, now_ms: int) -> None:
        """Take a robot time that arrived at the host's `now_ms`."""
        expected_ms = self.at(now_ms)
        if expected_ms is None:
            self._ahead_ms, self._read_ms = robot_ms - now_ms, now_ms
        elif since(robot_ms, expected_ms) >= 0:
            self._ahead_ms, self._read_ms = expected_ms + since(robot_ms, expected_ms) - now_ms, now_ms


def since(later_ms: int, earlier_ms: int) -> int:
    """Return the time between two robot times, negative when `later_ms` is the earlier one."""
    return (later_ms - earlier_ms + WRAP // 2) % WRAP - WRAP // 2
