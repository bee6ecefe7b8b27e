"""A cylinder on an elastic half-space: the line contact of Hertz, its pressure and width, on finer and finer meshes."""

import numpy as np
import pytest

from hil_sim.physics.block.block import Block, hold
from hil_sim.physics.block.indenters import Cylinder
from hil_sim.physics.block.material import Material
from hil_sim.physics.block.mesh import mesh_of, rectangle
from hil_sim.physics.block.press import Axis, Press

R, A, E, NU, DEEP = 0.050, 0.004, 1e5, 0.35, 0.150
LINE_FORCE = np.pi * A**2 * E / (1.0 - NU**2) / (4.0 * R)  # N/m, standard result
P0 = 2.0 * LINE_FORCE / (np.pi * A)  # Pa, its greatest pressure


def graded(h, growth=1.4):
    """Return places from 0 to DEEP that are h apart as far as 1.1 times the contact, then further and further."""
    places = [k * h for k in range(round(1.1 * A / h) + 1)]
    while places[-1] < DEEP:
        h *= growth
        places.append(places[-1] + h)
    return np.minimum(places, DEEP)


def half_space(h):
    """Return a mesh that is large against the contact, with triangles of size h there."""
    half = graded(h)
    x, y = np.r_[-half[:0:-1], half], DEEP - half[::-1]
    even = rectangle(1.0, 1.0, len(x) - 1, len(y) - 1)
    return mesh_of(np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2), even.triangles.T)


def contact(h):
    """Return places [m], pressures [Pa] and which nodes touch, below a cylinder that presses with LINE_FORCE."""
    mesh = half_space(h)
    bottom = hold((mesh.where(mesh.points[:, 1] == 0.0), 0.0, 0.0))
    material = Material(E0=E, nu0=NU)
    press = Press(Block(mesh, material), bottom, Cylinder(R), Axis(at=0.0))
    state = press.advance(press.start(), 1.0, force=LINE_FORCE)
    x = mesh.points[press.nodes, 0]
    return x, -state.forces[:, 1] / np.gradient(x), state.active


@pytest.fixture(scope="module")
def contacts():
    """Return the contacts on three meshes."""
    return {h: contact(h) for h in (4e-4, 2e-4, 1e-4)}


def error(x, pressure):
    """Return the greatest error of the pressure within 0.9 of the half-width, over P0."""
    within = np.abs(x) < 0.9 * A
    return np.abs(pressure[within] - P0 * np.sqrt(1.0 - (x[within] / A) ** 2)).max() / P0


def test_the_pressure_is_that_of_hertz(contacts):
    x, pressure, _ = contacts[1e-4]

    assert error(x, pressure) < 0.02


def test_half_the_size_of_the_triangles_halves_the_error(contacts):
    errors = [error(x, pressure) for x, pressure, _ in contacts.values()]

    assert errors[0] / errors[1] == pytest.approx(2.0, abs=0.4)
    assert errors[1] / errors[2] == pytest.approx(2.0, abs=0.4)


def test_the_contact_is_as_wide_as_that_of_hertz(contacts):
    for h, (x, _, active) in contacts.items():
        assert x[active].max() == pytest.approx(A, abs=h)
        assert -x[active].min() == pytest.approx(A, abs=h)
