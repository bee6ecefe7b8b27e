r"""Rotations: the exponential of a rotation vector and unit quaternions.

.. math::  \exp([\theta]_\times) = 1 + \frac{\sin t}{t} [\theta]_\times + \frac{1 - \cos t}{t^2} [\theta]_\times^2,
           \quad t = |\theta|                                                                                    (X1)

Rodrigues' formula (standard result). Checked in tests/test_physics_net_motion.py.
"""

import numpy as np

from hil_sim.physics.compiled import Array, lean


@lean
def turned(R0: Array, change: Array, b: int, R1: Array) -> None:
    """Write exp(change[b, 3:]) R0[b] to R1[b]."""
    x, y, z = change[b, 3], change[b, 4], change[b, 5]
    square = x * x + y * y + z * z
    if square < 1e-8:
        first, second = 1.0 - square / 6.0, 0.5 - square / 24.0
    else:
        t = np.sqrt(square)
        first, second = np.sin(t) / t, (1.0 - np.cos(t)) / square
    for q in range(3):
        a0, a1, a2 = R0[b, 0, q], R0[b, 1, q], R0[b, 2, q]
        b0, b1, b2 = y * a2 - z * a1, z * a0 - x * a2, x * a1 - y * a0
        R1[b, 0, q] = a0 + first * b0 + second * (y * b2 - z * b1)
        R1[b, 1, q] = a1 + first * b1 + second * (z * b0 - x * b2)
        R1[b, 2, q] = a2 + first * b2 + second * (x * b1 - y * b0)


@lean
def straighten(R: Array) -> None:
    """Make matrices orthogonal again that rounding has bent, one step of Newton's iteration for the polar factor."""
    for b in range(R.shape[0]):
        c00 = c01 = c02 = c11 = c12 = c22 = 0.0
        for p in range(3):
            c00 += R[b, p, 0] * R[b, p, 0]
            c01 += R[b, p, 0] * R[b, p, 1]
            c02 += R[b, p, 0] * R[b, p, 2]
            c11 += R[b, p, 1] * R[b, p, 1]
            c12 += R[b, p, 1] * R[b, p, 2]
            c22 += R[b, p, 2] * R[b, p, 2]
        for p in range(3):
            x, y, z = R[b, p, 0], R[b, p, 1], R[b, p, 2]
            R[b, p, 0] = 1.5 * x - 0.5 * (x * c00 + y * c01 + z * c02)
            R[b, p, 1] = 1.5 * y - 0.5 * (x * c01 + y * c11 + z * c12)
            R[b, p, 2] = 1.5 * z - 0.5 * (x * c02 + y * c12 + z * c22)


def matrix(yaw: float, pitch: float, roll: float) -> Array:
    """Return the rotation that turns by yaw about z, then pitch about the new y, then roll about the new x (3, 3)."""
    (cy, sy), (cp, sp), (cr, sr) = ((np.cos(a), np.sin(a)) for a in (yaw, pitch, roll))
    about_z = np.array([[cy, -sy, 0.0], [sy, cy, 0.0], [0.0, 0.0, 1.0]])
    about_y = np.array([[cp, 0.0, sp], [0.0, 1.0, 0.0], [-sp, 0.0, cp]])
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, cr, -sr], [0.0, sr, cr]])
    turn: Array = about_z @ about_y @ about_x
    return turn


def quaternion(R: Array) -> tuple[float, float, float, float]:
    """Return the unit quaternion (w, x, y, z), w >= 0, of a rotation matrix."""
    K = np.array(
        [
            [R[0, 0] + R[1, 1] + R[2, 2], R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]],
            [0.0, R[0, 0] - R[1, 1] - R[2, 2], R[0, 1] + R[1, 0], R[0, 2] + R[2, 0]],
            [0.0, 0.0, R[1, 1] - R[0, 0] - R[2, 2], R[1, 2] + R[2, 1]],
            [0.0, 0.0, 0.0, R[2, 2] - R[0, 0] - R[1, 1]],
        ]
    )
    w, x, y, z = np.linalg.eigh(K + np.triu(K, 1).T)[1][:, -1]
    sign = -1.0 if w < 0.0 else 1.0
    return float(sign * w), float(sign * x), float(sign * y), float(sign * z)
