r"""Forces and tangent of two-node, geometrically exact beam elements between rigid bodies.

An element joins bodies a and b at x_a, x_b with rotations R_a, R_b; T_i are its axes in the round body, where it has
no strain: T_1 along it, T_2 the strip's flat normal, T_3 across its width. With t_i = R T_i at either end, e = x_b -
x_a, length l, mean axes m_i = (t_i^a + t_i^b)/2, the turn theta about n that takes t^a to t^b, r = tan(theta/2) n:

.. math::
    \Gamma_i = \frac{m_i \cdot e}{l} - \delta_{i1} (1 - Q), \quad
    Q = \tfrac23 (r_2^2 + r_3^2) + \tfrac16 \varphi_0 r_3, \quad
    g = 2 (1 + r^2)^{-1/3} \, r, \quad
    U = \frac{l}{2} \sum_i C_i \Gamma_i^2 + \frac{1}{2 l} \sum_i B_i g_i^2                                       (N1)

The element is an arc that turns by phi_0 in the round body: Q is what its chord loses by bending, (phi^2 -
phi_0^2)/24, and what the mean axes fall short of a unit. Without it N = 24 is 15 % too stiff where the sphere is
squashed by a sixth; with it the error is 0.6 %, and 1.4 % at a third. The measure g is the turn itself to the fourth
order, and forbids folding. Kelvin-Voigt damping acts on it, g -> g + tau_v dg/dt. For a spin delta of b against a, in
the axes of a,

.. math::  2 \delta r = M \delta, \quad M = 1 - [r]_\times + r r^T, \qquad
           2 w \cdot \delta^2 r = (\delta \cdot r)(\mu \cdot \delta), \quad \mu = M^T w                          (N2)

Sources: strains of Simo and Reissner at one point with averaged axes, and the composition of Rodrigues' parameters
(standard results); Q, g, (N2) and the tangent derived here, the tangent held against finite differences in
tests/test_physics_net_forces.py, large bending against a MuJoCo chain in tests/test_physics_net_mujoco.py. Forces are
gradients `f` (M a + f = 0), three of force and three of moment a body. Left out of the tangent: its part that is not
symmetric, as large as the moments that accelerate a body, and the change of the damping with the shape.
"""

from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.net.mesh import Net

# Columns of the scratch `work`, a row for each element: axes at both ends, mean axes, levers of the ends, rows of M in
# space, vector from end to end, contracted axes, moment of b, r in the axes of a and in space, moment of g, thrust.
AXES_A, AXES_B, MEAN, LEVER_A, LEVER_B, GAIN = 0, 9, 18, 27, 36, 45
CHORD, PULL_A, PULL_B, MOMENT, TURN, TURN_OUT, TORQUE, THRUST = 54, 57, 60, 63, 66, 69, 72, 75
WORK_COLUMNS = 76


@lean
def beam_forces(net: Net, x: Array, R: Array, v: Array, work: Array, f: Array) -> tuple[float, float]:
    """Add the gradient of (N1) with its damping to f; return energy [J] and power lost in bending [W].

    Parameters
    ----------
    net : Net
        Constants of the body [SI]
    x, R, v : array (B, 3), (B, 3, 3), (B, 6)
        Positions [m], rotations [1], velocities and spins [m/s, rad/s]
    work : array (E, 76)
        Scratch; keeps what `beam_tangent` needs
    f : array (B, 6)
        Receives the gradient [N, N m]
    """
    energy = loss = 0.0
    for k in range(net.beams.size):
        a, b = net.ends[k, 0], net.ends[k, 1]
        carry_axes(net, R, a, k, work, AXES_A)
        carry_axes(net, R, b, k, work, AXES_B)
        measure_turn(work, k)
        bent, lost = bend(net, v, a, b, k, work, f)
        energy += bent + stretch(net, x, a, b, k, work, f)
        loss += lost
    return energy, loss


@lean
def carry_axes(net: Net, R: Array, body: int, k: int, work: Array, to: int) -> None:
    """Write the axes of element k as body carries them."""
    for i in range(3):
        for p in range(3):
            work[k, to + 3 * i + p] = (
                R[body, p, 0] * net.axes[k, i, 0]
                + R[body, p, 1] * net.axes[k, i, 1]
                + R[body, p, 2] * net.axes[k, i, 2]
            )


@lean
def lever(work: Array, k: int, axis: int, to: int) -> None:
    """Write half the cross product of an axis with the chord."""
    ax, ay, az = work[k, axis], work[k, axis + 1], work[k, axis + 2]
    ex, ey, ez = work[k, CHORD], work[k, CHORD + 1], work[k, CHORD + 2]
    work[k, to] = 0.5 * (ay * ez - az * ey)
    work[k, to + 1] = 0.5 * (az * ex - ax * ez)
    work[k, to + 2] = 0.5 * (ax * ey - ay * ex)


@lean
def stretch(net: Net, x: Array, a: int, b: int, k: int, work: Array, f: Array) -> float:
    """Add what stretch and shear of element k give, after `bend`; return their energy [J]."""
    r1, r2, bow = work[k, TURN + 1], work[k, TURN + 2], net.bow[k]
    lost = 2.0 / 3.0 * (r1 * r1 + r2 * r2) + bow * r2 / 6.0
    by_edge, by_flat = net.length * 2.0 / 3.0 * r1, net.length * (2.0 / 3.0 * r2 + bow / 12.0)
    for p in range(3):
        work[k, CHORD + p] = x[b, p] - x[a, p]
        work[k, PULL_A + p] = work[k, PULL_B + p] = 0.0
    energy = 0.0
    for i in range(3):
        at_a, at_b, strain = AXES_A + 3 * i, AXES_B + 3 * i, lost - 1.0 if i == 0 else 0.0
        for p in range(3):
            mean = 0.5 * (work[k, at_a + p] + work[k, at_b + p])
            work[k, MEAN + 3 * i + p] = mean
            strain += mean * work[k, CHORD + p] / net.length
        force = net.stiffness[i] * strain
        energy += 0.5 * net.length * force * strain
        for p in range(3):
            work[k, PULL_A + p] += force * work[k, at_a + p]
            work[k, PULL_B + p] += force * work[k, at_b + p]
        lever(work, k, at_a, LEVER_A + 3 * i)
        lever(work, k, at_b, LEVER_B + 3 * i)
        if i == 0:
            work[k, THRUST] = force
            for p in range(3):
                turning = by_edge * work[k, GAIN + 3 + p] + by_flat * work[k, GAIN + 6 + p]
                work[k, LEVER_A + p] -= turning
                work[k, LEVER_B + p] += turning
                work[k, MOMENT + p] += force * turning
        for p in range(3):
            f[a, 3 + p] += force * work[k, LEVER_A + 3 * i + p]
            f[b, 3 + p] += force * work[k, LEVER_B + 3 * i + p]
    for p in range(3):
        force = 0.5 * (work[k, PULL_A + p] + work[k, PULL_B + p])
        f[a, p] -= force
        f[b, p] += force
    return energy


@lean
def product(work: Array, k: int, i: int, j: int) -> float:
    """Return the product of axis i at a and axis j at b."""
    at_a, at_b = AXES_A + 3 * i, AXES_B + 3 * j
    result: float = (
        work[k, at_a] * work[k, at_b]
        + work[k, at_a + 1] * work[k, at_b + 1]
        + work[k, at_a + 2] * work[k, at_b + 2]
    )  # fmt: skip
    return result


@lean
def measure_turn(work: Array, k: int) -> None:
    """Write r of element k and the rows of M, (N2), in space."""
    share = 1.0 / (1.0 + product(work, k, 0, 0) + product(work, k, 1, 1) + product(work, k, 2, 2))
    r0 = share * (product(work, k, 2, 1) - product(work, k, 1, 2))
    r1 = share * (product(work, k, 0, 2) - product(work, k, 2, 0))
    r2 = share * (product(work, k, 1, 0) - product(work, k, 0, 1))
    work[k, TURN], work[k, TURN + 1], work[k, TURN + 2] = r0, r1, r2
    for p in range(3):
        tx, ty, tz = work[k, AXES_A + p], work[k, AXES_A + 3 + p], work[k, AXES_A + 6 + p]
        turn = r0 * tx + r1 * ty + r2 * tz
        work[k, TURN_OUT + p] = turn
        work[k, GAIN + p] = tx + r2 * ty - r1 * tz + r0 * turn
        work[k, GAIN + 3 + p] = ty - r2 * tx + r0 * tz + r1 * turn
        work[k, GAIN + 6 + p] = tz + r1 * tx - r0 * ty + r2 * turn


@lean
def bend(net: Net, v: Array, a: int, b: int, k: int, work: Array, f: Array) -> tuple[float, float]:
    """Add what bending and twist of element k give; return their energy [J] and the power lost [W]."""
    r0, r1, r2 = work[k, TURN], work[k, TURN + 1], work[k, TURN + 2]
    s, ds, _ = softening(r0 * r0 + r1 * r1 + r2 * r2)
    dx, dy, dz = v[b, 3] - v[a, 3], v[b, 4] - v[a, 4], v[b, 5] - v[a, 5]
    q0, q1, q2 = gain(work, k, 0, dx, dy, dz), gain(work, k, 1, dx, dy, dz), gain(work, k, 2, dx, dy, dz)
    inner = 2.0 * ds * (r0 * q0 + r1 * q1 + r2 * q2)
    q0, q1, q2 = s * q0 + inner * r0, s * q1 + inner * r1, s * q2 + inner * r2
    B0, B1, B2 = net.stiffness[3] / net.length, net.stiffness[4] / net.length, net.stiffness[5] / net.length
    g0, g1, g2, tau = 2.0 * s * r0, 2.0 * s * r1, 2.0 * s * r2, net.tau_v
    m0, m1, m2 = B0 * (g0 + tau * q0), B1 * (g1 + tau * q1), B2 * (g2 + tau * q2)
    work[k, TORQUE], work[k, TORQUE + 1], work[k, TORQUE + 2] = m0, m1, m2
    inner = 2.0 * ds * (r0 * m0 + r1 * m1 + r2 * m2)
    w0, w1, w2 = s * m0 + inner * r0, s * m1 + inner * r1, s * m2 + inner * r2
    for p in range(3):
        moment = w0 * work[k, GAIN + p] + w1 * work[k, GAIN + 3 + p] + w2 * work[k, GAIN + 6 + p]
        work[k, MOMENT + p] = moment
        f[a, 3 + p] -= moment
        f[b, 3 + p] += moment
    energy = 0.5 * (B0 * g0 * g0 + B1 * g1 * g1 + B2 * g2 * g2)
    return energy, tau * (B0 * q0 * q0 + B1 * q1 * q1 + B2 * q2 * q2)


@lean
def softening(square: float) -> tuple[float, float, float]:
    """Return (1 + square)^(-1/3) and its first two derivatives."""
    s = (1.0 + square) ** (-1.0 / 3.0)
    ds = -s / (3.0 * (1.0 + square))
    return s, ds, -4.0 * ds / (3.0 * (1.0 + square))


@lean
def gain(work: Array, k: int, i: int, x: float, y: float, z: float) -> float:
    """Return the product of row i of M with a vector in space."""
    at = GAIN + 3 * i
    component: float = work[k, at] * x + work[k, at + 1] * y + work[k, at + 2] * z
    return component


@lean
def turn_stiffness(net: Net, cv: float, k: int, work: Array) -> tuple[float, float, float, float, float, float]:
    """Return 00, 11, 22, 01, 02, 12 of the derivative of moments by 2 r of element k [N m]."""
    r0, r1, r2 = work[k, TURN], work[k, TURN + 1], work[k, TURN + 2]
    m0, m1, m2 = work[k, TORQUE], work[k, TORQUE + 1], work[k, TORQUE + 2]
    s, ds, dds = softening(r0 * r0 + r1 * r1 + r2 * r2)
    ease = (1.0 + net.tau_v * cv) / net.length
    B0, B1, B2 = net.stiffness[3] * ease, net.stiffness[4] * ease, net.stiffness[5] * ease
    inner, thrust = m0 * r0 + m1 * r1 + m2 * r2, net.length * work[k, THRUST] / 3.0
    bent = 4.0 * ds * ds * (B0 * r0 * r0 + B1 * r1 * r1 + B2 * r2 * r2) + 2.0 * dds * inner
    both = 2.0 * s * ds
    return (
        s * s * B0 + (2.0 * both * B0 + bent) * r0 * r0 + 2.0 * ds * r0 * m0 + ds * inner,
        s * s * B1 + (2.0 * both * B1 + bent) * r1 * r1 + 2.0 * ds * r1 * m1 + ds * inner + thrust,
        s * s * B2 + (2.0 * both * B2 + bent) * r2 * r2 + 2.0 * ds * r2 * m2 + ds * inner + thrust,
        (both * (B0 + B1) + bent) * r0 * r1 + ds * (r0 * m1 + r1 * m0),
        (both * (B0 + B2) + bent) * r0 * r2 + ds * (r0 * m2 + r2 * m0),
        (both * (B1 + B2) + bent) * r1 * r2 + ds * (r1 * m2 + r2 * m1),
    )


@lean
def beam_tangent(net: Net, cv: float, work: Array, blocks: Array) -> None:
    """Add the symmetric derivative of `beam_forces` by position, with velocity following at cv [1/s], to blocks."""
    S, length = net.stiffness, net.length
    c0, c1, c2 = S[0] / length, S[1] / length, S[2] / length
    for k in range(net.beams.size):
        a, b, ba = net.pattern.diagonal[net.ends[k, 0]], net.pattern.diagonal[net.ends[k, 1]], net.beams[k]
        b00, b11, b22, b01, b02, b12 = turn_stiffness(net, cv, k, work)
        for p in range(3):
            m0, m1, m2 = c0 * work[k, MEAN + p], c1 * work[k, MEAN + 3 + p], c2 * work[k, MEAN + 6 + p]
            u0, u1, u2 = c0 * work[k, LEVER_A + p], c1 * work[k, LEVER_A + 3 + p], c2 * work[k, LEVER_A + 6 + p]
            s0, s1, s2 = c0 * work[k, LEVER_B + p], c1 * work[k, LEVER_B + 3 + p], c2 * work[k, LEVER_B + 6 + p]
            G0, G1, G2 = work[k, GAIN + p], work[k, GAIN + 3 + p], work[k, GAIN + 6 + p]
            g0, g1, g2 = b00 * G0 + b01 * G1 + b02 * G2, b01 * G0 + b11 * G1 + b12 * G2, b02 * G0 + b12 * G1 + b22 * G2
            for q in range(3):
                M0, M1, M2 = work[k, MEAN + q], work[k, MEAN + 3 + q], work[k, MEAN + 6 + q]
                U0, U1, U2 = work[k, LEVER_A + q], work[k, LEVER_A + 3 + q], work[k, LEVER_A + 6 + q]
                V0, V1, V2 = work[k, LEVER_B + q], work[k, LEVER_B + 3 + q], work[k, LEVER_B + 6 + q]
                G0, G1, G2 = work[k, GAIN + q], work[k, GAIN + 3 + q], work[k, GAIN + 6 + q]
                xx = m0 * M0 + m1 * M1 + m2 * M2
                turning = (
                    g0 * G0
                    + g1 * G1
                    + g2 * G2
                    + 0.5 * (work[k, TURN_OUT + p] * work[k, MOMENT + q] + work[k, MOMENT + p] * work[k, TURN_OUT + q])
                )
                blocks[a, p, q] += xx
                blocks[b, p, q] += xx
                blocks[ba, p, q] -= xx
                blocks[a, 3 + p, q] -= u0 * M0 + u1 * M1 + u2 * M2
                blocks[b, 3 + p, q] += s0 * M0 + s1 * M1 + s2 * M2
                blocks[ba, 3 + p, q] -= s0 * M0 + s1 * M1 + s2 * M2
                blocks[ba, p, 3 + q] += m0 * U0 + m1 * U1 + m2 * U2
                blocks[a, 3 + p, 3 + q] += u0 * U0 + u1 * U1 + u2 * U2 + turning
                blocks[b, 3 + p, 3 + q] += s0 * V0 + s1 * V1 + s2 * V2 + turning
                blocks[ba, 3 + p, 3 + q] += s0 * U0 + s1 * U1 + s2 * U2 - turning
        carried(work, k, PULL_A, blocks, a, -0.5)
        carried(work, k, PULL_B, blocks, b, 0.5)
        skew(work, k, PULL_A, blocks, ba, 0, 3, -0.5)
        skew(work, k, PULL_B, blocks, ba, 3, 0, -0.5)
        skew(work, k, MOMENT, blocks, ba, 3, 3, -0.5)


@lean
def carried(work: Array, k: int, pull: int, blocks: Array, body: int, sign: float) -> None:
    """Add the second derivative by the spin of one body, and its mixed one with the position of the same body."""
    px, py, pz = work[k, pull], work[k, pull + 1], work[k, pull + 2]
    ex, ey, ez = work[k, CHORD], work[k, CHORD + 1], work[k, CHORD + 2]
    inner = 0.5 * (px * ex + py * ey + pz * ez)
    for p in range(3):
        blocks[body, 3 + p, 3 + p] -= inner
        for q in range(3):
            blocks[body, 3 + p, 3 + q] += 0.25 * (
                work[k, pull + p] * work[k, CHORD + q] + work[k, CHORD + p] * work[k, pull + q]
            )
    skew(work, k, pull, blocks, body, 3, 0, sign)


@lean
def skew(work: Array, k: int, at: int, blocks: Array, block: int, row: int, column: int, sign: float) -> None:
    """Add a cross-product matrix times sign to part of a block."""
    x, y, z = sign * work[k, at], sign * work[k, at + 1], sign * work[k, at + 2]
    blocks[block, row, column + 1] -= z
    blocks[block, row, column + 2] += y
    blocks[block, row + 1, column] += z
    blocks[block, row + 1, column + 2] -= x
    blocks[block, row + 2, column] -= y
    blocks[block, row + 2, column + 1] += x
