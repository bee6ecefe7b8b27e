"""PCA9685: sixteen PWM outputs behind I2C registers, as the NXP data sheet describes them.

From it, Rev. 2 (July 2009), 3 (September 2010) and 4 (April 2015): registers, wrap of the auto-increment and reserved
addresses (table 3), restart (7.3.1.1), what the counts do (figures 9 and 10, table 7), OE and OUTNE (7.4, table 10),
software reset (7.6). That MODE2 is 04h after a reset is on a page at which nobody here could look; four public models
and drivers agree on it.

Kept faithfully, because drivers trip over them: ALLCALL answers 0x70 after reset; PRE_SCALE is ignored unless asleep;
auto-increment wraps at 45h and FEh; reserved registers are not acknowledged; waking needs 500 us and a RESTART; full
OFF beats full ON; the registers survive a reset of the microcontroller and the outputs go on.

DEVIATION: new counts take effect at STOP and not at the end of the PWM cycle (figure 10), at most 0.7 ms later at
1526 Hz, an eighth of a control step: it would cost an event for every write. OCH, which moves that to the acknowledge
of the fourth byte, changes nothing here. SLEEP sets RESTART at once and not at the end of the cycle, and an orderly
shutdown before it keeps the counts, which the sheet calls invalid: they are all full OFF anyhow.
ASSUMED: no pull-ups on the outputs, so the open-drain setting and high impedance leave a MOSFET's gate low; without a
clock at EXTCLK the outputs stay low; the register for tests (FFh) is not acknowledged, as nobody may write it.
"""

from collections.abc import Callable

from hil_sim.clock import Clock
from hil_sim.devices.i2c import GENERAL_CALL

MODE1, MODE2, SUBADR1, ALLCALLADR, LED0, PRE_SCALE = 0x00, 0x01, 0x02, 0x05, 0x06, 0xFE
RESTART, EXTCLK, AUTO_INCREMENT, SLEEP, ALLCALL = 0x80, 0x40, 0x20, 0x10, 0x01
INVERT, TOTEM_POLE = 0x10, 0x04
SOFTWARE_RESET = 0x06
OSCILLATOR_HZ = 25_000_000
OSCILLATOR_START_US = 500

_LAST_LED, _ALL_LED, _LAST = 0x45, 0xFA, 0xFE
_FULL = 0x10
_OFF = (0.0, 0.0)
_ON = (0.0, 1.0)

Gate = tuple[float, float]  # rising edge and width, as shares of the PWM period; a pulse may wrap around its end


class Pca9685:
    """One chip at `address`. `outputs` are its sixteen gates; `changed` is called when any of them has changed."""

    def __init__(self, address: int, clock: Clock, changed: Callable[[], None]) -> None:
        self.address = address
        self.alive = True
        self.output_enable = False  # True when the OE pin is low
        self.outputs: list[Gate] = [_OFF] * 16
        self._clock = clock
        self._changed = changed
        self.reset()

    def reset(self) -> None:
        """Return to the power-on state, as a power cycle or SWRST does."""
        self.registers = bytearray(256)
        self.registers[MODE1] = SLEEP | ALLCALL
        self.registers[MODE2] = TOTEM_POLE
        self.registers[SUBADR1:LED0] = bytes((0xE2, 0xE4, 0xE8, 0xE0))
        for channel in range(16):
            self.registers[LED0 + 4 * channel + 3] = _FULL
        self.registers[PRE_SCALE] = 0x1E
        self._pointer = 0
        self._woken_us = 0
        self._listen()
        self._refresh()

    @property
    def pwm_period_us(self) -> float:
        """The length of one PWM cycle."""
        return 4096 * (self.registers[PRE_SCALE] + 1) * 1e6 / OSCILLATOR_HZ

    def enable(self, output_enable: bool) -> None:
        """Follow the OE pin: True for the low level that lets the outputs drive."""
        if output_enable != self.output_enable:
            self.output_enable = output_enable
            self._refresh()

    def answers(self, address: int) -> bool:
        """Own address, general call, and ALLCALL and the sub-addresses where MODE1 lets them."""
        return address in self._addresses and self.alive

    def write(self, address: int, data: bytes) -> int:
        """Take a control byte and register bytes; stop acknowledging at a reserved register."""
        if address == GENERAL_CALL:
            return self._general_call(data)
        if not data or _reserved(data[0]):
            return 0
        self._pointer = data[0]
        before = bytes(self.registers[: _LAST_LED + 1])
        for taken, byte in enumerate(data[1:], start=1):
            if _reserved(self._pointer):
                return taken
            self._store(self._pointer, byte)
            self._advance()
        if self.registers[: _LAST_LED + 1] != before:
            self._listen()
            self._refresh()
        return len(data)

    def read(self, count: int) -> bytes:
        """Return registers from the pointer on; the ALL_LED registers read 0."""
        said = bytearray()
        for _ in range(count):
            said.append(self.registers[self._pointer])
            self._advance()
        return bytes(said)

    def _general_call(self, data: bytes) -> int:
        if data[:1] != bytes((SOFTWARE_RESET,)):
            return 0
        self.reset()
        return 1

    def _advance(self) -> None:
        if self.registers[MODE1] & AUTO_INCREMENT:
            self._pointer = 0 if self._pointer in (_LAST_LED, _LAST) else self._pointer + 1

    def _store(self, register: int, byte: int) -> None:
        if register == MODE1:
            self._store_mode1(byte)
        elif register == MODE2:
            self.registers[MODE2] = byte & 0x1F
        elif register <= ALLCALLADR:
            self.registers[register] = byte & 0xFE
        elif register == PRE_SCALE:
            if self.registers[MODE1] & SLEEP:
                self.registers[PRE_SCALE] = max(3, byte)
        else:
            self._store_count(register, byte)

    def _store_count(self, register: int, byte: int) -> None:
        part = (register - LED0) & 3 if register <= _LAST_LED else register - _ALL_LED
        byte &= 0x1F if part in (1, 3) else 0xFF
        if register <= _LAST_LED:
            self.registers[register] = byte
        else:
            for channel in range(16):
                self.registers[LED0 + 4 * channel + part] = byte
        self.registers[MODE1] &= ~RESTART & 0xFF

    def _store_mode1(self, byte: int) -> None:
        old = self.registers[MODE1]
        restart = old & RESTART
        if byte & SLEEP and not old & SLEEP:
            restart = RESTART if self._any_in_use() else 0
        elif not byte & SLEEP and old & SLEEP:
            self._woken_us = self._clock.now_us
        elif byte & RESTART and not old & SLEEP:
            stable = self._clock.now_us - self._woken_us >= OSCILLATOR_START_US
            restart = 0 if stable else restart
        external = old & EXTCLK | (byte & EXTCLK if old & SLEEP else 0)
        self.registers[MODE1] = byte & 0x3F | restart | external

    def _any_in_use(self) -> bool:
        return any(not self.registers[LED0 + 4 * channel + 3] & _FULL for channel in range(16))

    def _listen(self) -> None:
        """Work out the addresses that the registers make it answer."""
        mode1, registers = self.registers[MODE1], self.registers
        groups = enumerate((0x08, 0x04, 0x02, ALLCALL))
        called = {registers[SUBADR1 + index] >> 1 for index, bit in groups if mode1 & bit}
        self._addresses = called | {self.address, GENERAL_CALL}

    def _refresh(self) -> None:
        outputs = self._driven()
        if outputs != self.outputs:
            self.outputs = outputs
            self._changed()

    def _driven(self) -> list[Gate]:
        mode2 = self.registers[MODE2]
        if not mode2 & TOTEM_POLE:
            return [_OFF] * 16
        if not self.output_enable:
            return [_ON if mode2 & 3 == 1 else _OFF] * 16
        gates = [self._gate(channel) for channel in range(16)]
        return [_inverted(gate) for gate in gates] if mode2 & INVERT else gates

    def _gate(self, channel: int) -> Gate:
        at = LED0 + 4 * channel
        on_low, on_high, off_low, off_high = self.registers[at : at + 4]
        if off_high & _FULL or self.registers[MODE1] & (SLEEP | RESTART | EXTCLK):
            return _OFF
        if on_high & _FULL:
            return _ON
        on, off = on_high << 8 | on_low, off_high << 8 | off_low
        if on == off:
            return _OFF
        return on / 4096, (off - on) % 4096 / 4096


def _inverted(gate: Gate) -> Gate:
    on, width = gate
    return ((on + width) % 1.0, 1.0 - width) if 0 < width < 1 else (0.0, 1.0 - width)


def _reserved(register: int) -> bool:
    return _LAST_LED < register < _ALL_LED or register > _LAST
