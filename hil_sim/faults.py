"""What can go wrong on the bench, by name, at a time: one table, from which the fault file and its page are read.

    schedule(bench, 2_000_000, "cable-cut", for_us=500_000)
    schedule(bench, 0, "coil-open:B10m1")
    schedule(bench, 0, "line-flip:5", seed="7").mend()

What stands after the colon is said in the table. A fault that can end is mended after `for_us`, if that is given;
of two of a kind that overlap, the first to end ends both. Whatever a fault draws at random, it draws from its seed.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from random import Random

from hil_sim import linemishaps, mishaps
from hil_sim.bench import Bench
from hil_sim.devices.lsm6ds3tr import Lsm6ds3tr
from hil_sim.journal import FAULT
from hil_sim.mishaps import Mend, Mishap, Value, imu, of_a_coil, on_off, once
from hil_sim.robotcheck import near

BEGUN, MENDED = 1, 0  # in the journal


@dataclass(frozen=True)
class Argument:
    """What stands after the colon of a name: a coil, a number in a range, or one of some words."""

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
        if self.form == LABEL.form:
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
    """One row of the table. `ends` says whether it lasts and can be mended."""

    name: str
    about: str
    happen: Mishap
    ends: bool = True
    argument: Argument = Argument()

    @property
    def spelled(self) -> str:
        """Return the name as it is written, as in coil-open:LABEL."""
        if self.argument.words:
            return f"{self.name}[:{'|'.join(self.argument.words)}]"
        return f"{self.name}:{self.argument.form}" if self.argument.form else self.name


LABEL = Argument("LABEL")
COUNT = Argument("COUNT", 1, 1_000_000)
PERMILLE = Argument("PERMILLE", 1, 1000)
PERCENT = Argument("PERCENT", 1, 100)
DELAY = Argument("MS", 1, 10_000)
BAUD = Argument("BAUD", 300, 4_000_000)
DRIFT = Argument("K_PER_S", -1000, 1000)
TASK = Argument("TASK", words=mishaps.TASKS)

TABLE = (
    Fault("coil-open", "The wire of a coil is broken.", of_a_coil(mishaps.coil_open), argument=LABEL),
    Fault("coil-short", "The terminals of a coil touch: 20 mohm.", of_a_coil(mishaps.coil_short), argument=LABEL),
    Fault("coil-whole", "The coil is mended.", of_a_coil(mishaps.coil_whole), False, LABEL),
    Fault("mosfet-stuck", "The MOSFET of a coil conducts for ever.", of_a_coil(mishaps.mosfet_stuck), argument=LABEL),
    Fault("contactor-welded", "The contactor of the coil supply is closed for ever.", on_off(mishaps.contactor_welded)),
    Fault(
        "monostable-bypassed",
        "OE hangs on the heartbeat pin alone, active low: a reset enables the outputs.",
        on_off(mishaps.monostable_bypassed),
    ),
    Fault("supply-sag", "The coil supply gives so much less.", mishaps.supply_sag, argument=PERCENT),
    Fault("battery-empty", "The battery on board is at its end.", once(mishaps.battery_empty), False),
    Fault("battery-full", "The battery on board is charged.", once(mishaps.battery_full), False),
    Fault("brown-out", "The board has no supply: chips and processor forget.", on_off(mishaps.brown_out)),
    Fault("power-cycle", "The board's supply is gone for an instant.", once(mishaps.power_cycle), False),
    Fault("thermistor-open", "The wire of the thermistor is broken.", on_off(mishaps.thermistor("open"))),
    Fault("thermistor-short", "The thermistor is shorted.", on_off(mishaps.thermistor("short"))),
    Fault("thermistor-drift", "The thermistor reads more with each second.", mishaps.thermistor_drift, argument=DRIFT),
    Fault("thermistor-whole", "The thermistor is mended.", once(mishaps.thermistor_whole), False),
    Fault("i2c-nack", "So many transfers find nobody.", linemishaps.i2c_nack, argument=COUNT),
    Fault("i2c-bit-error", "One bit is wrong in each of so many messages.", linemishaps.i2c_bit_error, argument=COUNT),
    Fault("i2c-stuck", "The clock of the bus is held low.", on_off(linemishaps.i2c_stuck)),
    Fault("i2c-free", "The bus is let go.", once(lambda bench: linemishaps.i2c_stuck(bench, False)), False),
    Fault("pwm-dead", "The PWM chips do not answer, and go on driving.", on_off(mishaps.pwm_dead)),
    Fault("pwm-forgets", "The PWM chips have lost their registers.", once(mishaps.pwm_forgets), False),
    Fault("monitor-dead", "The monitor of the supply does not answer.", on_off(mishaps.monitor_dead)),
    Fault(
        "monitor-forgets",
        "The monitor has lost its registers, its alert limit too.",
        once(lambda bench: bench.board.monitor.reset()),
        False,
    ),
    Fault("imu-dead", "The attitude sensor does not answer.", on_off(imu(mishaps.imu_dead))),
    Fault("imu-stuck", "The attitude sensor gives its last sample for ever.", on_off(imu(mishaps.imu_stuck))),
    Fault(
        "imu-forgets",
        "The attitude sensor has lost its settings.",
        on_off(imu(lambda chip, _: Lsm6ds3tr.reset(chip))),
        False,
    ),
    Fault("imu-whole", "The attitude sensor is mended.", on_off(imu(mishaps.imu_whole)), False),
    Fault("hang", "The firmware is caught in a loop, at once or in a task.", mishaps.hang, False, TASK),
    Fault("reset", "The processor is reset.", once(lambda bench: bench.world.reset()), False),
    Fault("flash-cut", "Power fails in the so-many-th write to the flash.", mishaps.flash_cut, argument=COUNT),
    Fault("line-flip", "So many of 1000 bytes have a wrong bit.", linemishaps.line_noise("flip"), argument=PERMILLE),
    Fault("line-lose", "So many of 1000 bytes are lost.", linemishaps.line_noise("lose"), argument=PERMILLE),
    Fault("line-double", "So many of 1000 bytes come twice.", linemishaps.line_noise("double"), argument=PERMILLE),
    Fault("line-delay", "Bytes arrive so much later.", linemishaps.line_delay, argument=DELAY),
    Fault("line-baud", "The host's end runs at this rate.", linemishaps.line_baud, argument=BAUD),
    Fault("cable-cut", "The cable is pulled out.", on_off(linemishaps.cable_cut)),
    Fault("cable-join", "The cable is plugged in.", once(lambda bench: linemishaps.cable_cut(bench, False)), False),
    Fault("estop-open", "The emergency-stop loop is open.", on_off(lambda bench, on: bench.board.set_estop(not on))),
    Fault("estop-close", "The emergency-stop loop is closed.", once(lambda bench: bench.board.set_estop(True)), False),
    Fault("host-killed", "The host's process has died: nothing is sent or read.", on_off(linemishaps.host_killed)),
)
NAMES = tuple(fault.name for fault in TABLE)


class Happening:
    """A fault that was scheduled. `mend` ends it at once."""

    def __init__(self, bench: Bench, fault: Fault, text: str, value: Value, draw: Random) -> None:
        self._bench = bench
        self._fault = fault
        self._text = text
        self._value = value
        self._draw = draw
        self._mend: Mend | None = None

    def begin(self) -> None:
        """Let it happen."""
        self._note(BEGUN)
        self._mend = self._fault.happen(self._bench, self._value, self._draw)

    def mend(self) -> None:
        """End it; ending it twice does nothing."""
        if self._mend is not None and self._fault.ends:
            self._note(MENDED)
            mend, self._mend = self._mend, None
            mend()

    def _note(self, what: int) -> None:
        self._bench.journal.note(self._bench.clock.now_us, FAULT, what, self._text.encode())


def schedule(bench: Bench, at_us: int, text: str, for_us: int | None = None, seed: str = "") -> Happening:
    """Let a fault happen at a virtual time; ValueError when this bench has none of that name or the time has passed."""
    fault, value = read(text)
    _fits(bench, fault, text, value)
    if at_us < bench.clock.now_us:
        raise ValueError(f"fault {text}: time {at_us} us has passed, now {bench.clock.now_us} us")
    if for_us is not None and not fault.ends:
        raise ValueError(f"fault {text} does not last: it cannot end")
    happening = Happening(bench, fault, text, value, Random(f"{seed}/{text}"))
    bench.clock.at(at_us, happening.begin)
    if for_us is not None:
        bench.clock.at(at_us + for_us, happening.mend)
    return happening


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


def _fits(bench: Bench, fault: Fault, text: str, value: Value) -> None:
    """Raise ValueError when a fault is of something that this bench has not."""
    labels: Sequence[str] = bench.plant.labels
    if fault.name.startswith("battery-") and bench.supply.battery is None:
        raise ValueError(f"fault {text}: this robot has no battery")
    if fault.name.startswith("imu-") and bench.board.imu is None:
        raise ValueError(f"fault {text}: this robot has no attitude sensor")
    if fault.argument == LABEL and value not in labels:
        raise ValueError(f"fault {text}: name a coil of this robot, as in {fault.name}:{labels[0]}")
