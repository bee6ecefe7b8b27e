"""A body under the power of its coils, on a plane that is tilted once it has taken hold: what all plants share."""

from abc import abstractmethod
from collections.abc import Callable
from math import degrees, inf
from typing import Any

import numpy as np

from hil_sim.physics.bodies import GroundNumbers
from hil_sim.physics.body import World, gravity
from hil_sim.physics.coilset import Coils, CoilState
from hil_sim.physics.compiled import Array, bound
from hil_sim.physics.tally import TIME, balance, effort


class CoilBody:
    """Coils and their heat, time, ground and the balance of energies; the shape is the plant's own."""

    _coils: Coils
    _state: CoilState
    _tally: Array

    def __init__(self, labels: tuple[str, ...], ground: GroundNumbers) -> None:
        self.labels = list(labels)
        self._world = World(ground.gravity, ground.slope, inf, abs(ground.slope) / ground.tilt_rate)
        self._tilt_after, self._taken_hold = ground.tilt_after, False
        self._power = np.zeros(len(labels))
        self._parts: tuple[Any, ...] = ()
        self._advance: Callable[..., None]
        self._stored_at_start = 0.0

    @property
    def temperature(self) -> Array:
        """Temperatures of the coils [degC]."""
        return self._state.T

    @property
    def resistance(self) -> Array:
        """Resistances of the coils [ohm]."""
        return self._state.R

    @property
    def lengths(self) -> Array:
        """Lengths of the coils between their attachments [m]."""
        return self._state.L

    @property
    @abstractmethod
    def force(self) -> Array:
        """Pulls of the coils [N]."""

    def advance(self, duration_us: int, coil_power_w: Array) -> None:
        """Let time pass with the mean electrical power of each coil."""
        self._power[:] = coil_power_w
        if not self._taken_hold and self._power.any():
            self._take_hold()
        self._advance(*self._parts, self._power, duration_us * 1e-6)

    def energies(self) -> dict[str, float]:
        """Return what the body holds and what went in and out since the start [J], see `tally.balance`."""
        return balance(self._tally, self._stored(), self._stored_at_start)

    def effort(self) -> dict[str, int]:
        """Return how many steps, rejected steps and Newton iterations it took so far."""
        return effort(self._tally)

    def hold(self, entry: Any) -> None:
        """Move no more: from here on `entry`, see still.py, heats and cools the coils at the lengths they have."""
        self._begin(entry, self._coils, self._state, self._state.L.copy(), self.force, self._tally)

    def _begin(self, entry: Any, *parts: Any) -> None:
        """Take the kernel that advances the body and what it works on; from here on energies are counted."""
        self._parts = parts
        self._advance = bound(entry, *parts, self._power, 0.0)
        self._stored_at_start = sum(self._stored().values())

    def _take_hold(self) -> None:
        """Let the plane begin to tilt a moment after now, when a coil is heated for the first time."""
        level, self._taken_hold = self._world, True
        self._world = level._replace(tilt_from=float(self._tally[TIME]) + self._tilt_after)
        self._parts = tuple(self._world if part is level else part for part in self._parts)

    def _gravity(self) -> tuple[float, float]:
        """Return gravity along and away from the plane at this moment [m/s2]."""
        along, away = gravity(self._world, float(self._tally[TIME]))
        return float(along), float(away)

    def _slope_deg(self) -> float:
        along, away = self._gravity()
        return degrees(np.arctan2(-along, -away)) if away else 0.0

    def _coils_seen(self, starts: list[Any], ends: list[Any]) -> dict[str, dict[str, Any]]:
        """Return temperature, pull and both ends of each coil by its label."""
        rows = zip(self.labels, self._state.T.tolist(), self.force.tolist(), starts, ends, strict=True)
        return {
            label: {"degc": degc, "force_n": force, "from": start, "to": end} for label, degc, force, start, end in rows
        }

    @abstractmethod
    def _stored(self) -> dict[str, float]:
        """Return the mechanical energy of the body without its coils [J]."""
