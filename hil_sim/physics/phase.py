r"""Martensite fraction of a shape-memory wire: the play operator between the two Liang-Rogers envelopes.

.. math::  \xi \leftarrow \mathrm{clip}(\xi, \; g(s), \; h(s)), \quad s = T - F / c_F                             (P1)

.. math::  h(s) = \tfrac12 \left[1 + \cos \pi \frac{s - A_s}{A_f - A_s}\right], \quad
           g(s) = \tfrac12 \left[1 + \cos \pi \frac{s - M_f}{M_s - M_f}\right]                                    (P2)

h (heating) and g (cooling) are 1 below and 0 above their ramps. Between them the fraction stands still, so minor
loops are closed and a ripple of the temperature changes nothing. In a step of time the temperature and the force
follow the fraction,

.. math::  T(\xi) = T_0 + B (\xi - \xi_0), \quad F = F(L, \xi)                                                    (P3)

and (P1) is solved for the fraction at the end of the step. The residual grows strictly with the fraction, so there is
exactly one solution and a bracketed Newton iteration always finds it. Sources: envelopes, Liang and Rogers as
implemented in gabrielegilardi/FingerControl; play instead of their multiplicative minor loops, which ratchet. Valid
for A_f > A_s >= M_s > M_f. Checked in tests/test_physics_coil_phase.py.
"""

from math import cos, pi, sin

from hil_sim.physics.coilset import Coils
from hil_sim.physics.compiled import lean
from hil_sim.physics.spring import tension

TOLERANCE = 1e-13  # of the fraction


@lean
def ramp(s: float, start: float, end: float) -> tuple[float, float]:
    r"""Return the cosine ramp from 1 at `start` to 0 at `end` and its slope, equation (P2).

    Parameters
    ----------
    s : float
        Temperature, reduced by the stress shift [degC]
    start : float
        The ramp is 1 up to here [degC]
    end : float
        The ramp is 0 from here, end > start [degC]

    Returns
    -------
    tuple of float
        Value [1] and slope, at most 0 [1/K]
    """
    if s <= start:
        return 1.0, 0.0
    if s >= end:
        return 0.0, 0.0
    angle = pi * (s - start) / (end - start)
    return 0.5 * (1.0 + cos(angle)), -0.5 * pi * sin(angle) / (end - start)


@lean
def settle(i: int, xi: float, T: float, B: float, L: float, coils: Coils) -> float:
    r"""Return the martensite fraction of coil i at the end of a step, equations (P1) and (P3).

    Parameters
    ----------
    i : int
        Number of the coil [1]
    xi : float
        Fraction at the beginning of the step [1]
    T : float
        Temperature that the step would end at without a change of phase [degC]
    B : float
        Rise of that temperature per unit of fraction that becomes martensite, at least 0 [K]
    L : float
        Length between the attachments [m]
    coils : Coils
        Constants of the coils [SI]

    Returns
    -------
    float
        Fraction at the end of the step, 0 <= xi <= 1 [1]
    """
    F, _ = tension(i, L, xi, coils)
    s = T - F / coils.c_F[i]
    upper, _ = ramp(s, coils.A_s[i], coils.A_f[i])
    if xi > upper:
        return _meet(i, xi, T, B, L, coils, coils.A_s[i], coils.A_f[i], 0.0)
    lower, _ = ramp(s, coils.M_f[i], coils.M_s[i])
    if xi < lower:
        return _meet(i, xi, T, B, L, coils, coils.M_f[i], coils.M_s[i], 1.0)
    return xi


@lean
def _meet(i: int, xi: float, T: float, B: float, L: float, coils: Coils, start: float, end: float,
          limit: float) -> float:  # fmt: skip
    """Return the fraction between xi and `limit` at which the coil lies on the ramp `start`..`end`."""
    F, _ = tension(i, L, limit, coils)
    if ramp(T + B * (limit - xi) - F / coils.c_F[i], start, end)[0] == limit:
        return limit
    low, high, x = min(xi, limit), max(xi, limit), xi
    for _ in range(80):
        F, slope = tension(i, L, x, coils)
        value, fall = ramp(T + B * (x - xi) - F / coils.c_F[i], start, end)
        residual = x - value
        if residual > 0.0:
            high = x
        else:
            low = x
        step = residual / (1.0 - fall * (B - slope / coils.c_F[i]))
        if abs(step) < TOLERANCE:
            break
        x -= step
        if not low < x < high:
            x = 0.5 * (low + high)
    return x
