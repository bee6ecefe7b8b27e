"""The common supply of coils and servos: what each coil is heated with, and what the monitor's pins see.

This is where the netlist meets the physics: gates (shares of the PWM period) go in, powers and voltages come out.
The order on the rail is source, shunt, the monitor's bus pin, the PWR_EN switch, coils; so the monitor sees the
supply's voltage also while the switch is open. The resistance of the source includes the shunt. A battery on board
stands before that source, and feeds the board's own chips before the shunt. Servos take a current that does not depend
on the voltage, `load_a`: behind the same shunt and switch, beside the coils.

A coil can be open or shorted at its terminals, and the source can sag. What a short turns to heat warms no coil.

ASSUMED: the PWM chips run in phase, and their period began at time 0; a short has 20 mohm.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hil_sim.devices.pca9685 import Gate
from hil_sim.physics.battery import BatteryNumbers, open_voltage
from hil_sim.physics.circuit import circuit_of
from hil_sim.physics.compiled import bound
from hil_sim.physics.window import solve_period, window_charges

FloatArray = NDArray[np.float64]


SHORT_OHM = 0.02
STALE_V = 1e-3  # a source that has moved so far since the last solution calls for another


class Battery:
    """What is left in a battery. `cut` is True once its protection has opened: no voltage, whatever is left."""

    def __init__(self, numbers: BatteryNumbers) -> None:
        self.charge = numbers.z  # share that is left
        self.cut = False
        self.inner_ohm = numbers.r
        self._numbers = numbers

    @property
    def voltage_v(self) -> float:
        """Return its voltage with nothing but the board to feed."""
        if self.cut:
            return 0.0
        return open_voltage(self.charge, self._numbers.cells) - self.inner_ohm * self._numbers.I_board

    def spend(self, current_a: float, duration_us: int) -> None:
        """Give the coils and the board their current."""
        if self.cut:
            return
        self.charge -= (current_a + self._numbers.I_board) * duration_us * 1e-6 / self._numbers.Q
        self.cut = self.voltage_v - self.inner_ohm * current_a < self._numbers.V_cut


class Supply:
    """Source, shunt and coils. `power_w` and `current_a` are the means over a PWM period; `solve` takes up `load_a`.

    The source is a bench supply of `voltage_v`, or the battery where there is one.
    """

    def __init__(
        self,
        series_ohm: FloatArray,
        source_ohm: float,
        shunt_ohm: float,
        voltage_v: float,
        battery: Battery | None = None,
    ) -> None:
        self.power_w: FloatArray = np.zeros(len(series_ohm))
        self.current_a = 0.0
        self.load_a = 0.0
        self.battery = battery
        self._series_ohm = series_ohm.copy()
        self._source_ohm = source_ohm + (battery.inner_ohm if battery else 0.0)
        self._nominal_v = voltage_v
        self._sag = 0.0
        self._voltage_v = self._source_v()
        self._loaded_a = 0.0  # `load_a` as of the last solution
        self._circuit = circuit_of(series_ohm, self._source_ohm, self._voltage_v)
        self._shunt_ohm = shunt_ohm
        self._on: FloatArray = np.zeros(len(series_ohm))
        self._width: FloatArray = np.zeros(len(series_ohm))
        self._period_us = 1.0
        self._intervals = 1  # of the period, between which something switches
        self._shorted: NDArray[np.bool_] = np.zeros(len(series_ohm), bool)
        self._bridged = False  # any of them is
        self._resistance_ohm: FloatArray = np.full(len(series_ohm), np.inf)
        coils = (self._on, self._width, self._resistance_ohm, self.power_w)
        self._solve_period = bound(solve_period, self._circuit, *coils)
        self._window_charges = bound(window_charges, self._circuit, self._period_us, 0, 0, 1, 1, 1)

    @property
    def stale(self) -> bool:
        """Whether source or load have moved since `solve`, so that it should be done again."""
        return abs(self._source_v() - self._voltage_v) > STALE_V or self.load_a != self._loaded_a

    def spend(self, duration_us: int) -> None:
        """Take from the battery, where there is one, what has been drawn for so long."""
        if self.battery is not None:
            self.battery.spend(self.current_a, duration_us)

    def break_coil(self, index: int, broken: bool) -> None:
        """Open the wire of a coil, or mend it; `solve` must follow."""
        self._circuit.r[index] = np.inf if broken else self._series_ohm[index]

    def short_coil(self, index: int, shorted: bool) -> None:
        """Bridge the terminals of a coil, or part them; `solve` must follow."""
        self._shorted[index] = shorted
        self._bridged = bool(self._shorted.any())

    def sag(self, share: float) -> None:
        """Let the source give this share less of its voltage than it should; `solve` must follow."""
        self._sag = share

    def drive(self, gates: Sequence[Gate], period_us: float) -> None:
        """Take the gates that hold from now on; `solve` must follow."""
        self._on, self._width = np.array(gates, float).reshape(-1, 2).T.copy()
        self._period_us = period_us

    def solve(self, resistance_ohm: FloatArray) -> None:
        """Work out powers and currents for resistances that hold from now on."""
        self._voltage_v, self._loaded_a = self._source_v(), self.load_a
        self._circuit.supply[0] = self._voltage_v - self._source_ohm * self._loaded_a  # what the coils have without any
        ohm = self._resistance_ohm
        ohm[:] = resistance_ohm
        if self._bridged:
            share = np.where(self._shorted, SHORT_OHM / (SHORT_OHM + ohm), 1.0)  # of its power, a coil's own
            ohm[:] = np.where(self._shorted, 1 / (1 / SHORT_OHM + 1 / ohm), ohm)
        self.current_a = self._solve_period(self._circuit, self._on, self._width, ohm, self.power_w) + self._loaded_a
        if self._bridged:
            self.power_w *= share
        self._intervals = int(self._circuit.intervals[0])

    def _source_v(self) -> float:
        """Return the voltage of the source without the coils."""
        return (1.0 - self._sag) * (self.battery.voltage_v if self.battery else self._nominal_v)

    def steady_v(self) -> tuple[float, float] | None:
        """Return the voltages across the shunt and at the bus pin, or None while they ripple."""
        if self._intervals > 1:
            return None
        return self._shunt_ohm * self.current_a, self._voltage_v - self._source_ohm * self.current_a

    def peak_shunt_v(self) -> float:
        """Return the greatest voltage across the shunt in the PWM period."""
        currents_a: list[float] = self._circuit.current[: self._intervals].tolist()
        return self._shunt_ohm * (max(currents_a) + self._loaded_a)

    def integrals_vus(
        self, begun_us: int, from_us: int, until_us: int, shunt_us: int, bus_us: int
    ) -> tuple[float, float]:
        """Return both voltages integrated over their turns of the conversions since begun_us."""
        shunt, bus, bus_time_us = self._window_charges(
            self._circuit, self._period_us, begun_us, from_us, until_us, shunt_us, bus_us
        )
        shunt += self._loaded_a * (until_us - from_us - bus_time_us)
        bus += self._loaded_a * bus_time_us
        return self._shunt_ohm * shunt, self._voltage_v * bus_time_us - self._source_ohm * bus
