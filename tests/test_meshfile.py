"""Meshes from files: what meshers write is read, what is no flat mesh of triangles is refused in one line."""

import sys

import meshio
import numpy as np
import pytest

from hil_sim.meshfile import MeshFileError, read_mesh
from hil_sim.physics.block.mesh import mesh_of, rectangle

GMSH = """$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
6
1 0 0 0
2 80 0 0
3 80 40 0
4 0 40 0
7 40 20 0
9 99 99 0
$EndNodes
$Elements
6
1 15 2 0 1 1
2 1 2 0 1 1 2
3 2 2 0 1 1 2 7
4 2 2 0 1 2 3 7
5 2 2 0 1 3 7 4
6 2 2 0 1 1 7 4
$EndElements
"""
POINTS = np.array([[0.0, 0, 5], [80, 0, 5], [80, 40, 5], [0, 40, 5]])
TRIANGLES = [[0, 1, 2], [0, 2, 3]]


def written(path, points=POINTS, cells=(("triangle", TRIANGLES),), **options):
    """Write a mesh file and return its path."""
    meshio.Mesh(np.array(points, float), [(kind, np.array(nodes)) for kind, nodes in cells]).write(path, **options)
    return path


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("block.msh", {"file_format": "gmsh22", "binary": False}),
        ("block.msh", {"file_format": "gmsh22", "binary": True}),
        ("block.msh", {"file_format": "gmsh", "binary": False}),
        ("block.msh", {"file_format": "gmsh", "binary": True}),
        ("block.vtu", {}),
        ("block.vtk", {}),
        ("block.inp", {}),
        ("block.mesh", {}),
        ("block.bdf", {}),
    ],
)
def test_a_mesh_that_was_written_is_read_back(tmp_path, name, options):
    mesh = rectangle(0.080, 0.040, 8, 4)
    flat = np.column_stack([1000 * mesh.points, np.zeros(mesh.nodes)])
    path = written(tmp_path / name, flat, [("triangle", mesh.triangles.T)], **options)

    points_mm, triangles = read_mesh(path)

    assert points_mm == pytest.approx(1000 * mesh.points, abs=1e-9)
    assert np.array_equal(triangles, mesh.triangles.T)


def test_a_gmsh_file_loses_its_marks_and_unused_nodes_and_turns_what_runs_clockwise(tmp_path):
    path = tmp_path / "block.msh"
    path.write_text(GMSH)

    points_mm, triangles = read_mesh(path)

    assert points_mm.tolist() == [[0, 0], [80, 0], [80, 40], [0, 40], [40, 20]]
    assert mesh_of(points_mm, triangles).area == pytest.approx([800.0] * 4)
    assert sorted(map(sorted, triangles.tolist())) == [[0, 1, 4], [0, 3, 4], [1, 2, 4], [2, 3, 4]]


def test_a_mesh_at_another_height_is_flat_all_the_same(tmp_path):
    points_mm, triangles = read_mesh(written(tmp_path / "block.vtu"))

    assert points_mm.tolist() == POINTS[:, :2].tolist()
    assert triangles.tolist() == TRIANGLES


def test_a_triangle_of_two_groups_is_one_triangle(tmp_path):
    _, triangles = read_mesh(written(tmp_path / "block.vtu", cells=[("triangle", [*TRIANGLES, [2, 0, 1]])]))

    assert triangles.tolist() == TRIANGLES


@pytest.mark.parametrize(
    ("points", "cells", "said"),
    [
        (POINTS, [("quad", [[0, 1, 2, 3]])], "has cells of the kind quad (1), only linear triangles can be used"),
        (POINTS, [("triangle", [[0, 1, 2]]), ("quad", [[0, 1, 2, 3]])], "cells of the kind quad"),
        (POINTS, [("line", [[0, 1]])], "has no triangles"),
        (POINTS + np.eye(4, 3, -1), [("triangle", TRIANGLES)], "is not flat: z goes from 5 to 6"),
        (POINTS * [1, np.nan, 1], [("triangle", TRIANGLES)], "not a finite number"),
        (POINTS * [1, 0, 1], [("triangle", TRIANGLES)], "has no area"),
        (POINTS, [("triangle", [[0, 1, 9]])], "a node that is not among the 4 of the file"),
        (POINTS[[0, 1, 2, 3, 0]], [("triangle", [[0, 1, 2], [4, 2, 3]])], "nodes 0 and 4 coincide: the mesh is torn"),
        (POINTS, [("triangle", [[0, 1, 2], [0, 1, 3]])], "two triangles on the same side"),
    ],
)  # fmt: skip
def test_what_is_no_flat_mesh_of_triangles_is_refused_with_the_path(tmp_path, points, cells, said):
    path = written(tmp_path / "block.vtu", points, cells)

    with pytest.raises(MeshFileError) as refused:
        read_mesh(path)

    assert said in str(refused.value)
    assert str(refused.value).startswith(f"{path}: ")
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("block.msh", None, "there is no such file"),
        ("block.msh", "", "cannot be read as a mesh"),
        ("block.msh", GMSH[:120], "cannot be read as a mesh"),
        ("block.msh", GMSH.replace("2.2 0 8", "9.9 0 8"), "cannot be read as a mesh"),
        ("block.msh", GMSH.replace("1 2 7", "1 2 8"), "a node that is not among the 6 of the file"),
        ("block.vtu", "<VTKFile", "cannot be read as a mesh"),
        ("block.txt", GMSH, "Could not deduce file format"),
        ("block", GMSH, "Could not deduce file format"),
    ],
)
def test_a_file_that_cannot_be_read_is_told_in_one_line_and_no_more(tmp_path, capsys, name, content, said):
    path = tmp_path / name
    if content is not None:
        path.write_text(content)

    with pytest.raises(MeshFileError) as refused:
        read_mesh(path)

    assert said in str(refused.value)
    assert str(refused.value).startswith(f"{path}: ")
    assert "\n" not in str(refused.value)
    assert capsys.readouterr() == ("", "")


def test_where_meshio_is_missing_the_extra_is_named(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "meshio", None)

    with pytest.raises(MeshFileError, match=r"pip install 'softrig\[mesh\]'"):
        read_mesh(tmp_path / "block.msh")
