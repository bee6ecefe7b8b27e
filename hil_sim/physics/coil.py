r"""Heat, phase, force and resistance of shape-memory coils under electrical power.

.. math::  m c \, \dot T = P - hA (T - T_{amb}) + m H \, \dot \xi                                                 (H1)

Over one step of length dt the power and the rate of transformation count as constant, for which (H1) has the exact
solution

.. math::  T_1 = T_\infty + (T_0 - T_\infty) e^{-dt/\tau}, \quad
           T_\infty = T_{amb} + \frac{P + m H (\xi_1 - \xi_0)/dt}{hA}, \quad \tau = \frac{m c}{hA}                (H2)

and the fraction xi_1 is found together with T_1 (`phase.settle`). The energies of the step close to rounding:

.. math::  P \, dt = m c (T_1 - T_0) + m H (\xi_0 - \xi_1) + \int hA (T - T_{amb}) \, dt                          (H3)

The work on the body, W = -∫ F dL, is kept beside the balance. ASSUMED: it does not cool the wire (some 1 mJ of 270 mJ
a stroke). ASSUMED: the wire is equally warm throughout (Biot number about 1e-3) and hA does not depend on pitch or
temperature, which makes coils hotter than Morgan's correlation above about 120 degC. Steps of 1 ms are fine; the
phase lags by about 0.3 K in a body that yields between steps. Checked in tests/test_physics_coil_heat.py, example:

    coils = coils_of(numbers, 8)
    state = cold(coils, lengths)
    for _ in range(5): advance(state, 1e-3, power, lengths, coils)
"""

from math import expm1

from hil_sim.physics.coilset import Coils, CoilState
from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.phase import settle
from hil_sim.physics.spring import force_and_tangent, resistance


@lean
def advance(state: CoilState, dt: float, P: Array, L: Array, coils: Coils) -> None:
    r"""Advance all coils by one step at given power and length, equations (H1) to (H3); changes `state` in place.

    Parameters
    ----------
    state : CoilState
        State of the coils, overwritten [SI]
    dt : float
        Length of the step, dt > 0 [s]
    P : array (n,)
        Electrical power turned to heat in each coil, mean of the step [W]
    L : array (n,)
        Length between the attachments at the end of the step [m]
    coils : Coils
        Constants of the coils [SI]
    """
    for i in range(state.T.size):
        T_0, xi_0, T_amb = state.T[i], state.xi[i], coils.T_amb[i]
        tau = coils.C[i] / coils.hA[i]
        share = -expm1(-dt / tau)  # of the way to the steady temperature
        B = coils.Q[i] / (coils.hA[i] * dt) * share
        T = T_0 + (T_amb + P[i] / coils.hA[i] - T_0) * share

        xi = settle(i, xi_0, T, B, L[i], coils)

        T_inf = T_amb + (P[i] + coils.Q[i] * (xi - xi_0) / dt) / coils.hA[i]
        state.E_in[i] += P[i] * dt
        state.E_lost[i] += coils.hA[i] * ((T_inf - T_amb) * dt + (T_0 - T_inf) * tau * share)
        state.T[i] = T + B * (xi - xi_0)
        state.xi[i] = xi
    measure(state, L, coils)


@lean
def measure(state: CoilState, L: Array, coils: Coils) -> None:
    r"""Bring force, work and resistance up to date with temperature, fraction and length; changes `state` in place.

    Parameters
    ----------
    state : CoilState
        State of the coils: L, F, W and R are overwritten [SI]
    L : array (n,)
        Length between the attachments [m]
    coils : Coils
        Constants of the coils [SI]
    """
    for i in range(state.T.size):
        F, _ = force_and_tangent(i, L[i], state.xi[i], coils)
        state.W[i] -= 0.5 * (state.F[i] + F) * (L[i] - state.L[i])
        state.L[i] = L[i]
        state.F[i] = F
        state.R[i] = resistance(i, L[i], state.xi[i], coils)


def stored(state: CoilState, coils: Coils) -> Array:
    r"""Return the sensible heat above ambient temperature, m c (T - T_amb).

    Parameters
    ----------
    state : CoilState
        State of the coils [SI]
    coils : Coils
        Constants of the coils [SI]

    Returns
    -------
    array (n,)
        Energy [J]
    """
    return coils.C * (state.T - coils.T_amb)


def latent(state: CoilState, coils: Coils) -> Array:
    r"""Return the latent heat taken up against full martensite, m H (1 - xi).

    Parameters
    ----------
    state : CoilState
        State of the coils [SI]
    coils : Coils
        Constants of the coils [SI]

    Returns
    -------
    array (n,)
        Energy [J]
    """
    return coils.Q * (1.0 - state.xi)
