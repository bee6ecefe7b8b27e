"""`softrig log export --fields`: what was seen inside a block, as files that ParaView opens."""

import sys
from dataclasses import replace
from xml.etree import ElementTree

import meshio
import numpy as np
import pytest
from click.testing import CliRunner

from host.cli import main
from host.log import LogWriter
from tests.pressed_block import recorded_press


@pytest.fixture(scope="module")
def recording():
    """Return a press of 4 mm in 2 s, held for 1 s; slices each 200 ms from the start."""
    return recorded_press(moves=((2.0, 4.0), (1.0, 4.0)))


@pytest.fixture
def log(tmp_path, recording):
    with LogWriter(tmp_path / "press.mcap") as writer:
        for event in recording.events:
            writer.record(event)
        writer.mesh(recording.mesh, 1000)
        for taken in recording.slices:
            writer.slice(taken)
    return tmp_path / "press.mcap"


def export(log, *options, output="press.vtu", fields="displacement,stress"):
    return CliRunner().invoke(
        main, ["log", "export", str(log), "--fields", fields, *options, "-o", str(log.parent / output)]
    )


def test_the_nearest_slice_is_written_and_its_true_time_told(log, recording):
    done = export(log, "--at", "1.93s")

    assert done.exit_code == 0
    assert done.stderr == f"slice at 2.000 s: {log.parent / 'press.vtu'}\n"
    taken = next(each for each in recording.slices if each.host_ms == 3000)
    mesh = meshio.read(log.parent / "press.vtu")
    assert mesh.points[:, :2] == pytest.approx(recording.mesh.points_mm)
    assert np.array_equal(mesh.cells_dict["triangle"], recording.mesh.triangles)
    assert np.array_equal(mesh.point_data["displacement_mm"][:, :2], taken.displacement_mm)
    assert mesh.point_data["displacement_mm"].shape == (len(mesh.points), 3)


def test_stress_is_a_symmetric_tensor_in_the_order_that_paraview_expects(log, recording):
    export(log, "--at", "2s")

    (stress,) = meshio.read(log.parent / "press.vtu").cell_data["stress_kpa"]
    xx, yy, zz, xy, yz, xz = stress.T
    taken = next(each for each in recording.slices if each.host_ms == 3000).stress_kpa
    assert np.array_equal(np.stack([xx, yy, zz, xy], axis=1), taken)
    assert not yz.any()
    assert not xz.any()


def test_strain_and_von_mises_stress_are_told_of_each_triangle(log, recording):
    export(log, "--at", "2s", fields="von_mises, strain")

    mesh = meshio.read(log.parent / "press.vtu")
    taken = next(each for each in recording.slices if each.host_ms == 3000)
    assert set(mesh.cell_data) == {"von_mises_kpa", "strain_x", "strain_y", "strain_xy"}
    assert mesh.cell_data["strain_xy"][0] == pytest.approx(taken.strain[:, 2], abs=1e-6)
    assert mesh.cell_data["von_mises_kpa"][0] == pytest.approx(taken.von_mises_kpa, rel=1e-5)


def test_all_slices_are_a_numbered_series_with_their_times(log, recording):
    done = export(log, "--at", "all")

    sets = ElementTree.parse(log.parent / "press.pvd").findall("Collection/DataSet")
    assert done.stderr == f"{len(recording.slices)} slices from 0.000 s on: {log.parent / 'press.pvd'}\n"
    assert [float(each.get("timestep")) for each in sets] == pytest.approx(
        [0.2 * k for k in range(len(recording.slices))]
    )
    assert all((log.parent / each.get("file")).is_file() for each in sets)
    last = meshio.read(log.parent / sets[-1].get("file")).point_data["displacement_mm"]
    assert np.array_equal(last[:, :2], recording.slices[-1].displacement_mm)


@pytest.mark.parametrize(
    ("options", "more", "said"),
    [
        (("--at", "9s"), {}, "there is no slice at 9 s: the record has 15, from 0.00 to 2.80 s"),
        (
            ("--at", "2s"),
            {"fields": "stress,heat"},
            "no field 'heat': there are displacement, stress, von_mises, strain",
        ),
        ((), {}, "fields are exported with --fields NAME,... --at TIME (or all) -o FILE.vtu"),
        (("--at", "2s"), {"output": "press.csv"}, "-o FILE.vtu"),
        (("--at", "2s"), {"output": "absent/press.vtu"}, "cannot write"),
        (("--at", "soon"), {}, "--at soon: write a time, as 2s, or all"),
    ],
)
def test_what_cannot_be_exported_is_told_in_one_line(log, options, more, said):
    done = export(log, *options, **more)

    assert done.exit_code == 2
    assert said in done.stderr.splitlines()[-1]


def test_a_log_without_fields_says_where_they_come_from(tmp_path):
    with LogWriter(tmp_path / "crawl.mcap"):
        pass

    done = export(tmp_path / "crawl.mcap", "--at", "2s")

    assert "the record holds no fields: they come from the bench of a block" in done.stderr


def test_where_meshio_is_missing_the_extra_is_named(log, monkeypatch):
    monkeypatch.setitem(sys.modules, "meshio", None)

    assert "pip install 'softrig[mesh]'" in export(log, "--at", "2s").stderr


def test_a_slice_from_before_a_rest_says_that_nothing_has_changed_since(tmp_path, recording):
    rest = [replace(recording.slices[-1], host_ms=recording.slices[-1].host_ms + later_ms) for later_ms in (0, 2000)]
    path = tmp_path / "rest.mcap"
    with LogWriter(path) as writer:
        for event in recording.events:
            writer.record(event)
        writer.mesh(recording.mesh, 1000)
        for taken in [recording.slices[0], *rest]:
            writer.slice(taken)

    assert "slice at 2.800 s, as at 3.5 s: nothing changed between" in export(path, "--at", "3.5s").stderr
    assert "nothing changed" not in export(path, "--at", "1s").stderr
