"""MCP3208, converter of 12 bits with eight analogue inputs on SPI (Microchip DS21298, section 6.1)."""

SINGLE_ENDED = 0x06  # start bit and SGL/DIFF behind five zeros, so that the result ends with the third byte


class Mcp3208:
    """One chip. Nobody can tell from its answer whether it is there: a line that rests low reads as 0."""

    def __init__(self, spi, select) -> None:
        self._spi = spi
        self._select = select
        self._three = bytearray(3)

    def counts(self, channel: int) -> int:
        """Return a conversion of that input: 4096 counts would be the reference."""
        three = self._three
        three[0] = SINGLE_ENDED | channel >> 2
        three[1] = (channel & 3) << 6
        three[2] = 0
        self._select.value(0)
        self._spi.write_readinto(three, three)
        self._select.value(1)
        return (three[1] & 0x0F) << 8 | three[2]
