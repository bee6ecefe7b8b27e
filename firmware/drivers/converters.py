"""Converters that share an SPI bus, each with a chip select of its own, as one with their inputs numbered through."""

CHANNELS = 8  # of each chip


class Converters:
    """`chips` are drivers of MCP3208: inputs 0 to 7 are those of the first, 8 to 15 those of the second."""

    def __init__(self, chips) -> None:
        self._chips = chips

    def counts(self, number: int) -> int:
        """Return a conversion of that input: 4096 counts would be the reference."""
        return self._chips[number // CHANNELS].counts(number % CHANNELS)
