"""`machine.PWM` as the rp2 port of MicroPython has it: its rounding and its refusals (ports/rp2/machine_pwm.c).

The two pins of a slice share one frequency. Nothing is put out until both a frequency and a duty are set. MicroPython
1.25 for the RP2040, on an emulator of that chip, refuses freq(1) and reads duty_ns(1_500_000) at 50 Hz as 1_500_005.
"""

from typing import ClassVar

from hil_sim.devices.pwm import CLOCK_HZ, Slice
from hil_sim.worlds.costs import PWM_US
from hil_sim.worlds.pins import Pin
from hil_sim.worlds.processor import Processor

TOP_MAX = 65_534  # so that a duty of 65535 is always on
DIV16_MIN, DIV16_MAX = 16, 256 * 16 - 1
DUTY_MAX = 65_535
_NS = 1_000_000_000
_NOT_GIVEN = -1


class PWM:
    """The pulses on one pin."""

    _processor: ClassVar[Processor]
    _duties: ClassVar[dict[int, tuple[str, int]]]  # of each pin: in which unit it was set last, and to what
    _timed: ClassVar[set[int]]  # slices with a frequency

    def __init__(
        self, dest: Pin | int, freq: int = _NOT_GIVEN, duty_u16: int = _NOT_GIVEN, duty_ns: int = _NOT_GIVEN
    ) -> None:
        self._pin = dest.number if isinstance(dest, Pin) else dest
        self._duties.pop(self._pin, None)
        self._processor.board.pulses.connect(self._pin)
        self.init(freq, duty_u16, duty_ns)

    def init(self, freq: int = _NOT_GIVEN, duty_u16: int = _NOT_GIVEN, duty_ns: int = _NOT_GIVEN) -> None:
        """Set what is given."""
        self._processor.spend(PWM_US)
        if freq != _NOT_GIVEN:
            self._set_freq(freq)
        if duty_u16 != _NOT_GIVEN:
            self._set_duty("u16", duty_u16)
        if duty_ns != _NOT_GIVEN:
            self._set_duty("ns", duty_ns)
        self._start()

    def deinit(self) -> None:
        """Stop the slice, and with it the pulses on the other pin."""
        self._processor.spend(PWM_US)
        self._slice.enabled = False
        self._processor.board.pulses.changed(self._pin)

    def freq(self, value: int = _NOT_GIVEN) -> int | None:
        """Return the frequency of the slice [Hz], or set it; its duties stay what they were set to."""
        if value != _NOT_GIVEN:
            self.init(freq=value)
            return None
        self._processor.spend(PWM_US)
        return _rounded(16 * CLOCK_HZ, self._slice.div16 * (self._slice.top + 1))

    def duty_u16(self, value: int = _NOT_GIVEN) -> int | None:
        """Return the duty as a share of 65535, or set it."""
        if value != _NOT_GIVEN:
            self.init(duty_u16=value)
            return None
        self._processor.spend(PWM_US)
        return _rounded(self._slice.levels[self._pin & 1] * DUTY_MAX, self._slice.top + 1)

    def duty_ns(self, value: int = _NOT_GIVEN) -> int | None:
        """Return the width of the pulse [ns], or set it."""
        if value != _NOT_GIVEN:
            self.init(duty_ns=value)
            return None
        self._processor.spend(PWM_US)
        return _rounded(self._slice.levels[self._pin & 1] * _NS, self._counts_hz())

    @property
    def _slice(self) -> Slice:
        return self._processor.board.pulses.of(self._pin)[0]

    def _set_freq(self, freq: int) -> None:
        if freq <= 0:
            raise ValueError("freq too small")
        if _rounded(CLOCK_HZ, freq) < TOP_MAX:
            div16, top = DIV16_MIN, _rounded(CLOCK_HZ, freq) - 1
        else:
            div16 = -(-16 * CLOCK_HZ // (TOP_MAX * freq))
            top = _rounded(16 * CLOCK_HZ, div16 * freq) - 1
        if top < 1:
            raise ValueError("freq too large")
        if div16 > DIV16_MAX:
            raise ValueError("freq too small")
        self._slice.div16, self._slice.top = div16, top
        self._timed.add(self._pin >> 1 & 7)
        for pin, (unit, value) in list(self._duties.items()):
            if self._processor.board.pulses.of(pin)[0] is self._slice:
                self._slice.levels[pin & 1] = self._level(unit, value)

    def _set_duty(self, unit: str, value: int) -> None:
        self._slice.levels[self._pin & 1] = self._level(unit, value)
        self._duties[self._pin] = (unit, value)

    def _level(self, unit: str, value: int) -> int:
        if unit == "u16":
            return (value * (self._slice.top + 1) + DUTY_MAX // 2) // DUTY_MAX
        level = _rounded(value * self._counts_hz(), _NS)
        if level > DUTY_MAX:
            raise ValueError("duty larger than period")
        return level

    def _counts_hz(self) -> int:
        return _rounded(16 * CLOCK_HZ, self._slice.div16)

    def _start(self) -> None:
        if self._pin >> 1 & 7 in self._timed and self._pin in self._duties and not self._slice.enabled:
            self._slice.enabled = True
            self._slice.begun_us = self._processor.clock.now_us
        self._processor.board.pulses.changed(self._pin)


def _rounded(numerator: int, denominator: int) -> int:
    return (numerator + denominator // 2) // denominator
