r"""Charge drawn in the two kinds of windows in which a current monitor converts by turns.

Windows of lengths a (shunt) and b (bus) follow each other without a gap from the time t_s on; what a conversion sees is

.. math::  Q_a = \sum_j \int_{W_j} I \, dt, \quad W_j = [t_s + j (a + b), t_s + j (a + b) + a] \cap [t_0, t_1]   (W1)

and likewise Q_b. With I from the circuit's exact solution a window shorter than the PWM period aliases as on the board.
Derived here; checked in tests/test_bench_supply.py.
"""

from hil_sim.physics.circuit import Circuit, charge, solve
from hil_sim.physics.compiled import Array, kernel


@kernel
def window_charges(
    circuit: Circuit, period: float, begun: int, t_0: int, t_1: int, first: int, second: int
) -> tuple[float, float, float]:
    r"""Return the charge drawn in both kinds of windows, equation (W1), and the time in the second kind.

    Parameters
    ----------
    circuit : Circuit
        A solved circuit [SI]
    period : float
        Length of the PWM period [us]
    begun : int
        Begin of the first window [us]
    t_0 : int
        Begin of the time that counts, t_0 >= begun [us]
    t_1 : int
        Its end [us]
    first : int
        Length of the windows of the first kind [us]
    second : int
        Length of the windows of the second kind [us]

    Returns
    -------
    tuple[float, float, float]
        Charge in the first kind, charge in the second kind [A us], time in the second kind [us]
    """
    drawn_first = 0.0
    drawn_second = 0.0
    time_second = 0.0
    t = t_0
    while t < t_1:
        phase = (t - begun) % (first + second)
        end = min(t_1, t - phase + (first if phase < first else first + second))
        drawn = (charge(circuit, end / period) - charge(circuit, t / period)) * period
        if phase < first:
            drawn_first += drawn
        else:
            drawn_second += drawn
            time_second += end - t
        t = end
    return drawn_first, drawn_second, time_second


@kernel
def solve_period(circuit: Circuit, on: Array, width: Array, R: Array, P: Array) -> float:
    r"""Solve one PWM period as `circuit.solve` does and return the mean current of the supply.

    Parameters
    ----------
    circuit : Circuit
        Constants; edges, current and intervals are overwritten [SI]
    on : array (n,)
        Phase of each rising edge, 0 <= on < 1 [1]
    width : array (n,)
        Share of the period that each coil conducts [1]
    R : array (n,)
        Resistance of each coil; infinite for an open one [ohm]
    P : array (n,)
        Receives the mean power turned to heat in each coil [W]

    Returns
    -------
    float
        Current [A]
    """
    solve(circuit, on, width, R, P)
    return charge(circuit, 1.0)
