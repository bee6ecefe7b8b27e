"""What faults of converters, load cell and force cells do to a bench; see parts.py for how they are written.

A wire that is broken leaves its input to the resistor that pulls it to ground: it reads 0. A converter that does not
answer leaves the line to the pull-down of the processor's pad: all its inputs read 0.
"""

from random import Random

from hil_sim.bench import Bench
from hil_sim.faults.parts import Mend, Value
from hil_sim.loadcells import Loaded, cell_input, load_input

CONVERTERS = ("1", "2")


def cells_of(bench: Bench) -> list[str]:
    """Return the labels of the force cells, none where a body has none."""
    return list(bench.plant.observe()["cell_kpa"]) if isinstance(bench.plant, Loaded) else []


def load_cell_open(bench: Bench, broken: bool) -> None:
    """Break the wire of the load cell."""
    _open(bench, load_input(len(cells_of(bench)), len(bench.joints)), broken)


def cell_open(bench: Bench, label: Value, _draw: Random) -> Mend:
    """Break the wire of a force cell."""
    number = cell_input(cells_of(bench).index(str(label)), len(bench.joints))
    _open(bench, number, True)
    return lambda: _open(bench, number, False)


def converter_dead(bench: Bench, which: Value, _draw: Random) -> Mend:
    """Let a converter fall silent, or both."""
    chips = bench.board.adc.chips if not which else [bench.board.adc.chips[CONVERTERS.index(str(which))]]

    def switch(alive: bool) -> None:
        for chip in chips:
            chip.alive = alive

    switch(False)
    return lambda: switch(True)


def _open(bench: Bench, number: int, broken: bool) -> None:
    (bench.board.adc.opened.add if broken else bench.board.adc.opened.discard)(number)
