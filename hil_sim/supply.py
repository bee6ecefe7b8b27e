"""The common supply of the coils: what each coil is heated with, and what the monitor's pins see.

This is where the netlist meets the physics: gates (shares of the PWM period) go in, powers and voltages come out.
The order on the rail is source, shunt, the monitor's bus pin, the PWR_EN switch, coils; so the monitor sees the
supply's voltage also while the switch is open. The resistance of the source includes the shunt.

ASSUMED: the PWM chips run in phase, and their period began at time 0.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hil_sim.devices.pca9685 import Gate
from hil_sim.physics.circuit import charge, circuit_of, solve
from hil_sim.physics.window import window_charges

FloatArray = NDArray[np.float64]


class Supply:
    """Voltage source, shunt and coils. `power_w` and `current_a` are the means over a PWM period."""

    def __init__(self, series_ohm: FloatArray, source_ohm: float, shunt_ohm: float, voltage_v: float) -> None:
        self.power_w: FloatArray = np.zeros(len(series_ohm))
        self.current_a = 0.0
        self._circuit = circuit_of(series_ohm, source_ohm, voltage_v)
        self._source_ohm = source_ohm
        self._shunt_ohm = shunt_ohm
        self._voltage_v = voltage_v
        self._period_us = 1.0
        self._steady = True

    def drive(self, gates: Sequence[Gate], period_us: float, resistance_ohm: FloatArray) -> None:
        """Solve the circuit for gates and resistances that hold from now on."""
        self._period_us = period_us
        if not any(width for _, width in gates):
            self.power_w = np.zeros(len(gates))
            self.current_a, self._steady = 0.0, True
            return
        on_width = np.array(gates)
        power_w = np.empty(len(gates))
        solve(self._circuit, on_width[:, 0].copy(), on_width[:, 1].copy(), resistance_ohm, power_w)
        self.power_w = power_w
        self.current_a = charge(self._circuit, 1.0)
        self._steady = self._circuit.intervals[0] == 1

    def steady_v(self) -> tuple[float, float] | None:
        """Return the voltages across the shunt and at the bus pin, or None while they ripple."""
        if not self._steady:
            return None
        return self._shunt_ohm * self.current_a, self._voltage_v - self._source_ohm * self.current_a

    def integrals_vus(
        self, begun_us: int, from_us: int, until_us: int, shunt_us: int, bus_us: int
    ) -> tuple[float, float]:
        """Return both voltages integrated over their turns of the conversions since begun_us."""
        shunt, bus, bus_time_us = window_charges(
            self._circuit, self._period_us, begun_us, from_us, until_us, shunt_us, bus_us
        )
        return self._shunt_ohm * shunt, self._voltage_v * bus_time_us - self._source_ohm * bus
