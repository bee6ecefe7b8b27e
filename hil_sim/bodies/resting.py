r"""Coils of a body at rest, heated by given duties: the physics of every body, in steps as long as they may be.

Where no coil changes its phase and no duty changes, one step of any length is exact (coil.py, H2), so a step ends
where the next change of phase begins, and is short only within one: `WITHIN` of sensible heat. Whatever is looked for
is found to a control step: a step that jumps over it is halved and done again. A coil that is kept near a temperature
is switched at each control step.

Checked in tests/test_bench_prediction.py against a bench whose body is still.
"""

import numpy as np

from hil_sim.physics.circuit import Circuit, solve
from hil_sim.physics.coil import advance
from hil_sim.physics.coilset import Coils, CoilState
from hil_sim.physics.compiled import Array, kernel
from hil_sim.physics.spring import tension

GRID_MS = 5  # control step
WITHIN = 3.0  # [K]
NEAR = 0.2  # [K] a change of phase as near as this has begun
EVER_MS = 1 << 40
TIME, ROWS = range(2)  # of what `heat` counts
MASK, ABOVE, DEGC, ALL = range(4)  # of what is asked for


@kernel
def heat(
    circuit: Circuit, coils: Coils, state: CoilState, on: Array, width: Array, P: Array, R: Array, before: Array,
    limit: Array, keep: Array, asked: Array, peak: Array, peak_at: Array, trace: Array, count: Array, time: int,
    every: int,
) -> None:  # fmt: skip
    """Heat and cool for `time` [ms] at most: until a limit ends an order or what is asked for holds.

    `count` receives the time that passed [ms] and the rows of `trace`, which is filled each `every` [ms].
    """
    t = 0
    rows = 0
    n = state.T.size
    for i in range(n):
        peak[i] = state.T[i]
        peak_at[i] = 0.0
    while t < time and rows < trace.shape[0] and not ended(state, width, limit, keep, asked):
        steady = True
        for i in range(n):
            P[i] = width[i]
            if keep[i] > 0.0 and width[i] > 0.0:
                steady = False
                if state.T[i] >= limit[i]:
                    P[i] = 0.0
        before[0, :] = P
        solve(circuit, on, before[0], state.R, R)  # R: powers, until the step
        P[:] = R
        h = min(time - t, every, longest(coils, state, P) if steady else GRID_MS)
        before[1], before[2], before[3], before[4] = state.T, state.xi, state.E_in, state.E_lost
        while True:
            advance(state, 1e-3 * h, P, state.L, coils)
            if h <= GRID_MS or not ended(state, width, limit, keep, asked):
                break
            h = max(GRID_MS, h // 2 // GRID_MS * GRID_MS)
            state.T[:], state.xi[:], state.E_in[:], state.E_lost[:] = before[1], before[2], before[3], before[4]
        t += h
        for i in range(n):
            if state.T[i] > peak[i]:
                peak[i] = state.T[i]
                peak_at[i] = t
        if every < EVER_MS:
            trace[rows, 0] = t
            trace[rows, 1:] = state.T
            rows += 1
    count[TIME] = t
    count[ROWS] = rows


@kernel
def ended(state: CoilState, width: Array, limit: Array, keep: Array, asked: Array) -> bool:
    """Return whether a coil that is on has reached its limit, or what is asked for holds."""
    holds, wanted = asked[ALL] > 0.0, asked[MASK] > 0.0
    mask = int(asked[MASK])
    for i in range(state.T.size):
        if width[i] > 0.0 and keep[i] == 0.0 and state.T[i] >= limit[i]:
            return True
        if mask >> i & 1:
            met = state.T[i] > asked[DEGC] if asked[ABOVE] > 0.0 else state.T[i] < asked[DEGC]
            if met != (asked[ALL] > 0.0):
                holds = met
    return bool(wanted and holds)


@kernel
def longest(coils: Coils, state: CoilState, P: Array) -> int:
    """Return the longest step [ms] that no change of phase calls for ending, in whole control steps."""
    shortest = np.inf
    for i in range(state.T.size):
        T, xi, T_amb = state.T[i], state.xi[i], coils.T_amb[i]
        T_inf = T_amb + P[i] / coils.hA[i]
        tau = coils.C[i] / coils.hA[i]
        F, _ = tension(i, state.L[i], xi, coils)
        shift = F / coils.c_F[i]
        if T_inf > T:
            if xi == 0.0:
                continue
            turn = turning(xi, coils.A_s[i], coils.A_f[i]) + shift
        else:
            if xi == 1.0:
                continue
            turn = turning(xi, coils.M_f[i], coils.M_s[i]) + shift
        if (turn - T) * (T_inf - T) <= 0.0 or abs(turn - T) < NEAR:  # within
            shortest = min(shortest, WITHIN / max(abs(T_inf - T), WITHIN) * tau)
        elif (T_inf - turn) * (turn - T) > 0.0:
            shortest = min(shortest, tau * np.log((T_inf - T) / (T_inf - turn)))
    if shortest * 1e3 >= EVER_MS:
        return EVER_MS
    return max(GRID_MS, int(1e3 * shortest) // GRID_MS * GRID_MS)


@kernel
def turning(xi: float, start: float, end: float) -> float:
    """Return the temperature, reduced by the stress shift, at which the ramp from `start` to `end` is at xi [degC]."""
    return float(start + (end - start) * np.arccos(2.0 * xi - 1.0) / np.pi)
