r"""Two soft fingers hold an object by friction along a path of the joints, quasi-statically.

    held = carry(numbers, radians([2.5, 12.5]), radians([-2.5, 7.5]))
    held.psi, held.used

At the first pose of a path the tips have just been pressed on the object and nothing shears them, T = 0; from there
the equations of `rolling` are followed in short steps. Checked in tests/test_physics_hand_tangential.py.
"""

from math import radians
from typing import Any, NamedTuple

import numpy as np

from hil_sim.physics.compiled import Array, kernel, prepare
from hil_sim.physics.hand.fingertip import HandError
from hil_sim.physics.hand.grasp import HELD, failure, grasp, joint_angles
from hil_sim.physics.hand.numbers import Fingers, HandNumbers, fingers_of
from hil_sim.physics.hand.press import press
from hil_sim.physics.hand.rolling import COUNT, NEW, WORK, follow, stiffness
from hil_sim.physics.hand.state import (
    ALONG,
    ENERGY,
    LOAD,
    MOMENT,
    NORMAL,
    PSI,
    Q_L,
    Q_R,
    READ,
    SLIDE_L,
    SLIDE_R,
    STATE,
    STIFFNESS,
    THETA,
    D,
    X,
    Y,
)

STEP = radians(0.25)  # of a joint; halving it changes the orientation by less than 1e-3 deg


class Held(NamedTuple):
    """Where the object rests: arrays over the poses of the path, those of the fingers (poses, 2) with R first."""

    x: Array  # [m]
    y: Array  # [m]
    psi: Array  # [rad]
    d: Array  # [m]
    theta: Array  # [rad]
    d_t: Array  # [m]
    N: Array  # [N]
    M: Array  # [N m]
    T: Array  # [N]
    torque: Array  # that the finger exerts on its joint [N m]
    used: Array  # |T| / N [1]
    U: Array  # [J]
    K_psi: Array  # rotational stiffness of the grip, the object free to shift [N m/rad]
    iterations: Array  # of Newton's method since the pose before [1]
    along: str = "determined"


ROW = READ + 6  # what `press` reads, pose, slides, Newton's steps


def carry(numbers: HandNumbers, q_r: Any, q_l: Any, step: float = STEP) -> Held:
    r"""Return where the object rests at each pose of a path, held by tips that stick or slip.

    Parameters
    ----------
    numbers : HandNumbers
        Numbers of the hand, its contact "stick" or "coulomb" [SI]
    q_r : array_like (n,)
        Angles of the right joint along the path [rad]
    q_l : array_like (n,)
        Angles of the left joint along the path [rad]
    step : float
        Longest step of a joint in between [rad]

    Returns
    -------
    Held
        Pose, depths, forces, energy and stiffness, one row for each pose [SI]

    Raises
    ------
    ContactLost
        A tip leaves its face, or the friction does not carry the object
    OutOfRange
        A tip would be pressed to the edge of its plate
    NoEquilibrium
        Newton's method finds no rest
    HandError
        A number that cannot be, a contact without friction, or an object without width
    """
    fingers = fingers_of(numbers._replace(motion="quasi-static"))
    if numbers.contact == "frictionless":
        raise HandError("contact 'frictionless' carries nothing along the faces: ask `grasp`, or choose 'stick'")
    if not step > 0.0:
        raise HandError(f"step = {step} rad, must be above 0 rad")
    q_r, q_l = joint_angles(q_r, q_l)
    state, work, rows = np.zeros(STATE), np.zeros(WORK), np.zeros((q_r.size, ROW))
    first = grasp(numbers, q_r[:1], q_l[:1])
    state[[X, Y, PSI]] = first.x[0], first.y[0], first.psi[0]
    state[[Q_R, Q_L]] = q_r[0], q_l[0]
    state[[SLIDE_R, SLIDE_L]] = -0.5 * fingers.b / fingers.k * first.d[0] * np.tan(first.theta[0])
    prepare(trace)
    status = trace(fingers, q_r, q_l, step, state, work, rows)
    if status != HELD:
        raise failure(status, work[NEW:], fingers)
    return held(rows)


def held(rows: Array) -> Held:
    """Return what `trace` has filled in, by name."""
    d, theta, N, M, T, load = (rows[:, i : i + 2] for i in (D, THETA, NORMAL, MOMENT, ALONG, LOAD))
    x, y, psi = rows[:, READ : READ + 3].T
    used, count = np.abs(T) / N, rows[:, ROW - 1].astype(int)
    return Held(x, y, psi, d, theta, rows[:, READ + 3 : READ + 5], N, M, T, load, used, rows[:, ENERGY],
                rows[:, STIFFNESS], count)  # fmt: skip


@kernel
def trace(f: Fingers, q_r: Array, q_l: Array, step: float, state: Array, work: Array, rows: Array) -> int:
    """Fill a row for each pose of the path; return HELD or what is wrong."""
    for i in range(q_r.size):
        from_r, from_l = state[Q_R], state[Q_L]
        count = max(1, int(np.ceil(max(abs(q_r[i] - from_r), abs(q_l[i] - from_l)) / step - 1e-9)))
        for k in range(1, count + 1):
            share = k / count
            status = follow(f, from_r + share * (q_r[i] - from_r), from_l + share * (q_l[i] - from_l), state, work)
            if status != HELD:
                return status
            rows[i, ROW - 1] += work[COUNT]
        press(f, state, rows[i])
        rows[i, STIFFNESS] = stiffness(work)
        for j in range(5):
            rows[i, READ + j] = state[j]
    return HELD
