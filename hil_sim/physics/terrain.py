r"""Terrain: a height profile along the plane, of a step and of random roughness, as a polyline of solid ground.

.. math::
    z(x) = h_s \, [x > x_s] + h_r \, w(x) \sum_j g_j \, e^{-2 (x - x_j)^2 / l^2}, \qquad
    \langle z(x) z(x + s) \rangle = h_r^2 \, e^{-s^2 / l^2}                                             (G1)

with independent Gaussian g_j, normalised. The weight w is 0 under the start, where the robot is to stand level, and
1 from a body's width away; a step that lies behind the start is one for a robot that goes backward. Across the
direction of travel nothing changes.

Source: filtered Gaussian noise (standard result); the step is vertical. Beyond `FAR` the ground is level. Checked in
tests/test_physics_terrain.py.

    terrain = terrain_of(robot.ground, seed=1, width=0.04)
    d, nx, nz = depth(terrain, x, z)
"""

from math import ceil
from typing import NamedTuple

import numpy as np

from hil_sim.physics.bodies import GroundNumbers
from hil_sim.physics.compiled import Array, lean

FAR = 2.0  # [m] to where there is roughness on either side
LEVEL = 1e3  # [m] to where the ground reaches
FINENESS = 6  # vertices in a correlation length
FINEST = 2.5e-4  # [m] shortest correlation length
TINY = 1e-12  # [m]


class Terrain(NamedTuple):
    """Vertices of the surface, x rising or equal (a riser); none for a plane."""

    x: Array  # along the plane [m]
    z: Array  # above it [m]


def terrain_of(ground: GroundNumbers, seed: int, width: float = 0.1) -> Terrain:
    """Return the terrain of these numbers and this seed for a body of that width [m].

    Raises ValueError for a step right under the start and for roughness that is too fine.
    """
    if not (ground.step or ground.rough):
        return Terrain(np.zeros(0), np.zeros(0))
    x, z = np.array([0.0]), np.array([0.0])
    if ground.rough:
        x, z = roughness(ground, seed, width)
    x, z = np.concatenate(([-LEVEL], x, [LEVEL])), np.concatenate((z[:1], z, z[-1:]))
    return Terrain(*stepped(x, z, ground)) if ground.step else Terrain(x, z)


def roughness(ground: GroundNumbers, seed: int, width: float) -> tuple[Array, Array]:
    """Return the vertices of the roughness alone, second part of (G1) [m]."""
    if ground.rough_length < FINEST:
        raise ValueError(f"roughness correlated over {1e3 * ground.rough_length:g} mm: at least {1e3 * FINEST:g} mm")
    spacing = ground.rough_length / FINENESS
    count = ceil(FAR / spacing)
    x: Array = np.linspace(-count * spacing, count * spacing, 2 * count + 1)
    near = np.arange(-2 * FINENESS, 2 * FINENESS + 1)
    weights = np.exp(-2.0 * (near / FINENESS) ** 2)
    noise = np.random.default_rng(seed).standard_normal(x.size + near.size - 1)
    smooth = np.convolve(noise, weights / np.sqrt(weights @ weights), mode="valid")
    part = np.clip(2.0 * np.abs(x) / width - 1.0, 0.0, 1.0)
    z: Array = ground.rough * part * part * (3.0 - 2.0 * part) * smooth
    return x, z


def stepped(x: Array, z: Array, ground: GroundNumbers) -> tuple[Array, Array]:
    """Return the vertices with a riser put in, and all beyond it, seen from the start, lifted by the step."""
    edge = ground.step_at
    if edge == 0.0:
        raise ValueError("a step at 0 mm: right under the start")
    at, foot = int(np.searchsorted(x, edge)), float(np.interp(edge, x, z))
    before, after = (0.0, ground.step) if edge > 0.0 else (ground.step, 0.0)
    heights = (z[:at] + before, [foot + before, foot + after], z[at:] + after)
    return np.concatenate((x[:at], [edge, edge], x[at:])), np.concatenate(heights)


def profile(terrain: Terrain, x: float, reach: float) -> list[list[float]]:
    """Return the vertices within that reach of a place, with an end on either side, for a picture; none on a plane."""
    if terrain.x.size == 0:
        return []
    near = np.abs(terrain.x - x) < reach
    ends = [[end, surface(terrain, end)] for end in (x - reach, x + reach)]
    return [ends[0], *np.stack([terrain.x[near], terrain.z[near]], 1).tolist(), ends[1]]


@lean
def under(terrain: Terrain, x: float) -> int:
    """Return the number of the piece of the surface that lies straight under a place."""
    low, high = 0, terrain.x.size - 1
    while high - low > 1:
        middle = (low + high) // 2
        if terrain.x[middle] <= x:
            low = middle
        else:
            high = middle
    return low


@lean
def surface(terrain: Terrain, x: float) -> float:
    """Return the height of the ground at a place [m]."""
    if terrain.x.size == 0:
        return 0.0
    i = under(terrain, x)
    rise, run = terrain.z[i + 1] - terrain.z[i], terrain.x[i + 1] - terrain.x[i]
    return float(terrain.z[i] + rise * (x - terrain.x[i]) / run)


@lean
def depth(terrain: Terrain, x: float, z: float) -> tuple[float, float, float]:
    r"""Return how deep a point lies in the ground, and the direction of the shortest way out.

    Parameters
    ----------
    terrain : Terrain
        Surface of the ground [m]
    x, z : float
        Place of the point along the plane and above it [m]

    Returns
    -------
    float
        Depth below the nearest surface; in the air minus the height above the ground straight below [m]
    float, float
        Unit vector from the point to that nearest surface, at the surface its normal; in the air upward [1]
    """
    if terrain.x.size == 0:
        return -z, 0.0, 1.0
    gap = z - surface(terrain, x)
    if gap > 0.0:
        return -gap, 0.0, 1.0
    best, nx, nz = np.inf, 0.0, 1.0
    first = under(terrain, x)
    k = first
    while k >= 0 and terrain.x[k + 1] >= x - min(best, -gap):
        d, ux, uz = way_out(terrain, k, x, z)
        if d < best:
            best, nx, nz = d, ux, uz
        k -= 1
    k = first + 1
    while k + 1 < terrain.x.size and terrain.x[k] <= x + min(best, -gap):
        d, ux, uz = way_out(terrain, k, x, z)
        if d < best:
            best, nx, nz = d, ux, uz
        k += 1
    return best, nx, nz


@lean
def way_out(terrain: Terrain, k: int, x: float, z: float) -> tuple[float, float, float]:
    """Return distance from a point in the ground to piece k of its surface [m] and the unit vector of the way."""
    ex, ez = terrain.x[k + 1] - terrain.x[k], terrain.z[k + 1] - terrain.z[k]
    px, pz = x - terrain.x[k], z - terrain.z[k]
    square = ex * ex + ez * ez
    s = min(1.0, max(0.0, (px * ex + pz * ez) / square))
    dx, dz = s * ex - px, s * ez - pz
    d = np.sqrt(dx * dx + dz * dz)
    if d < TINY:
        length = np.sqrt(square)
        return d, -ez / length, ex / length
    return d, dx / d, dz / d
