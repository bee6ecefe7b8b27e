"""The converter of an INA226: shunt and bus by turns, so many turns to a cycle whose averages are the result.

It takes what has been on the inputs as integrals over the windows of its conversions, up to a time that it is told.
Sums are kept of the cycle and of the turn under way; see ina226.py for what comes of them.
"""

from typing import Protocol

SHUNT_LSB_V = 2.5e-6
BUS_LSB_V = 1.25e-3
CONVERSION_US = (140, 204, 332, 588, 1100, 2116, 4156, 8244)
AVERAGES = (1, 4, 16, 64, 128, 256, 512, 1024)


class Source(Protocol):
    """What is on the chip's inputs."""

    def steady_v(self) -> tuple[float, float] | None:
        """Return the voltages across the shunt and at the bus pin, or None while they ripple."""

    def peak_shunt_v(self) -> float:
        """Return the greatest voltage across the shunt at any instant, as long as nothing changes."""

    def integrals_vus(
        self, begun_us: int, from_us: int, until_us: int, shunt_us: int, bus_us: int
    ) -> tuple[float, float]:
        """Return shunt and bus voltage integrated over those parts of from_us..until_us that belong to each.

        Since begun_us, conversions of the shunt (shunt_us long) and of the bus (bus_us) take turns.
        """


class Converter:
    """One converter at its source. `begun_us` is the start of its cycle, `seen_us` until when it has converted.

    `turn_counts` is for the chip to say whether what this turn converts is held against a limit.
    """

    def __init__(self, source: Source) -> None:
        self._source = source
        self.begin(0, 0)

    def begin(self, config: int, now_us: int) -> None:
        """Start a cycle as the register CONFIG says; a `cycle_us` of 0 is no cycle at all."""
        self._averages = AVERAGES[config >> 9 & 7]
        self._shunt_us = CONVERSION_US[config >> 3 & 7] if config & 1 else 0
        self._bus_us = CONVERSION_US[config >> 6 & 7] if config & 2 else 0
        self._turn_us = self._shunt_us + self._bus_us
        self.cycle_us = self._turn_us * self._averages
        self.begin_cycle(now_us)

    def begin_cycle(self, at_us: int) -> None:
        """Start the next cycle."""
        self.begun_us = self.seen_us = at_us
        self._shunt_sum = self._bus_sum = 0.0
        self.begin_turn()

    def begin_turn(self) -> None:
        """Start the sums of a turn."""
        self._turn_shunt = self._turn_bus = 0.0
        self.turn_counts = True

    @property
    def at_shunt_end(self) -> bool:
        """Whether the conversion of the shunt has ended at `seen_us`."""
        return self._place_us() == self._shunt_us % self._turn_us

    @property
    def at_turn_end(self) -> bool:
        """Whether a turn has ended at `seen_us`."""
        return self._place_us() == 0

    def conversion_end_us(self) -> int:
        """Return when the conversion ends that is under way."""
        place_us = self._place_us()
        length_us = self._shunt_us if place_us < self._shunt_us else self._turn_us
        return self.seen_us + length_us - place_us

    def shunt_end_us(self) -> int:
        """Return when the next conversion of the shunt ends."""
        place_us = self._place_us()
        return self.seen_us - place_us + self._shunt_us + (self._turn_us if place_us >= self._shunt_us else 0)

    def convert(self, until_us: int) -> None:
        """Take what has been on the inputs up to `until_us`, with the sums of the turn that is under way then."""
        turn_us = until_us - (until_us - self.begun_us) % self._turn_us
        if turn_us > self.seen_us:
            self._integrate(turn_us)
            self.begin_turn()
        self._integrate(until_us)

    def end_conversion(self) -> None:
        """Convert to the end of the conversion under way."""
        self._integrate(self.conversion_end_us())

    def convert_cycle(self) -> None:
        """Convert to the end of the cycle."""
        self._integrate(self.begun_us + self.cycle_us)

    def cycle_bits(self) -> tuple[int | None, int | None]:
        """Return the averages of shunt and bus over the cycle; None for one that is not converted."""
        shunt_us, bus_us = self._shunt_us * self._averages, self._bus_us * self._averages
        return (
            _bits(self._shunt_sum, shunt_us, SHUNT_LSB_V) if shunt_us else None,
            max(0, _bits(self._bus_sum, bus_us, BUS_LSB_V)) if bus_us else None,
        )

    def turn_bits(self) -> tuple[int, int]:
        """Return the conversions of the shunt and of the bus in this turn."""
        shunt = _bits(self._turn_shunt, self._shunt_us, SHUNT_LSB_V)
        return shunt, max(0, _bits(self._turn_bus, self._bus_us, BUS_LSB_V))

    def _place_us(self) -> int:
        return (self.seen_us - self.begun_us) % self._turn_us

    def _integrate(self, until_us: int) -> None:
        """Add what has been on the inputs between `seen_us` and `until_us` to the sums."""
        steady = self._source.steady_v()
        if steady is None:
            shunt_vus, bus_vus = self._source.integrals_vus(
                self.begun_us, self.seen_us, until_us, self._shunt_us, self._bus_us
            )
        else:
            past_us, end_us = self.seen_us - self.begun_us, until_us - self.begun_us
            shunt_us = self._shunt_time_us(end_us) - self._shunt_time_us(past_us)
            shunt_vus, bus_vus = steady[0] * shunt_us, steady[1] * (end_us - past_us - shunt_us)
        self._shunt_sum += shunt_vus
        self._bus_sum += bus_vus
        self._turn_shunt += shunt_vus
        self._turn_bus += bus_vus
        self.seen_us = until_us

    def _shunt_time_us(self, elapsed_us: int) -> int:
        """Return how much of the first `elapsed_us` of a cycle went into shunt conversions."""
        turns, rest_us = divmod(elapsed_us, self._turn_us)
        return turns * self._shunt_us + min(rest_us, self._shunt_us)


def _bits(sum_vus: float, time_us: int, lsb_v: float) -> int:
    """Return the mean of a sum in bits, held at the ends of the scale; 0 where nothing was converted."""
    return max(-0x8000, min(0x7FFF, round(sum_vus / time_us / lsb_v))) if time_us else 0
