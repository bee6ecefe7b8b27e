"""Coil temperatures that a robot of the bench would come to, without its firmware: duties in, temperatures out.

The coils lie at the lengths that they have in the body at rest, as with `body=still`, on the wires and the supply of
the robot file. This is what the host finds among the entry points `softrig.predictors`.

    coils = predictor("sim:circular")
    coils.advance([500, 0, 0, 0, 0, 0, 0, 0], 800).degc[0]

ASSUMED: a pulse begins at its output's sixteenth of the PWM period, as drivers of that chip spread the inrush.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hil_sim.address import parse
from hil_sim.assembly import plant_of
from hil_sim.bodies.coilbody import CoilBody
from hil_sim.bodies.resting import EVER_MS, ROWS, TIME, heat
from hil_sim.physics import coil
from hil_sim.physics.body import packed
from hil_sim.physics.circuit import circuit_of
from hil_sim.physics.coilset import coils_of, cold
from hil_sim.physics.compiled import bound, prepare
from hil_sim.robots.file import RobotFile, load
from hil_sim.supply import Battery

FloatArray = NDArray[np.float64]

COUNTS = 4096  # of the PWM chip in one period
OUTPUTS = 16
TRACED = 1024
NEVER_DEGC = 1e9


class Passed(NamedTuple):
    """What came of a stretch of time; of `trace` each row is a time since its begin [ms] and all temperatures."""

    ms: int
    degc: FloatArray
    peak_degc: FloatArray
    peak_ms: FloatArray
    trace: FloatArray


class Thermals:
    """The coils of one robot, cold at first, and `spare` ones that can stand for any of them."""

    def __init__(self, robot: RobotFile, seed: int = 1, spare: int = 0) -> None:
        body = plant_of(robot, seed)
        if not isinstance(body, CoilBody) or robot.coil is None:
            raise LookupError(f"{robot.name} has no coils")
        prepare(heat)
        self.labels = tuple(robot.labels)
        count = len(robot.labels) + spare
        lengths = np.concatenate([body.lengths, np.full(spare, body.lengths[0])])
        coils = coils_of(robot.coil, count, robot.ambient_degc)
        self._coils = packed(coils)
        self._state = cold(coils, lengths)
        coil.measure(self._state, lengths, coils)
        self._battery = Battery(robot.battery) if robot.battery else None
        source_ohm = robot.wiring.source_ohm + (self._battery.inner_ohm if self._battery else 0.0)
        series_ohm = np.full(count, robot.wiring.series_ohm)
        self._circuit = circuit_of(series_ohm, source_ohm, robot.wiring.supply_v)
        places = [robot.wiring.outputs[label][1] / OUTPUTS for label in robot.labels]
        self._on, self._width = np.array(places + [0.0] * spare), np.zeros(count)
        self._limit, self._keep, self._asked = np.full(count, NEVER_DEGC), np.zeros(count), np.zeros(4)
        self._peak, self._peak_ms, self._count = np.zeros(count), np.zeros(count), np.zeros(2)
        self._trace = np.zeros((TRACED, count + 1))
        self._parts: tuple[Any, ...] = (
            self._circuit, self._coils, self._state, self._on, self._width, np.zeros(count), np.zeros(count),
            np.zeros((5, count)), self._limit, self._keep, self._asked, self._peak, self._peak_ms, self._trace,
            self._count,
        )  # fmt: skip
        self._heat = bound(heat, *self._parts, 0, EVER_MS)
        self._cold = [values.copy() for values in (*self._state, self._on)]
        self._numbers = robot.battery

    @property
    def degc(self) -> FloatArray:
        """Temperatures of all coils, the spare ones last."""
        return self._state.T

    @property
    def energy_mj(self) -> FloatArray:
        """What each coil has turned to heat so far."""
        return 1e3 * self._state.E_in

    def restart(self) -> None:
        """Let all coils be cold again, and the battery as full as it was."""
        for values, before in zip((*self._state, self._on), self._cold, strict=True):
            values[:] = before
        self._battery = Battery(self._numbers) if self._numbers else None

    def copy(self, place: int, index: int) -> None:
        """Let the coil at `place` be as the one at `index` is, in all but the energy that it has taken."""
        for values in (self._state.T, self._state.xi, self._state.L, self._state.F, self._state.R, self._on):
            values[place] = values[index]

    def advance(
        self,
        duty_permille: Sequence[int],
        time_ms: int,
        limit_degc: Sequence[float] | None = None,
        kept: int = 0,
        until: tuple[int, bool, float, bool] | None = None,
        every_ms: int = 0,
    ) -> Passed:
        """Let `time_ms` pass, or less: until a coil that is on reaches its limit, or what is asked for holds.

        A coil of the mask `kept` is not stopped by its limit but kept near it. What is asked for `until` is a mask of
        coils, whether they should be above (or below) a temperature, that temperature, and whether all (or any) must.
        With `every_ms` temperatures are traced, and time ends when that has filled its room.
        """
        permille = np.asarray(duty_permille, float)
        self._width[:] = np.floor(permille * COUNTS / 1000 + 1e-9) / COUNTS
        self._limit[:] = NEVER_DEGC if limit_degc is None else limit_degc
        self._keep[:] = [kept >> i & 1 for i in range(self._keep.size)] if kept else 0.0
        self._asked[:] = until if until else 0.0
        if self._battery is not None:
            self._circuit.supply[0] = self._battery.voltage_v
        self._heat(*self._parts, time_ms, every_ms or EVER_MS)
        passed_ms, rows = int(self._count[TIME]), int(self._count[ROWS])
        if self._battery is not None:
            self._spend(passed_ms)
        return Passed(passed_ms, self._state.T, self._peak, self._peak_ms, self._trace[:rows])

    def _spend(self, time_ms: int) -> None:
        """Take from the battery what has been drawn for so long."""
        assert self._battery is not None
        source_v, inner = float(self._circuit.supply[0]), self._circuit
        loads = self._width / (self._state.R + inner.r)
        self._battery.spend(source_v * float(loads.sum()), 1000 * time_ms)


def predictor(address: str, spare: int = 0) -> Thermals:
    """Return the coils of a robot that the bench knows, by its `sim:` address or its name.

    LookupError when it knows none of that name, or the robot has no coils; ValueError when the address cannot be read.
    """
    place = parse(address)
    return Thermals(load(place.robot, place.overrides), place.seed, spare)
