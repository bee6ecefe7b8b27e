"""Presses, what they are driven by, and the conditions of contact that any of their states is held to."""

import numpy as np

from hil_sim.physics.block.block import Block, hold
from hil_sim.physics.block.indenters import Cylinder, gap
from hil_sim.physics.block.material import Material, Maxwell
from hil_sim.physics.block.mesh import mesh_of, rectangle
from hil_sim.physics.block.press import Axis, Press
from tests.block_samples import HEIGHT, THICK, THREE, WIDTH, distorted, scattered

FIVE = Material((Maxwell(40e3, 120e3, nu=0.30), Maxwell(25e3, 5e3, nu=0.40)), c0=4e3, nu_c=0.2)
CREEPING = Material((Maxwell(60e3, 300e3, nu=0.45),), E0=5e3, c0=6e3, nu0=0.1)
DUAL = Material((Maxwell(60e3, 300e3, c_unloading=80e3),), c0=6e3, c0_unloading=2e3)
MATERIALS = {"three": THREE, "five": FIVE, "creeping": CREEPING, "dual": DUAL, "thin": FIVE._replace(plane="stress")}


def hilly(mesh):
    """Return a mesh with a shallow hill on its top."""
    x, y = mesh.points.T
    return mesh_of(np.stack([x, y * (1.0 + 0.03 * np.sin(np.pi * x / WIDTH))], axis=1), mesh.triangles.T)


MESHES = {"distorted": hilly(distorted(24, 12)), "scattered": hilly(scattered(250))}


def press_of(indenter=None, columns=32, material=THREE, mesh=None, **axis):
    """Return a press above the middle of a block, of columns by half as many cells or of a mesh."""
    mesh = rectangle(WIDTH, HEIGHT, columns, columns // 2) if mesh is None else mesh
    bottom = hold((mesh.where(mesh.points[:, 1] == 0.0), 0.0, 0.0))
    axis = Axis(**({"at": WIDTH / 2} | axis))
    return Press(Block(mesh, material, THICK), bottom, indenter or Cylinder(R=0.015), axis)


def program(t, push=2.0, held=5.0, down=2e-3, up=8e-3):
    """Return the depth [m] of scenario B: pushed at `down`, held, lifted at `up` [m/s]."""
    return max(-0.010, down * min(t, push) - max(0.0, t - held) * up)


def run(press, orders, dt=0.02, state=None):
    """Return the states after each order, a dictionary for `Press.advance`, beginning with that before the first."""
    states = [press.start() if state is None else state]
    for order in orders:
        states.append(press.advance(states[-1], dt, **order))
    return states


def assert_contact(press, state):
    """Hold a state to the conditions of contact, by nothing but displacements, nodal forces and the shape."""
    x, y = press.block.mesh.points[press.nodes].T
    u, f = state.block.u[press.nodes], state.block.force[press.nodes]
    opening = gap(press.indenter, x - press.axis.at, y + u[:, 1], state.depth, press.begin)
    others = np.setdiff1d(np.arange(len(state.block.u)), np.r_[press.nodes, press.supports.dofs // 2])
    rounding = 1e-12  # N, where forces are newtons

    assert opening.min() >= -1e-13, "a node is inside the shape"
    assert f[:, 1].max() <= rounding, "a force pulls"
    assert np.abs(f[:, 0]).max() <= rounding, "a force rubs"
    assert np.abs(f[:, 1] * opening).max() <= 1e-12 * max(1.0, state.force), "a force acts at a distance"
    assert np.abs(state.block.force[others]).max() <= rounding, "a free node is not in equilibrium"
    assert abs(f[:, 1].sum() + state.force) <= 10 * rounding, "the force is not that on the nodes"
