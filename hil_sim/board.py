"""The netlist of the core board: which pin, bus, chip and coil hang together, and what of that is broken.

The outputs of both PWM chips drive only while the heartbeat keeps the monostable running and the emergency-stop loop
is closed; the monitor's ALERT is the monostable's clear input. The coils are fed only while PWR_EN is high. Both rest
low, hence off, when the processor is reset; the chips keep their registers through that. An attitude sensor is there
where the body has `motion` to be felt; its axes are the core's. Two analogue converters hang on the second SPI
bus, and where there is something to look at, an angle camera on the I2C bus.

    board = Board(clock, journal, supply, outputs=[(0x60, 0), (0x60, 1)], ntc=Ntc())
    board.gates()  # what each coil is driven with
"""

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from hil_sim.clock import Clock
from hil_sim.devices.anglecamera import AngleCamera, Optics
from hil_sim.devices.canframe import Frame
from hil_sim.devices.canwire import CanWire
from hil_sim.devices.converters import Converters
from hil_sim.devices.flash import Flash
from hil_sim.devices.gpio import OUT, Gpio
from hil_sim.devices.i2c import Bus
from hil_sim.devices.ina226 import Ina226
from hil_sim.devices.ina226converter import Source
from hil_sim.devices.lsm6ds3tr import Lsm6ds3tr, Motion
from hil_sim.devices.mcp2515 import Mcp2515
from hil_sim.devices.monostable import Monostable
from hil_sim.devices.ntc import Ntc
from hil_sim.devices.pca9685 import Gate, Pca9685
from hil_sim.devices.pwm import PwmSlices
from hil_sim.devices.remanence import Remanence
from hil_sim.devices.servo import DEAD_BAND_US, Servo
from hil_sim.devices.spi import SpiBus
from hil_sim.devices.uart import Uart
from hil_sim.journal import ADC, CAN_HEARD, CAN_SENT, FAULT, RESET, UART_HEARD, Journal

PWR_EN, HEARTBEAT, ESTOP_SENSE, ALERT = 2, 3, 6, 7
SDA, SCL = 4, 5
SERVOS = (8, 9, 10)
ADC_MISO, ADC_SCK, ADC_MOSI = 12, 14, 15
ADC_SELECTS = (13, 11)  # of the inputs 0 to 7, and 8 to 15
MISO, CAN_SELECT, SCK, MOSI, CAN_INTERRUPT = range(16, 21)
WARM = 21
THERMISTOR_CHANNEL = 0
HEARTBEAT_WINDOW_US = 50_000
PWM_CHIPS = (0x60, 0x61)
MONITOR = 0x40
ATTITUDE = 0x6A
CAMERA = 0x33
_OFF = (0.0, 0.0)
_ON = (0.0, 1.0)


@dataclass
class Broken:
    """What is broken or wrong on a board; `Board.rewired` takes up a change.

    Without the monostable OE, which is active low, hangs on the heartbeat pin alone: its pull-down after a reset then
    ENABLES the outputs, and neither the emergency stop nor ALERT reach them.
    """

    welded: bool = False  # the contactor does not open any more
    bypassed: bool = False  # the monostable was left out
    stuck: set[int] = field(default_factory=set)  # coils whose MOSFET conducts for ever


class Board:
    """Chips and wires around one processor. `changed` is called when the drive of any coil may have changed."""

    def __init__(
        self,
        clock: Clock,
        journal: Journal,
        source: Source,
        outputs: Sequence[tuple[int, int]],
        ntc: Ntc,
        baud: int = 115_200,
        identity: str = "softrig",
        motion: Motion | None = None,
        can_wire: CanWire | None = None,
        camera: Optics | None = None,
        servo_dead_band_us: float = DEAD_BAND_US,
    ) -> None:
        self.clock = clock
        self.journal = journal
        self.changed: Callable[[], None] = _nothing
        self.degc = 25.0
        self.broken = Broken()
        self.estop_closed = True
        self.unique_id = hashlib.sha256(identity.encode()).digest()[:8]
        self.pwm = {address: Pca9685(address, clock, self._on_change) for address in PWM_CHIPS}
        self.monitor = Ina226(MONITOR, clock, source, self._on_alert)
        self.imu = None if motion is None else Lsm6ds3tr(ATTITUDE, clock, motion, identity)
        self.camera = None if camera is None else AngleCamera(CAMERA, clock, camera, identity)
        self.bus = Bus([*self.pwm.values(), self.monitor])
        self.bus.chips += [chip for chip in (self.imu, self.camera) if chip is not None]
        self.ntc = ntc
        self.flash = Flash({})
        self.uart = Uart(baud)
        self.monostable = Monostable(clock, HEARTBEAT_WINDOW_US, self._on_enable)
        self.gpio = Gpio(clock, journal)
        self.can_wire = can_wire or CanWire(clock)
        self.can = Mcp2515(clock, self.can_wire, passed=self._on_frame)
        self.adc = Converters()
        self.spi = SpiBus({CAN_SELECT: self.can}, self._is_low)
        self.adc_spi = SpiBus(dict(zip(ADC_SELECTS, self.adc.chips, strict=True)), self._is_low)
        self.pulses = PwmSlices(clock, journal)
        self.servos = {pin: Servo(dead_band_us=servo_dead_band_us) for pin in SERVOS}
        self.remanence = Remanence(clock)
        self.gpio.watchers[PWR_EN] = self._on_power
        self.gpio.sources[WARM] = self.remanence.level
        self.gpio.watchers[HEARTBEAT] = lambda _: self._on_beat()
        self.gpio.sources[ESTOP_SENSE] = lambda: 1 if self.estop_closed else None
        self.gpio.sources[ALERT] = self.monitor.alert_level
        self.gpio.watchers[CAN_SELECT] = lambda _: self.spi.look()
        for pin in ADC_SELECTS:
            self.gpio.watchers[pin] = lambda _: self.adc_spi.look()
        self.gpio.sources[CAN_INTERRUPT] = self.can.int_level
        for pin, servo in self.servos.items():
            self.pulses.watch(pin, servo.pulsed)
        self._outputs = [(self.pwm[chip], output) for chip, output in outputs]

    def gates(self) -> list[Gate]:
        """Return what each coil is driven with: nothing while its supply is open."""
        if not self.powered:
            return [_OFF] * len(self._outputs)
        gates = [chip.outputs[output] for chip, output in self._outputs]
        for coil in self.broken.stuck:
            gates[coil] = _ON
        return gates

    @property
    def powered(self) -> bool:
        """Whether the contactor feeds the coils."""
        return self.broken.welded or self.gpio.driven(PWR_EN) == 1

    @property
    def enabled(self) -> bool:
        """Whether the wires let the PWM chips drive their outputs."""
        if self.broken.bypassed:
            return not self.gpio.driven(HEARTBEAT)
        return self.monostable.running and self.estop_closed

    def rewired(self) -> None:
        """Take up that something broke or was mended."""
        self._on_enable()
        self._on_change()

    def pwm_period_us(self) -> float:
        """Return the length of a PWM period."""
        return self.pwm[PWM_CHIPS[0]].pwm_period_us

    def convert(self, channel: int) -> int:
        """Return the 12-bit result of an analogue input; an unconnected one reads 0."""
        counts = self.ntc.counts(self.degc, self.clock.now_us) if channel == THERMISTOR_CHANNEL else 0
        self.journal.note(self.clock.now_us, ADC, channel, counts.to_bytes(2, "little"))
        return counts

    def reset_processor(self, cause: int) -> None:
        """Reset the pins and the processor's own peripherals; the chips keep their state."""
        self.journal.note(self.clock.now_us, RESET, cause, b"")
        self.gpio.reset()
        self.spi.look()
        self.adc_spi.look()
        self.pulses.reset()
        self.uart.close(self.clock.now_us)

    def power_cycle(self) -> None:
        """Take the board's own supply away and give it back: the chips forget, too."""
        for chip in self.pwm.values():
            chip.reset()
        self.monitor.reset()
        self.can.reset()
        self.adc.reset()
        for sensor in (self.imu, self.camera):
            if sensor is not None:
                sensor.reset()

    def host_write(self, data: bytes) -> None:
        """Put bytes of the host on the serial line."""
        self.journal.note(self.clock.now_us, UART_HEARD, 0, data)
        self.uart.host_write(data, self.clock.now_us)

    def set_estop(self, closed: bool) -> None:
        """Close or open the emergency-stop loop."""
        self.journal.note(self.clock.now_us, FAULT, ESTOP_SENSE, b"\x01" if closed else b"\x00")
        self.estop_closed = closed
        self._on_enable()

    def unplug(self) -> None:
        """Take the board off the CAN bus for good."""
        if self.can.can in self.can_wire.nodes:
            self.can_wire.leave(self.can.can)

    def _is_low(self, pin: int) -> bool:
        """Return whether the processor drives a pin low."""
        return self.gpio.mode(pin) == OUT and not self.gpio.driven(pin)

    def _on_frame(self, frame: Frame, outward: bool) -> None:
        flags = bytes((frame.extended << 1 | frame.remote, frame.length))
        self.journal.note(self.clock.now_us, CAN_SENT if outward else CAN_HEARD, frame.id, flags + frame.data)

    def _on_beat(self) -> None:
        self.monostable.edge()
        if self.broken.bypassed:
            self._on_enable()

    def _on_alert(self) -> None:
        self.monostable.clear(held=not self.monitor.alert_level())

    def _on_enable(self) -> None:
        for chip in self.pwm.values():
            chip.enable(self.enabled)

    def _on_power(self, level: int) -> None:
        self.remanence.feed(level)
        self._on_change()

    def _on_change(self) -> None:
        self.changed()


def _nothing() -> None:
    """What a board does about changed gates before a bench listens."""
