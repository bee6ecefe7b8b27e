"""A retriggerable monostable: it runs for a fixed time after the last edge on its input.

It is what switches the coils off when nobody is left to: the heartbeat pin must move, or the outputs open. Edges cost
nothing; one event per window checks whether the window has been extended meanwhile.
"""

from collections.abc import Callable

from hil_sim.clock import Clock


class Monostable:
    """Runs while edges keep coming; `changed` is called whenever it starts or stops."""

    def __init__(self, clock: Clock, window_us: int, changed: Callable[[], None]) -> None:
        self.running = False
        self._clock = clock
        self._window_us = window_us
        self._changed = changed
        self._ends_us = 0

    def edge(self) -> None:
        """Start the window, or start it anew."""
        self._ends_us = self._clock.now_us + self._window_us
        if not self.running:
            self.running = True
            self._clock.at(self._ends_us, self._check)
            self._changed()

    def _check(self) -> None:
        if self._clock.now_us < self._ends_us:
            self._clock.at(self._ends_us, self._check)
        else:
            self.running = False
            self._changed()
