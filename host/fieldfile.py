"""Writes slices of a body as .vtu files, which ParaView opens, and all of a record as a numbered series with its .pvd.

Lengths are mm, stresses kPa. Nodes have the displacement as a vector (in ParaView: Warp By Vector, scale 1); triangles
the stress as a symmetric tensor XX, YY, ZZ, XY, YZ, XZ (the order that ParaView expects of one, says the page of its
TensorGlyph, paraview.org/paraview-docs), its von Mises stress, and the strains, that of xy as engineering shear.

    written = write_slice(recording, 2.0, ("displacement", "stress"), Path("press.vtu"))
    written.t_s     # the time of the nearest slice
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any, NamedTuple
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from host.errors import BadRequest
from host.fields import Mesh, Slice, same
from host.recording import Recording

Arrays = dict[str, NDArray[Any]]
NEAR_S = 0.2  # beyond the first and last slice, and between two while the body changes


class Field(NamedTuple):
    """One field: whether nodes have it or triangles, and what gives its arrays."""

    of_nodes: bool
    arrays: Callable[[Slice], Arrays]


class Written(NamedTuple):
    """What was written: the file to open, the time of the slice or that of the first one, and how many slices.

    `still`: nothing changed in the body between the time that was asked for and that of the slice.
    """

    path: Path
    t_s: float
    slices: int
    still: bool = False


def write_slice(recording: Recording, at_s: float, names: Sequence[str], path: Path) -> Written:
    """Write the slice nearest to that time since the program began; BadRequest when the record has none there."""
    mesh, slices = _seen(recording)
    times = np.array([recording.seconds(taken.host_ms) for taken in slices])
    if not times[0] - NEAR_S <= at_s <= times[-1] + NEAR_S:
        span = f"from {times[0]:.2f} to {times[-1]:.2f} s"
        raise BadRequest(f"there is no slice at {at_s:g} s: the record has {len(slices)}, {span}")
    nearest = int(np.abs(times - at_s).argmin())
    _write(mesh, slices[nearest], fields_of(names), path)
    still = abs(times[nearest] - at_s) > NEAR_S and _unchanged(slices, times, at_s)
    return Written(path, float(times[nearest]), 1, bool(still))


def write_series(recording: Recording, names: Sequence[str], path: Path) -> Written:
    """Write all slices, as `press-0000.vtu` and so on beside `press.pvd`, which says their times."""
    mesh, slices = _seen(recording)
    wanted, rows = fields_of(names), []
    for number, taken in enumerate(slices):
        part = path.with_name(f"{path.stem}-{number:04d}.vtu")
        _write(mesh, taken, wanted, part)
        rows.append(f'<DataSet timestep="{recording.seconds(taken.host_ms):g}" part="0" file={quoteattr(part.name)}/>')
    collection = path.with_suffix(".pvd")
    lines = ['<VTKFile type="Collection" version="0.1">', "<Collection>", *rows, "</Collection>", "</VTKFile>", ""]
    collection.write_text("\n".join(lines), encoding="utf-8")
    return Written(collection, recording.seconds(slices[0].host_ms), len(slices))


def _unchanged(slices: list[Slice], times: NDArray[np.float64], at_s: float) -> bool:
    """Return whether the slices before and after that time are the same."""
    after = min(int(np.searchsorted(times, at_s)), len(slices) - 1)
    return same(slices[max(0, after - 1)], slices[after])


def fields_of(names: Sequence[str]) -> tuple[Field, ...]:
    """Return the fields of those names; BadRequest lists what there is."""
    for name in names:
        if name not in FIELDS:
            raise BadRequest(f"no field {name!r}: there are {', '.join(FIELDS)}")
    return tuple(FIELDS[name] for name in dict.fromkeys(names))


def _seen(recording: Recording) -> tuple[Mesh, list[Slice]]:
    """Return mesh and slices of a record; BadRequest when nobody saw inside the body."""
    if recording.mesh is None or not recording.slices:
        raise BadRequest("the record holds no fields: they come from the bench of a block, with `softrig run --log`")
    return recording.mesh, recording.slices


def _write(mesh: Mesh, taken: Slice, fields: Sequence[Field], path: Path) -> None:
    try:
        import meshio  # noqa: PLC0415  (an extra)
    except ImportError as error:
        raise BadRequest("fields are written with meshio: pip install 'softrig[mesh]'") from error
    nodes: Arrays = {}
    triangles: Arrays = {}
    for field in fields:
        (nodes if field.of_nodes else triangles).update(field.arrays(taken))
    points = np.column_stack([mesh.points_mm, np.zeros(len(mesh.points_mm))])
    cells = {name: [array] for name, array in triangles.items()}
    with redirect_stdout(StringIO()), redirect_stderr(StringIO()):
        meshio.Mesh(points, [("triangle", mesh.triangles)], nodes, cells).write(path, file_format="vtu")


def _displacement(taken: Slice) -> Arrays:
    """Return the displacement as a vector of three components."""
    flat = np.zeros((len(taken.displacement_mm), 1), np.float32)
    return {"displacement_mm": np.hstack([taken.displacement_mm, flat])}


def _stress(taken: Slice) -> Arrays:
    """Return the stress as a symmetric tensor."""
    none = np.zeros((len(taken.stress_kpa), 2), np.float32)
    return {"stress_kpa": np.hstack([taken.stress_kpa, none])}


def _strain(taken: Slice) -> Arrays:
    """Return the strains; there is none along z in plane strain, and it is not told in plane stress."""
    return dict(zip(("strain_x", "strain_y", "strain_xy"), np.ascontiguousarray(taken.strain.T), strict=True))


FIELDS = {
    "displacement": Field(True, _displacement),
    "stress": Field(False, _stress),
    "von_mises": Field(False, lambda taken: {"von_mises_kpa": taken.von_mises_kpa}),
    "strain": Field(False, _strain),
}
