"""When something goes wrong on a bench: a fault of the table at a time, and its end.

    schedule(bench, 2_000_000, "cable-cut", for_us=500_000)
    schedule(bench, 0, "coil-open:B10m1")
    schedule(bench, 0, "line-flip:5", seed="7").mend()

A fault that can end is mended after `for_us`, if that is given; of two of a kind that overlap, the first to end ends
both. Whatever a fault draws at random, it draws from its seed.
"""

from collections.abc import Sequence
from random import Random

from hil_sim.bench import Bench
from hil_sim.faults.gauges import cells_of
from hil_sim.faults.parts import Mend, Value
from hil_sim.faults.table import BATTERY, CAMERA, CELL, CONVERTER, IMU, JOINT, LABEL, LOAD_CELL, Fault, read
from hil_sim.journal import FAULT
from hil_sim.loadcells import Loaded

BEGUN, MENDED = 1, 0  # in the journal


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
        """Let it happen, unless the bench was closed before."""
        if self._bench.closed:
            return
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


def _fits(bench: Bench, fault: Fault, text: str, value: Value) -> None:
    """Raise ValueError when a fault is of something that this bench has not."""
    has = {
        BATTERY: bench.supply.battery is not None,
        IMU: bench.board.imu is not None,
        CAMERA: bench.board.camera is not None,
        CONVERTER: bool(bench.joints),
        LOAD_CELL: isinstance(bench.plant, Loaded),
    }
    if fault.of and not has[fault.of]:
        raise ValueError(f"fault {text}: this robot has no {fault.of}")
    if fault.argument == LABEL:
        _names_one(fault, text, value, "coil", bench.plant.labels)
    if fault.argument == JOINT:
        _names_one(fault, text, value, "joint", [joint.label for joint in bench.joints])
    if fault.argument == CELL:
        _names_one(fault, text, value, "force cell", cells_of(bench))


def _names_one(fault: Fault, text: str, value: Value, what: str, labels: Sequence[str]) -> None:
    """Raise ValueError unless the argument is one of the labels."""
    if not labels:
        raise ValueError(f"fault {text}: this robot has no {what}s")
    if value not in labels:
        raise ValueError(f"fault {text}: name a {what} of this robot, as in {fault.name}:{labels[0]}")
