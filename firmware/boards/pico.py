"""The Pico-class board: which pin is which, and the chips on its bus.

Two PCA9685 drive the coils' low-side MOSFETs, an INA226 watches the common supply, a thermistor the board; some robots
carry an LSM6DS3TR-C besides, for their attitude. Robots with joints have servos on PWM pins, one or two MCP3208 that
measure, and an angle camera on the bus. The outputs are enabled only while the heartbeat pin keeps moving (a
retriggerable monostable of 50 ms) and the emergency-stop loop is closed: a hung processor cannot hold a coil on. An
MCP2515 joins the robot to a CAN bus where it is fitted.
"""

import sys
import time

from machine import ADC, I2C, PWM, SPI, UART, WDT, Pin, unique_id

from firmware.dictionary import Dictionary
from firmware.drivers.ina226 import Ina226
from firmware.drivers.lsm6ds3tr import Lsm6ds3tr
from firmware.drivers.ntc import decidegc
from firmware.drivers.pca9685 import Pca9685

# GP numbers; docs/hardware.md has what each is wired to. boot.py and main.py, which import nothing, repeat five.
TX, RX, PWR_EN, HEARTBEAT, SDA, SCL, ESTOP_SENSE, ALERT = 0, 1, 2, 3, 4, 5, 6, 7
SERVOS = (8, 9, 10)
ADC_MISO, ADC_SCK, ADC_MOSI = 12, 14, 15
ADC_SELECTS = (13, 11)  # of the converter's inputs 0 to 7, and 8 to 15
MISO, CAN_SELECT, SCK, MOSI, CAN_INTERRUPT = 16, 17, 18, 19, 20
WARM, STRAP, THERMISTOR = 21, 22, 26
MONITOR = 0x40
WATCHDOG_MS = 200
WRITING_MS = 2000  # the flash erases a sector in 45 ms, at worst in 400 ms (W25Q16JV), and a file may take two
BAUD = 115_200  # to begin with, see rates.py
BUFFER_BYTES = 512
HEARD_BYTES = 1024  # of the receive buffer: what a host with full credit sends while a step is late fits in
CRYSTAL_HZ = 8_000_000  # of the MCP2515
SPI_HZ = 8_000_000
ADC_HZ = 1_000_000  # what the MCP3208 is promised to follow at 2.7 V and above
QUIET_US, BUSY_US = 500, 200  # between two looks at the CAN bus; the second while frames wait to be sent
CREDIT_BYTES = 960  # of unacknowledged frames; what is acknowledged to nobody, as a hello, needs the rest


class Board:
    """The hardware as the core sees it: a supply switch, a heartbeat, PWM outputs, sensors and a serial line."""

    credit_bytes = CREDIT_BYTES

    def __init__(self) -> None:
        self.serial = unique_id()
        self._power = Pin(PWR_EN, Pin.OUT, value=0)
        self._heartbeat = Pin(HEARTBEAT, Pin.OUT, value=0)
        self._estop = Pin(ESTOP_SENSE, Pin.IN, Pin.PULL_DOWN)
        self._alert = Pin(ALERT, Pin.IN, Pin.PULL_UP)
        self._warm = Pin(WARM, Pin.IN, Pin.PULL_UP)
        self._beat = 0
        self._bus = Attended(I2C(0, scl=Pin(SCL), sda=Pin(SDA), freq=400_000, timeout=1000))
        self.tune(BAUD)
        self._thermistor = ADC(Pin(THERMISTOR))
        self.watch()

    def pwm(self, address: int) -> Pca9685:
        """Return the driver of the PWM chip at that address."""
        return Pca9685(self._bus, address)

    def monitor(self, shunt_mohm: int, alert_ma: int) -> Ina226:
        """Return the driver of the monitor of the coil supply, which pulls its alert pin at that current."""
        return Ina226(self._bus, MONITOR, shunt_mohm, alert_ma)

    def imu(self, address: int) -> Lsm6ds3tr:
        """Return the driver of the attitude sensor at that address."""
        return Lsm6ds3tr(self._bus, address)

    def adc(self):
        """Return the driver of the two converters, inputs 0 to 15; see `can` for its import.

        Both selects are high from here on: a robot without the second chip never reads beyond the first one's inputs.
        """
        from firmware.drivers.mcp3208 import Mcp3208  # noqa: PLC0415

        spi = SPI(1, ADC_HZ, sck=Pin(ADC_SCK), mosi=Pin(ADC_MOSI), miso=Pin(ADC_MISO))
        return Mcp3208(spi, *[Pin(pin, Pin.OUT, value=1) for pin in ADC_SELECTS])

    def servo(self, pin: int, hz: int):
        """Return the driver of the servo on that pin, one of SERVOS, with so many pulses a second."""
        from firmware.drivers.servo import Servo  # noqa: PLC0415

        return Servo(PWM(Pin(pin)), hz)

    def camera(self, address: int):
        """Return the driver of the angle camera at that address."""
        from firmware.drivers.anglecamera import AngleCamera  # noqa: PLC0415

        return AngleCamera(self._bus, address)

    def can(self, node: int):
        """Return the CAN port of a robot with that number, or None when there is no controller.

        What it takes is loaded only here: a robot without a number has that memory for itself.
        """
        from firmware.canport import CanPort  # noqa: PLC0415
        from firmware.drivers.mcp2515 import Mcp2515  # noqa: PLC0415

        spi = SPI(0, SPI_HZ, sck=Pin(SCK), mosi=Pin(MOSI), miso=Pin(MISO))
        chip = Mcp2515(spi, Pin(CAN_SELECT, Pin.OUT, value=1), CRYSTAL_HZ)
        try:
            self._bus.port = CanPort(chip, Pin(CAN_INTERRUPT, Pin.IN, Pin.PULL_UP), node)
        except OSError:
            return None
        return self._bus.port

    def rest(self, time_ms: int) -> None:
        """Let time pass between two control steps; the CAN bus is looked after meanwhile, if anybody is on it."""
        port = self._bus.port
        if port is None or not port.awake:
            time.sleep_ms(time_ms)
            return
        left_us = time_ms * 1000
        end = time.ticks_add(time.ticks_us(), left_us)
        while left_us > 0:
            port.look()
            time.sleep_us(min(left_us, BUSY_US if port.waiting() else QUIET_US))
            left_us = time.ticks_diff(end, time.ticks_us())

    def power(self, on: bool) -> None:
        """Switch the coil supply."""
        self._power.value(1 if on else 0)

    def beat(self) -> None:
        """Move the heartbeat: outputs stay enabled for another 50 ms."""
        self._beat = 1 - self._beat
        self._heartbeat.value(self._beat)

    def estop_closed(self) -> bool:
        """Return whether the emergency-stop loop is closed."""
        return self._estop.value() == 1

    def alert(self) -> bool:
        """Return whether the monitor has seen too much current; it has opened the outputs by itself then."""
        return self._alert.value() == 0

    def warm(self) -> bool:
        """Return whether the coil supply was closed within the last minute or so: asked before it is closed again."""
        return self._warm.value() == 0

    def wait_us(self, time_us: int) -> None:
        """Let time pass within a control step."""
        time.sleep_us(time_us)

    def board_decidegc(self) -> int:
        """Return the board's temperature; far outside -40..150 C when the thermistor is open or shorted."""
        return decidegc(self._thermistor.read_u16())

    def tune(self, baud: int) -> None:
        """Run the serial line at that rate; what is on it is lost."""
        self._baud = baud
        self.byte_ns = 10 * 1_000_000_000 // baud
        self.noise = 0  # bytes that have arrived since somebody last set it to 0
        self._cut = b"\x00"  # ends what had arrived of a frame
        self._uart = UART(0, baudrate=baud, tx=Pin(TX), rx=Pin(RX), txbuf=BUFFER_BYTES, rxbuf=HEARD_BYTES)
        self._quiet_ms = time.ticks_ms()  # when the line will have sent all that was written

    def read(self) -> bytes:
        """Return the bytes that have arrived."""
        data = self._uart.read()
        if not data:
            return b""
        self.noise += len(data)
        if self._cut:
            data = self._cut + data
            self._cut = b""
        return data

    def room(self) -> int:
        """Return how many bytes `write` takes now."""
        busy_ms = max(0, time.ticks_diff(self._quiet_ms, time.ticks_ms()))
        return BUFFER_BYTES - busy_ms * self._baud // 10_000

    def write(self, data: bytes) -> None:
        """Send bytes to the host; what is more than `room` would be lost."""
        if data:
            now_ms = time.ticks_ms()
            begin_ms = self._quiet_ms if time.ticks_diff(self._quiet_ms, now_ms) > 0 else now_ms
            self._quiet_ms = time.ticks_add(begin_ms, 1 + len(data) * 10_000 // self._baud)
            self._uart.write(data)

    def dictionary(self) -> Dictionary:
        """Return the dictionary of the slot that runs."""
        return Dictionary(open, sys.path[0])

    def open(self, path: str, mode: str):
        """Return a file on the flash; the next period of the watchdog lasts as long as the slowest writing."""
        if mode == "wb":
            self._watchdog = WDT(timeout=WRITING_MS)
            self._writing = True
        return open(path, mode)

    def watch(self) -> None:
        """Give the watchdog its short period."""
        self._writing = False
        self._watchdog = WDT(timeout=WATCHDOG_MS)

    def feed(self) -> None:
        """Keep the watchdog quiet for another period."""
        if self._writing:
            self.watch()
        else:
            self._watchdog.feed()


class Attended:
    """The I2C bus, with a look at the CAN bus before each access: no frame may wait for the end of a control step."""

    def __init__(self, bus) -> None:
        self.port = None
        self._bus = bus

    def writeto_mem(self, address: int, register: int, data) -> None:
        """Write registers of a chip."""
        if self.port:
            self.port.look()
        self._bus.writeto_mem(address, register, data)

    def readfrom_mem_into(self, address: int, register: int, data) -> None:
        """Fill `data` from registers of a chip."""
        if self.port:
            self.port.look()
        self._bus.readfrom_mem_into(address, register, data)


def boot_number() -> int:
    """Return a number that names this start of the firmware."""
    seed = 0
    for byte in unique_id():
        seed = (seed * 31 + byte) & 0xFFFFFFFF
    return (seed ^ time.ticks_us()) & 0xFFFFFFFF
