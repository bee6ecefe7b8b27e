"""INA226: current and voltage of the common supply behind 16-bit registers, as the TI data sheet describes them.

Texas Instruments SBOS547 (June 2011) and SBOS547B (September 2024): registers and values after reset (table 7-1), order
of conversions and averages (6.3.1, figure 6-1), current = shunt * calibration / 2048 (equation 3), bits of 2.5 uV,
1.25 mV and 25 current bits for power; Linux has the same numbers (hwmon/ina2xx.c: shunt_div 400, 2048, 1250, 25;
iio/adc/ina2xx-adc.c: 0.00512). The limit is held against every single conversion and not against the average: figure
19 of the 2011 sheet as TI explains it (e2e.ti.com, thread 856374). So a pulsed current may alert while its mean is
below the limit.

Conversions run by themselves at the configured times and averages, and each result is the mean of its own window. No
event is needed for that: the chip works out what it would have converted when it is next asked, and once more
(`before_change`) before the supply changes. Conversions end with events, for an alert pin that acts without being
read, only while what is watched can happen (`after_change`): not while the supply's peak is below an over-current
limit. Conversions and PWM are not synchronous, so a short one of a pulsed current aliases, as on the real board.

DEVIATION: power is the product of the averages, where the chip averages products; nothing here reads it. ASSUMED: a
turn is a shunt and then a bus conversion; results round to the nearest bit, current and power towards zero; a limit
set within a turn is held against the next one first; an alert that is not latched ends with its function.
"""

from collections.abc import Callable

from hil_sim.clock import Clock, Event
from hil_sim.devices.ina226converter import SHUNT_LSB_V, Converter, Source
from hil_sim.devices.ina226registers import (
    ALERT_FLAG,
    ALERT_HIGH,
    CALIBRATION,
    CONFIG,
    LATCH,
    LIMIT,
    LIMITS,
    MASK,
    OF_SHUNT,
    OVERFLOW_FLAG,
    READY_ALERT,
    READY_FLAG,
    RESET,
    SHUNT_OVER,
    WATCHED,
    after_reset,
    is_beyond_limit,
    signed,
    take_averages,
)


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
        self._converter = Converter(source)
        self.reset()

    def reset(self) -> None:
        """Return to the power-on state: calibration 0, so current and power read 0 until it is written."""
        self.registers = after_reset()
        self._pointer = 0
        self._quiet = True  # nothing that is watched can happen before the source or a register changes
        self._begin()
        self._tell()

    def catch_up(self) -> None:
        """Finish all conversions that have ended by now."""
        now_us, converter = self._clock.now_us, self._converter
        if self._settled:
            self._repeat(now_us)
            return
        while converter.cycle_us and now_us - converter.begun_us >= converter.cycle_us:
            if not self._quiet:
                self._compare_until(converter.begun_us + converter.cycle_us)
            converter.convert_cycle()
            self._finish()
            if self._settled:
                self._repeat(now_us)
                return
            self._skip(now_us)
        if not self._quiet:
            self._compare_until(now_us)

    def before_change(self) -> None:
        """Convert up to now with what has been on the inputs; to be called before the source changes."""
        self.catch_up()
        self._settled = False
        if self._converter.cycle_us:
            self._converter.convert(self._clock.now_us)
            self._pure = self._converter.seen_us == self._converter.begun_us

    def after_change(self) -> None:
        """See whether what is watched may happen now; to be called after the source has changed."""
        if self._quiet and not self._is_quiet():
            self._quiet = False
            self._watch()

    def alert_level(self) -> int:
        """Return the level of the open-drain alert pin with its pull-up: 0 while it alerts."""
        if not self._quiet:
            self.catch_up()
        return self._pin()

    def answers(self, address: int) -> bool:
        """Its own address only."""
        return self.alive and address == self.address

    def write(self, address: int, data: bytes) -> int:
        """Take a register pointer and, where there are two more bytes, a value."""
        if data:
            self._pointer = data[0]
        if len(data) >= 3:
            self.catch_up()
            self._settled = False
            if self._converter.cycle_us:
                self._converter.convert(self._clock.now_us)
            self._store(data[0], data[1] << 8 | data[2])
            self._quiet = not self.registers[MASK] & WATCHED
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
        if not old & LIMITS and self._converter.cycle_us:
            self._converter.turn_counts = self._converter.at_turn_end

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

    def _is_quiet(self) -> bool:
        """Return whether nothing that is watched can happen with what is on the inputs now."""
        mask = self.registers[MASK]
        if not mask & WATCHED:
            return True
        if not mask & SHUNT_OVER or mask & READY_ALERT or (mask & ALERT_FLAG and not mask & LATCH):
            return False
        return self._source.peak_shunt_v() < signed(self.registers[LIMIT]) * SHUNT_LSB_V

    def _watch(self) -> None:
        """See to it that a conversion that is watched is looked at when it ends."""
        if self._look_at is not None:
            self._look_at.cancel()
            self._look_at = None
        if not self._quiet and self._converter.cycle_us:
            self._look_at = self._clock.at(self._due_us(), self._look)

    def _due_us(self) -> int:
        """Return when a conversion ends that is watched."""
        watched = self.registers[MASK]
        if not watched & LIMITS:
            return self._converter.begun_us + self._converter.cycle_us
        return self._converter.shunt_end_us() if watched & OF_SHUNT else self._converter.conversion_end_us()

    def _look(self) -> None:
        """Hold a conversion that ends now against the limit; what comes after it has nothing but what is there now."""
        self.catch_up()
        self._quiet = self._is_quiet()
        self._watch()
        self._tell()

    def _begin(self) -> None:
        """Start a conversion as CONFIG says."""
        self._converter.begin(self.registers[CONFIG], self._clock.now_us)
        self._pure = True  # nothing has changed since this conversion began
        self._settled = False  # True: the last conversion and all since saw no change, its results repeat

    def _skip(self, now_us: int) -> None:
        """Leave out conversions whose results nobody can see: all but the last one before now."""
        converter = self._converter
        if self._quiet and converter.cycle_us:
            unseen = max(0, (now_us - converter.begun_us) // converter.cycle_us - 1)
            converter.begin_cycle(converter.begun_us + unseen * converter.cycle_us)

    def _repeat(self, now_us: int) -> None:
        """Take whole conversions as done without a change of the results."""
        converter = self._converter
        cycles = (now_us - converter.begun_us) // converter.cycle_us
        if cycles:
            converter.begin_cycle(converter.begun_us + cycles * converter.cycle_us)
            self.registers[MASK] |= READY_FLAG

    def _compare_until(self, until_us: int) -> None:
        """Hold every conversion that ends by then against the limit, if one is watched."""
        converter, mask = self._converter, self.registers[MASK]
        while mask & LIMITS and converter.cycle_us and converter.conversion_end_us() <= until_us:
            converter.end_conversion()
            if converter.turn_counts and (converter.at_shunt_end if mask & OF_SHUNT else converter.at_turn_end):
                self._compare()
            if converter.at_turn_end:
                converter.begin_turn()

    def _compare(self) -> None:
        if is_beyond_limit(self.registers, *self._converter.turn_bits()):
            self.registers[MASK] |= ALERT_FLAG
        elif not self.registers[MASK] & LATCH:
            self.registers[MASK] &= ~ALERT_FLAG

    def _finish(self) -> None:
        """Put the averages of a cycle into the registers and begin the next."""
        converter = self._converter
        take_averages(self.registers, *converter.cycle_bits())
        self._settled = self._pure and self._quiet and self._source.steady_v() is not None
        self._pure = True
        converter.begin_cycle(converter.seen_us)
        if not self.registers[CONFIG] & 4:  # one shot
            converter.cycle_us, self._settled = 0, False
