"""LSM6DS3TR-C, accelerometer and gyroscope (ST DocID030071 Rev 3)."""

from array import array

WHO_AM_I, CTRL1_XL, CTRL3_C, STATUS = 0x0F, 0x10, 0x12, 0x1E
IDENTITY = 0x6A
SW_RESET = 0x01
FRESH = 0x03  # STATUS: new data of both sensors
# CTRL1_XL: 104 Hz, +-4 g, 0.122 mg a bit. CTRL2_G: 104 Hz, +-1000 deg/s, 35 mdeg/s a bit. CTRL3_C: a sample is not
# changed while it is read, addresses count up.
SETTINGS = b"\x48\x48\x44"
OUTPUTS = 16  # bytes from STATUS to the last output: status, reserved, temperature, turn rate, acceleration
RESET_LOOKS = 10


class Lsm6ds3tr:
    """One chip. Every method raises OSError when it does not answer, `begin` also when it is another chip."""

    def __init__(self, bus, address: int) -> None:
        self.address = address
        self.words = array("h", [0] * 6)  # the last sample: turn rate x y z, acceleration x y z
        self._bus = bus
        self._byte = bytearray(1)
        self._settings = bytearray(len(SETTINGS))
        self._outputs = bytearray(OUTPUTS)

    def begin(self) -> None:
        """Reset the chip and start both sensors; the first sample comes some 40 ms later."""
        if self._read(WHO_AM_I) != IDENTITY:
            raise OSError(19, "ENODEV")
        self._byte[0] = SW_RESET
        self._bus.writeto_mem(self.address, CTRL3_C, self._byte)
        looks = 0
        while self._read(CTRL3_C) & SW_RESET:
            looks += 1
            if looks > RESET_LOOKS:
                raise OSError(5, "EIO")
        self._bus.writeto_mem(self.address, CTRL1_XL, SETTINGS)

    def configured(self) -> bool:
        """Return whether the chip still holds what `begin` set."""
        self._bus.readfrom_mem_into(self.address, CTRL1_XL, self._settings)
        return self._settings == SETTINGS

    def read(self) -> bool:
        """Bring the last sample into `words`; return whether it is a new one."""
        outputs, words = self._outputs, self.words
        self._bus.readfrom_mem_into(self.address, STATUS, outputs)
        for i in range(6):
            word = outputs[2 * i + 4] | outputs[2 * i + 5] << 8
            words[i] = word - 0x10000 if word & 0x8000 else word
        return outputs[0] & FRESH == FRESH

    def _read(self, register: int) -> int:
        self._bus.readfrom_mem_into(self.address, register, self._byte)
        return self._byte[0]
