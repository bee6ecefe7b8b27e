"""Nets of strips for tests: one hoop or a small sphere with a few coils, and what is done with them."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.linalg import eigh

from hil_sim.physics.bodies import GroundNumbers, SphereNumbers
from hil_sim.physics.flight import no_flight
from hil_sim.physics.net.beam import beam_forces, beam_tangent
from hil_sim.physics.net.mesh import SPHERE, Net, net_of, slot
from hil_sim.physics.net.motion import begin, march
from hil_sim.physics.net.pulls import FREE, HARD, SOFT, SOLID
from hil_sim.physics.net.state import Motion, motion_of
from hil_sim.physics.state import Method, method_of
from hil_sim.physics.tally import STEP
from hil_sim.physics.terrain import Terrain

NUMBERS = SphereNumbers(
    R=0.045, m=4e-3, m_joints=0.4e-3, m_core=0.6e-3, r_core=3e-3, attach=0.01, EI=4.5e-5, edgewise=20.0,
    twist=1.54, EA=300.0, tau_v=0.0, width=6e-3, damping=0.0, drag=0.0, nodes=16,
)  # fmt: skip
GROUND = GroundNumbers(0.0, 1.4, 0.17, 0.6, 500.0, 0.1, 9.81, 25.0)
PLANE = Terrain(np.zeros(0), np.zeros(0))
HOOP = (((0, 0, -1), (1, 0, 0)),)
SPOKES = [(1, 0, 0), (0, 0, -1), (1, 0, -1), (0, 1, 1)]
CHORDS = [((1, 0, -1), (0, 1, -1))]
COIL_RATE, COIL_FREE = 20.0, 0.02  # [N/m], [m]
FALL = (0.0, -9.81)
WEIGHTLESS = (0.0, 0.0)


class Sample(NamedTuple):
    """A net and its motion."""

    net: Net
    m: Motion


def hoop(**numbers: float) -> Net:
    """Return the net of one hoop without coils."""
    return net_of(replace(NUMBERS, **numbers), GROUND, HOOP, [])


def sphere(ground: GroundNumbers = GROUND, **numbers: float) -> Net:
    """Return the net of a sphere with a few coils."""
    return net_of(replace(NUMBERS, **numbers), ground, SPHERE, SPOKES, CHORDS)


def placed(net: Net, height: float = 0.045) -> Sample:
    """Return a net at rest in its round shape, its centre at that height, with taut springs for coils."""
    places = np.vstack([NUMBERS.R * net.directions, np.zeros((1, 3))])
    places[:, 2] += height
    m = motion_of(net, places, np.eye(3))
    m.coils[[SOFT, FREE, SOLID, HARD]] = np.array([[COIL_RATE], [COIL_FREE], [0.0], [0.0]])
    return Sample(net, m)


def exponential(theta: np.ndarray) -> np.ndarray:
    """Return the rotation matrix of a rotation vector."""
    t = np.linalg.norm(theta)
    if t == 0.0:
        return np.eye(3)
    x, y, z = theta / t
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(t) * K + (1 - np.cos(t)) * K @ K


def moved(m: Motion, change: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return places and rotations after displacements and spins (B, 6)."""
    turns = [exponential(spin) @ R for spin, R in zip(change[:, 3:], m.now.R, strict=True)]
    return m.now.x + change[:, :3], np.array(turns)


def shaken(sample: Sample, amount: float, seed: int = 0) -> Sample:
    """Return the sample with all its bodies displaced and turned at random by about `amount` (of R, of a radian)."""
    change = amount * np.random.default_rng(seed).standard_normal((sample.net.bodies, 6))
    change[:, :3] *= NUMBERS.R
    sample.m.now.x[:], sample.m.now.R[:] = moved(sample.m, change)
    return sample


def dense(net: Net, blocks: np.ndarray) -> np.ndarray:
    """Return the whole symmetric matrix of blocks (6 B, 6 B)."""
    A = np.zeros((6 * net.bodies, 6 * net.bodies))
    for body in range(net.bodies):
        lower = np.tril(blocks[net.pattern.diagonal[body]])
        A[6 * body : 6 * body + 6, 6 * body : 6 * body + 6] = lower + np.tril(lower, -1).T
    pairs = {tuple(pair) for pair in [*net.ends.tolist(), *zip(net.near.tolist(), net.far.tolist(), strict=True)]}
    for a, b in pairs:
        place, later = slot(net.pattern, a, b)
        row, column = (a, b) if later else (b, a)
        A[6 * row : 6 * row + 6, 6 * column : 6 * column + 6] = blocks[place]
        A[6 * column : 6 * column + 6, 6 * row : 6 * row + 6] = blocks[place].T
    return A


def ringing(net: Net, speed: float, height: float = 1.0) -> Sample:
    """Return a sphere without coils that begins to swing in its softest shape, its quickest node at `speed` [m/s]."""
    sample = placed(net, height)
    m = sample.m
    m.coils[FREE] = 1.0
    beam_forces(net, m.now.x, m.now.R, m.now.v, m.work, np.zeros((net.bodies, 6)))
    beam_tangent(net, 0.0, m.work, m.blocks)
    mass = np.repeat(np.stack([net.mass, net.inertia], axis=1), 3, axis=1).ravel()
    _, shapes = eigh(dense(net, m.blocks), np.diag(mass), subset_by_index=[12, 12])  # after two bodies' rigid ones
    shape = shapes[:, 0].reshape(-1, 6)
    m.now.v[:] = speed / np.abs(shape[:, :3]).max() * shape
    return started(sample)


def run(
    sample: Sample, seconds: float, g: tuple[float, float] = WEIGHTLESS, step: float = 0.0, method: Method | None = None
) -> Motion:
    """Move a sample from where it is, at a fixed step or as the local error demands, and return its motion."""
    net, m = sample
    chosen = method or method_of(0.8, tolerance=4.5e-6, share=1e-6)
    if step:
        chosen = chosen._replace(tolerance=1.0, longest=step, share=1e-12)
        m.tally[STEP] = step
    march(net, PLANE, g, chosen, m, no_flight(), seconds)
    return m


def started(sample: Sample, g: tuple[float, float] = WEIGHTLESS) -> Sample:
    """Return the sample with forces and accelerations of its present state."""
    begin(sample.net, PLANE, g, sample.m)
    return sample
