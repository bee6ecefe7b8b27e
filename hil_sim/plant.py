"""What a bench asks of a body; one with joints is `Jointed`, one that is pressed `Loaded`, too."""

from collections.abc import Sequence
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


class Plant(Protocol):
    """The body: coils and what they move."""

    @property
    def labels(self) -> Sequence[str]:
        """The coils."""

    @property
    def resistance(self) -> FloatArray:
        """Their resistances [ohm]; infinite for an open one."""

    @property
    def temperature(self) -> FloatArray:
        """Their temperatures [degC]."""

    def advance(self, duration_us: int, coil_power_w: FloatArray) -> None:
        """Let time pass with constant power in each coil."""

    def observe(self) -> dict[str, Any]:
        """Return what a motion capture system would."""

    def snapshot(self) -> dict[str, Any]:
        """Return the shape, for pictures."""


@runtime_checkable
class Meshed(Protocol):
    """A body that is a mesh of triangles."""

    def fields(self) -> dict[str, Any]:
        """Return the mesh, and displacement, strain and stress on it."""
