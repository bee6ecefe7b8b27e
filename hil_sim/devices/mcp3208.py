"""MCP3208: eight analogue inputs and a 12-bit converter behind single bits on SPI, as Microchip's sheet DS21298 has it.

Section 5 of DS21298E (and B): the first clock with CS low and DIN high is the start bit, then come SGL/DIFF, D2, D1 and
D0; the input is sampled from the fourth clock after the start bit to the falling edge of the fifth, which puts out the
null bit; 12 bits follow, the highest first, each on a falling edge. Who clocks on gets the same bits again from the
second lowest up, and then zeros; only CS ends that. A chip that begins with CS low waits until it has been high.
Section 6.1: five leading zeros put the 12 bits at the end of three bytes, in SPI modes 0,0 and 1,1. With SGL/DIFF low
the pairs are 0-1, 2-3, 4-5 and 6-7, and D0 says which of the two is subtracted; below zero it reads 0.

    adc = Mcp3208({2: lambda: 1.65})
    adc.select(True)
    [adc.exchange(byte) for byte in b"\\x06\\x80\\x00"]  # single-ended, channel 2: the last 12 bits are 2048

It is promised 100,000 conversions a second at 5 V and 50,000 at 2.7 V, of 20 clocks each: 2 and 1 MHz. For what lies
between the sheet has no number, so at 3.3 V the rate is that of 2.7 V.

ASSUMED: steps are at half bits, and neither offset nor nonlinearity (1 bit at most, class B) is modelled; MISO rests
low while nothing is put out, by the pull-down of the processor's pad. Not modelled: what a slow clock loses of the
sample, and how far the lower input of a pair may be from ground.
"""

import random
from collections.abc import Callable, Mapping

REFERENCE_V = 3.3
STEPS = 4096
CHANNELS = 8
ORDER_BITS = 4  # after the start bit: SGL/DIFF, D2, D1, D0
SAMPLED = 5  # clocks after the start bit
RESULT_BITS = 12
FLOATING = 0


class Mcp3208:
    """One chip; `inputs` are the volts on its channels, and one that is not connected, or `opened`, is at 0 V.

    `noise_lsb` is the rms of a noise that is a function of `seed` and the number of the conversion.
    """

    rate_max_hz: int = 1_000_000
    modes: tuple[int, ...] = (0, 3)

    def __init__(
        self, inputs: Mapping[int, Callable[[], float]] | None = None, noise_lsb: float = 0.0, seed: str = ""
    ) -> None:
        self.inputs: dict[int, Callable[[], float]] = dict(inputs or {})
        self.opened: set[int] = set()  # channels whose wire is broken
        self.alive = True
        self.conversions = 0
        self._noise_lsb = noise_lsb
        self._seed = seed
        self._selected = False
        self._order = 0
        self._bits: list[int] = []  # yet to be put out, the next one last
        self._end()

    def reset(self) -> None:
        """Begin anew, as a power cycle does: CS must be high before it is heard."""
        self._end()
        self._ready = not self._selected

    def select(self, selected: bool) -> None:
        """Follow the CS pin, True for low; either edge ends a conversion."""
        self._selected = selected
        self._end()

    def exchange(self, byte: int) -> int:
        """Take one byte, the highest bit first, and return the one that is clocked out meanwhile."""
        if not (self._selected and self._ready and self.alive):
            return FLOATING
        said = 0
        for place in range(7, -1, -1):
            said = said << 1 | self._out
            self._clock(byte >> place & 1)
        return said

    def counts(self, order: int) -> int:
        """Return a conversion; `order` is SGL/DIFF, D2, D1, D0, so 8 to 15 are the channels by themselves."""
        channel = order & CHANNELS - 1
        volts = self._volts(channel) if order & CHANNELS else self._volts(channel) - self._volts(channel ^ 1)
        self.conversions += 1
        steps = volts / REFERENCE_V * STEPS + self._noise()
        return max(0, min(STEPS - 1, round(steps)))

    def _clock(self, bit: int) -> None:
        """One clock: DIN is taken on its rising edge, DOUT changes on its falling one."""
        if self._clocks < 0:
            self._clocks += bit  # a zero before the start bit
            return
        self._clocks += 1
        if self._clocks <= ORDER_BITS:
            self._order = self._order << 1 | bit
        elif self._clocks == SAMPLED:
            self._bits = _as_clocked(self.counts(self._order))
        else:
            self._out = self._bits.pop() if self._bits else 0

    def _end(self) -> None:
        self._ready = True
        self._clocks = -1  # since the start bit, which has not come
        self._order = 0
        self._bits = []
        self._out = FLOATING

    def _volts(self, channel: int) -> float:
        connected = channel in self.inputs and channel not in self.opened
        return self.inputs[channel]() if connected else 0.0

    def _noise(self) -> float:
        if not self._noise_lsb:
            return 0.0
        return random.Random(f"{self._seed} {self.conversions}").gauss(0.0, self._noise_lsb)


def _as_clocked(counts: int) -> list[int]:
    """Return a result as it is put out, the first bit last: down from the highest, then up again from the second."""
    rising = [counts >> place & 1 for place in range(RESULT_BITS)]
    return [*rising[:0:-1], *rising]
