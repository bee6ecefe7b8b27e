"""A sphere on the ground and its core inside: it stands, sticks, slips and does not creep; nothing passes through."""

from dataclasses import replace

import numpy as np
import pytest

from hil_sim.physics.flight import no_flight
from hil_sim.physics.net.apart import THICKNESS, list_close, nearest, none_close, strip_forces
from hil_sim.physics.net.beam import beam_forces
from hil_sim.physics.net.gauge import centre
from hil_sim.physics.net.ground import FORCE, PUSH
from hil_sim.physics.net.inside import PUSH as CORE_PUSH
from hil_sim.physics.net.inside import core_forces, core_tangent
from hil_sim.physics.net.mesh import SPHERE, net_of, node_at
from hil_sim.physics.net.motion import march
from hil_sim.physics.net.pulls import FREE, SOFT
from hil_sim.physics.state import method_of
from hil_sim.physics.tally import CONTACTS, ELASTIC
from tests.net_samples import FALL, GROUND, NUMBERS, PLANE, Sample, dense, placed, run, sphere, started

DAMPED = replace(NUMBERS, tau_v=3e-3, drag=20.0)
SLOPE = (-9.81 * np.sin(np.radians(10)), -9.81 * np.cos(np.radians(10)))


def flattened(mu: float = 0.6) -> Sample:
    """Return a sphere that stands on the dent of a coil at the ground, with the opposite one pulling as well."""
    net = net_of(DAMPED, replace(GROUND, mu=mu), SPHERE, [(0, 0, -1), (0, 0, 1)])
    sample = placed(net)
    sample.m.coils[SOFT], sample.m.coils[FREE] = 40.0, 0.024
    run(started(sample, FALL), 0.5, FALL, method=method_of(0.5, 4.5e-6))
    return sample


def test_a_standing_sphere_is_borne_by_its_points():
    net, m = flattened()

    assert m.touch[:, FORCE + 2].sum() == pytest.approx(9.81 * net.mass.sum(), rel=1e-3)
    assert m.tally[CONTACTS] == (m.touch[:, PUSH] > 0).sum() >= 4


def test_a_standing_sphere_does_not_creep_on_ten_degrees():
    """Friction that depends on speed lets a body of 5 g creep by 4 to 600 um/s."""
    sample = flattened()
    run(sample, 4.0, SLOPE, method=method_of(0.5, 4.5e-6))
    before = sample.m.now.x.copy()

    run(sample, 2.0, SLOPE, method=method_of(0.5, 4.5e-6))

    assert np.abs(sample.m.now.x - before).max() / 2.0 < 1e-9  # [m/s]


def test_a_standing_sphere_slides_where_friction_is_less_than_the_slope():
    sample = flattened(mu=0.1)
    start = centre(sample.net, sample.m.now.x, 0)

    run(sample, 0.2, SLOPE, method=method_of(0.5, 4.5e-6))

    a, d = 9.81 * (np.sin(np.radians(10)) - 0.1 * np.cos(np.radians(10))), DAMPED.drag
    along = a * (0.2 / d - (1.0 - np.exp(-0.2 * d)) / d**2)  # pulled by a, held back by drag
    assert start - centre(sample.net, sample.m.now.x, 0) == pytest.approx(along, rel=0.05)  # it rocks a little


def pressed() -> Sample:
    """Return a sphere whose core lies against the inside of a strip, beside its middle."""
    sample = placed(sphere())
    sample.m.now.x[-1] = [0.0435, 0.002, 0.045 - 0.004]
    return sample


def core_push(sample, x):
    """Return the forces between strips and core."""
    net, m = sample
    f = np.zeros((net.bodies, 6))
    beam_forces(net, x, m.now.R, np.zeros_like(f), m.work, np.zeros_like(f))
    core_forces(net, x, m.work, m.near, f)
    return f


def test_a_strip_pushes_the_core_back_inside_and_nothing_else():
    sample = pressed()

    f = core_push(sample, sample.m.now.x)

    assert f[-1, 0] > 0.0  # the gradient: the push is inward
    assert f[:, :3].sum(axis=0) == pytest.approx([0, 0, 0], abs=1e-12)
    turning = np.cross(sample.m.now.x, f[:, :3]) + f[:, 3:]
    assert turning.sum(axis=0) == pytest.approx([0, 0, 0], abs=1e-9)


def test_the_tangent_of_the_core_s_contact_is_at_least_the_derivative_along_the_push():
    """A bound, so that a step of Newton's method never goes too far."""
    sample = pressed()
    core_push(sample, sample.m.now.x)
    u = sample.m.near[sample.m.near[:, CORE_PUSH] > 0][0, 1:4]

    core_tangent(sample.net, sample.m.near, sample.m.blocks)

    step = np.zeros(6 * sample.net.bodies)
    step[-6:-3] = 1e-7 * u
    change = core_push(sample, sample.m.now.x + step.reshape(-1, 6)[:, :3]) - core_push(sample, sample.m.now.x)
    bound = dense(sample.net, sample.m.blocks)
    assert step @ bound @ step >= 0.999 * step @ change.ravel() > 0.0


def test_a_core_that_is_thrown_at_a_crossing_stays_inside():
    sample = placed(sphere(tau_v=3e-4, r_core=4e-3), height=1.0)
    sample.m.coils[SOFT] = 0.0
    core, wall = -1, node_at(sample.net.directions, (1, 0, 0))
    sample.m.now.v[core, 0] = 2.0

    run(started(sample), 0.1)

    x = sample.m.now.x
    assert sample.m.tally[ELASTIC] > 0.0
    assert np.linalg.norm(x[core] - x[:-1].mean(axis=0)) < NUMBERS.R
    assert x[wall, 0] > x[core, 0]


def test_two_strips_that_are_pulled_together_do_not_pass_through():
    """The poles would meet in the middle and go on, had they no thickness."""
    poles = [(0, 0, 1), (0, 0, -1)]
    net = net_of(
        replace(NUMBERS, EI=4.5e-6, tau_v=3e-4, drag=20.0, r_core=1e-4), GROUND, SPHERE, [(1, 0, 0)], [tuple(poles)]
    )
    sample = placed(net, height=1.0)
    m, nodes = sample.m, [node_at(net.directions, pole) for pole in poles]
    m.now.x[-1] += [0.02, 0.02, 0.02]  # the core is out of the way
    m.coils[SOFT], m.coils[FREE] = [0.0, 0.2], [0.0, -1.0]
    started(sample)
    gaps, flight = [], no_flight()
    for _ in range(40):
        march(net, PLANE, (0.0, 0.0), method_of(0.5, 4.5e-6), m, flight, 5e-3)
        gaps.append(m.now.x[nodes[0], 2] - m.now.x[nodes[1], 2])

    assert min(gaps) < 1.5 * THICKNESS
    assert min(gaps) > 0.0


def test_strips_push_each_other_with_opposite_forces():
    sample = placed(sphere(), height=0.0)
    net, m = sample
    m.now.x[:, 2] *= 0.005
    m.now.x[:, 0] += 0.3 * m.now.x[:, 2]
    f, close = np.zeros((net.bodies, 6)), none_close()

    list_close(net, m.now.x, m.now.v, 0.0, close)
    strip_forces(net, m.now.x, close, f)

    assert close[0, 0] > 0
    assert nearest(net, m.now.x) < THICKNESS
    assert np.abs(f).max() > 0.1
    assert f.sum(axis=0) == pytest.approx(np.zeros(6), abs=1e-12)
