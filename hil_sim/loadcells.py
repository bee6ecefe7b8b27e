"""The wires between force sensors and converter: the load cell of a press, and force cells inside a body.

A load cell's amplifier gives `zero_v` without load and covers `full_n` with the converter's whole range; a force cell
gives 0 V without pressure and the converter's reference at `full_pa`. The converter reads them after what it reads of
the joints: first the force cells in their order, then the load cell.

    connect(plant, board, joints=1, load_cell=LoadCell(0.66, 32.768), cells=ForceCells(20e3))

Noise, off unless asked for, is a function of the board's identity, the input and the time.
"""

from collections.abc import Callable
from dataclasses import dataclass
from random import Random
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from hil_sim.board import Board
from hil_sim.joints import REFERENCE_V


@runtime_checkable
class Loaded(Protocol):
    """A body with a load cell, and with force cells inside."""

    @property
    def load_n(self) -> float:
        """What the load cell feels, pressure positive."""

    @property
    def cell_pa(self) -> NDArray[np.float64]:
        """What the force cells feel, pressure positive."""


@dataclass(frozen=True)
class LoadCell:
    """A load cell with its amplifier."""

    zero_v: float
    full_n: float
    noise_n: float = 0.0  # root mean square


@dataclass(frozen=True)
class ForceCells:
    """Force cells with their amplifiers."""

    full_pa: float
    noise_pa: float = 0.0  # root mean square


def cell_input(cell: int, joints: int) -> int:
    """Return the converter's input that reads a force cell of a robot with so many joints."""
    return 2 * joints + cell


def load_input(cells: int, joints: int) -> int:
    """Return the converter's input that reads the load cell of a robot with so many force cells and joints."""
    return cell_input(cells, joints)


def connect(plant: Loaded, board: Board, joints: int, load_cell: LoadCell, cells: ForceCells) -> None:
    """Solder the sensors of a body to the converter's inputs."""
    count = len(plant.cell_pa)
    for cell in range(count):
        number = cell_input(cell, joints)
        noise = _noise(board, number, cells.noise_pa)
        board.adc.inputs[number] = _cell_v(plant, cell, cells.full_pa, noise)
    number = load_input(count, joints)
    noise = _noise(board, number, load_cell.noise_n)
    board.adc.inputs[number] = lambda: load_cell.zero_v + (plant.load_n + noise()) / load_cell.full_n * REFERENCE_V


def _cell_v(plant: Loaded, cell: int, full_pa: float, noise: Callable[[], float]) -> Callable[[], float]:
    return lambda: (float(plant.cell_pa[cell]) + noise()) / full_pa * REFERENCE_V


def _noise(board: Board, number: int, rms: float) -> Callable[[], float]:
    """Return what a sensor adds to its value."""
    if not rms:
        return lambda: 0.0
    return lambda: Random(f"{board.unique_id.hex()} {number} {board.clock.now_us}").gauss(0.0, rms)
