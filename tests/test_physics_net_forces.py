"""Forces of strips, coils and ground are the gradients of their energies, and the tangents theirs."""

import numpy as np
import pytest
from scipy.linalg import eigh

from hil_sim.physics.net.beam import beam_forces, beam_tangent
from hil_sim.physics.net.ground import BORNE, PUSH, PUSH_BEFORE, ground_forces, ground_tangent
from hil_sim.physics.net.pulls import LENGTH, coil_forces, coil_tangent
from tests.net_samples import COIL_FREE, COIL_RATE, NUMBERS, PLANE, dense, hoop, moved, placed, shaken, sphere

H = 1e-6  # [m, rad] of the finite differences


def elastic(sample, x, R):
    """Return energy and gradient of strips and coils."""
    net, m = sample
    f = np.zeros((net.bodies, 6))
    energy, _ = beam_forces(net, x, R, np.zeros_like(f), m.work, f)
    coil_forces(net, x, R, np.zeros_like(f), m.coils, f)
    return energy + 0.5 * COIL_RATE * (np.maximum(0.0, m.coils[LENGTH] - COIL_FREE) ** 2).sum(), f


def differences(sample, of):
    """Return the derivative of a function of places and rotations by every unknown, one column each."""
    columns = []
    for entry in range(6 * sample.net.bodies):
        change = np.zeros(6 * sample.net.bodies)
        change[entry] = H
        change = change.reshape(-1, 6)
        columns.append((of(*moved(sample.m, change)) - of(*moved(sample.m, -change))) / (2 * H))
    return np.array(columns).T


@pytest.mark.parametrize("amount", [0.02, 0.3])
def test_forces_of_strips_and_coils_are_the_gradient_of_their_energy(amount):
    sample = shaken(placed(sphere()), amount)

    gradient = differences(sample, lambda x, R: np.array(elastic(sample, x, R)[0]).reshape(1))

    _, f = elastic(sample, sample.m.now.x, sample.m.now.R)
    assert np.abs(f).max() > 10.0
    assert gradient.ravel() == pytest.approx(f.ravel(), abs=1e-9 * np.abs(f).max())


@pytest.mark.parametrize("amount", [0.02, 0.3])
def test_the_tangent_of_strips_and_coils_is_the_symmetric_derivative_of_their_forces(amount):
    sample = shaken(placed(sphere()), amount)

    derivative = differences(sample, lambda x, R: elastic(sample, x, R)[1].ravel())

    elastic(sample, sample.m.now.x, sample.m.now.R)
    beam_tangent(sample.net, 0.0, sample.m.work, sample.m.blocks)
    coil_tangent(sample.net, 0.0, sample.m.coils, sample.m.blocks)
    tangent = dense(sample.net, sample.m.blocks)
    assert tangent == pytest.approx(0.5 * (derivative + derivative.T), abs=1e-9 * np.abs(tangent).max())


@pytest.mark.parametrize("sliding", [0.0, 3e-4])
def test_the_tangent_of_the_ground_is_the_derivative_of_its_forces_sticking_and_slipping(sliding):
    """At a bound of friction that is given, as it is within a step."""
    sample = placed(sphere(), height=0.0446)
    net, m = sample
    v, f = np.zeros((net.bodies, 6)), np.zeros((net.bodies, 6))
    ground_forces(net, PLANE, m.now.x - [sliding, 0.5 * sliding, 0.0], m.now.R, v, m.touch, f)
    m.touch[:, 3:6] = m.touch[:, 0:3]  # the anchors
    m.touch[:, PUSH_BEFORE] = m.touch[:, PUSH]

    def forces(x, R):
        f = np.zeros((net.bodies, 6))
        ground_forces(net, PLANE, x, R, v, m.touch, f)
        return f.ravel()

    derivative = differences(sample, forces)
    forces(m.now.x, m.now.R)
    ground_tangent(net, m.now.x, 0.0, m.touch, m.blocks)
    tangent = dense(net, m.blocks)
    assert (m.touch[:, PUSH] > 0.0).sum() == 8
    assert (m.touch[:, BORNE].min() < 1.0) == (sliding > 0.0)
    assert tangent == pytest.approx(0.5 * (derivative + derivative.T), abs=1e-6 * np.abs(tangent).max())


def test_a_strip_that_is_moved_and_turned_as_a_whole_has_no_strain():
    sample = placed(sphere())
    spin = np.tile([0.0, 0.0, 0.0, 0.4, -0.7, 0.2], (sample.net.bodies, 1))
    turn = moved(sample.m, spin)[1][0]

    energy, f = elastic(sample, sample.m.now.x @ turn.T + [1.0, 2.0, 3.0], moved(sample.m, spin)[1])

    at_rest, _ = elastic(sample, sample.m.now.x, sample.m.now.R)
    assert energy == pytest.approx(at_rest, rel=1e-12)
    assert np.abs(f[:, :3].sum(axis=0)).max() < 1e-12


def bending(nodes):
    """Return what a hoop without stretch gives under a small pull across it, and its lowest frequency, over theory."""
    net = hoop(nodes=nodes, EA=1e4, m_core=1.0)
    sample = placed(net)
    elastic(sample, sample.m.now.x, sample.m.now.R)
    beam_tangent(net, 0.0, sample.m.work, sample.m.blocks)
    K, count = dense(net, sample.m.blocks)[:-6, :-6], 6 * (net.bodies - 1)
    mass = np.repeat(np.stack([net.mass, net.inertia], axis=1)[:-1], 3, axis=1).ravel()
    planar = np.isin(np.arange(count) % 6, (0, 2, 4))
    squared, shapes = eigh(K[np.ix_(planar, planar)], np.diag(mass[planar]))
    across = np.zeros(count)
    across[[6 * net.hoops[0, 0] + 2, 6 * net.hoops[0, nodes // 2] + 2]] = -1.0, 1.0
    part = shapes[:, 3:].T @ across[planar]
    EI, R, rho = NUMBERS.EI, NUMBERS.R, NUMBERS.m / (2 * np.pi * NUMBERS.R)
    give = (part**2 / squared[3:]).sum() / ((np.pi / 4 - 2 / np.pi) * R**3 / EI)
    slow = 1.0 + 1.8 * NUMBERS.width**2 / (12.0 * R**2)  # moment of inertia of the strip, the same about all axes
    return np.array([give, squared[3] * slow / (36 / 5 * EI / (rho * R**4))])


def test_a_hoop_bends_and_vibrates_as_a_thin_ring_does_with_the_second_order():
    """0.1488 P R^3/EI and omega^2 = 36/5 EI/(rho A R^4), less what turning the strip's mass takes (derived here)."""
    errors = np.array([bending(nodes) - 1.0 for nodes in (16, 32, 64)])

    orders = np.log2(errors[:-1] / errors[1:])
    assert np.abs(errors[1]).max() < 0.02
    assert orders == pytest.approx(2.0, abs=0.15)


def test_the_strip_is_stiffer_edgewise_than_flat_as_its_numbers_say():
    soft, stiff = (sphere(edgewise=ratio).stiffness for ratio in (1.0, 20.0))

    assert stiff[4] == pytest.approx(20.0 * soft[4])
    assert stiff[5] == soft[5] == NUMBERS.EI
    assert sphere(twist=0.5).stiffness[3] == pytest.approx(0.5 * NUMBERS.EI)
