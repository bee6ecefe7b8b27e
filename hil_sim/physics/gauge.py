"""What is read off a ring: its centre, how far it has turned, its energy and what bending costs."""

import numpy as np

from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.ring import SPIN, TX, TY, Ring


@lean
def bend_loss(ring: Ring, rim: Array) -> float:
    """Return the power lost in bending, from what `rim_forces` left in rim [W]."""
    power = 0.0
    for i in range(1, ring.nodes + 1):
        dot = rim[TX, i - 1] * rim[TX, i] + rim[TY, i - 1] * rim[TY, i]
        rate = 2.0 / (1.0 + dot) * (rim[SPIN, i] - rim[SPIN, i - 1])
        power += rate * rate
    return ring.EI / ring.l0 * ring.tau_v * power


@lean
def turned(ring: Ring, q: Array) -> float:
    """Return by how much the rim as a whole is turned, positive forward (clockwise), -pi < turned <= pi [rad]."""
    n, x, y, sine, cosine = ring.nodes, 0.0, 0.0, 0.0, 0.0
    for i in range(n):
        x += q[2 * i] / n
        y += q[2 * i + 1] / n
    for i in range(n):
        dx, dy, ax, ay = q[2 * i] - x, q[2 * i + 1] - y, ring.compass[0, i], ring.compass[1, i]
        cosine += ax * dx + ay * dy
        sine += ay * dx - ax * dy
    return float(np.arctan2(sine, cosine))


@lean
def centre(ring: Ring, q: Array) -> tuple[float, float]:
    """Return the centre of mass of rim and hub [m]."""
    mass = x = y = 0.0
    for i in range(ring.nodes + 1):
        mass += ring.mass[2 * i]
        x += ring.mass[2 * i] * q[2 * i]
        y += ring.mass[2 * i] * q[2 * i + 1]
    return x / mass, y / mass


@lean
def rim_energy(ring: Ring, q: Array) -> float:
    """Return the elastic energy (R1) of the rim [J]."""
    n, energy = ring.nodes, 0.0
    px, py = q[0] - q[2 * n - 2], q[1] - q[2 * n - 1]
    for i in range(n):
        j = 2 * ((i + 1) % n)
        ex, ey = q[j] - q[2 * i], q[j + 1] - q[2 * i + 1]
        length = np.hypot(ex, ey)
        c = 2.0 * (px * ey - py * ex) / (np.hypot(px, py) * length + px * ex + py * ey)
        energy += 0.5 * ring.EI / ring.l0 * (c - ring.c0) ** 2 + 0.5 * ring.EA / ring.l0 * (length - ring.l0) ** 2
        px, py = ex, ey
    return energy
