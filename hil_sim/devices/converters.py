"""Two MCP3208 on one SPI bus, each with a chip select of its own: inputs 0 to 7 are the first chip, 8 to 15 the second.

They share clock and data. Who is not selected takes no clock and leaves DOUT at high impedance (Microchip DS21298E,
figure 5-1), so that only the selected one is heard.

    converters = Converters()
    converters.inputs[8] = lambda: 0.66  # volts on CH0 of the second chip
    converters.opened.add(8)             # its wire breaks: 0 V
"""

from collections.abc import Callable

from hil_sim.devices.mcp3208 import CHANNELS, Mcp3208

CHIPS = 2
SINGLE_ENDED = 8


class Converters:
    """`inputs` are the volts on the inputs of all chips by number; one not connected, or `opened`, is at 0 V."""

    def __init__(self) -> None:
        self.inputs: dict[int, Callable[[], float]] = {}
        self.opened: set[int] = set()  # inputs whose wire is broken
        self.chips = tuple(Mcp3208(self._wires(chip)) for chip in range(CHIPS))

    def counts(self, number: int) -> int:
        """Return what is read of an input by itself: 0 of a chip that is dead."""
        chip, channel = self.chips[number // CHANNELS], number % CHANNELS
        return chip.counts(SINGLE_ENDED | channel) if chip.alive else 0

    def reset(self) -> None:
        """Begin anew, as a power cycle does."""
        for chip in self.chips:
            chip.reset()

    def _wires(self, chip: int) -> dict[int, Callable[[], float]]:
        return {channel: self._wire(chip * CHANNELS + channel) for channel in range(CHANNELS)}

    def _wire(self, number: int) -> Callable[[], float]:
        return lambda: self.inputs[number]() if number in self.inputs and number not in self.opened else 0.0
