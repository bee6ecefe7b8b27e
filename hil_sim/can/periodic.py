"""python-can's periodic sending on the virtual clock: no thread, no wall clock.

task = bus.send_periodic(message, period=0.02, duration=1.0)
bus.recv(0.1)       # five of them have gone out
task.stop()
"""

from collections.abc import Callable, Sequence
from contextlib import suppress

from can import BusABC, CanOperationError, Message
from can.broadcastmanager import LimitedDurationCyclicSendTaskABC, ModifiableCyclicTaskABC, RestartableCyclicTaskABC

from hil_sim.clock import Clock, Event


class PeriodicTask(LimitedDurationCyclicSendTaskABC, ModifiableCyclicTaskABC, RestartableCyclicTaskABC):
    """Sends its messages in turn, one each `period` seconds; one for which the bus has no room is left out."""

    def __init__(
        self,
        bus: BusABC,
        clock: Clock,
        messages: Message | Sequence[Message],
        period: float,
        duration: float | None = None,
        autostart: bool = True,
        modifier_callback: Callable[[Message], None] | None = None,
    ) -> None:
        super().__init__(messages, period, duration)
        if round(period * 1e6) < 1:
            raise ValueError(f"period {period} s, at least a microsecond")
        self._bus = bus
        self._clock = clock
        self._modify = modifier_callback
        self._count = 0
        self._ends_us = 0
        self._next: Event | None = None
        if autostart:
            self.start()

    def start(self) -> None:
        """Begin, or begin again, with a message at once."""
        self.stop()
        self._ends_us = self._clock.now_us + round((self.duration or 0) * 1e6)
        self._next = self._clock.at(self._clock.now_us, self._send)

    def stop(self) -> None:
        """Send no more."""
        if self._next is not None:
            self._next.cancel()
            self._next = None

    def _send(self) -> None:
        if self.duration and self._clock.now_us >= self._ends_us:
            self._next = None
            return
        message = self.messages[self._count % len(self.messages)]
        self._count += 1
        if self._modify is not None:
            self._modify(message)
        with suppress(CanOperationError):
            self._bus.send(message)
        self._next = self._clock.at(self._clock.now_us + round(self.period * 1e6), self._send)
