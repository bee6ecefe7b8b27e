"""How a net is made out of hoops, labels and numbers."""

import numpy as np
import pytest

from hil_sim.physics.net.mesh import SPHERE, net_of, node_at
from tests.net_samples import GROUND, NUMBERS, hoop, sphere


def test_three_hoops_share_six_crossings():
    net = sphere(nodes=16)

    shared = np.bincount(net.hoops.ravel())
    assert net.bodies == 3 * 16 - 6 + 1
    assert (shared == 2).sum() == 6
    assert (shared == 1).sum() == 3 * 16 - 2 * 6


def test_the_masses_of_all_bodies_add_up_to_the_robot_s():
    net = sphere()

    assert net.mass.sum() == pytest.approx(NUMBERS.m + NUMBERS.m_joints + NUMBERS.m_core)
    assert net.mass[-1] == NUMBERS.m_core
    assert net.inertia[-1] == pytest.approx(0.4 * NUMBERS.m_core * NUMBERS.r_core**2)


def test_the_axes_of_a_strip_lie_along_it_flat_and_across():
    net = sphere()
    middles = net.directions[net.ends].mean(axis=1)

    assert net.axes @ net.axes.transpose(0, 2, 1) == pytest.approx(np.tile(np.eye(3), (net.beams.size, 1, 1)))
    assert np.linalg.det(net.axes) == pytest.approx(1.0)
    assert np.abs(np.einsum("ei,ei->e", net.axes[:, 0], middles)).max() < 1e-12  # along
    assert np.abs(np.einsum("ei,ei->e", net.axes[:, 2], middles)).max() < 1e-12  # across


def test_the_contact_points_lie_on_the_edges_of_the_strips():
    net = sphere()
    places = NUMBERS.R * net.directions[net.feet] + net.offsets

    assert net.feet.size == 4 * net.hoops.size
    assert np.linalg.norm(places, axis=1) == pytest.approx(np.hypot(NUMBERS.R, NUMBERS.width / 2))


def test_coils_run_from_the_core_to_points_and_between_points():
    spoke, chord = (1, 0, -1), ((1, 0, -1), (0, 1, -1))

    net = net_of(NUMBERS, GROUND, SPHERE, [spoke], [chord])

    ends = [node_at(net.directions, end) for end in chord]
    assert (net.near.tolist(), net.far.tolist()) == ([net.bodies - 1, ends[0]], [ends[0], ends[1]])
    assert net.arms[0] == pytest.approx(NUMBERS.attach * np.array(spoke) / np.sqrt(2.0))
    assert not net.arms[1].any()


def test_a_coil_that_ends_where_no_node_is_raises():
    with pytest.raises(ValueError, match="no node of the mesh lies in direction"):
        net_of(NUMBERS, GROUND, SPHERE, [(1, 1, 1)])


def test_elements_that_meet_at_a_crossing_are_no_strangers():
    net = sphere()
    pairs = {tuple(pair) for pair in net.strangers.tolist()}
    sharing = [
        (k, n)
        for k in range(net.beams.size)
        for n in range(k + 1, net.beams.size)
        if set(net.ends[k]) & set(net.ends[n])
    ]

    assert len(sharing) > net.beams.size
    assert not pairs & set(sharing)
    assert len(pairs) > 300


def test_one_hoop_alone_is_a_net_too():
    net = hoop(nodes=24)

    assert net.bodies == 25
    assert net.hoops.tolist() == [list(range(24))]
