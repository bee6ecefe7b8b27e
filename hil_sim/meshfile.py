"""Reads a mesh of triangles from any file that meshio can read: gmsh .msh (2.2 and 4.1), .vtu, .inp and others.

Coordinates are mm, in the plane z = constant, y upwards. Points and lines that a mesher marks boundaries with are
passed over, nodes that no triangle uses are left out, a triangle that is there twice (gmsh writes one for each group)
is taken once, and one that runs clockwise is turned. What is no flat, conforming mesh of linear triangles is refused
with a MeshFileError, one line that begins with the path.

    points_mm, triangles = read_mesh("block.msh")     # (N, 2), (T, 3) counterclockwise
"""

from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np

from hil_sim.physics.block.material import BlockError
from hil_sim.physics.block.mesh import Indices, counterclockwise, mesh_of
from hil_sim.physics.compiled import Array

PASSED_OVER = ("vertex", "line", "line3")
FLAT = 1e-9  # differences of z over the size of the mesh that are rounding [1]


class MeshFileError(ValueError):
    """A file that gives no mesh of a block."""


def read_mesh(path: str | Path) -> tuple[Array, Indices]:
    """Return nodes (N, 2) [mm] and counterclockwise triangles (T, 3) of a file; MeshFileError says what is wrong."""
    with _named(Path(path)):
        points, blocks = _read(Path(path))
        triangles = _triangles(blocks)
        if not 0 <= triangles.min() <= triangles.max() < len(points):
            raise MeshFileError(f"a triangle has a node that is not among the {len(points)} of the file")
        used, numbers = np.unique(triangles, return_inverse=True)
        points_mm, triangles = _flat(points[used]), numbers.reshape(-1, 3).astype(np.int64)
        triangles = counterclockwise(points_mm, triangles)
        mesh_of(points_mm * 1e-3, triangles)
        return points_mm, triangles


@contextmanager
def _named(path: Path) -> Iterator[None]:
    """Begin the text of an error with the path."""
    try:
        yield
    except MeshFileError as error:
        raise MeshFileError(f"{path}: {error}") from None
    except BlockError as error:
        note = "numbers count from 0, without nodes that no triangle uses"
        raise MeshFileError(f"{path}: {error} ({note})") from error


def _read(path: Path) -> tuple[Array, list[Any]]:
    """Return points (N, 2 or 3) and blocks of cells as they stand in the file."""
    try:
        import meshio  # noqa: PLC0415  (an extra)
    except ImportError as error:
        raise MeshFileError("a mesh file needs meshio: pip install 'softrig[mesh]'") from error
    if not path.is_file():
        raise MeshFileError("there is no such file")
    said = StringIO()
    try:
        with redirect_stdout(said), redirect_stderr(said):
            mesh = meshio.read(path)
        points = np.array(mesh.points, float)
    except (Exception, SystemExit) as error:  # its parsers raise whatever a damaged file makes them stumble over
        why = f"{said.getvalue()} {error if isinstance(error, Exception) else ''}".split()
        raise MeshFileError(f"cannot be read as a mesh: {' '.join(why)[:200] or type(error).__name__}") from error
    if points.ndim != 2 or points.shape[1] not in (2, 3):
        raise MeshFileError("its points have not two or three coordinates")
    return points, list(mesh.cells)


def _triangles(blocks: list[Any]) -> Indices:
    """Return all triangles of the blocks, each once; refuse cells that would leave a hole if they were passed over."""
    for block in blocks:
        if block.type not in ("triangle", *PASSED_OVER) and len(block.data):
            raise MeshFileError(
                f"has cells of the kind {block.type} ({len(block.data)}), only linear triangles can be used"
            )
    found = [np.array(block.data, np.int64).reshape(-1, 3) for block in blocks if block.type == "triangle"]
    triangles = np.concatenate([np.zeros((0, 3), np.int64), *found])
    if not len(triangles):
        raise MeshFileError("has no triangles")
    _, first = np.unique(np.sort(triangles, axis=1), axis=0, return_index=True)
    once: Indices = triangles[np.sort(first)]
    return once


def _flat(points: Array) -> Array:
    """Return the points (N, 2) of one height z."""
    if not np.isfinite(points).all():
        raise MeshFileError("a node has a coordinate that is not a finite number")
    if points.shape[1] == 3 and np.ptp(points[:, 2]) > FLAT * np.ptp(points[:, :2], axis=0).max():
        low, high = points[:, 2].min(), points[:, 2].max()
        raise MeshFileError(f"is not flat: z goes from {low:g} to {high:g} mm, must be the same for all nodes")
    return np.ascontiguousarray(points[:, :2])
