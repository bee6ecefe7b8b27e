"""The forces of the ring: derivatives of one energy, and the two laws of a thin ring."""

import numpy as np
import pytest

from hil_sim.physics.gauge import rim_energy
from hil_sim.physics.motion import correct, forces
from hil_sim.physics.spokes import FREE, HARD, SOFT, SOLID
from tests.ring_samples import floating, lossless, ring

RNG = np.random.default_rng(4)


def crumpled(body, size=3e-4):
    """Return a ring off its round shape, with taut, slack and closed spokes."""
    m = floating(body)
    m.now[0] += size * RNG.normal(size=m.now.shape[1])
    m.spokes[SOFT], m.spokes[FREE] = 60.0, np.linspace(0.012, 0.022, 8)
    m.spokes[HARD], m.spokes[SOLID] = 500.0, 0.0
    m.spokes[SOLID, 3] = 0.021
    return m


def gradient(body, m, q, v=None):
    f = np.zeros(q.size)
    forces(body, 0.3, -9.8, m, q, np.zeros(q.size) if v is None else v, 0.0, f)
    return f


def differences(function, q, size=1e-7):
    """Return the derivative of a function by central differences."""
    return np.array([(function(q + e) - function(q - e)) / (2 * size) for e in np.eye(q.size) * size])


def test_the_forces_are_the_gradient_of_the_energy():
    body = lossless()
    m = floating(body)
    q = m.now[0] + 3e-4 * RNG.normal(size=m.now.shape[1])

    slope = differences(lambda q: rim_energy(body, q), q, 1e-8)

    weight = gradient(body, floating(body), m.now[0])
    assert gradient(body, m, q) - weight == pytest.approx(slope, abs=1e-6 * np.abs(slope).max())


@pytest.mark.parametrize("attach", [0.0, 0.003])
def test_newtons_correction_solves_the_exact_tangent(attach):
    """With hub, taut, slack and closed spokes, also about an attachment that turns with the hub."""
    body = lossless(attach=attach)
    m = crumpled(body)
    q, rhs, x = m.now[0], RNG.normal(size=m.now.shape[1]), np.zeros(m.now.shape[1])
    tangent = differences(lambda q: gradient(body, m, q), q) + 1e8 * np.diag(body.mass)

    gradient(body, m, q)
    assert correct(body, m, q, 0 * q, 0.0, 1e8, False, rhs, x)

    assert x == pytest.approx(np.linalg.solve(tangent, rhs), rel=1e-5, abs=1e-8 * np.abs(x).max())


def test_inner_forces_neither_push_nor_turn_the_body():
    """Bending with damping, stretch and all spokes: momentum and angular momentum are kept."""
    body = ring(tau_v=1e-3, drag=0.0, damping=0.01)
    m = crumpled(body)
    v = 0.1 * RNG.normal(size=m.now.shape[1])
    f = np.zeros(v.size)

    forces(body, 0.0, 0.0, m, m.now[0], v, 0.0, f)

    (x, y), (fx, fy) = m.now[0, :-1].reshape(-1, 2).T, f[:-1].reshape(-1, 2).T
    assert np.abs(f).max() > 1e-3
    assert [fx.sum(), fy.sum()] == pytest.approx([0, 0], abs=1e-14)
    assert (x * fy - y * fx).sum() + f[-1] == pytest.approx(0, abs=1e-14)


def response(body, load, shift=1e-2):
    """Return the small displacement under a load, with `shift` times the mass as a bed."""
    m, x = floating(body), np.zeros(load.size)
    gradient(body, m, m.now[0])
    assert correct(body, m, m.now[0], 0 * load, 0.0, shift, False, load, x)
    return x


def deflection_error(nodes):
    """Return the relative error of the closing of the ring between two forces P: 0.1488 P R^3/EI."""
    body = lossless(nodes=nodes, EA=4e3)
    load = np.zeros(2 * nodes + 3)
    load[[1, nodes + 1]] = 1.0, -1.0
    x = response(body, load)
    return (x[1] - x[nodes + 1]) / ((np.pi / 4 - 2 / np.pi) * 0.02**3 / body.EI) - 1


def frequency_error(nodes):
    """Return the relative error of omega in omega^2 = 36/5 EI/(rho A R^4), by inverse iteration."""
    body = lossless(nodes=nodes, EA=4e3)
    angle = np.arctan2(body.compass[1], body.compass[0])
    mode = np.zeros(2 * nodes + 3)
    radial, along = np.cos(2 * angle), -0.5 * np.sin(2 * angle)
    mode[0:-3:2] = radial * np.cos(angle) - along * np.sin(angle)
    mode[1:-3:2] = radial * np.sin(angle) + along * np.cos(angle)
    for _ in range(4):
        before = mode / np.linalg.norm(mode)
        mode = response(body, body.mass * before, 1e3)
    omega = np.sqrt(1 / (before @ mode) - 1e3)
    per_length = body.mass[0] * nodes / (2 * np.pi * 0.02)
    return omega / np.sqrt(7.2 * body.EI / (per_length * 0.02**4)) - 1


@pytest.mark.parametrize("error", [deflection_error, frequency_error])
def test_both_laws_of_a_thin_ring_hold_to_1_percent_and_converge_with_second_order(error):
    coarse, default, fine = (abs(error(nodes)) for nodes in (16, 32, 64))

    assert default < 0.01
    assert np.log2(default / fine) == pytest.approx(2, abs=0.2)
    assert coarse > 2 * default


def test_nodes_that_cannot_be_shared_among_the_spokes_are_refused():
    with pytest.raises(ValueError, match="30 nodes for 8 spokes"):
        lossless(nodes=30)


def test_a_round_ring_without_load_has_no_energy_and_no_forces():
    body = lossless()
    m = floating(body)
    f = np.zeros(m.now.shape[1])

    forces(body, 0.0, 0.0, m, m.now[0], 0 * f, 0.0, f)

    assert rim_energy(body, m.now[0]) == pytest.approx(0, abs=1e-18)
    assert np.abs(f).max() < 1e-10
