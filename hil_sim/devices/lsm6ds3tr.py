"""LSM6DS3TR-C: accelerometer and gyroscope on I2C behind 8-bit registers, as in ST's data sheet DocID030071 Rev 3.

From it: address and auto-increment (6.3), register map with its values after reset (table 19), rates and
full scales (tables 51 to 55), CTRL3_C (table 57), STATUS_REG (table 87), sensitivities, zero levels and noise densities
(table 3), turn-on time (table 4), temperature output (table 5).

Both sensors sample by themselves at their rates. No event is needed for that: the chip works out its newest sample when
it is asked, and once more (`before_change`) before the body moves on; a sample is what the body did at the last such
moment, at most one grid step of the bench before. Noise is a function of seed and sample number, so that looking
changes nothing. Its axes are the axes of the robot's core.

Zero levels are drawn from the seed within the typical ones (40 mg, 3 deg/s).

RECALLED, from the application note, of which no copy was found: a high byte read clears its sensor's flag; a reset
takes 50 us (drivers wait longer: Zephyr 35 ms, which does no harm here either). ASSUMED: the turn-on time is that of
each sensor leaving power-down; noise is white up to half the rate, in the low-power and normal modes as well; no
filter delays; codes that are not allowed stop a sensor. Not there: FIFO, interrupts, filters, self-test, embedded
functions; their registers keep what is written.
"""

import random
from collections.abc import Sequence
from math import sqrt
from typing import Protocol, runtime_checkable

from hil_sim.clock import Clock

WHO_AM_I, CTRL1_XL, CTRL2_G, CTRL3_C, CTRL4_C, CTRL6_C, STATUS = 0x0F, 0x10, 0x11, 0x12, 0x13, 0x15, 0x1E
TEMPERATURE, RATE, FORCE = 0x20, 0x22, 0x28  # first of the outputs, low byte first
IDENTITY = 0x6A
BDU, IF_INC, BLE, SW_RESET = 0x40, 0x04, 0x02, 0x01
SLEEP_G = 0x40  # in CTRL4_C
XL_HM_OFF = 0x10  # in CTRL6_C
FS_125 = 0x02  # in CTRL2_G
LOWEST, SCALE_16G = 11, 1  # codes in CTRL1_XL
XLDA, GDA = 1, 2
READ_ONLY = {WHO_AM_I, *range(0x1B, 0x58)}
REGISTERS = 0x80
RATES_HZ = (0.0, 12.5, 26.0, 52.0, 104.0, 208.0, 416.0, 833.0, 1666.0, 3332.0, 6664.0)
G = 9.80665  # [m/s2]
FORCE_LSB = tuple(mg * 1e-3 * G for mg in (0.061, 0.488, 0.122, 0.244))  # [m/s2], by FS_XL: 2, 16, 4, 8 g
RATE_LSB_DPS = (8.75e-3, 17.5e-3, 35e-3, 70e-3)  # by FS_G: 245, 500, 1000, 2000 deg/s
RATE_LSB_125_DPS = 4.375e-3
DEG_PER_RAD = 57.29577951308232
TURN_ON_US = 35_000
RESET_US = 50
FORCE_NOISE, FORCE_NOISE_16G = 90e-6 * G, 130e-6 * G  # [m/s2 per root Hz]
RATE_NOISE_DPS = 5e-3  # [deg/s per root Hz]
FORCE_ZERO = 0.040 * G  # [m/s2], typical
RATE_ZERO_DPS = 3.0  # typical
TEMPERATURE_LSB_PER_K, TEMPERATURE_ZERO_DEGC = 256, 25.0


@runtime_checkable
class Motion(Protocol):
    """What the chip feels, in its own axes."""

    def specific_force(self) -> Sequence[float]:
        """Return the specific force [m/s2]: at rest, 9.8 away from the ground."""

    def angular_rate(self) -> Sequence[float]:
        """Return the angular rate [rad/s]."""


class Sensor:
    """One of the two sensors: when it samples, and where its three words stand."""

    def __init__(self, first: int, ready: int) -> None:
        self.first = first  # register of its first output
        self.ready = ready  # its bit in STATUS
        self.words = (0, 0, 0)  # of the newest sample
        self.half_read = [0, 0, 0]  # of each word: 1 only its low byte was read, 2 only its high byte
        self.rate_hz = 0.0
        self.count = 0  # samples since it runs at this rate
        self._began_us = 0

    def run(self, rate_hz: float, now_us: int) -> None:
        """Go on at that rate, 0 for power-down; waking up takes its time."""
        if rate_hz != self.rate_hz:
            self._began_us = now_us + (0 if self.rate_hz else TURN_ON_US)
            self.rate_hz, self.count = rate_hz, 0

    def sampled(self, now_us: int) -> bool:
        """Count the samples up to now; return whether there is a new one."""
        if not self.rate_hz or now_us < self._began_us:
            return False
        before, self.count = self.count, int((now_us - self._began_us) * 1e-6 * self.rate_hz) + 1
        return self.count > before


class Lsm6ds3tr:
    """One chip at `address` that rides on `motion`; `seed` makes its zero levels and noise, None an ideal one."""

    def __init__(self, address: int, clock: Clock, motion: Motion, seed: str | None = None) -> None:
        self.address = address
        self.alive = True
        self.stuck = False  # its sensors give the same words over and over, as new ones
        self.identity = IDENTITY
        self.degc = TEMPERATURE_ZERO_DEGC
        self._clock = clock
        self._motion = motion
        self._seed = seed
        self._force_zero = self._zeros("force", FORCE_ZERO)
        self._rate_zero_dps = self._zeros("rate", RATE_ZERO_DPS)
        self.reset()

    def reset(self) -> None:
        """Return to the power-on state: both sensors in power-down."""
        self.registers = bytearray(REGISTERS)
        self.registers[WHO_AM_I], self.registers[CTRL3_C] = self.identity, IF_INC
        self._force, self._rate = Sensor(FORCE, XLDA), Sensor(RATE, GDA)
        self._pointer = 0
        self._resetting_until_us = 0

    def before_change(self) -> None:
        """Sample what was due up to now; to be called before the body moves on."""
        now_us = self._clock.now_us
        for sensor, felt in ((self._force, self._felt_force), (self._rate, self._felt_rate)):
            if sensor.sampled(now_us):
                sensor.words = sensor.words if self.stuck else felt()
                self.registers[STATUS] |= sensor.ready
                self._publish(sensor)

    def answers(self, address: int) -> bool:
        """Its own address only."""
        return self.alive and address == self.address

    def write(self, address: int, data: bytes) -> int:
        """Take a register's address and the values for it and those that follow."""
        self.before_change()
        if data:
            self._pointer = data[0] & (REGISTERS - 1)
        for value in data[1:]:
            self._store(self._pointer, value)
            self._step()
        return len(data)

    def read(self, count: int) -> bytes:
        """Return the register pointed at and those that follow; with IF_INC off the same one over and over."""
        self.before_change()
        return bytes([self._load() for _ in range(count)])

    def _load(self) -> int:
        register = self._pointer
        self._step()
        if register == CTRL3_C and self._clock.now_us < self._resetting_until_us:
            return self.registers[register] | SW_RESET
        swapped = self.registers[CTRL3_C] & BLE and TEMPERATURE <= register < FORCE + 6
        value = self.registers[register ^ 1 if swapped else register]
        for sensor in (self._rate, self._force):
            if sensor.first <= register < sensor.first + 6:
                self._was_read(sensor, register)
        return value

    def _was_read(self, sensor: Sensor, register: int) -> None:
        """A high byte clears the flag of its sensor; a word of which both bytes were read may change again."""
        if register & 1:
            self.registers[STATUS] &= ~sensor.ready
        axis, byte = divmod(register - sensor.first, 2)
        other = sensor.half_read[axis] == 2 - byte
        sensor.half_read[axis] = 0 if other else 1 + byte
        self._publish(sensor)

    def _publish(self, sensor: Sensor) -> None:
        """Show the newest sample, save words that block data update holds because they are half read."""
        update = not self.registers[CTRL3_C] & BDU
        for axis, word in enumerate(sensor.words):
            if update or not sensor.half_read[axis]:
                at = sensor.first + 2 * axis
                self.registers[at : at + 2] = (word & 0xFFFF).to_bytes(2, "little")
        warm = round((self.degc - TEMPERATURE_ZERO_DEGC) * TEMPERATURE_LSB_PER_K) & 0xFFFF
        self.registers[TEMPERATURE : TEMPERATURE + 2] = warm.to_bytes(2, "little")

    def _step(self) -> None:
        if self.registers[CTRL3_C] & IF_INC:
            self._pointer = (self._pointer + 1) & (REGISTERS - 1)

    def _store(self, register: int, value: int) -> None:
        if register in READ_ONLY:
            return
        if register == CTRL3_C and value & SW_RESET:
            pointer = self._pointer
            self.reset()
            self._pointer, self._resetting_until_us = pointer, self._clock.now_us + RESET_US
            return
        self.registers[register] = value
        now_us, low_power = self._clock.now_us, self.registers[CTRL6_C] & XL_HM_OFF
        code, code_g = self.registers[CTRL1_XL] >> 4, self.registers[CTRL2_G] >> 4
        self._force.run((1.6 if low_power else 12.5) if code == LOWEST else _rate_hz(code), now_us)
        self._rate.run(0.0 if self.registers[CTRL4_C] & SLEEP_G else _rate_hz(code_g), now_us)

    def _felt_force(self) -> tuple[int, int, int]:
        scale = self.registers[CTRL1_XL] >> 2 & 3
        density = FORCE_NOISE_16G if scale == SCALE_16G else FORCE_NOISE
        noise = self._noise(self._force, density)
        felt = [sum(parts) for parts in zip(self._motion.specific_force(), self._force_zero, noise, strict=True)]
        return _words(felt, FORCE_LSB[scale])

    def _felt_rate(self) -> tuple[int, int, int]:
        noise = self._noise(self._rate, RATE_NOISE_DPS)
        turned = [DEG_PER_RAD * rate for rate in self._motion.angular_rate()]
        felt = [sum(parts) for parts in zip(turned, self._rate_zero_dps, noise, strict=True)]
        control = self.registers[CTRL2_G]
        return _words(felt, RATE_LSB_125_DPS if control & FS_125 else RATE_LSB_DPS[control >> 2 & 3])

    def _zeros(self, what: str, typical: float) -> list[float]:
        zero = random.Random(f"{self._seed} zero {what}")
        return [0.0 if self._seed is None else zero.uniform(-typical, typical) for _ in range(3)]

    def _noise(self, sensor: Sensor, density: float) -> list[float]:
        """Return the noise of a sample: a function of seed, sensor and number."""
        if self._seed is None:
            return [0.0, 0.0, 0.0]
        noise = random.Random(f"{self._seed} {sensor.first} {sensor.count}")
        return [noise.gauss(0.0, density * sqrt(sensor.rate_hz / 2)) for _ in range(3)]


def _rate_hz(code: int) -> float:
    return RATES_HZ[code] if code < len(RATES_HZ) else 0.0


def _words(values: Sequence[float], lsb: float) -> tuple[int, int, int]:
    """Return three values in bits, held at the ends of the scale."""
    x, y, z = (max(-0x8000, min(0x7FFF, round(value / lsb))) for value in values)
    return x, y, z
