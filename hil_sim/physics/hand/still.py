r"""A hand that moves slowly: the servos turn the joints, and the object is at rest between the tips at any moment.

An object that is not gripped stays where it is, on a stand (ASSUMED), and the tips press on it there. It is gripped
once both tips touch it and it finds a rest between them; where it no longer does, the stand has it again, where it is.
"""

import numpy as np

from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.hand.fingertip import deepest, springs
from hil_sim.physics.hand.geometry import meet, sweep
from hil_sim.physics.hand.grasp import DEEP_R, HELD, LOST_L, LOST_R, rest
from hil_sim.physics.hand.numbers import Fingers, Servo
from hil_sim.physics.hand.servo import drive
from hil_sim.physics.hand.state import (
    ALONG,
    ENERGY,
    GRIPPED,
    JAM_R,
    LOAD,
    MOMENT,
    MOTOR,
    NORMAL,
    PSI,
    Q_L,
    Q_R,
    RATES,
    STIFFNESS,
    THETA,
    D,
    X,
    Y,
)

STEP = 2.5e-4  # [s] a sixtieth of a servo's time constant


@lean
def creep(f: Fingers, servo: Servo, c_r: float, c_l: float, dt: float, state: Array, read: Array, found: Array) -> int:
    """Advance servos and object by dt [s] under the commands [rad]; return HELD or what is wrong."""
    count = max(1, int(np.ceil(dt / STEP - 1e-9)))
    for _ in range(count):
        turn(servo, 0, c_r, dt / count, state, read)
        turn(servo, 1, c_l, dt / count, state, read)
        status = relax(f, state, read, found)
        if status != HELD:
            return status
    return HELD


@lean
def turn(servo: Servo, i: int, c: float, h: float, state: Array, read: Array) -> None:
    """Turn joint i by its servo for a step h [s] under the load of the moment."""
    acceleration, read[MOTOR + i] = drive(servo, c, state[Q_R + i], state[RATES + Q_R + i], read[LOAD + i])
    state[RATES + Q_R + i] = 0.0 if state[JAM_R + i] > 0.0 else state[RATES + Q_R + i] + h * acceleration
    state[Q_R + i] += h * state[RATES + Q_R + i]


@lean
def relax(f: Fingers, state: Array, read: Array, found: Array) -> int:
    """Let the object come to rest at the present angles and read forces; return HELD or what is wrong."""
    touching = press(f, state, read)
    if touching:
        status = rest(f, state[Q_R], state[Q_L], found)
        if status not in (HELD, LOST_R, LOST_L):
            return status
        state[GRIPPED] = 1.0 if status == HELD else 0.0
        if status == HELD:
            for i in range(3):
                state[X + i] = found[i]
            press(f, state, read)
            read[STIFFNESS] = found[14]
    else:
        state[GRIPPED] = 0.0
    for i in range(2):
        if read[D + i] > 0.0 and not read[D + i] <= deepest(f.a, read[THETA + i]):
            found[3 + i], found[5 + i] = read[D + i], read[THETA + i]
            return DEEP_R + i
    return HELD


@lean
def press(f: Fingers, state: Array, read: Array) -> bool:
    """Read what the tips do to the object at its place and to the joints; return whether both touch it."""
    read[ENERGY] = read[STIFFNESS] = 0.0
    for i in range(2):
        s, q, psi = 1.0 - 2.0 * i, state[Q_R + i], state[PSI]
        d, theta, _ = meet(f, s, q, state[X], state[Y], psi)
        U, N, M, T, _, _, _, _, _, _ = springs(f.b, f.E, f.k, max(d, 0.0), theta, 0.0)
        dx, dy = sweep(f, s, q)
        read[D + i], read[THETA + i], read[NORMAL + i], read[MOMENT + i], read[ALONG + i] = d, theta, N, M, 0.0 * T
        read[LOAD + i] = N * s * (np.cos(psi) * dx + np.sin(psi) * dy) + M
        read[ENERGY] += U
    return bool(read[D] > 0.0 and read[D + 1] > 0.0)
