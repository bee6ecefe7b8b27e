"""The RP2040's eight PWM slices: a counter with a fractional divider each, and two outputs that compare with it.

RP2040 data sheet, section 4.5 (TOP, CC, DIV with 4 fractional bits, values after reset in 4.5.3), and MicroPython's
ports/rp2/machine_pwm.c, which sets them. New values are taken over when the counter wraps (4.5.2.1). ASSUMED: a
counter begins at 0 when its slice is enabled; a slice that is disabled leaves its outputs low.

    slices.watch(8, servo.pulsed)
    slices.connect(8)
"""

from collections.abc import Callable

from hil_sim.clock import Clock
from hil_sim.journal import PWM, Journal

SLICES = 8
CLOCK_HZ = 125_000_000
DIV_AFTER_RESET, TOP_AFTER_RESET = 16, 0xFFFF  # the divider counts in sixteenths

Watcher = Callable[[int, float, float], None]  # from when [us], pulse width [us], period [us]; width 0 for none


class Slice:
    """One counter with its two levels, for the even and the odd pin."""

    def __init__(self) -> None:
        self.div16 = DIV_AFTER_RESET
        self.top = TOP_AFTER_RESET
        self.levels = [0, 0]
        self.enabled = False
        self.begun_us = 0

    @property
    def period_us(self) -> float:
        """The time from wrap to wrap."""
        return (self.top + 1) * self.div16 / 16 * 1e6 / CLOCK_HZ

    def width_us(self, channel: int) -> float:
        """Return how long an output is high in each period."""
        if not self.enabled:
            return 0.0
        return min(self.levels[channel], self.top + 1) * self.div16 / 16 * 1e6 / CLOCK_HZ


class PwmSlices:
    """All slices and the pins that they drive."""

    def __init__(self, clock: Clock, journal: Journal) -> None:
        self.slices = [Slice() for _ in range(SLICES)]
        self._clock = clock
        self._journal = journal
        self._watchers: dict[int, Watcher] = {}
        self._pins: set[int] = set()

    def reset(self) -> None:
        """Disable every slice and let go of every pin."""
        driven = sorted(self._pins)
        self.slices = [Slice() for _ in range(SLICES)]
        self._pins.clear()
        for pin in driven:
            self._tell(pin)

    def watch(self, pin: int, watcher: Watcher) -> None:
        """Have somebody told of every change of the pulses on a pin."""
        self._watchers[pin] = watcher

    def of(self, pin: int) -> tuple[Slice, int]:
        """Return the slice and the channel that belong to a pin."""
        return self.slices[pin >> 1 & SLICES - 1], pin & 1

    def connect(self, pin: int) -> None:
        """Hand a pin over to its slice."""
        self._pins.add(pin)
        self.changed(pin)

    def release(self, pin: int) -> None:
        """Take a pin back from its slice."""
        if pin in self._pins:
            self._pins.discard(pin)
            self._tell(pin)

    def changed(self, pin: int) -> None:
        """Note what a slice was set to and tell who watches its pins."""
        counter, channel = self.of(pin)
        values = (counter.div16, counter.top, counter.levels[channel], int(counter.enabled))
        data = b"".join(value.to_bytes(4, "little") for value in values)
        self._journal.note(self._clock.now_us, PWM, pin, data)
        for other in sorted(self._pins):
            if self.of(other)[0] is counter:
                self._tell(other)

    def _tell(self, pin: int) -> None:
        watcher = self._watchers.get(pin)
        if watcher is not None:
            counter, channel = self.of(pin)
            width_us = counter.width_us(channel) if pin in self._pins else 0.0
            watcher(self._wrap_us(counter), width_us, counter.period_us)

    def _wrap_us(self, counter: Slice) -> int:
        """Return when the counter wraps next: a period that has begun is finished as it was."""
        if not counter.enabled:
            return self._clock.now_us
        periods = -(-(self._clock.now_us - counter.begun_us) // counter.period_us)
        return round(counter.begun_us + periods * counter.period_us)
