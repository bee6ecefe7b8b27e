r"""Planar elastic ring with a rigid hub on tension-only spokes: forces and exact tangents.

A closed discrete elastic rod of N nodes and edges e_i from node i to i+1, counter-clockwise, node 0 at the bottom:

.. math::
    U = \sum_i \frac{EI}{2 l_0} (c_i - c_0)^2 + \sum_i \frac{EA}{2 l_0} (|e_i| - l_0)^2,
    \qquad c_i = 2 \tan(\varphi_i / 2)                                                      (R1)

with the turning angle \varphi_i from e_{i-1} to e_i. The tangent measure, not the angle itself, makes N = 32 right to
1 % in deflection and frequency, and it forbids folding. Kelvin-Voigt damping acts on the curvature, c_i -> c_i +
tau_v dc_i/dt. A spoke of length L between its rim node and the hub has the force of its coil (`spring`, S1) at a
phase frozen for the step, and while taut a damping d that never makes it push; closed, the winding resists:

.. math::  F = \max(0, k (L - L_0) + d \dot L)_{L > L_0} - k_s \max(0, L_s - L)                       (R2)

Source: the energy is that of a discrete elastic rod (standard result; Bergou 2008 for the family); derivatives
derived here and held against finite differences in tests/test_physics_ring_forces.py, which also checks the two laws
of a thin ring. Forces are kept as gradients `f` (the equation of motion is M a + f = 0). Unknowns are q = [x_0, y_0,
... x_hub, y_hub, psi_hub].
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hil_sim.physics.bodies import GroundNumbers, RingNumbers
from hil_sim.physics.coilset import Coils
from hil_sim.physics.compiled import Array, kernel

# Rows of the scratch `rim`, columns padded by one on either side so that column i + 1 belongs to node or edge i.
TX, TY, GX, GY, TENSION, INVERSE, SPIN, MOMENT, STIFF = range(9)
RIM_ROWS = 9
# Rows of the scratch `blocks`: diagonal, first and second neighbour and hub columns of each node's two rows.
DXX, DXY, DYY, AXX, AXY, AYX, AYY, BXX, BXY, BYX, BYY, HXX, HXY, HXP, HYX, HYY, HYP = range(17)
BLOCK_ROWS = 17
# Rows of the scratch `spokes`: length, force, tangent, direction, twist and arm of the attachment; the frozen coils;
# length and force before the step.
LENGTH, PULL, RATE, UX, UY, TWIST, ARM, SOFT, FREE, SOLID, HARD = range(11)
LENGTH_BEFORE, PULL_BEFORE = range(11, 13)
SPOKE_ROWS = 13
DAMPING_RAMP = 5e-5  # [m] the damping of a spoke grows from zero over this stretch, so that the force is continuous


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


def ring_of(numbers: RingNumbers, ground: GroundNumbers, spokes: int) -> Ring:
    """Return the constants of a ring with spokes to evenly spaced nodes, number 0 at the bottom.

    Raises ValueError if the nodes cannot be shared out evenly.
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
        p.attach * compass[:, feet], feet, compass,
    )  # fmt: skip


def round_pose(ring: Ring, R: float, height: float, turn: float = 0.0) -> Array:
    """Return the unknowns of a round ring of radius R, centre at (0, height) [m], turned forward by `turn` [rad]."""
    q = np.zeros(2 * ring.nodes + 3)
    (x, y), cosine, sine = R * ring.compass, np.cos(turn), np.sin(turn)
    q[0:-3:2] = x * cosine + y * sine
    q[1:-3:2] = height + y * cosine - x * sine
    q[-2:] = height, -turn
    return q


@kernel
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


@kernel
def wrap(rim: Array, first: int, last: int, n: int) -> None:
    """Copy the closing columns of some rows to the padding on either side."""
    for row in range(first, last):
        rim[row, 0] = rim[row, n]
        rim[row, n + 1] = rim[row, 1]


@kernel
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


@kernel
def edge_force(rim: Array, e: int) -> tuple[float, float]:
    """Return the gradient that the edge in column e gives to its start, and takes from its end [N]."""
    bend = rim[MOMENT, e + 1] - rim[MOMENT, e]
    return bend * rim[GX, e] - rim[TENSION, e] * rim[TX, e], bend * rim[GY, e] - rim[TENSION, e] * rim[TY, e]


@kernel
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


@kernel
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


@kernel
def freeze(coils: Coils, xi: Array, spokes: Array) -> None:
    """Write stiffness, free length, solid height and stiffness below it of coils at phase xi to spokes [N/m, m]."""
    for s in range(xi.size):
        spokes[SOFT, s] = coils.k_A[s] + xi[s] * (coils.k_M[s] - coils.k_A[s])
        spokes[FREE, s] = coils.L_A[s] + xi[s] * coils.dL[s]
        spokes[SOLID, s] = coils.L_s[s]
        spokes[HARD, s] = coils.k_s[s]


@kernel
def spoke_forces(ring: Ring, q: Array, v: Array, f: Array, spokes: Array) -> None:
    """Add the force (R2) of every spoke to f; note lengths, forces and directions in spokes."""
    hub = 2 * ring.nodes
    cosine, sine = np.cos(q[hub + 2]), np.sin(q[hub + 2])
    for s in range(ring.feet.size):
        i = 2 * ring.feet[s]
        rx = cosine * ring.arms[0, s] - sine * ring.arms[1, s]
        ry = sine * ring.arms[0, s] + cosine * ring.arms[1, s]
        dx, dy = q[i] - q[hub] - rx, q[i + 1] - q[hub + 1] - ry
        length = np.sqrt(dx * dx + dy * dy)
        ux, uy = dx / length, dy / length
        twist = uy * rx - ux * ry
        rate = ux * (v[i] - v[hub]) + uy * (v[i + 1] - v[hub + 1]) - twist * v[hub + 2]
        F = k = 0.0
        stretch, pressed = length - spokes[FREE, s], spokes[SOLID, s] - length
        if stretch > 0.0:
            k = spokes[SOFT, s]
            F = max(0.0, k * stretch + ring.coil_damping * min(1.0, stretch / DAMPING_RAMP) * rate)
        if pressed > 0.0:
            k += spokes[HARD, s]
            F -= spokes[HARD, s] * pressed
        spokes[LENGTH, s] = length
        spokes[PULL, s] = F
        spokes[RATE, s] = k
        spokes[UX, s] = ux
        spokes[UY, s] = uy
        spokes[TWIST, s] = twist
        spokes[ARM, s] = ux * rx + uy * ry
        f[i] += F * ux
        f[i + 1] += F * uy
        f[hub] -= F * ux
        f[hub + 1] -= F * uy
        f[hub + 2] -= F * twist


@kernel
def spoke_tangent(ring: Ring, spokes: Array, cv: float, blocks: Array, hub: Array) -> None:
    """Add the derivative of `spoke_forces`, from what that noted, to blocks and to hub (3, 3) [N/m]."""
    for s in range(ring.feet.size):
        F, i = spokes[PULL, s], ring.feet[s]
        if F == 0.0:
            continue
        ux, uy, twist, arm = spokes[UX, s], spokes[UY, s], spokes[TWIST, s], spokes[ARM, s]
        along = spokes[RATE, s] + (cv * ring.coil_damping if F > 0.0 else 0.0)
        across = F / spokes[LENGTH, s]
        kxx = along * ux * ux + across * uy * uy
        kxy = (along - across) * ux * uy
        kyy = along * uy * uy + across * ux * ux
        kxp = -along * twist * ux + across * arm * uy
        kyp = -along * twist * uy - across * arm * ux
        couple(blocks, hub, i, kxx, kxy, kyy)
        blocks[HXP, i] += kxp
        blocks[HYP, i] += kyp
        hub[2, 0] -= kxp
        hub[2, 1] -= kyp
        hub[2, 2] += along * twist * twist + across * arm * arm + F * arm


@kernel
def couple(blocks: Array, hub: Array, i: int, kxx: float, kxy: float, kyy: float) -> None:
    """Add a stiffness between node i and the centre of the hub [N/m]; the lower half of hub is enough."""
    blocks[DXX, i] += kxx
    blocks[DXY, i] += kxy
    blocks[DYY, i] += kyy
    blocks[HXX, i] -= kxx
    blocks[HXY, i] -= kxy
    blocks[HYX, i] -= kxy
    blocks[HYY, i] -= kyy
    hub[0, 0] += kxx
    hub[1, 0] += kxy
    hub[1, 1] += kyy


@kernel
def bend_loss(ring: Ring, rim: Array) -> float:
    """Return the power lost in bending, from what `rim_forces` left in rim [W]."""
    power = 0.0
    for i in range(1, ring.nodes + 1):
        dot = rim[TX, i - 1] * rim[TX, i] + rim[TY, i - 1] * rim[TY, i]
        rate = 2.0 / (1.0 + dot) * (rim[SPIN, i] - rim[SPIN, i - 1])
        power += rate * rate
    return ring.EI / ring.l0 * ring.tau_v * power


@kernel
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


@kernel
def centre(ring: Ring, q: Array) -> tuple[float, float]:
    """Return the centre of mass of rim and hub [m]."""
    mass = x = y = 0.0
    for i in range(ring.nodes + 1):
        mass += ring.mass[2 * i]
        x += ring.mass[2 * i] * q[2 * i]
        y += ring.mass[2 * i] * q[2 * i + 1]
    return x / mass, y / mass


@kernel
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
