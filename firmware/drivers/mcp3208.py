"""MCP3208, converters of 12 bits with eight analogue inputs each, on SPI (Microchip DS21298, section 6.1)."""

SINGLE_ENDED = 0x06  # start bit and SGL/DIFF behind five zeros, so that the result ends with the third byte


class Mcp3208:
    """Chips on one bus, each with a select of its own: inputs 0 to 7 are those of the first, 8 to 15 of the second.

    Nobody can tell from an answer whether the chip is there: a line that rests low reads as 0.
    """

    def __init__(self, spi, *selects) -> None:
        self._spi = spi
        self._selects = selects
        self._three = bytearray(3)

    def counts(self, number: int) -> int:
        """Return a conversion of that input: 4096 counts would be the reference."""
        three = self._three
        three[0] = SINGLE_ENDED | number >> 2 & 1
        three[1] = (number & 3) << 6
        three[2] = 0
        select = self._selects[number >> 3]
        select.value(0)
        self._spi.write_readinto(three, three)
        select.value(1)
        return (three[1] & 0x0F) << 8 | three[2]
