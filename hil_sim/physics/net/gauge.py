r"""What is read off a net: its centre of mass and how fast it rises, its lowest point, its attitude, its energy.

The attitude of the hoops as a whole is the rotation nearest to where their nodes are: the orthogonal factor R of

.. math::  \sum_b (x_b - \bar x) \, d_b^T = R S                                                                  (A1)

with the directions d_b of the round body, found by Newton's iteration X -> (X + X^{-T})/2 (standard results). It says
how a body has rolled also where the core hangs in one point and does not turn with it.
"""

import numpy as np

from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.net.ground import DEPTH
from hil_sim.physics.net.mesh import Net
from hil_sim.physics.net.state import Motion, State

ITERATIONS = 8  # to rounding, also for a body squashed to a fifth


@lean
def centre(net: Net, x: Array, axis: int) -> float:
    """Return one coordinate of the centre of mass [m]."""
    mass = moment = 0.0
    for b in range(net.bodies):
        mass += net.mass[b]
        moment += net.mass[b] * x[b, axis]
    return moment / mass


@lean
def rise_rate(net: Net, v: Array) -> float:
    """Return the speed at which the centre of mass leaves the plane [m/s]."""
    mass = moment = 0.0
    for b in range(net.bodies):
        mass += net.mass[b]
        moment += net.mass[b] * v[b, 2]
    return moment / mass


@lean
def lowest(m: Motion) -> float:
    """Return the height of the lowest contact point above the ground [m]."""
    height = np.inf
    for k in range(m.touch.shape[0]):
        height = min(height, -m.touch[k, DEPTH])
    return float(height)


@lean
def kinetic(net: Net, s: State) -> float:
    """Return the kinetic energy [J]."""
    energy = 0.0
    for b in range(net.bodies):
        for p in range(3):
            energy += 0.5 * (net.mass[b] * s.v[b, p] ** 2 + net.inertia[b] * s.v[b, 3 + p] ** 2)
    return energy


@lean
def attitude(net: Net, x: Array, R: Array) -> None:
    """Write the attitude (A1) of the hoops at node places x to R (3, 3)."""
    count, square = net.bodies - 1, 0.0
    for p in range(3):
        middle = 0.0
        R[p, 0] = R[p, 1] = R[p, 2] = 0.0
        for b in range(count):
            middle += x[b, p] / count
        for b in range(count):
            for q in range(3):
                R[p, q] += (x[b, p] - middle) * net.directions[b, q]
        square += R[p, 0] ** 2 + R[p, 1] ** 2 + R[p, 2] ** 2
    for p in range(3):
        for q in range(3):
            R[p, q] *= np.sqrt(3.0 / square)
    for _ in range(ITERATIONS):
        halve(R)


@lean
def halve(X: Array) -> None:
    """Replace X by (X + X^{-T})/2; the inverse transposed is the matrix of cofactors over the determinant."""
    a, b, c, d, e, f, g, h, i = X[0, 0], X[0, 1], X[0, 2], X[1, 0], X[1, 1], X[1, 2], X[2, 0], X[2, 1], X[2, 2]
    share = 0.5 / (a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g))
    X[0, 0], X[0, 1], X[0, 2] = (
        0.5 * a + share * (e * i - f * h), 0.5 * b + share * (f * g - d * i), 0.5 * c + share * (d * h - e * g),
    )  # fmt: skip
    X[1, 0], X[1, 1], X[1, 2] = (
        0.5 * d + share * (c * h - b * i), 0.5 * e + share * (a * i - c * g), 0.5 * f + share * (b * g - a * h),
    )  # fmt: skip
    X[2, 0], X[2, 1], X[2, 2] = (
        0.5 * g + share * (b * f - c * e), 0.5 * h + share * (c * d - a * f), 0.5 * i + share * (a * e - b * d),
    )  # fmt: skip
