"""Builds a sphere of three elastic hoops from MuJoCo's flex rods (4.0), as far as they go.

Twelve open rods, each clamped to a crossing at both ends; their vertices lie where the hinges of the chain do. Their
section is round: edgewise as soft as flatwise, which allows longer steps than a strip. Only the integrators "discrete"
and Euler bend such rods, and they do not stretch: an equality holds each edge.
"""

from collections.abc import Iterable

import mujoco
import numpy as np

from benchmarks.sphere_chain import AXES, TOE
from hil_sim.physics.bodies import SphereNumbers

HOOPS = (("+x", "+y"), ("+y", "+z"), ("+z", "+x"))  # axes in the plane of each
OTHER = {"+": "-", "-": "+"}
POINT = '<inertial pos="0 0 0" mass="{}" diaginertia="{}"/>'
SLIDES = "".join(f'<joint type="slide" axis="{axis}"/>' for axis in ("1 0 0", "0 1 0", "0 0 1"))


def sphere_flex(numbers: SphereNumbers, nodes: int) -> mujoco.MjSpec:
    """Return the free sphere, its centre at the origin; its crossings are the bodies "-x", "+x", ... "+z"."""
    link = numbers.m / 3 / nodes
    heavy = 4 * link + numbers.m_joints / 6
    inertia = text([heavy * (numbers.R * np.pi / nodes) ** 2 / 3] * 3)
    bodies = [
        f'<body name="{name}" pos="{text(numbers.R * out)}"><freejoint/>{POINT.format(heavy, inertia)}</body>'
        for name, out in AXES.items()
    ]
    rods, ties = [], []
    for u, v in HOOPS:
        corners = [u, v, OTHER[u[0]] + u[1], OTHER[v[0]] + v[1]]
        for start, end in zip(corners, corners[1:] + corners[:1], strict=True):
            bodies += points(numbers, nodes, start, end)
            rods.append(rod(numbers, nodes, start, end))
            ties.append(f'<flex flex="{start}{end}"/>')
    return mujoco.MjSpec.from_string(
        f"<mujoco><worldbody>{''.join(bodies)}</worldbody><deformable>{''.join(rods)}</deformable>"
        f"<equality>{''.join(ties)}</equality></mujoco>"
    )


def vertices(numbers: SphereNumbers, nodes: int, start: str, end: str) -> np.ndarray:
    """Return the places of the vertices of an arc; the outer two at each end belong to the crossings."""
    angle = 2 * np.pi / nodes
    turns = angle * (np.arange(nodes // 4 + 2) - 0.5)
    ways = np.outer(np.cos(turns), AXES[start]) + np.outer(np.sin(turns), AXES[end])
    return numbers.R / np.cos(angle / 2) * ways


def points(numbers: SphereNumbers, nodes: int, start: str, end: str) -> list[str]:
    """Return the bodies of the free vertices of an arc and of the twists of its edges."""
    name, link, places = start + end, numbers.m / 3 / nodes, vertices(numbers, nodes, start, end)
    point, spin = POINT.format(link, text([1e-12] * 3)), POINT.format(1e-9, text([link * numbers.width**2 / 12] * 3))
    free = [f'<body name="{name}{i}" pos="{text(places[i])}">{point}{SLIDES}</body>' for i in range(2, len(places) - 2)]
    twists = [
        f'<body name="{twist}">{spin}<joint name="{twist}" type="hinge" axis="0 0 1"/></body>'
        for twist in (f"{name}_twist_{i}" for i in range(1, len(places) - 2))
    ]
    return free + twists


def rod(numbers: SphereNumbers, nodes: int, start: str, end: str) -> str:
    """Return the rod of an arc."""
    name, places = start + end, vertices(numbers, nodes, start, end)
    last = len(places) - 2
    holders = [start] * 2 + [f"{name}{i}" for i in range(2, last)] + [end] * 2
    places[2:last] = 0.0
    places[:2] -= numbers.R * AXES[start]
    places[last:] -= numbers.R * AXES[end]
    young = 4 * numbers.EI / (np.pi * TOE**4)
    edges = " ".join(f"{i} {i + 1}" for i in range(last + 1))
    return (
        f'<flex name="{name}" dim="1" radius="{TOE}" body="{" ".join(holders)}" vertex="{text(places.ravel())}" '
        f'element="{edges}"><contact contype="1" conaffinity="0" selfcollide="none"/>'
        f'<elasticity young="{young}" shear="{numbers.twist * young / 2}" damping="{numbers.tau_v}"/></flex>'
    )


def text(values: Iterable[float]) -> str:
    """Return numbers as MuJoCo reads them."""
    return " ".join(f"{value:.17g}" for value in values)
