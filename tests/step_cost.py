"""So many control steps in some states, for a counter of instructions (benchmarks/step_budget.py, under MicroPython).

Arguments: the profile's path, then pairs of a state (idle, armed, firing, running; turning of a robot with joints,
pressing of a press) and how many steps. The core runs on its own drivers; the bus gives back what was written, a
current as if the one coil under test were whole, and a new frame of the camera at every look.
"""

import sys

from firmware.core import Core
from firmware.drivers.anglecamera import IDENTITY, SEEN, AngleCamera
from firmware.drivers.ina226 import BUS_VOLTAGE, SHUNT_VOLTAGE, Ina226
from firmware.drivers.lsm6ds3tr import Lsm6ds3tr
from firmware.drivers.mcp3208 import Mcp3208
from firmware.drivers.pca9685 import FULL, Pca9685
from firmware.drivers.servo import Servo
from firmware.profile import Profile
from protocol import program
from tests.loaded import Loaded

STEP_MS = 5
PWM_CHIPS = (0x60, 0x61)
CAMERA = 0x33


class Wire:
    """A pin, the pulses on it, and a bus with a converter."""

    def freq(self, hz):
        """Take a rate."""

    def duty_ns(self, width_ns):
        """Take a width."""

    def value(self, level):
        """Take a level."""

    def write_readinto(self, sent, came):
        """Give back half of the reference of every third and fourth input, little of the others."""
        came[1], came[2] = (8, 0) if sent[1] & 0x80 else (3, 232) if sent[1] & 0x40 else (0, 100)


class Bus:
    """Chips that remember bytes; the shunt carries current while one output is full on."""

    def __init__(self, shunt) -> None:
        self.registers = [bytearray(1024) for _ in range(128)]
        self.registers[CAMERA] = bytearray((IDENTITY, SEEN, 0, 50, 0))
        self._shunt = shunt

    def writeto_mem(self, address, register, data):
        """Remember."""
        at = register if address in PWM_CHIPS else 2 * register
        for i in range(len(data)):
            self.registers[address][at + i] = data[i]
        if address in PWM_CHIPS:
            on = len(data) == 4 and data[1] == FULL and data[3] == 0
            self.registers[0x40][2 * SHUNT_VOLTAGE] = self._shunt >> 8 if on else 0
            self.registers[0x40][2 * SHUNT_VOLTAGE + 1] = self._shunt & 0xFF if on else 0

    def readfrom_mem_into(self, address, register, buffer):
        """Give back; a camera has a new frame each time."""
        if address == CAMERA:
            self.registers[CAMERA][2] = self.registers[CAMERA][2] + 1 & 255
        at = register if address in PWM_CHIPS or address == CAMERA else 2 * register
        for i in range(len(buffer)):
            buffer[i] = self.registers[address][at + i]


class Nothing:
    """A dictionary that no step asks for."""

    crc = size = 0


class Table:
    """A board without its pins."""

    credit_bytes, byte_ns, serial = 960, 86_805, b"one"

    def __init__(self, profile) -> None:
        mv, mohm = profile.supply.nominal_mv, profile.coil.resistance_mohm + profile.coil.wiring_mohm
        self.bus = Bus(mv * profile.supply.shunt_mohm * 400 // mohm)
        self.bus.writeto_mem(0x40, BUS_VOLTAGE, (mv * 4 // 5).to_bytes(2, "big"))

    def open(self, path, mode):
        """There is no flash."""
        raise OSError(2)

    def dictionary(self):
        """There is no text."""
        return Nothing()

    def pwm(self, address):
        """Return a driver."""
        return Pca9685(self.bus, address)

    def monitor(self, shunt_mohm, alert_ma):
        """Return a driver."""
        return Ina226(self.bus, 0x40, shunt_mohm, alert_ma)

    def imu(self, address):
        """Return a driver."""
        return Lsm6ds3tr(self.bus, address)

    def servo(self, pin, hz):
        """Return a driver."""
        return Servo(Wire(), hz)

    def adc(self):
        """Return a driver."""
        return Mcp3208(Wire(), Wire(), Wire())

    def camera(self, address):
        """Return a driver."""
        return AngleCamera(self.bus, address)

    def wait_us(self, time_us):
        """Take no time."""

    def alert(self):
        """Return that there is none."""
        return False

    def power(self, on):
        """Switch nothing."""

    def beat(self):
        """Move nothing."""

    def estop_closed(self):
        """Return that it is."""
        return True

    def board_decidegc(self):
        """Return room temperature."""
        return 250


def script():
    """Return a program that keeps two coils busy under a guard."""
    hot = program.Condition(program.TEMPERATURE, program.ALL, program.ABOVE, 1100, 0xFF)
    cold = program.Condition(program.TEMPERATURE, program.ANY, program.BELOW, 0, 0b11)
    body = program.fire(0b11, 300, 400, 600) + program.wait(cold, 1000, program.CONTINUE)
    return program.guard(hot) + program.repeat(50) + body + program.next_() + program.halt()


def enter(core, state):
    """Bring a core into a state by the shortest way."""
    if state != "idle":
        core.arm(60_000)
    if state == "firing":
        core.channels.fire(0b11, 300, 9000, core.now_ms)
    if state == "running":
        core.start(Loaded(script()), False)
    if state == "turning":
        core.profile.servo.astray_ms = 60_000  # no joint follows here
        core.limbs.move(0b01, 250, 100, 60_000, core.now_ms)
        core.limbs.move(0b10, -250, 100, 60_000, core.now_ms)
        core.limbs.turn(100, 60_000, 0, core.now_ms)
    if state == "pressing":
        core.profile.servo.astray_ms = 60_000
        core.limbs.push(5000, 1000, 60_000, 0, core.now_ms)
    core.link.begin(core.link.decoder.dictionary_crc, 0)  # a host has acknowledged what it was told
    core.link.heard_ms = core.now_ms


def main(path, pairs):
    """Run the steps."""
    with open(path, "rb") as file:
        text = file.read()
    for state, count in pairs:
        profile = Profile(text)
        core = Core(Table(profile), profile, 1)
        core.step(0, b"", 1024)
        enter(core, state)
        wanted = core.state
        for step in range(1, count + 1):
            core.step(step * STEP_MS, b"", 1024)
        if core.state != wanted:
            raise ValueError(f"{state}: the core left its state with code {core.code}")


main(sys.argv[1], [(sys.argv[i], int(sys.argv[i + 1])) for i in range(2, len(sys.argv), 2)])
