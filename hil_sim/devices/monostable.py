"""A retriggerable monostable with a clear input: it runs for a fixed time after the last edge on its trigger.

It is what switches the coils off when nobody is left to: the heartbeat pin must move, or the outputs open. Edges cost
nothing; one event per window checks whether the window has been extended meanwhile. Clear ends it at once and blocks
the trigger; its release starts nothing, as the data sheet of the 74HC423 says (NXP, Rev. 6: "cannot be triggered via
the reset input", unlike the 74HC123), so the outputs come back only with the next edge.
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
        self._held = False
        self._checking = False  # an event is on its way

    def edge(self) -> None:
        """Start the window, or start it anew."""
        if self._held:
            return
        self._ends_us = self._clock.now_us + self._window_us
        if not self.running:
            self.running = True
            self._wait()
            self._changed()

    def clear(self, held: bool) -> None:
        """Hold the clear input, which ends the window now, or release it."""
        self._held = held
        if held and self.running:
            self._stop()

    def _check(self) -> None:
        self._checking = False
        if not self.running:
            return
        if self._clock.now_us < self._ends_us:
            self._wait()
        else:
            self._stop()

    def _stop(self) -> None:
        self.running = False
        self._changed()

    def _wait(self) -> None:
        if not self._checking:
            self._checking = True
            self._clock.at(self._ends_us, self._check)
