"""Coils and wires that the coil tests share, made from the numbers of the circular robot."""

from dataclasses import replace

import numpy as np

from hil_sim.physics import coil
from hil_sim.physics.coilset import CoilNumbers, Coils, CoilState, coils_of, cold
from hil_sim.robots.file import load

HT = {"A_s": 88.0, "A_f": 98.0, "M_s": 72.0, "M_f": 62.0}  # Flexinol HT, read


def ring_coil(**changes) -> CoilNumbers:
    """Return the coil of the circular robot."""
    return replace(load("circular").coil, **changes)


def at_rest(coils: Coils, length) -> tuple[CoilState, np.ndarray]:
    """Return cold coils at that length (m), and the lengths."""
    L = np.full(coils.T_amb.size, length, dtype=float)
    state = cold(coils, L)
    coil.measure(state, L, coils)
    return state, L


def slack(numbers: CoilNumbers) -> tuple[Coils, CoilState, np.ndarray]:
    """Return one coil that is never stretched, so that it behaves as its straight wire would."""
    coils = coils_of(numbers, 1)
    return coils, *at_rest(coils, numbers.n * numbers.d)


def wire_power(numbers: CoilNumbers, current_a: float, ohm_per_m: float) -> np.ndarray:
    """Return the power of a constant current in the wire of one coil."""
    return np.array([current_a**2 * ohm_per_m * numbers.L_w])


def seconds_until(done, state, coils, L, P, dt=1e-3, most=30.0) -> float:
    """Advance until done(state) and return how long it took, or infinity."""
    steps = 0
    while not done(state):
        if steps * dt >= most:
            return float("inf")
        coil.advance(state, dt, P, L, coils)
        steps += 1
    return steps * dt


def run(seconds, state, coils, L, P, dt=1e-3) -> None:
    """Advance at constant power and length."""
    for _ in range(round(seconds / dt)):
        coil.advance(state, dt, P, L, coils)
