"""PCA9685, 16 PWM outputs of 12 bits (NXP data sheet, Rev 4)."""

MODE1, LED0, ALL_LED_OFF_H, PRE_SCALE = 0x00, 0x06, 0xFD, 0xFE
AUTO_INCREMENT, SLEEP = 0x20, 0x10
FULL = 0x10  # bit 4 of the high byte: full on, or full off, whatever the counts say
FASTEST = 3  # prescale for 1526 Hz, the chip's highest frequency


class Pca9685:
    """One chip. Every method raises OSError when it does not answer."""

    def __init__(self, bus, address: int) -> None:
        self.address = address
        self._bus = bus
        self._counts = bytearray(4)
        self._seen = bytearray(1)

    def begin(self) -> None:
        """Set the PWM frequency (only possible in sleep), all outputs full off, ALLCALL off, then wake."""
        self._write(MODE1, AUTO_INCREMENT | SLEEP)
        self._write(PRE_SCALE, FASTEST)
        self._write(ALL_LED_OFF_H, FULL)
        self._write(MODE1, AUTO_INCREMENT)

    def set(self, output: int, permille: int) -> None:
        """Drive one output; its pulse starts at its own place in the period, so that inrush is spread."""
        counts = self._counts
        start = output << 8
        end = (start + permille * 4096 // 1000) & 0xFFF
        full_on = permille >= 1000
        counts[0] = start & 0xFF
        counts[1] = FULL if full_on else start >> 8
        counts[2] = end & 0xFF
        counts[3] = FULL if permille == 0 else 0 if full_on else end >> 8
        self._bus.writeto_mem(self.address, LED0 + 4 * output, counts)

    def all_off(self) -> None:
        """Full off on every output, in one write."""
        self._write(ALL_LED_OFF_H, FULL)

    def configured(self) -> bool:
        """Return whether the chip still holds what `begin` set."""
        return self._read(MODE1) == AUTO_INCREMENT and self._read(PRE_SCALE) == FASTEST

    def _write(self, register: int, value: int) -> None:
        self._seen[0] = value
        self._bus.writeto_mem(self.address, register, self._seen)

    def _read(self, register: int) -> int:
        self._bus.readfrom_mem_into(self.address, register, self._seen)
        return self._seen[0]
