"""What an observer sees inside a body: displacement, stress and strain over a mesh of triangles, slice by slice.

A slice is one instant, as a tomograph would take it: displacements are those of the nodes, stresses (x, y, z, xy) and
strains (x, y, and engineering shear xy) those of the triangles. In rows of a log arrays are base64 of little-endian
numbers, row by row: 64-bit floats for the mesh, 32-bit integers for its triangles, 32-bit floats for all that changes.
Von Mises stress and strain follow from the rest and are not written; who reads a row gets them back.

    mesh, taken = mesh_of(observer.fields()), slice_of(observer.fields(), t_s, host_ms)
    slice_from(slice_row(taken), mesh).stress_kpa
"""

from __future__ import annotations

from base64 import b64decode, b64encode
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Row = dict[str, Any]
Floats = NDArray[np.float32]
STILL_MM, STILL_KPA = 1e-5, 1e-5  # changes that nobody would see in a picture


@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    """Nodes and triangles of an undeformed body."""

    points_mm: NDArray[np.floating[Any]]  # (N, 2)
    triangles: NDArray[np.int32]  # (T, 3) nodes of each, counterclockwise


@dataclass(frozen=True, slots=True, eq=False)
class Slice:
    """A body at one instant; `t_s` is the observer's time, `host_ms` the host's clock."""

    t_s: float
    host_ms: int
    displacement_mm: Floats  # (N, 2)
    stress_kpa: Floats  # (T, 4) x, y, z, xy
    von_mises_kpa: Floats  # (T,)
    strain: Floats  # (T, 3) x, y, engineering shear xy


def mesh_of(fields: Row) -> Mesh:
    """Return the mesh of an observer's fields."""
    return Mesh(np.array(fields["points_mm"], float), np.array(fields["triangles"], np.int32))


def slice_of(fields: Row, t_s: float, host_ms: int) -> Slice:
    """Return an observer's fields at this instant."""
    names = ("displacement_mm", "stress_kpa", "von_mises_kpa", "strain")
    return Slice(t_s, host_ms, *(np.array(fields[name], np.float32) for name in names))


def same(one: Slice, other: Slice) -> bool:
    """Return whether nothing has changed from one slice to the other."""
    moved, stress = one.displacement_mm - other.displacement_mm, one.stress_kpa - other.stress_kpa
    return bool(np.abs(moved).max() < STILL_MM and np.abs(stress).max() < STILL_KPA)


def mesh_row(mesh: Mesh, host_ms: int) -> Row:
    """Return a mesh as a row of a log."""
    points, triangles = _packed(mesh.points_mm, "<f8"), _packed(mesh.triangles, "<i4")
    return {"host_ms": host_ms, "points_mm": points, "triangles": triangles}


def slice_row(taken: Slice) -> Row:
    """Return a slice as a row of a log."""
    displacement, stress = _packed(taken.displacement_mm, "<f4"), _packed(taken.stress_kpa, "<f4")
    return {"host_ms": taken.host_ms, "t_s": taken.t_s, "displacement_mm": displacement, "stress_kpa": stress}


def mesh_from(row: Row) -> Mesh:
    """Return the mesh of a log's row; ValueError when it is damaged."""
    points, triangles = _unpacked(row["points_mm"], "<f8", 2), _unpacked(row["triangles"], "<i4", 3)
    if not (triangles.size and triangles.min() >= 0 and triangles.max() < len(points)):
        raise ValueError("mesh: a triangle has a node that there is not")
    return Mesh(points, triangles)


def slice_from(row: Row, mesh: Mesh) -> Slice:
    """Return the slice of a log's row over its mesh; ValueError when it is damaged or of another mesh."""
    moved, stress = _unpacked(row["displacement_mm"], "<f4", 2), _unpacked(row["stress_kpa"], "<f4", 4)
    if len(moved) != len(mesh.points_mm) or len(stress) != len(mesh.triangles):
        raise ValueError(f"fields: {len(moved)} nodes and {len(stress)} triangles, not those of the mesh")
    return Slice(row["t_s"], row["host_ms"], moved, stress, von_mises(stress), strain(mesh, moved))


def von_mises(stress: Floats) -> Floats:
    """Return the von Mises stress of stresses (T, 4) x, y, z, xy."""
    x, y, z, xy = stress.T.astype(float)
    equal: Floats = np.sqrt(0.5 * ((x - y) ** 2 + (y - z) ** 2 + (z - x) ** 2) + 3.0 * xy**2).astype(np.float32)
    return equal


def strain(mesh: Mesh, displacement_mm: Floats) -> Floats:
    """Return the strain (T, 3) of displacements that are linear over each triangle."""
    p, u = (np.asarray(each, float)[mesh.triangles] for each in (mesh.points_mm, displacement_mm))
    (ax, ay), (bx, by) = (p[:, 1] - p[:, 0]).T, (p[:, 2] - p[:, 0]).T
    (au, av), (bu, bv) = (u[:, 1] - u[:, 0]).T, (u[:, 2] - u[:, 0]).T
    double = ax * by - bx * ay
    along, across = (au * by - bu * ay) / double, (bv * ax - av * bx) / double
    shear = (bu * ax - au * bx + av * by - bv * ay) / double
    return np.stack([along, across, shear], axis=1).astype(np.float32)


def _packed(array: NDArray[Any], kind: str) -> str:
    return b64encode(array.astype(kind).tobytes()).decode()


def _unpacked(text: str, kind: str, columns: int) -> NDArray[Any]:
    return np.frombuffer(b64decode(text), kind).reshape(-1, columns)
