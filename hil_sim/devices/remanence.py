"""A capacitor that remembers for about a minute that the coil supply was closed, with or without power on the board.

PWR_EN charges it through a diode and 1 kohm; it empties through 1 Mohm alone. Its voltage stands on the gate of a small
N-MOSFET, which takes no current from it and pulls the processor's pin low while the coils may still be warm. So a
processor that starts with no memory of its own can tell a cold robot from one whose power was gone for an instant.

ASSUMED: 100 uF, 3.0 V behind the diode, threshold 1.5 V (a 2N7002 has 1.0 to 2.5 V: 18 to 110 s instead of 69 s).
"""

from math import exp

from hil_sim.clock import Clock

FULL_V = 3.0
THRESHOLD_V = 1.5
CHARGE_US = 1_000 * 100  # 1 kohm * 100 uF, in ohm * uF
LEAK_US = 1_000_000 * 100


class Remanence:
    """The capacitor and its MOSFET."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._since_us = clock.now_us
        self._voltage_v = 0.0
        self._fed = False

    def feed(self, level: int) -> None:
        """Follow PWR_EN."""
        self._voltage_v = self.voltage_v()
        self._since_us = self._clock.now_us
        self._fed = bool(level)

    def voltage_v(self) -> float:
        """Return the voltage on the capacitor."""
        passed_us = self._clock.now_us - self._since_us
        if self._fed:
            return FULL_V - (FULL_V - self._voltage_v) * exp(-passed_us / CHARGE_US)
        return self._voltage_v * exp(-passed_us / LEAK_US)

    def level(self) -> int:
        """Return the level of the processor's pin, which is pulled up: 0 while the coils may be warm."""
        return int(self.voltage_v() < THRESHOLD_V)
