"""The processor's pins: who drives a wire, and what is read on it.

A reset turns every pin into an input with its pull-down on, as RP2040 pads do; wires that matter are therefore safe
when low. Outside sources drive a pin that is an input; watchers are told of each change of a driven level.
"""

from collections.abc import Callable

from hil_sim.clock import Clock
from hil_sim.journal import PIN, Journal

PIN_COUNT = 30
IN, OUT, OPEN_DRAIN = 0, 1, 2
NO_PULL, PULL_UP, PULL_DOWN = 0, 1, 2


class Gpio:
    """Thirty pins."""

    def __init__(self, clock: Clock, journal: Journal) -> None:
        self.watchers: dict[int, Callable[[int], None]] = {}
        self.sources: dict[int, Callable[[], int | None]] = {}
        self._clock = clock
        self._journal = journal
        self._mode = [IN] * PIN_COUNT
        self._pull = [PULL_DOWN] * PIN_COUNT
        self._latch = [0] * PIN_COUNT
        self._level = [0] * PIN_COUNT

    def reset(self) -> None:
        """Turn every pin into an input with pull-down."""
        for pin in range(PIN_COUNT):
            self._latch[pin] = 0
            self.configure(pin, IN, PULL_DOWN)

    def configure(self, pin: int, mode: int | None = None, pull: int | None = None, value: int | None = None) -> None:
        """Change what is given; the value is latched before the pin drives, so that there is no glitch."""
        if value is not None:
            self._latch[pin] = value
        if mode is not None:
            self._mode[pin] = mode
        if pull is not None:
            self._pull[pin] = pull
        self._drive(pin)

    def write(self, pin: int, value: int) -> None:
        """Latch the output value of a pin."""
        self._latch[pin] = value
        if self._mode[pin] != IN:
            self._drive(pin)

    def read(self, pin: int) -> int:
        """Return the level on a pin."""
        if self._mode[pin] == OUT or (self._mode[pin] == OPEN_DRAIN and not self._latch[pin]):
            return self._latch[pin]
        source = self.sources.get(pin)
        level = source() if source is not None else None
        return int(self._pull[pin] == PULL_UP) if level is None else level

    def driven(self, pin: int) -> int:
        """Return the level that the processor leaves on a wire: low where its pin is an input, by the pull-down."""
        return self._level[pin]

    def mode(self, pin: int) -> int:
        """Return IN, OUT or OPEN_DRAIN."""
        return self._mode[pin]

    def _drive(self, pin: int) -> None:
        """Pass a changed level on to whom it drives. An input pin leaves its wire to the board's own pull-down."""
        level = self._latch[pin] if self._mode[pin] == OUT else 0
        if level != self._level[pin]:
            self._level[pin] = level
            self._journal.note(self._clock.now_us, PIN, pin, b"\x01" if level else b"\x00")
            watcher = self.watchers.get(pin)
            if watcher is not None:
                watcher(level)
