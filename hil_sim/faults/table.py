"""What can go wrong on the bench, by name: one table, from which fault files and their page are read.

    fault, value = read("coil-open:B10m1")

What stands after the colon is said in the table.
"""

from dataclasses import dataclass

from hil_sim.devices.lsm6ds3tr import Lsm6ds3tr
from hil_sim.faults import gauges, limbs, lines, parts
from hil_sim.faults.limbs import camera, of_a_joint
from hil_sim.faults.parts import Mishap, Value, imu, of_a_coil, on_off, once
from hil_sim.spelling import near


@dataclass(frozen=True)
class Argument:
    """What stands after the colon of a name: a coil, joint or force cell, a number in a range, or one of some words."""

    form: str = ""
    least: float = 0
    most: float = 0
    words: tuple[str, ...] = ()

    def read(self, text: str) -> Value:
        """Return its value; ValueError says what is allowed."""
        if self.words or not self.form:
            allowed = ("", *self.words)
            if text not in allowed:
                raise ValueError(f"after the colon stands {' or '.join(self.words)}" if self.words else "takes nothing")
            return text
        if self.form in (LABEL.form, JOINT.form, CELL.form):
            return text
        try:
            number = float(text) if self.form == DRIFT.form else int(text)
        except ValueError:
            number = float("nan")
        if not self.least <= number <= self.most:
            raise ValueError(f"after the colon stands {self.form} from {self.least:g} to {self.most:g}")
        return number


@dataclass(frozen=True)
class Fault:
    """One row of the table. `ends` says whether it lasts and can be mended, `of` which part of some robots it is."""

    name: str
    about: str
    happen: Mishap
    ends: bool = True
    argument: Argument = Argument()
    of: str = ""

    @property
    def spelled(self) -> str:
        """Return the name as it is written, as in coil-open:LABEL."""
        if self.argument.words:
            return f"{self.name}[:{'|'.join(self.argument.words)}]"
        return f"{self.name}:{self.argument.form}" if self.argument.form else self.name


BATTERY, IMU, CAMERA, LOAD_CELL, CONVERTER = "battery", "attitude sensor", "camera", "load cell", "converter"
LABEL = Argument("LABEL")
JOINT = Argument("JOINT")
CELL = Argument("CELL")
COUNT = Argument("COUNT", 1, 1_000_000)
PERMILLE = Argument("PERMILLE", 1, 1000)
PERCENT = Argument("PERCENT", 1, 100)
DELAY = Argument("MS", 1, 10_000)
BAUD = Argument("BAUD", 300, 4_000_000)
DRIFT = Argument("K_PER_S", -1000, 1000)
TASK = Argument("TASK", words=parts.TASKS)
CHIP = Argument("CHIP", words=gauges.CONVERTERS)

TABLE = (
    Fault("coil-open", "The wire of a coil is broken.", of_a_coil(parts.coil_open), argument=LABEL),
    Fault("coil-short", "The terminals of a coil touch: 20 mohm.", of_a_coil(parts.coil_short), argument=LABEL),
    Fault("coil-whole", "The coil is mended.", of_a_coil(parts.coil_whole), False, LABEL),
    Fault("mosfet-stuck", "The MOSFET of a coil conducts for ever.", of_a_coil(parts.mosfet_stuck), argument=LABEL),
    Fault("contactor-welded", "The contactor of the coil supply is closed for ever.", on_off(parts.contactor_welded)),
    Fault(
        "monostable-bypassed",
        "OE hangs on the heartbeat pin alone, active low: a reset enables the outputs.",
        on_off(parts.monostable_bypassed),
    ),
    Fault("supply-sag", "The coil supply gives so much less.", parts.supply_sag, argument=PERCENT),
    Fault("battery-empty", "The battery on board is at its end.", once(parts.battery_empty), False, of=BATTERY),
    Fault("battery-full", "The battery on board is charged.", once(parts.battery_full), False, of=BATTERY),
    Fault("brown-out", "The board has no supply: chips and processor forget.", on_off(parts.brown_out)),
    Fault("power-cycle", "The board's supply is gone for an instant.", once(parts.power_cycle), False),
    Fault("thermistor-open", "The wire of the thermistor is broken.", on_off(parts.thermistor("open"))),
    Fault("thermistor-short", "The thermistor is shorted.", on_off(parts.thermistor("short"))),
    Fault("thermistor-drift", "The thermistor reads more with each second.", parts.thermistor_drift, argument=DRIFT),
    Fault("thermistor-whole", "The thermistor is mended.", once(parts.thermistor_whole), False),
    Fault("i2c-nack", "So many transfers find nobody.", lines.i2c_nack, argument=COUNT),
    Fault("i2c-bit-error", "One bit is wrong in each of so many messages.", lines.i2c_bit_error, argument=COUNT),
    Fault("i2c-stuck", "The clock of the bus is held low.", on_off(lines.i2c_stuck)),
    Fault("i2c-free", "The bus is let go.", once(lambda bench: lines.i2c_stuck(bench, False)), False),
    Fault("pwm-dead", "The PWM chips do not answer, and go on driving.", on_off(parts.pwm_dead)),
    Fault("pwm-forgets", "The PWM chips have lost their registers.", once(parts.pwm_forgets), False),
    Fault("monitor-dead", "The monitor of the supply does not answer.", on_off(parts.monitor_dead)),
    Fault(
        "monitor-forgets",
        "The monitor has lost its registers, its alert limit too.",
        once(lambda bench: bench.board.monitor.reset()),
        False,
    ),
    Fault("imu-dead", "The attitude sensor does not answer.", on_off(imu(parts.imu_dead)), of=IMU),
    Fault("imu-stuck", "The attitude sensor gives its last sample for ever.", on_off(imu(parts.imu_stuck)), of=IMU),
    Fault(
        "imu-forgets",
        "The attitude sensor has lost its settings.",
        on_off(imu(lambda chip, _: Lsm6ds3tr.reset(chip))),
        False,
        of=IMU,
    ),
    Fault("imu-whole", "The attitude sensor is mended.", on_off(imu(parts.imu_whole)), False, of=IMU),
    Fault("hang", "The firmware is caught in a loop, at once or in a task.", parts.hang, False, TASK),
    Fault("reset", "The processor is reset.", once(lambda bench: bench.world.reset()), False),
    Fault("flash-cut", "Power fails in the so-many-th write to the flash.", parts.flash_cut, argument=COUNT),
    Fault("line-flip", "So many of 1000 bytes have a wrong bit.", lines.line_noise("flip"), argument=PERMILLE),
    Fault("line-lose", "So many of 1000 bytes are lost.", lines.line_noise("lose"), argument=PERMILLE),
    Fault("line-double", "So many of 1000 bytes come twice.", lines.line_noise("double"), argument=PERMILLE),
    Fault("line-delay", "Bytes arrive so much later.", lines.line_delay, argument=DELAY),
    Fault("line-baud", "The host's end runs at this rate.", lines.line_baud, argument=BAUD),
    Fault("cable-cut", "The cable is pulled out.", on_off(lines.cable_cut)),
    Fault("cable-join", "The cable is plugged in.", once(lambda bench: lines.cable_cut(bench, False)), False),
    Fault("estop-open", "The emergency-stop loop is open.", on_off(lambda bench, on: bench.board.set_estop(not on))),
    Fault("estop-close", "The emergency-stop loop is closed.", once(lambda bench: bench.board.set_estop(True)), False),
    Fault("host-killed", "The host's process has died: nothing is sent or read.", on_off(lines.host_killed)),
    Fault("joint-jam", "A joint is stuck, whatever its servo does.", of_a_joint(limbs.joint_jam), argument=JOINT),
    Fault("servo-dead", "A servo has no torque.", of_a_joint(limbs.servo_dead), argument=JOINT),
    Fault("pot-open", "The wire of a joint's potentiometer is broken.", of_a_joint(limbs.pot_open), argument=JOINT),
    Fault(
        "converter-dead",
        "The first converter does not answer, or the second, or neither: all its inputs read 0.",
        gauges.converter_dead,
        argument=CHIP,
        of=CONVERTER,
    ),
    Fault("load-cell-open", "The wire of the load cell is broken.", on_off(gauges.load_cell_open), of=LOAD_CELL),
    Fault("cell-open", "The wire of a force cell is broken.", gauges.cell_open, argument=CELL),
    Fault("camera-lost", "The camera does not answer.", on_off(camera(limbs.camera_lost)), of=CAMERA),
    Fault("camera-frozen", "The camera gives its last frame for ever.", on_off(camera(limbs.camera_frozen)), of=CAMERA),
    Fault("object-hidden", "The camera does not see the object.", on_off(camera(limbs.object_hidden)), of=CAMERA),
)
NAMES = tuple(fault.name for fault in TABLE)


def read(text: str) -> tuple[Fault, Value]:
    """Return the fault that a text names and its argument; ValueError says what is allowed."""
    name, colon, rest = text.partition(":")
    fault = next((fault for fault in TABLE if fault.name == name), None)
    if fault is None:
        raise ValueError(f"no fault {text!r}: known are {', '.join(NAMES)}{near(name, NAMES)}")
    if bool(colon) != bool(rest) or (bool(fault.argument.form) and not colon and not fault.argument.words):
        raise ValueError(f"fault {text}: write {fault.spelled}")
    try:
        return fault, fault.argument.read(rest)
    except ValueError as error:
        raise ValueError(f"fault {text}: {error}") from None
