r"""Planar elastic ring with a rigid hub: its constants, the forces of the rim and their exact tangent.

A closed discrete elastic rod of N nodes and edges e_i from node i to i+1, counter-clockwise, node 0 at the bottom:

.. math::
    U = \sum_i \frac{EI}{2 l_0} (c_i - c_0)^2 + \sum_i \frac{EA}{2 l_0} (|e_i| - l_0)^2,
    \qquad c_i = 2 \tan(\varphi_i / 2)                                                      (R1)

with the turning angle \varphi_i from e_{i-1} to e_i. The tangent measure, not the angle itself, makes N = 32 right to
1 % in deflection and frequency, and it forbids folding. Kelvin-Voigt damping acts on the curvature, c_i -> c_i +
tau_v dc_i/dt.

Source: the energy is that of a discrete elastic rod (standard result; Bergou 2008 for the family); derivatives
derived here and held against finite differences in tests/test_physics_ring_forces.py, which also checks the two laws
of a thin ring. Forces are kept as gradients `f` (the equation of motion is M a + f = 0). Unknowns are q = [x_0, y_0,
... x_hub, y_hub, psi_hub].
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hil_sim.physics.bodies import GroundNumbers, RingNumbers
from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.terrain import Terrain, terrain_of

# Rows of the scratch `rim`, columns padded by one on either side so that column i + 1 belongs to node or edge i.
TX, TY, GX, GY, TENSION, INVERSE, SPIN, MOMENT, STIFF = range(9)
RIM_ROWS = 9
# Rows of the scratch `blocks`: diagonal, first and second neighbour and hub columns of each node's two rows.
DXX, DXY, DYY, AXX, AXY, AYX, AYY, BXX, BXY, BYX, BYY, HXX, HXY, HXP, HYX, HYY, HYP = range(17)
BLOCK_ROWS = 17


class Ring(NamedTuple):
    """Constants of one body and its ground in SI units; mass is an array over the unknowns."""

    nodes: int
    EI: float  # [N m2]
    EA: float  # [N]
    tau_v: float  # [s]
    drag: float  # [1/s]
    l0: float  # length of an edge at rest [m]
    c0: float  # curvature measure at rest [1]
    coil_damping: float  # [N s/m]
    hub_radius: float  # [m]
    k_n: float  # contact stiffness of a node [N/m]
    c_n: float  # contact damping of a node [N s/m]
    mu: float  # coefficient of friction [1]
    mass: Array  # (2 N + 3,) [kg, kg m2]
    arms: Array  # attachments about the centre of the hub (2, S) [m]
    feet: NDArray[np.int64]  # node of each spoke (S,) [1]
    compass: Array  # directions of the nodes of the round ring that has not turned (2, N) [1]
    terrain: Terrain  # surface of the ground


def ring_of(numbers: RingNumbers, ground: GroundNumbers, spokes: int, seed: int = 0) -> Ring:
    """Return the constants of a ring with spokes to evenly spaced nodes, number 0 at the bottom.

    The seed is that of the ground's roughness. Raises ValueError if the nodes cannot be shared out evenly.
    """
    p, n = numbers, numbers.nodes
    if n < 8 or n % spokes:
        raise ValueError(f"{n} nodes for {spokes} spokes: at least 8, and a multiple of the spokes")
    half = np.pi / n
    angles = 2.0 * np.pi * np.arange(n) / n - 0.5 * np.pi
    compass, feet = np.array([np.cos(angles), np.sin(angles)]), np.arange(spokes) * (n // spokes)
    mass = np.full(2 * n + 3, p.m / n)
    mass[2 * n :] = p.m_hub
    mass[2 * n + 2] *= 0.5 * p.r_hub**2
    return Ring(
        n, p.EI, p.EA, p.tau_v, p.drag, 2.0 * p.R * np.sin(half), 2.0 * np.tan(half), p.damping, p.r_hub,
        ground.k_n, ground.c_n, ground.mu, mass,
        p.attach * compass[:, feet], feet, compass, terrain_of(ground, seed, 2.0 * p.R),
    )  # fmt: skip


def round_pose(ring: Ring, R: float, height: float, turn: float = 0.0) -> Array:
    """Return the unknowns of a round ring of radius R, centre at (0, height) [m], turned forward by `turn` [rad]."""
    q = np.zeros(2 * ring.nodes + 3)
    (x, y), cosine, sine = R * ring.compass, np.cos(turn), np.sin(turn)
    q[0:-3:2] = x * cosine + y * sine
    q[1:-3:2] = height + y * cosine - x * sine
    q[-2:] = height, -turn
    return q


@lean
def edge(rim: Array, q: Array, v: Array, i: int, j: int, EA: float, l0: float) -> None:
    """Fill the columns of edge i from node i to node j."""
    ex = q[2 * j] - q[2 * i]
    ey = q[2 * j + 1] - q[2 * i + 1]
    length = np.sqrt(ex * ex + ey * ey)
    inverse = 1.0 / length
    tx, ty = ex * inverse, ey * inverse
    gx, gy = -ty * inverse, tx * inverse
    rim[TX, i + 1] = tx
    rim[TY, i + 1] = ty
    rim[GX, i + 1] = gx
    rim[GY, i + 1] = gy
    rim[INVERSE, i + 1] = inverse
    rim[TENSION, i + 1] = EA * (length / l0 - 1.0)
    rim[SPIN, i + 1] = gx * (v[2 * j] - v[2 * i]) + gy * (v[2 * j + 1] - v[2 * i + 1])


@lean
def wrap(rim: Array, first: int, last: int, n: int) -> None:
    """Copy the closing columns of some rows to the padding on either side."""
    for row in range(first, last):
        rim[row, 0] = rim[row, n]
        rim[row, n + 1] = rim[row, 1]


@lean
def rim_forces(ring: Ring, q: Array, v: Array, cv: float, rim: Array, f: Array) -> None:
    r"""Write the gradient of (R1) with its damping to the node entries of f.

    Parameters
    ----------
    ring : Ring
        Constants of the body [SI]
    q, v : array (2 N + 3,)
        Positions and velocities [m, m/s]
    cv : float
        Derivative of velocity by position in the time step [1/s]
    rim : array (9, N + 2)
        Scratch; moments, stiffnesses and edge vectors stay in it for `rim_tangent`
    f : array (2 N + 3,)
        Receives the gradient [N]
    """
    n, B = ring.nodes, ring.EI / ring.l0
    for i in range(n - 1):
        edge(rim, q, v, i, i + 1, ring.EA, ring.l0)
    edge(rim, q, v, n - 1, 0, ring.EA, ring.l0)
    wrap(rim, TX, MOMENT, n)
    for i in range(1, n + 1):
        cross = rim[TX, i - 1] * rim[TY, i] - rim[TY, i - 1] * rim[TX, i]
        dot = rim[TX, i - 1] * rim[TX, i] + rim[TY, i - 1] * rim[TY, i]
        half = cross / (1.0 + dot)
        slope = 1.0 + half * half
        rate = slope * (rim[SPIN, i] - rim[SPIN, i - 1])
        strain = 2.0 * half - ring.c0 + ring.tau_v * rate
        rim[MOMENT, i] = B * strain * slope
        rim[STIFF, i] = B * (slope * slope * (1.0 + ring.tau_v * cv) + (strain + ring.tau_v * rate) * slope * half)
    wrap(rim, MOMENT, RIM_ROWS, n)
    px, py = edge_force(rim, 0)
    for i in range(n):
        qx, qy = edge_force(rim, i + 1)
        f[2 * i] = qx - px
        f[2 * i + 1] = qy - py
        px, py = qx, qy


@lean
def edge_force(rim: Array, e: int) -> tuple[float, float]:
    """Return the gradient that the edge in column e gives to its start, and takes from its end [N]."""
    bend = rim[MOMENT, e + 1] - rim[MOMENT, e]
    return bend * rim[GX, e] - rim[TENSION, e] * rim[TX, e], bend * rim[GY, e] - rim[TENSION, e] * rim[TY, e]


@lean
def rim_tangent(ring: Ring, rim: Array, blocks: Array) -> None:
    """Write the symmetric derivative of `rim_forces`, from what that left in rim, to the blocks of all nodes [N/m]."""
    n, EA = ring.nodes, ring.EA / ring.l0
    for i in range(n):
        e = i + 1
        gx, gy, hx, hy = rim[GX, e], rim[GY, e], rim[GX, e - 1], rim[GY, e - 1]
        nx, ny = rim[GX, e + 1], rim[GY, e + 1]
        sx, sy, ox, oy = gx + hx, gy + hy, nx + gx, ny + gy
        before, here, after = rim[STIFF, e - 1], rim[STIFF, e], rim[STIFF, e + 1]
        kxx, kxy, kyy = edge_stiffness(rim, e, EA)
        lxx, lxy, lyy = edge_stiffness(rim, e - 1, EA)
        blocks[DXX, i] = here * sx * sx + after * gx * gx + before * hx * hx + kxx + lxx
        blocks[DXY, i] = here * sx * sy + after * gx * gy + before * hx * hy + kxy + lxy
        blocks[DYY, i] = here * sy * sy + after * gy * gy + before * hy * hy + kyy + lyy
        blocks[AXX, i] = -after * gx * ox - here * sx * gx - kxx
        blocks[AXY, i] = -after * gx * oy - here * sx * gy - kxy
        blocks[AYX, i] = -after * gy * ox - here * sy * gx - kxy
        blocks[AYY, i] = -after * gy * oy - here * sy * gy - kyy
        blocks[BXX, i] = after * gx * nx
        blocks[BXY, i] = after * gx * ny
        blocks[BYX, i] = after * gy * nx
        blocks[BYY, i] = after * gy * ny
        for row in range(HXX, BLOCK_ROWS):
            blocks[row, i] = 0.0


@lean
def edge_stiffness(rim: Array, e: int, EA: float) -> tuple[float, float, float]:
    """Return xx, xy, yy of the stretch and moment stiffness of the edge in column e [N/m]."""
    tx, ty, inverse = rim[TX, e], rim[TY, e], rim[INVERSE, e]
    turn = (rim[MOMENT, e] - rim[MOMENT, e + 1]) * inverse * inverse
    pull = rim[TENSION, e] * inverse
    along = EA - pull
    kxx = along * tx * tx + pull + 2.0 * turn * tx * ty
    kxy = along * tx * ty + turn * (ty * ty - tx * tx)
    kyy = along * ty * ty + pull - 2.0 * turn * tx * ty
    return kxx, kxy, kyy
