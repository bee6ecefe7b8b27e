r"""Voltage of a lithium-ion battery over its charge.

With z the share of the charge that is left, one cell has without load

.. math::  U(z) = 3.685 - 1.031 e^{-35 z} + 0.2156 z - 0.1178 z^2 + 0.3201 z^3                                   (E1)

Source: Chen and Rincon-Mora, IEEE Transactions on Energy Conversion 21 (2006) 504, of a polymer cell of 850 mAh; read
in the open implementations of their model, which agree. ASSUMED: the internal resistance stands for their resistors
and capacitors together, so what a load costs is felt at once and is over with it. Valid for 0 <= z <= 1; just below 0
the voltage goes on falling, ever steeper. Checked in tests/test_bench_battery.py.
"""

from dataclasses import dataclass
from math import exp


@dataclass(frozen=True)
class BatteryNumbers:
    """Cells in series, their protection, and what the board draws beside the coils, in SI units."""

    cells: float  # in series [1]
    Q: float  # charge of a full battery [A s]
    z: float  # share of it that is left at the start [1]
    r: float  # internal resistance of all cells with contacts and protection [ohm]
    V_cut: float  # under load: below it the protection opens for good [V]
    I_board: float  # what processor and chips draw [A]


def open_voltage(z: float, cells: float) -> float:
    r"""Return the voltage of a battery without load, equation (E1).

    Parameters
    ----------
    z : float
        Share of the charge that is left, at most 1 [1]
    cells : float
        Number of cells in series [1]

    Returns
    -------
    float
        Voltage [V]
    """
    return cells * (3.685 - 1.031 * exp(-35.0 * z) + z * (0.2156 + z * (-0.1178 + z * 0.3201)))
