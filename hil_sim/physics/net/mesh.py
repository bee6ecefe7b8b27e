r"""Makes a net of elastic strips out of closed hoops: bodies, beam elements, contact points and coil ends.

Every node is a rigid body of six unknowns; hoops that cross share the node there, so their frames are tied. The last
body is the core. All frames are the identity in the round body at rest, whose axes are those of the labels: x forward,
y to the left, z up. A place on a body is kept as its offset from the node in those axes.

    net = net_of(numbers, ground, SPHERE, spokes=[(1, 0, 0), ...], chords=[((1, 0, -1), (0, 1, -1)), ...])

Source: lumped masses and the directions of labels, derived here. ASSUMED: a node's moment of inertia is the same about
all axes, m (w^2 + l^2)/12. Four contact points a node and hoop lie on the strip's edges, half an element apart.
Checked in tests/test_physics_net_mesh.py.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hil_sim.physics.bodies import GroundNumbers, SphereNumbers
from hil_sim.physics.compiled import Array
from hil_sim.physics.net.pattern import Pattern, pattern_of, slot

Ints = NDArray[np.int64]
Direction = tuple[int, int, int]
# The circles of a body: from the first axis towards the second. The first lies in the plane of travel.
Circle = tuple[Direction, Direction]
SPHERE: tuple[Circle, ...] = (((0, 0, -1), (1, 0, 0)), ((0, 0, -1), (0, 1, 0)), ((1, 0, 0), (0, 1, 0)))


class Net(NamedTuple):
    """Constants of one body and its ground in SI units; B bodies, E elements, P contact points, S coils."""

    bodies: int
    mass: Array  # (B,) [kg]
    inertia: Array  # (B,) [kg m2]
    weight: float  # of all, on the ground of the earth [N]
    drag: float  # [1/s]
    # elements: the earlier and the later of their bodies in the order of elimination
    ends: Ints  # (E, 2)
    beams: Ints  # slot of the block between them (E,)
    axes: Array  # rows: along, flat normal and width of the strip in the round body (E, 3, 3) [1]
    bow: Array  # turn of the arc of each in the round body, about the last of its axes (E,) [rad]
    length: float  # [m]
    stiffness: Array  # of the six strains (6,): stretch, two shears [N]; twist, edgewise, flatwise bending [N m2]
    tau_v: float  # [s]
    # contact points with the ground
    feet: Ints  # body of each (P,)
    offsets: Array  # (P, 3) [m]
    k_n: float  # [N/m]
    c_n: float  # [N s/m]
    mu: float  # [1]
    # coils: they pull the body `far` towards a place on the body `near`
    near: Ints  # (S,)
    far: Ints  # (S,)
    arms: Array  # offset of the place on `near` (S, 3) [m]
    pulls: Ints  # slot of the block between them (S,)
    near_last: Ints  # 1 where `near` is the later in the order of elimination, as the core is (S,)
    coil_damping: float  # [N s/m]
    core_radius: float  # [m]
    width: float  # of the strips [m]
    to_core: Ints  # slot of the block of each node, columns, with the core, rows; -1 where there is none (B - 1,)
    strangers: Ints  # pairs of elements that are far from each other in the round body (C, 2)
    hoops: Ints  # bodies in order round each hoop (H, N)
    directions: Array  # of the nodes from the centre of the round body (B - 1, 3) [1]
    pattern: Pattern


def net_of(
    numbers: SphereNumbers,
    ground: GroundNumbers,
    circles: Sequence[Circle],
    spokes: Sequence[Direction],
    chords: Sequence[tuple[Direction, Direction]] = (),
) -> Net:
    """Return the net of hoops on these circles with coils from the core to points and between points.

    Raises ValueError when a coil ends where there is no node.
    """
    p = numbers
    hoops, directions = _nodes(circles, p.nodes)
    count, core = len(directions), len(directions)
    near, far, arms = _coils(directions, core, p.attach, spokes, chords)
    first, second, axes = _elements(hoops, circles, directions)
    couples = [*zip(first, second, strict=True), *zip(near, far, strict=True)]
    pattern = pattern_of(count + 1, sorted({(int(min(pair)), int(max(pair))) for pair in couples}))
    bow = np.full(len(first), 2.0 * np.pi / p.nodes)
    ends, beams = _ordered(pattern, first, second, axes, bow)
    found = [slot(pattern, a, b) for a, b in zip(near.tolist(), far.tolist(), strict=True)]
    length = 2.0 * p.R * np.sin(np.pi / p.nodes)
    mass, inertia = _masses(p, hoops, count, length)
    feet, offsets = _feet(hoops, circles, p)
    return Net(
        count + 1, mass, inertia, 9.81 * float(mass.sum()), p.drag,
        ends, beams, axes, bow, length, _stiffness(p, length), p.tau_v,
        feet, offsets, ground.k_n, ground.c_n, ground.mu,
        near, far, arms, np.array([place for place, _ in found], dtype=np.int64),
        np.array([int(later) for _, later in found], dtype=np.int64),
        p.damping, p.r_core, p.width, _to_core(pattern, near, far), _strangers(ends, directions),
        hoops, directions, pattern,
    )  # fmt: skip


def unit(direction: Sequence[float]) -> Array:
    """Return the unit vector of a direction."""
    vector = np.asarray(direction, dtype=float)
    return np.asarray(vector / np.linalg.norm(vector))


def _points(circle: Circle, nodes: int, ahead: float = 0.0) -> Array:
    """Return evenly spaced unit vectors round a circle, turned ahead by a share of their spacing (N, 3)."""
    angles = 2.0 * np.pi * (np.arange(nodes) + ahead) / nodes
    return np.outer(np.cos(angles), circle[0]) + np.outer(np.sin(angles), circle[1])


def _nodes(circles: Sequence[Circle], nodes: int) -> tuple[Ints, Array]:
    """Return the nodes round each hoop and all directions, a crossing once."""
    points = np.concatenate([_points(circle, nodes) for circle in circles])
    _, first, same = np.unique(np.round(points, 9) + 0.0, axis=0, return_index=True, return_inverse=True)
    kept = np.sort(first)
    return np.searchsorted(kept, first[same.ravel()]).reshape(len(circles), nodes), points[kept]


def _elements(hoops: Ints, circles: Sequence[Circle], directions: Array) -> tuple[Ints, Ints, Array]:
    """Return both bodies of every element and its axes."""
    first, second = hoops.ravel(), np.roll(hoops, -1, axis=1).ravel()
    along = directions[second] - directions[first]
    along /= np.linalg.norm(along, axis=1)[:, None]
    width = np.repeat([np.cross(*circle) for circle in circles], hoops.shape[1], axis=0).astype(float)
    return first, second, np.stack([along, np.cross(width, along), width], axis=1)


def _ordered(pattern: Pattern, first: Ints, second: Ints, axes: Array, bow: Array) -> tuple[Ints, Ints]:
    """Return the ends of the elements, the earlier eliminated first, and their slots; turn axes and arcs with them."""
    swap = pattern.place[first] > pattern.place[second]
    axes[swap, :2] *= -1.0
    bow[swap] *= -1.0
    ends = np.stack([np.where(swap, second, first), np.where(swap, first, second)], axis=1)
    return ends, np.array([slot(pattern, int(a), int(b))[0] for a, b in ends], dtype=np.int64)


def _to_core(pattern: Pattern, near: Ints, far: Ints) -> Ints:
    """Return the slot of the block of each node with the core that has the core's rows, -1 where there is none."""
    core = pattern.place.size - 1
    slots = np.full(core, -1, dtype=np.int64)
    for node in far[near == core].tolist():
        place, last = slot(pattern, core, node)
        slots[node] = place if last else -1
    return slots


def _strangers(ends: Ints, directions: Array) -> Ints:
    """Return the pairs of elements whose middles are farther apart in the round body than four elements are long."""
    middles = 0.5 * (directions[ends[:, 0]] + directions[ends[:, 1]])
    length = np.linalg.norm(directions[ends[0, 0]] - directions[ends[0, 1]])
    first, second = np.triu_indices(len(ends), 1)
    apart = np.linalg.norm(middles[first] - middles[second], axis=1) > 4.0 * length
    return np.stack([first[apart], second[apart]], axis=1)


def _coils(
    directions: Array,
    core: int,
    attach: float,
    spokes: Sequence[Direction],
    chords: Sequence[tuple[Direction, Direction]],
) -> tuple[Ints, Ints, Array]:
    """Return both bodies of every coil and where it is fixed to the first."""
    ends = [node_at(directions, spoke) for spoke in spokes]
    pairs = [(node_at(directions, a), node_at(directions, b)) for a, b in chords]
    near = np.array([core] * len(ends) + [a for a, _ in pairs], dtype=np.int64)
    far = np.array(ends + [b for _, b in pairs], dtype=np.int64)
    arms = np.zeros((len(near), 3))
    for row, spoke in enumerate(spokes):
        arms[row] = attach * unit(spoke)
    return near, far, arms


def node_at(directions: Array, direction: Sequence[float]) -> int:
    """Return the node that lies in a direction from the centre; ValueError if there is none."""
    found = np.flatnonzero(np.linalg.norm(directions - unit(direction), axis=1) < 1e-6)
    if len(found) != 1:
        raise ValueError(f"no node of the mesh lies in direction {tuple(direction)}: nodes must be a multiple of 8")
    return int(found[0])


def _masses(p: SphereNumbers, hoops: Ints, count: int, length: float) -> tuple[Array, Array]:
    """Return mass and moment of inertia of every body, the core last."""
    shares = np.bincount(hoops.ravel(), minlength=count)
    mass = shares * (p.m / hoops.size)
    inertia = mass * (p.width**2 + length**2) / 12.0
    crossing = shares > 1
    if crossing.any():
        mass = mass + crossing * (p.m_joints / crossing.sum())
    ball = 0.4 * p.m_core * p.r_core**2
    return np.append(mass, p.m_core), np.append(inertia, ball)


def _stiffness(p: SphereNumbers, length: float) -> Array:
    r"""Return the stiffness of the six strains.

    The shears are MacNeal's residual bending flexibility alone, 1/GA* = l^2/(12 EI): it makes a two-node element with
    one point of integration bend as the cubic beam does (standard result); a thin strip hardly shears beyond that.
    """
    flat, edge = p.EI, p.EI * p.edgewise
    return np.array([p.EA, 12.0 * flat / length**2, 12.0 * edge / length**2, p.EI * p.twist, edge, flat])


def _feet(hoops: Ints, circles: Sequence[Circle], p: SphereNumbers) -> tuple[Ints, Array]:
    """Return body and offset of the contact points: on both edges of the strip, half an element apart."""
    feet, offsets = [], []
    for hoop, circle in zip(hoops, circles, strict=True):
        side = 0.5 * p.width * np.cross(*circle)
        for ahead in (-0.25, 0.25):
            rim = p.R * (_points(circle, p.nodes, ahead) - _points(circle, p.nodes))
            for edge in (-side, side):
                feet.append(hoop)
                offsets.append(rim + edge)
    return np.concatenate(feet), np.concatenate(offsets)
