"""What a press is made of, in SI units: its block, its indenter, its force cells, and the physics built from them."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hil_sim.bodies.screw import ScrewNumbers
from hil_sim.meshfile import read_mesh
from hil_sim.physics.block.block import Block, hold
from hil_sim.physics.block.indenters import Cylinder, Indenter, Polygon, Punch
from hil_sim.physics.block.material import BlockError, Material
from hil_sim.physics.block.mesh import Mesh, mesh_of, rectangle
from hil_sim.physics.block.press import Axis, Press
from hil_sim.physics.block.stress import Cells

REACH = 0.010  # of the axis, up and down [m]
ROUNDING = 1e-9
BOTTOM = 1e-6  # share of the height within which a node is at the bottom


@dataclass(frozen=True)
class PressNumbers:
    """A press: lengths in m, forces in N, times in s."""

    kind: str  # of the indenter
    thickness: float
    R: float  # of a cylinder
    w: float  # width of a punch
    corners: tuple[tuple[float, float], ...]  # of a polygon, around the axis
    pull_off: float  # with which a bonded punch tears off
    tool_mass: float  # [kg]
    g: float  # [m/s^2]
    backlash: float
    dt: float  # of the block's steps
    side: float  # of a force cell
    centres: dict[str, tuple[float, float]]  # of the force cells by their labels
    relative: bool  # they are shares of the block's extent
    material: Material
    screw: ScrewNumbers
    at: float | None = None  # x of the axis, None: the middle of the block
    width: float = 0.0
    height: float = 0.0
    columns: int = 0
    rows: int = 0
    mesh: Path | None = None  # in place of the four before


def indenter_of(numbers: PressNumbers) -> Indenter:
    """Return the indenter; IndenterError for a polygon that is none."""
    if numbers.kind == "cylinder":
        return Cylinder(numbers.R)
    if numbers.kind == "polygon":
        return Polygon(numbers.corners)
    return Punch(numbers.w, bonded=numbers.kind == "bonded")


def mesh_for(numbers: PressNumbers) -> Mesh:
    """Return the mesh of the block: cells, with nodes where the indenter is lowest, or what its file holds.

    MeshFileError or BlockError when that is no mesh.
    """
    if numbers.mesh is None:
        at = 0.5 * numbers.width if numbers.at is None else numbers.at
        lines = [at + x for x in indenter_of(numbers).lowest]
        return rectangle(numbers.width, numbers.height, numbers.columns, numbers.rows, lines)
    points_mm, triangles = read_mesh(numbers.mesh)
    return mesh_of(1e-3 * points_mm, triangles)


def press_of(numbers: PressNumbers, material: Material | None = None) -> Press:
    """Return press and block, which stands on its lowest nodes; BlockError for numbers that cannot be."""
    mesh = mesh_for(numbers)
    low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
    bottom = mesh.where(mesh.points[:, 1] - low[1] <= BOTTOM * (high[1] - low[1]))
    at = 0.5 * float(low[0] + high[0]) if numbers.at is None else numbers.at
    axis = Axis(at, least=-(REACH + numbers.backlash) * (1.0 + ROUNDING), most=REACH * (1.0 + ROUNDING))
    block = Block(mesh, material or numbers.material, numbers.thickness)
    return Press(block, hold((bottom, 0.0, 0.0)), indenter_of(numbers), axis)


def places_of(numbers: PressNumbers, mesh: Mesh) -> dict[str, tuple[float, float]]:
    """Return where the force cells are in the coordinates of the mesh [m]."""
    if not numbers.relative:
        return numbers.centres
    (left, bottom), (width, height) = mesh.points.min(axis=0).tolist(), np.ptp(mesh.points, axis=0).tolist()
    return {label: (left + x * width, bottom + y * height) for label, (x, y) in numbers.centres.items()}


def cells_at(places: dict[str, tuple[float, float]], side: float, mesh: Mesh) -> Cells:
    """Return the force cells; BlockError, which names it, for one that is not all inside the block."""
    for label, centre in places.items():
        try:
            Cells(mesh, [centre], side)
        except BlockError as error:
            raise BlockError(f"force cell {label}: {error}") from error
    return Cells(mesh, list(places.values()), side)


def shape_of(numbers: PressNumbers) -> float | None:
    """Return the force per modulus and depth [m] of an elastic block under this indenter.

    None where there is no such number: where the contact grows with the depth, or the parts of the material have
    different Poisson ratios.
    """
    nu = ratios(numbers.material)
    if numbers.kind not in ("flat", "bonded") or len(nu) > 1:
        return None
    press = press_of(numbers, Material((), E0=1.0, nu0=nu.pop(), plane=numbers.material.plane))
    depth = 1e-3
    return press.advance(press.start(), 1.0, depth=depth).force / depth


def ratios(material: Material) -> set[float]:
    """Return the different Poisson ratios of the parts that a material has."""
    found = {branch.nu for branch in material.branches}
    found |= {material.nu0} if material.E0 else set()
    return found | ({material.nu_c} if material.c0 else set())
