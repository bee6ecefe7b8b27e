r"""Coils on one supply under pulse-width modulation: power in each coil, current and voltage of the supply.

Coil i conducts while the phase p of the PWM period, 0 <= p < 1, lies in a window that may wrap around. Between two
edges of any window nothing changes, and with the set S of conducting coils

.. math::  U = \frac{V}{1 + r_s \sum_S 1/(R_i + r_i)}, \quad I_i = \frac{U}{R_i + r_i}, \quad I = \sum_S I_i      (K1)

.. math::  P_i = \int_0^1 I_i^2 R_i \, dp                                                                         (K2)

So duty averages power, not voltage, and coils that conduct together share the drop over the source while coils that
take turns do not. Source: Ohm and Kirchhoff; the inductance of a coil (0.5 uH, settled within 0.1 us) is left out:
ASSUMED instant edges. `r_i` is all the series resistance of one coil (wiring, MOSFET), `r_s` what all of them share.
Checked in tests/test_physics_circuit_pwm.py, example:

    circuit = circuit_of(series, source=0.02, voltage=2.0)
    solve(circuit, on, width, resistance, power)
    current = mean_current(circuit, 0.25, 2.0)      # over this window of the phase, in periods
"""

from typing import NamedTuple

import numpy as np

from hil_sim.physics.compiled import Array, kernel


class Circuit(NamedTuple):
    """Constants of the circuit and the solution of one PWM period: the intervals between edges."""

    r: Array  # series resistance of each coil (n,) [ohm]
    supply: Array  # voltage V [V] and source resistance r_s [ohm] (2,)
    edges: Array  # phases at which something switches, 0 and 1 included (2 n + 2,) [1]
    current: Array  # of the supply in each interval (2 n + 1,) [A]
    intervals: Array  # number of intervals (1,) [1]


def circuit_of(series: Array, source: float, voltage: float) -> Circuit:
    r"""Return the circuit of coils with all gates off.

    Parameters
    ----------
    series : array (n,)
        Resistance of wiring and switch of each coil, at least 0 [ohm]
    source : float
        Resistance that all coils share, at least 0 [ohm]
    voltage : float
        Voltage of the supply without load [V]

    Returns
    -------
    Circuit
        Constants and room for the solution [SI]

    Raises
    ------
    ValueError
        A negative resistance
    """
    if source < 0 or np.any(series < 0):
        raise ValueError(f"source {source} ohm, series {series} ohm: a resistance is at least 0")
    n = series.size
    edges = np.zeros(2 * n + 2)
    edges[1] = 1.0
    return Circuit(np.array(series, dtype=float), np.array([voltage, source]), edges, np.zeros(2 * n + 1), np.ones(1))


@kernel
def conducts(on: float, width: float, p: float) -> bool:
    r"""Return whether a coil that is switched on at phase `on` for `width` conducts at phase p.

    Parameters
    ----------
    on : float
        Phase of the rising edge, 0 <= on < 1 [1]
    width : float
        Share of the period, 0 off .. 1 always on [1]
    p : float
        Phase, 0 <= p < 1 [1]

    Returns
    -------
    bool
        True while the coil conducts
    """
    return p - on < width if p >= on else p + 1.0 - on < width


@kernel
def cut(edges: Array, on: Array, width: Array) -> int:
    r"""Write the sorted phases between which no gate switches and return the number of intervals.

    Parameters
    ----------
    edges : array (2 n + 2,)
        Receives 0, the phases of all edges in rising order, 1 [1]
    on : array (n,)
        Phase of the rising edge, 0 <= on < 1 [1]
    width : array (n,)
        Share of the period, 0 off .. 1 always on [1]

    Returns
    -------
    int
        Number of intervals, at least 1 [1]
    """
    edges[0] = 0.0
    size = 1
    for i in range(on.size):
        if not 0.0 < width[i] < 1.0:
            continue
        for phase in (on[i], (on[i] + width[i]) % 1.0):
            k = size
            while edges[k - 1] > phase:
                edges[k] = edges[k - 1]
                k -= 1
            if edges[k - 1] < phase:
                edges[k] = phase
                size += 1
            else:  # there already: close the gap again
                for j in range(k, size):
                    edges[j] = edges[j + 1]
    edges[size] = 1.0
    return size


@kernel
def solve(circuit: Circuit, on: Array, width: Array, R: Array, P: Array) -> None:
    r"""Solve one PWM period, equations (K1) and (K2); keeps the supply's current in `circuit`.

    Parameters
    ----------
    circuit : Circuit
        Constants; edges, current and intervals are overwritten [SI]
    on : array (n,)
        Phase of each rising edge, 0 <= on < 1 [1]
    width : array (n,)
        Share of the period that each coil conducts, 0 off .. 1 always on; may reach past the end of the period [1]
    R : array (n,)
        Resistance of each coil; infinite for an open one [ohm]
    P : array (n,)
        Receives the mean power turned to heat in each coil [W]
    """
    V, r_s = circuit.supply[0], circuit.supply[1]
    intervals = cut(circuit.edges, on, width)
    circuit.intervals[0] = intervals
    P[:] = 0.0
    for k in range(intervals):
        start, end = circuit.edges[k], circuit.edges[k + 1]
        middle = 0.5 * (start + end)
        G = 0.0
        for i in range(on.size):
            if conducts(on[i], width[i], middle):
                G += 1.0 / (R[i] + circuit.r[i])
        U = V / (1.0 + r_s * G)
        circuit.current[k] = U * G
        for i in range(on.size):
            if conducts(on[i], width[i], middle) and R[i] < np.inf:
                I_i = U / (R[i] + circuit.r[i])
                P[i] += I_i * I_i * R[i] * (end - start)


@kernel
def charge(circuit: Circuit, t: float) -> float:
    r"""Return the charge drawn from phase 0 of period 0 up to time t, as mean current times periods.

    Parameters
    ----------
    circuit : Circuit
        A solved circuit [SI]
    t : float
        Time in periods, of either sign [1]

    Returns
    -------
    float
        Charge [A] (times the period)
    """
    whole = np.floor(t)
    phase = t - whole
    total = 0.0
    part = 0.0
    for k in range(int(circuit.intervals[0])):
        start, end = circuit.edges[k], circuit.edges[k + 1]
        total += circuit.current[k] * (end - start)
        part += circuit.current[k] * max(0.0, min(phase, end) - start)
    return float(whole * total + part)


@kernel
def mean_current(circuit: Circuit, t_0: float, t_1: float) -> float:
    r"""Return the exact mean of the supply's current over a window of the PWM phase.

    Parameters
    ----------
    circuit : Circuit
        A solved circuit [SI]
    t_0 : float
        Begin of the window in periods [1]
    t_1 : float
        End of the window, t_1 > t_0; it may span any number of periods [1]

    Returns
    -------
    float
        Current [A]
    """
    return (charge(circuit, t_1) - charge(circuit, t_0)) / (t_1 - t_0)


@kernel
def mean_voltage(circuit: Circuit, t_0: float, t_1: float) -> float:
    r"""Return the exact mean of the voltage behind the source resistance over a window of the PWM phase.

    Parameters
    ----------
    circuit : Circuit
        A solved circuit [SI]
    t_0 : float
        Begin of the window in periods [1]
    t_1 : float
        End of the window, t_1 > t_0 [1]

    Returns
    -------
    float
        Voltage [V]
    """
    return float(circuit.supply[0] - circuit.supply[1] * mean_current(circuit, t_0, t_1))
