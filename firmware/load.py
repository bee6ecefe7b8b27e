"""The load cell behind an axis and the force cells in what it presses, through the converter's inputs.

A force beyond its limit is a fault while the axis is driven and not on its way back: what presses too hard must be able
to be moved off, also beyond what the load cell can tell: the upper end of the converter's range is such a force. A load
cell that reads the lower end is torn off.
"""

from array import array

from firmware.jointlimits import EDGE_COUNTS
from protocol import codes

OVER_READS = 3  # in a row that a force must be too great before it is believed
BROKEN_READS = 10  # and that a reading must be at the end of the range
CELLS_PER_STEP = 2


class Load:
    """The load cell; `force_mn` is positive where it is pressed."""

    def __init__(self, converter, limits) -> None:
        self.force_mn = 0
        self.counts = 0
        self._converter = converter
        self._limits = limits
        self._over = 0
        self._edge = 0

    def read(self, pushing: bool) -> None:
        """Read the force; `pushing`: the axis is driven, and not on its way back."""
        self.counts = self._converter.counts(self._limits.input)
        self.force_mn = self._limits.force_mn(self.counts)
        is_over = pushing and abs(self.force_mn) > self._limits.trip_mn
        self._over = min(self._over + 1, OVER_READS) if is_over else 0
        self._edge = min(self._edge + 1, BROKEN_READS) if self.counts <= EDGE_COUNTS else 0

    @property
    def broken(self) -> bool:
        """Whether the load cell cannot be read."""
        return self._edge >= BROKEN_READS

    def check(self) -> int:
        """Return the code of a fault, or 0."""
        if self._over >= OVER_READS:
            return codes.OVERLOAD
        return codes.LOAD_CELL if self.broken else 0


class Cells:
    """The force cells, in the order of the profile; an open one reads 0."""

    def __init__(self, converter, inputs: list, full_pa: int) -> None:
        self.pressure_pa = array("H", [0] * len(inputs))
        self._converter = converter
        self._inputs = inputs
        self._full_pa = full_pa
        self._turn = 0

    def read(self) -> None:
        """Read some of them, each in its turn."""
        for _ in range(min(CELLS_PER_STEP, len(self._inputs))):
            cell = self._turn
            self._turn = cell + 1 if cell + 1 < len(self._inputs) else 0
            self.pressure_pa[cell] = self._converter.counts(self._inputs[cell]) * self._full_pa >> 12
