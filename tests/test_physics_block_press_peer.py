"""The press against a solver of other parts (`fem_block`): contact, history, planes and dual modulus at once."""

import numpy as np
import pytest

from hil_sim.physics.block.block import Block, hold
from hil_sim.physics.block.indenters import Cylinder, Polygon, Punch
from hil_sim.physics.block.material import Material, Maxwell
from hil_sim.physics.block.mesh import rectangle
from hil_sim.physics.block.press import Axis, Press
from tests.block_samples import HEIGHT, MIXED, THICK, THREE, WIDTH, distorted, scattered
from tests.fem_block import FemBlock

STEP_S = 0.02
WAY_MM = ((0.0, -0.3), (0.4, 2.0), (0.7, 2.0), (1.0, -1.0), (1.3, 3.0), (1.5, 2.5), (1.7, 3.2), (2.0, -1.0))
SHAPES = {"cylinder": Cylinder(0.02), "flat": Punch(0.02), "wedge": Polygon(((-0.02, 0.01), (0.0, 0.0), (0.03, 0.01)))}
DUAL = Material((Maxwell(60e3, 300e3, 0.2, 30e3), Maxwell(20e3, 8e3, 0.45)), 2e3, 6e3, 0.3, 0.1, c0_unloading=1e3)


def both(mesh, material, shape, at):
    """Yield press and peer after each step of pushes, holds, lifts off the block and pushes again."""
    bottom = np.flatnonzero(mesh.points[:, 1] == 0.0)
    press = Press(Block(mesh, material, THICK), hold((bottom, 0.0, 0.0)), shape, Axis(at))
    peer = FemBlock(mesh.points, mesh.triangles, material, THICK, lambda x: shape.height(x - at))
    state = press.start()
    for t in np.arange(STEP_S, WAY_MM[-1][0] + 0.5 * STEP_S, STEP_S):
        depth = 1e-3 * float(np.interp(t, *np.transpose(WAY_MM)))
        state = press.advance(state, STEP_S, depth=depth)
        peer.press(STEP_S, depth)
        yield state, peer


def agree(mesh, material, shape, at=0.5 * WIDTH):
    """Compare force, displacements and stress in every step."""
    rows = []
    for state, peer in both(mesh, material, shape, at):
        u, stress = peer.u[peer.basis.nodal_dofs].T, peer.stress.mean(axis=2)
        rows.append((peer.forces.sum(), state.force - peer.forces.sum(), np.abs(state.block.u - u).max(),
                     np.abs(state.block.stress - stress).max()))  # fmt: skip
    force, off_n, off_m, off_pa = np.abs(rows).max(axis=0)
    assert force > 0.5
    assert peer.settled_s > 0.0  # it was freed
    assert (off_n / force, off_m / 3e-3, off_pa / 10e3) == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
    assert off_n <= 1e-10 * force


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("plane", ["strain", "stress"])
def test_each_shape_presses_as_a_solver_of_other_parts_says(shape, plane):
    agree(rectangle(WIDTH, HEIGHT, 16, 8), MIXED._replace(plane=plane), SHAPES[shape])


@pytest.mark.parametrize("mesh", [distorted(16, 8, 3), scattered(60, 1)], ids=["distorted", "scattered"])
def test_also_beside_the_middle_of_other_meshes(mesh):
    agree(mesh, THREE, SHAPES["cylinder"], at=0.033)


@pytest.mark.parametrize("plane", ["strain", "stress"])
def test_also_with_other_viscosities_while_it_is_unloaded(plane):
    agree(rectangle(WIDTH, HEIGHT, 16, 8), DUAL._replace(plane=plane), SHAPES["cylinder"])
