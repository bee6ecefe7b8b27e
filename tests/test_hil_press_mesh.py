"""A press on a block of any other shape: a mesh of triangles from a file beside the robot's."""

import re

import meshio
import numpy as np
import pytest

from hil_sim.bodies.press import PressPlant
from hil_sim.physics.block.mesh import rectangle
from hil_sim.robots.file import FOLDER, load
from tests.press_samples import MESHES
from tests.pressed_plants import driven, plant_of, push_hold_lift

TEXT = (FOLDER / "press.toml").read_text(encoding="utf-8")
CELLS = ("width_mm = [80.0", "height_mm = [40.0", "columns_count =", "rows_count =")


def plant_on(folder, mesh, name="block.msh", shift_mm=(0.0, 0.0), turned=False):
    """Return the press on a mesh that a file has kept, in mm and somewhere else."""
    points = np.c_[1e3 * mesh.points + shift_mm, np.zeros(mesh.nodes)]
    corners = mesh.triangles.T[:, ::-1] if turned else mesh.triangles.T
    meshio.write(folder / name, meshio.Mesh(points, [("triangle", corners)]))
    text = TEXT.replace('plane = "strain"', f'plane = "strain"\nmesh = "{name}"')
    for key in CELLS:
        text = re.sub(rf"^{re.escape(key)}.*\n", "", text, flags=re.MULTILINE)
    (folder / "mine.toml").write_text(text, encoding="utf-8")
    return PressPlant(load(str(folder / "mine.toml")))


@pytest.mark.parametrize(("name", "turned"), [("block.msh", False), ("block.vtu", True), ("block.inp", False)])
def test_the_same_block_from_a_file_does_the_same_wherever_it_is(name, turned, tmp_path):
    own = driven(plant_of(), 6.0, push_hold_lift).observe()
    read = plant_on(tmp_path, rectangle(0.080, 0.040, 16, 8), name, shift_mm=(-40.0, 10.0), turned=turned)

    seen = driven(read, 6.0, push_hold_lift).observe()

    assert (seen["force_peak_n"], seen["dent_mm"]) == pytest.approx((own["force_peak_n"], own["dent_mm"]), rel=1e-6)
    assert seen["cell_kpa"] == pytest.approx(own["cell_kpa"], abs=1e-6)


@pytest.mark.parametrize("shape", MESHES)
def test_a_block_without_structure_and_with_a_hill_is_dented_like_the_even_one(shape, tmp_path):
    plant = plant_on(tmp_path, MESHES[shape])
    even = driven(plant_of(), 2.0, push_hold_lift).load_n

    force = driven(plant, 2.0, push_hold_lift).load_n
    block = plant.snapshot()["block"]

    assert force == pytest.approx(even, rel=0.3)  # nodes on the surface are up to 10 mm apart
    assert (block["width_mm"], block["height_mm"]) == (80.0, pytest.approx(41.2, abs=0.1))


def test_its_surface_and_its_cells_are_in_the_coordinates_of_the_file(tmp_path):
    plant = plant_on(tmp_path, rectangle(0.080, 0.040, 16, 8), shift_mm=(-40.0, 10.0))
    seen = driven(plant, 1.0, 2.0).snapshot()

    assert seen["cells"]["C2"]["centre_mm"] == pytest.approx([-20.0, 40.0])
    assert seen["block"]["corner_mm"] == pytest.approx([-40.0, 10.0])
    assert min(y for _, y in seen["surface_mm"]) == pytest.approx(50.0 - seen["depth_mm"])
