r"""Strips against each other: two elements that come nearer than the thickness of what they carry push each other off.

.. math::  F = 10 \, k_n \max(0, w - d)                                                                            (W3)

with the distance d of their chords and the thickness w; no friction. Elements that are near each other in the round
body, along a hoop or round a crossing, do not count. What may come near within a step is listed before it, from the
greatest speed of a node at its begin; what a step adds to that speed is left out, so two strips could pass unseen only
if it carried them across each other at once. In most steps nothing is listed. The stiffness would reach across the
pattern of the equations, so Newton's method gets a bound of it on the diagonal: slower there, to the same end.
ASSUMED: w = 1 mm, a strip of 0.2 mm with crimps. Checked in tests/test_physics_net_contact.py.
"""

import numpy as np

from hil_sim.physics.compiled import Array, lean
from hil_sim.physics.net.mesh import Ints, Net

THICKNESS = 1e-3  # [m] ASSUMED
STIFFER = 10.0  # than the ground ASSUMED: so that what a jump throws stays on its side
MOST = 256  # pairs that may be near at once; a body with more is long past saving
# Entries of a meeting of two chords: distance, unit vector from the first to the second, shares of their later ends.
Meeting = tuple[float, float, float, float, float, float]


def none_close() -> Ints:
    """Return room for the pairs of elements that are near each other; their number stands in the first row."""
    return np.zeros((MOST + 1, 2), dtype=np.int64)


@lean
def list_close(net: Net, x: Array, v: Array, h: float, close: Ints) -> None:
    """Fill close with the pairs that may touch within a step of length h."""
    fastest = 0.0
    for b in range(net.bodies):
        fastest = max(fastest, v[b, 0] * v[b, 0] + v[b, 1] * v[b, 1] + v[b, 2] * v[b, 2])
    reach = THICKNESS + 2.0 * h * np.sqrt(fastest)
    count, far = 0, (reach + net.length) ** 2
    for k in range(net.strangers.shape[0]):
        a, b = net.ends[net.strangers[k, 0], 0], net.ends[net.strangers[k, 1], 0]
        dx, dy, dz = x[a, 0] - x[b, 0], x[a, 1] - x[b, 1], x[a, 2] - x[b, 2]
        if dx * dx + dy * dy + dz * dz > 4.0 * far or count == MOST:
            continue
        if meeting(net, x, net.strangers[k, 0], net.strangers[k, 1])[0] < reach:
            count += 1
            close[count, 0], close[count, 1] = net.strangers[k, 0], net.strangers[k, 1]
    close[0, 0] = count


@lean
def meeting(net: Net, x: Array, first: int, second: int) -> Meeting:
    """Return where the chords of two elements are nearest to each other."""
    a, b, c, d = net.ends[first, 0], net.ends[first, 1], net.ends[second, 0], net.ends[second, 1]
    ux, uy, uz = x[b, 0] - x[a, 0], x[b, 1] - x[a, 1], x[b, 2] - x[a, 2]
    vx, vy, vz = x[d, 0] - x[c, 0], x[d, 1] - x[c, 1], x[d, 2] - x[c, 2]
    wx, wy, wz = x[c, 0] - x[a, 0], x[c, 1] - x[a, 1], x[c, 2] - x[a, 2]
    uu, vv, uv = ux * ux + uy * uy + uz * uz, vx * vx + vy * vy + vz * vz, ux * vx + uy * vy + uz * vz
    uw, vw = ux * wx + uy * wy + uz * wz, vx * wx + vy * wy + vz * wz
    slant = uu * vv - uv * uv
    s = min(1.0, max(0.0, (uw * vv - vw * uv) / slant)) if slant > 1e-9 * uu * vv else 0.5
    t = min(1.0, max(0.0, (s * uv - vw) / vv))
    s = min(1.0, max(0.0, (t * uv + uw) / uu))
    wx, wy, wz = wx + t * vx - s * ux, wy + t * vy - s * uy, wz + t * vz - s * uz
    distance = np.sqrt(wx * wx + wy * wy + wz * wz)
    return distance, wx / distance, wy / distance, wz / distance, s, t


@lean
def strip_forces(net: Net, x: Array, close: Ints, f: Array) -> None:
    """Add the pushes (W3) of all close pairs to f [N]."""
    for k in range(1, close[0, 0] + 1):
        distance, ux, uy, uz, s, t = meeting(net, x, close[k, 0], close[k, 1])
        push = STIFFER * net.k_n * max(0.0, THICKNESS - distance)
        i, j = close[k, 0], close[k, 1]
        first, second = (net.ends[i, 0], net.ends[i, 1]), (net.ends[j, 0], net.ends[j, 1])
        for body, share in ((first[0], 1.0 - s), (first[1], s), (second[0], t - 1.0), (second[1], -t)):
            f[body, 0] += share * push * ux
            f[body, 1] += share * push * uy
            f[body, 2] += share * push * uz


@lean
def strip_tangent(net: Net, x: Array, close: Ints, blocks: Array) -> None:
    """Add a diagonal bound of the stiffness of all close pairs that touch to blocks [N/m]."""
    for k in range(1, close[0, 0] + 1):
        distance, ux, uy, uz, s, t = meeting(net, x, close[k, 0], close[k, 1])
        if distance >= THICKNESS:
            continue
        i, j, u = close[k, 0], close[k, 1], (ux, uy, uz)
        first, second = (net.ends[i, 0], net.ends[i, 1]), (net.ends[j, 0], net.ends[j, 1])
        for body, share in ((first[0], 1.0 - s), (first[1], s), (second[0], 1.0 - t), (second[1], t)):
            block = net.pattern.diagonal[body]
            for p in range(3):
                for q in range(3):
                    blocks[block, p, q] += 2.0 * STIFFER * net.k_n * share * u[p] * u[q]


@lean
def nearest(net: Net, x: Array) -> float:
    """Return the least distance of two elements that are far from each other in the round body [m]."""
    least = np.inf
    for k in range(net.strangers.shape[0]):
        least = min(least, meeting(net, x, net.strangers[k, 0], net.strangers[k, 1])[0])
    return float(least)
