"""INA226, current and voltage monitor (Texas Instruments SBOS547)."""

CONFIG, BUS_VOLTAGE, CURRENT, CALIBRATION = 0x00, 0x02, 0x04, 0x05
# 4 averages of 2.116 ms (shunt) and 332 us (bus): a value every 9.8 ms. They fall on all phases of the coils'
# PWM (655 us), so that the mean is right within 0.5 % of full duty; many other settings beat with the PWM by 50 %.
AVERAGED = 0x42AF


class Ina226:
    """The monitor of the coil supply. Every method raises OSError when the chip does not answer."""

    def __init__(self, bus, address: int, shunt_mohm: int) -> None:
        self.address = address
        self._bus = bus
        self._calibration = 10_240 // shunt_mohm  # 0.00512 / (0.5 mA * shunt)
        self._word = bytearray(2)

    def begin(self) -> None:
        """Set averaging and the scale: one bit of the current is 0.5 mA."""
        self._write(CONFIG, AVERAGED)
        self._write(CALIBRATION, self._calibration)

    def configured(self) -> bool:
        """Return whether the chip still holds what `begin` set."""
        return self._read(CALIBRATION) == self._calibration

    def current_ma(self) -> int:
        """Return the mean current of the last conversion; 0 when it flows backwards."""
        raw = self._read(CURRENT)
        return 0 if raw & 0x8000 else raw >> 1

    def voltage_mv(self) -> int:
        """Return the mean voltage of the last conversion."""
        return (self._read(BUS_VOLTAGE) & 0x7FFF) * 5 >> 2

    def _write(self, register: int, value: int) -> None:
        self._word[0] = value >> 8
        self._word[1] = value & 0xFF
        self._bus.writeto_mem(self.address, register, self._word)

    def _read(self, register: int) -> int:
        self._bus.readfrom_mem_into(self.address, register, self._word)
        return self._word[0] << 8 | self._word[1]
