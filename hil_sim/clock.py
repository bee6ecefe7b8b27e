"""One clock per bench: integer microseconds and a queue of events.

Events run in the order of their time, then of their insertion, so a run is the same whoever drives it and however
often. A client that only passes time (the firmware between two bus accesses) may move `now_us` itself as long as it
stays below `limit_us`; at `limit_us` something else is due and it must queue behind that.

    clock = Clock()
    clock.at(5_000, tick)
    clock.run_until(20_000)
"""

from collections.abc import Callable
from heapq import heappop, heappush

Callback = Callable[[], None]


class Event:
    """A callback in the queue; `cancel` makes it a no-op."""

    __slots__ = ("callback",)

    def __init__(self, callback: Callback) -> None:
        self.callback: Callback | None = callback

    def cancel(self) -> None:
        """Never run the callback."""
        self.callback = None


class Clock:
    """Virtual time, advanced by `run_until` only."""

    def __init__(self) -> None:
        self.now_us = 0
        self.limit_us = 0
        self._horizon_us = -1
        self._queue: list[tuple[int, int, Event]] = []  # time_us, order of insertion, event
        self._order = 0

    def at(self, time_us: int, callback: Callback) -> Event:
        """Queue `callback` for `time_us` (for now, if that has passed) and return its event."""
        time_us = max(time_us, self.now_us)
        self.limit_us = min(self.limit_us, time_us)
        self._order += 1
        event = Event(callback)
        heappush(self._queue, (time_us, self._order, event))
        return event

    def run_until(self, time_us: int) -> None:
        """Run all events due up to and including `time_us`, or up to an earlier `stop_at`; leave the clock there."""
        self._horizon_us = max(time_us, self.now_us)
        queue = self._queue
        while queue and queue[0][0] <= self._horizon_us:
            time_us, _, event = heappop(queue)
            if event.callback is None:
                continue
            self.now_us = time_us
            self._set_limit()
            event.callback()
        self.now_us = self._horizon_us
        self.limit_us = 0

    def stop_at(self, time_us: int) -> None:
        """Let the present `run_until` end at `time_us` if that is sooner."""
        self._horizon_us = max(self.now_us, min(time_us, self._horizon_us))
        self._set_limit()

    def _set_limit(self) -> None:
        queue, limit_us = self._queue, self._horizon_us + 1
        self.limit_us = queue[0][0] if queue and queue[0][0] < limit_us else limit_us
