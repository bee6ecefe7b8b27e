"""INA226, current and voltage monitor (Texas Instruments SBOS547).

Two ways of converting: averaged, for the mean of pulsed currents, and hasty, for one coil that is on without a pause.
The alert is a limit on the shunt's voltage that pulls the ALERT pin low and stays until the chip's mask is read.
"""

CONFIG, SHUNT_VOLTAGE, BUS_VOLTAGE, CURRENT, CALIBRATION, MASK, LIMIT = 0x00, 0x01, 0x02, 0x04, 0x05, 0x06, 0x07
# 4 averages of 2.116 ms (shunt) and 332 us (bus): a value every 9.8 ms. They fall on all phases of the coils'
# PWM (655 us), so that the mean is right within 0.5 % of full duty; many other settings beat with the PWM by 50 %.
AVERAGED = 0x42AF
HASTY = 0x4097  # no averages, 332 us each; the sheet allows 10 % more
OVER_SHUNT_LATCHED = 0x8001


class Ina226:
    """The monitor of the coil supply. Every method raises OSError when the chip does not answer."""

    def __init__(self, bus, address: int, shunt_mohm: int, alert_ma: int) -> None:
        self.address = address
        self.shunt = 0  # of the last look [2.5 uV]
        self.bus = 0  # and at the coils' rail [1.25 mV]
        self._bus = bus
        self._shunt_mohm = shunt_mohm
        self._calibration = 10_240 // shunt_mohm  # 0.00512 / (0.5 mA * shunt)
        self._limit = min(0x7FFF, alert_ma * shunt_mohm * 2 // 5)
        self._word = bytearray(2)

    def begin(self) -> None:
        """Set averaging, the scale (one bit of the current is 0.5 mA) and the alert, and end an alert that holds."""
        self.average()
        self._write(CALIBRATION, self._calibration)
        self._write(LIMIT, self._limit)
        self._write(MASK, OVER_SHUNT_LATCHED)
        self._read(MASK)

    def configured(self) -> bool:
        """Return whether the chip still holds what `begin` set; the mask is not read, that would end an alert."""
        return (
            self._read(CALIBRATION) == self._calibration
            and self._read(CONFIG) == AVERAGED
            and self._read(LIMIT) == self._limit
        )

    def average(self) -> None:
        """Begin averaged conversions anew; the first result comes after 9.8 ms."""
        self._write(CONFIG, AVERAGED)

    def hasten(self) -> None:
        """Begin hasty conversions anew; the first result comes after both."""
        self._write(CONFIG, HASTY)

    def look(self) -> None:
        """Keep both voltages of the last conversion; a current that flows backwards counts as none."""
        shunt = self._read(SHUNT_VOLTAGE)
        self.shunt = 0 if shunt & 0x8000 else shunt
        self.bus = self._read(BUS_VOLTAGE) & 0x7FFF

    def seen_ma(self) -> int:
        """Return the current of the last look."""
        return self.shunt * 5 // (2 * self._shunt_mohm)

    def seen_mv(self) -> int:
        """Return the voltage of the last look."""
        return self.bus * 5 >> 2

    def seen_mohm(self) -> int:
        """Return what resistance took that current at that voltage; with no current, more than can be measured."""
        return self.bus * (500 * self._shunt_mohm) // self.shunt if self.shunt else 0x3FFFFFFF

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
