"""INA226: current and voltage of the common supply behind 16-bit registers, as the TI data sheet describes them.

Texas Instruments SBOS547 (June 2011) and SBOS547B (September 2024): registers and values after reset (table 7-1), order
of conversions and averages (6.3.1, figure 6-1), current = shunt * calibration / 2048 (equation 3), bits of 2.5 uV,
1.25 mV and 25 current bits for power; Linux has the same numbers (hwmon/ina2xx.c: shunt_div 400, 2048, 1250, 25;
iio/adc/ina2xx-adc.c: 0.00512). The limit is held against every single conversion and not against the average: figure
19 of the 2011 sheet as TI explains it (e2e.ti.com, thread 856374). So a pulsed current may alert while its mean is
below the limit.

Conversions run by themselves at the configured times and averages, and each result is the mean of its own window. No
event is needed for that: the chip works out what it would have converted when it is next asked, and once more
(`before_change`) before the supply changes. Only while something is watched does a conversion end with an event, as
the alert pin acts without being read. Conversions and PWM are not synchronous, so a short conversion of a pulsed
current aliases, as on the real board.

DEVIATION: power is the product of the averages, where the chip averages products; nothing here reads it. ASSUMED: a
turn is a shunt and then a bus conversion; results round to the nearest bit, current and power towards zero; a limit
set within a turn is held against the next one first; an alert that is not latched ends with its function.
"""

from collections.abc import Callable
from typing import Protocol

from hil_sim.clock import Clock, Event

CONFIG, SHUNT, BUS, POWER, CURRENT, CALIBRATION, MASK, LIMIT, MAKER_ID, DIE_ID = (*range(8), 0xFE, 0xFF)
RESET = 0x8000
SHUNT_OVER, SHUNT_UNDER, BUS_OVER, BUS_UNDER, POWER_OVER, READY_ALERT = 0x8000, 0x4000, 0x2000, 0x1000, 0x800, 0x400
OF_SHUNT, LIMITS, WATCHED = 0xC000, 0xF800, 0xFC00
ALERT_FLAG, READY_FLAG, OVERFLOW_FLAG, ALERT_HIGH, LATCH = 0x10, 0x08, 0x04, 0x02, 0x01
SHUNT_LSB_V = 2.5e-6
BUS_LSB_V = 1.25e-3
CONVERSION_US = (140, 204, 332, 588, 1100, 2116, 4156, 8244)
AVERAGES = (1, 4, 16, 64, 128, 256, 512, 1024)


class Source(Protocol):
    """What is on the chip's inputs."""

    def steady_v(self) -> tuple[float, float] | None:
        """Return the voltages across the shunt and at the bus pin, or None while they ripple."""

    def integrals_vus(
        self, begun_us: int, from_us: int, until_us: int, shunt_us: int, bus_us: int
    ) -> tuple[float, float]:
        """Return shunt and bus voltage integrated over those parts of from_us..until_us that belong to each.

        Since begun_us, conversions of the shunt (shunt_us long) and of the bus (bus_us) take turns.
        """


class Ina226:
    """One chip at `address` that measures `source`; `alerted` is called when the level of its alert pin has changed."""

    def __init__(self, address: int, clock: Clock, source: Source, alerted: Callable[[], None] | None = None) -> None:
        self.address = address
        self.alive = True
        self._alerted = alerted
        self._level = 1  # of the alert pin, as last told
        self._look_at: Event | None = None
        self._clock = clock
        self._source = source
        self._settled = False  # the last conversion and all since saw no change: its results repeat
        self._pure = True  # nothing has changed since this conversion began
        self.reset()

    def reset(self) -> None:
        """Return to the power-on state: calibration 0, so current and power read 0 until it is written."""
        self.registers = dict.fromkeys(range(8), 0) | {CONFIG: 0x4127, MAKER_ID: 0x5449, DIE_ID: 0x2260}
        self._pointer = 0
        self._begin()
        self._tell()

    def catch_up(self) -> None:
        """Finish all conversions that have ended by now."""
        now_us = self._clock.now_us
        if self._settled:
            self._repeat(now_us)
            return
        while self._cycle_us and now_us - self._begun_us >= self._cycle_us:
            self._compare_until(self._begun_us + self._cycle_us)
            self._integrate(self._begun_us + self._cycle_us)
            self._finish()
            if self._settled:
                self._repeat(now_us)
                return
            self._skip(now_us)
        self._compare_until(now_us)

    def before_change(self) -> None:
        """Convert up to now with what has been on the inputs; to be called before the source changes."""
        self.catch_up()
        self._settled = False
        if self._cycle_us:
            self._integrate(self._clock.now_us)
            self._pure = self._seen_us == self._begun_us

    def alert_level(self) -> int:
        """Return the level of the open-drain alert pin with its pull-up: 0 while it alerts."""
        self.catch_up()
        return self._pin()

    def answers(self, address: int) -> bool:
        """Its own address only."""
        return self.alive and address == self.address

    def write(self, address: int, data: bytes) -> int:
        """Take a register pointer and, where there are two more bytes, a value."""
        self.catch_up()
        if data:
            self._pointer = data[0]
        if len(data) >= 3:
            self._settled = False
            self._store(data[0], data[1] << 8 | data[2])
            self._watch()
            self._tell()
        return len(data)

    def read(self, count: int) -> bytes:
        """Return the register pointed at, high byte first, over and over."""
        self.catch_up()
        value = self.registers.get(self._pointer, 0)
        if self._pointer == MASK:
            self._acknowledge()
            self._tell()
        return (value.to_bytes(2, "big") * (count // 2 + 1))[:count]

    def _store(self, register: int, value: int) -> None:
        if register == CONFIG and value & RESET:
            self.reset()
        elif register == CONFIG:
            self.registers[CONFIG] = value & 0x0FFF | 0x4000
            if value & 3:  # power-down leaves it
                self.registers[MASK] &= ~READY_FLAG
            self._begin()
        elif register == CALIBRATION:
            self.registers[CALIBRATION] = value & 0x7FFF
        elif register == MASK:
            self._store_mask(value)
        elif register == LIMIT:
            self.registers[LIMIT] = value

    def _store_mask(self, value: int) -> None:
        """Take what is to be watched; an alert stays if it is latched, or its function is."""
        old = self.registers[MASK]
        kept = READY_FLAG | OVERFLOW_FLAG | (ALERT_FLAG if value & (LIMITS | LATCH) else 0)
        self.registers[MASK] = value & (WATCHED | ALERT_HIGH | LATCH) | old & kept
        if not old & LIMITS and self._cycle_us:
            self._integrate(self._clock.now_us)
            self._turn_shunt = self._turn_bus = 0.0
            self._turn_known = self._seen_us == self._begun_us

    def _acknowledge(self) -> None:
        self.registers[MASK] &= ~READY_FLAG
        if self.registers[MASK] & LATCH:
            self.registers[MASK] &= ~ALERT_FLAG

    def _pin(self) -> int:
        mask = self.registers[MASK]
        asserted = mask & ALERT_FLAG or (mask & READY_ALERT and mask & READY_FLAG)
        return int(bool(asserted) == bool(mask & ALERT_HIGH))

    def _tell(self) -> None:
        if self._level != self._pin():
            self._level = self._pin()
            if self._alerted is not None:
                self._alerted()

    def _watch(self) -> None:
        """See to it that a conversion that is watched is looked at when it ends."""
        watched = self.registers[MASK] & WATCHED
        if self._look_at is not None or not self._cycle_us or not watched:
            return
        due_us = self._begun_us + self._cycle_us
        if watched & LIMITS:
            due_us = self._conversion_end()
            if watched & OF_SHUNT and (due_us - self._begun_us) % self._turn_us != self._shunt_us % self._turn_us:
                due_us += self._shunt_us
        self._look_at = self._clock.at(due_us, self._look)

    def _look(self) -> None:
        self._look_at = None
        self.catch_up()
        self._watch()
        self._tell()

    def _begin(self) -> None:
        """Start a conversion as CONFIG says."""
        config = self.registers[CONFIG]
        self._averages = AVERAGES[config >> 9 & 7]
        self._shunt_us = CONVERSION_US[config >> 3 & 7] if config & 1 else 0
        self._bus_us = CONVERSION_US[config >> 6 & 7] if config & 2 else 0
        self._turn_us = self._shunt_us + self._bus_us
        self._cycle_us = self._turn_us * self._averages
        self._begun_us = self._seen_us = self._clock.now_us
        self._shunt_sum = self._bus_sum = 0.0
        self._turn_shunt = self._turn_bus = 0.0  # of this turn alone
        self._turn_known = True  # from its beginning
        self._pure, self._settled = True, False

    def _skip(self, now_us: int) -> None:
        """Leave out conversions whose results nobody can see: all but the last one before now."""
        if self._cycle_us and not self.registers[MASK] & WATCHED:
            unseen = max(0, (now_us - self._begun_us) // self._cycle_us - 1)
            self._begun_us = self._seen_us = self._begun_us + unseen * self._cycle_us

    def _repeat(self, now_us: int) -> None:
        """Take whole conversions as done without a change of the results."""
        turns = (now_us - self._begun_us) // self._cycle_us
        if turns:
            self._begun_us = self._seen_us = self._begun_us + turns * self._cycle_us
            self._shunt_sum = self._bus_sum = 0.0
            self.registers[MASK] |= READY_FLAG

    def _conversion_end(self) -> int:
        """Return when the conversion ends that is under way."""
        place_us = (self._seen_us - self._begun_us) % self._turn_us
        length_us = self._shunt_us if place_us < self._shunt_us else self._turn_us
        return self._seen_us + length_us - place_us

    def _compare_until(self, until_us: int) -> None:
        """Hold every conversion that ends by then against the limit, if one is watched."""
        while self._cycle_us and self.registers[MASK] & LIMITS and self._conversion_end() <= until_us:
            self._integrate(self._conversion_end())
            place_us = (self._seen_us - self._begun_us) % self._turn_us
            of_shunt = bool(self.registers[MASK] & OF_SHUNT)
            if self._turn_known and place_us == (self._shunt_us % self._turn_us if of_shunt else 0):
                self._compare()
            if place_us == 0:
                self._turn_shunt = self._turn_bus = 0.0
                self._turn_known = True

    def _compare(self) -> None:
        if self._beyond_limit():
            self.registers[MASK] |= ALERT_FLAG
        elif not self.registers[MASK] & LATCH:
            self.registers[MASK] &= ~ALERT_FLAG

    def _beyond_limit(self) -> bool:
        """Return whether the one watched value, the highest bit where several are set, is beyond the limit."""
        mask, limit = self.registers[MASK], self.registers[LIMIT]
        shunt = _bits(self._turn_shunt, self._shunt_us, SHUNT_LSB_V)
        bus = max(0, _bits(self._turn_bus, self._bus_us, BUS_LSB_V))
        power = abs(int(shunt * self.registers[CALIBRATION] / 2048)) * bus // 20_000
        watched = (
            (SHUNT_OVER, shunt > _signed(limit)),
            (SHUNT_UNDER, shunt < _signed(limit)),
            (BUS_OVER, bus > limit),
            (BUS_UNDER, bus < limit),
            (POWER_OVER, power > limit),
        )
        return next((beyond for bit, beyond in watched if mask & bit), False)

    def _integrate(self, until_us: int) -> None:
        """Add what has been on the inputs between the time last seen and `until_us` to the sums."""
        steady = self._source.steady_v()
        if steady is None:
            shunt_vus, bus_vus = self._source.integrals_vus(
                self._begun_us, self._seen_us, until_us, self._shunt_us, self._bus_us
            )
        else:
            past_us, end_us = self._seen_us - self._begun_us, until_us - self._begun_us
            shunt_us = self._shunt_time(end_us) - self._shunt_time(past_us)
            shunt_vus, bus_vus = steady[0] * shunt_us, steady[1] * (end_us - past_us - shunt_us)
        self._shunt_sum += shunt_vus
        self._bus_sum += bus_vus
        self._turn_shunt += shunt_vus
        self._turn_bus += bus_vus
        self._seen_us = until_us

    def _shunt_time(self, elapsed_us: int) -> int:
        """Return how much of the first `elapsed_us` of a cycle went into shunt conversions."""
        turns, rest_us = divmod(elapsed_us, self._turn_us)
        return turns * self._shunt_us + min(rest_us, self._shunt_us)

    def _finish(self) -> None:
        registers = self.registers
        if self._shunt_us:
            shunt = _bits(self._shunt_sum, self._shunt_us * self._averages, SHUNT_LSB_V)
            registers[SHUNT] = shunt & 0xFFFF
            current = int(shunt * registers[CALIBRATION] / 2048)
            registers[CURRENT] = max(-0x8000, min(0x7FFF, current)) & 0xFFFF
            overflow = OVERFLOW_FLAG if not -0x8000 <= current <= 0x7FFF else 0
            registers[MASK] = registers[MASK] & ~OVERFLOW_FLAG | overflow
        if self._bus_us:
            registers[BUS] = max(0, _bits(self._bus_sum, self._bus_us * self._averages, BUS_LSB_V))
        registers[POWER] = min(0xFFFF, abs(_signed(registers[CURRENT])) * registers[BUS] // 20_000)
        registers[MASK] |= READY_FLAG
        self._begun_us = self._seen_us
        self._shunt_sum = self._bus_sum = 0.0
        watched = registers[MASK] & WATCHED
        self._settled = self._pure and not watched and self._source.steady_v() is not None
        self._pure = True
        if not registers[CONFIG] & 4:
            self._cycle_us, self._settled = 0, False  # one shot


def _bits(sum_vus: float, time_us: int, lsb_v: float) -> int:
    """Return the mean of a sum in bits, held at the ends of the scale; 0 where nothing was converted."""
    return max(-0x8000, min(0x7FFF, round(sum_vus / time_us / lsb_v))) if time_us else 0


def _signed(value: int) -> int:
    return value - 0x10000 if value & 0x8000 else value
