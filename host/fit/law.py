r"""The force of a rheological block under a shape whose contact does not grow, in closed form.

A spring E and a dashpot c1 in series, beside a dashpot c2 and a spring E0. Where all parts have one Poisson ratio, the
force is that of an elastic block of modulus 1 (`shape` [m]: force per modulus and depth), times

.. math::  S(t) = E_0 s + c_2 \dot s + q, \qquad \dot q = E \dot s - q / \tau, \qquad \tau = c_1 / E

with the depth s. While s changes at a constant rate for dt, q becomes exactly
a q + c_1 (1 - a) \Delta s / dt with a = exp(-dt / tau), so that any depth that is linear in pieces has an exact force.

Source: generalised Maxwell model (standard result). Checked against the bench's own law, hil_sim/physics/block/law.py,
in tests/test_host_fit_law.py.

    force(Material(60e3, 300e3, 6e3), t, depth, shape=0.046)     # N, at the end of each piece
"""

from __future__ import annotations

from math import exp, expm1
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


class Material(NamedTuple):
    """A block's material, in SI units."""

    E: float  # Young's modulus of the spring in series [Pa]
    c1: float  # viscosity of the dashpot in series with it [Pa s]
    c2: float  # viscosity of the dashpot beside both [Pa s]
    E0: float = 0.0  # Young's modulus of the spring beside both [Pa]


def force(material: Material, t: Floats, depth: Floats, shape: float) -> Floats:
    """Return the force [N] at times t [s], ascending, of a block at rest at first; depth [m] is linear in between."""
    E, c1, c2, E0 = material
    rate = np.diff(depth) / np.diff(t)
    q, kept = 0.0, [0.0]
    for dt, v in zip(np.diff(t).tolist(), rate.tolist(), strict=True):
        past = -dt * E / c1
        q = exp(past) * q - c1 * expm1(past) * v
        kept.append(q)
    told: Floats = shape * (E0 * (depth - depth[0]) + c2 * np.concatenate([[0.0], rate]) + np.array(kept))
    return told
