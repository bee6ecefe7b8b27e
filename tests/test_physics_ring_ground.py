"""The ring on the ground: what stands does not creep, what slips slips by Coulomb's law, nothing passes through."""

import numpy as np
import pytest

from hil_sim.physics.contact import NORMAL, crossings
from hil_sim.physics.gauge import centre, rim_energy
from hil_sim.physics.motion import begin
from hil_sim.physics.ring import round_pose
from hil_sim.physics.spokes import FREE, SOFT
from hil_sim.physics.state import motion_of
from hil_sim.physics.tally import GROUND_WORK
from tests.ring_samples import floating, ring, robot, run

G = 9.81


def slope(degrees):
    return -G * np.sin(np.radians(degrees)), -G * np.cos(np.radians(degrees))


def standing(body, turn=0.0, height=0.02):
    """Return the motion of a round ring whose hub hangs in eight cold spokes."""
    m = motion_of(body, round_pose(body, 0.02, height, turn))
    m.spokes[SOFT], m.spokes[FREE] = 42.0, 0.02
    return m


def nut(mu=0.6):
    """Return a ring of eight nodes, stiff as a nut, standing on one of its sides, and its motion."""
    ground = robot(ground__friction_ratio=mu).ground
    body = ring(ground, nodes=8, EI=1e-2, drag=0.0)
    return body, standing(body, np.pi / 8, 0.02 * np.cos(np.pi / 8))


def dented():
    """Return the ring with one hot coil, fixed in its phase, that stands on its dent, and its motion."""
    body = ring()
    m = standing(body)
    m.spokes[SOFT, 0], m.spokes[FREE, 0] = 95.0, 0.0115
    run(body._replace(drag=20.0), m, 2.0, gravity=(0.0, -G))
    return body, m


@pytest.mark.parametrize("make", [nut, dented])
def test_a_ring_that_stands_on_10_degrees_does_not_creep(make):
    body, m = make()
    run(body._replace(drag=20.0), m, 3.0, gravity=slope(10))
    run(body, m, 2.0, gravity=slope(10))
    before = centre(body, m.now[0])[0]

    run(body, m, 10.0, gravity=slope(10))

    assert abs(centre(body, m.now[0])[0] - before) / 10.0 < 1e-9


def test_a_nut_slips_when_the_slope_is_steeper_than_its_friction_and_stays_when_it_is_not():
    travels = []
    for mu in (0.20, 0.40):  # tan 19 degrees = 0.344
        body, m = nut(mu)
        run(body._replace(drag=20.0), m, 1.0, gravity=slope(0))
        run(body, m, 0.5, gravity=slope(19))
        travels.append(centre(body, m.now[0])[0])

    sliding = 0.5 * G * (np.sin(np.radians(19)) - 0.20 * np.cos(np.radians(19))) * 0.5**2
    assert travels[0] == pytest.approx(-sliding, rel=0.02)  # it rocks a little as the plane turns
    assert abs(travels[1]) < 1e-3


def test_sliding_turns_work_into_heat_by_coulombs_law():
    body, m = nut(0.3)
    run(body._replace(drag=20.0), m, 1.0, gravity=slope(0))
    m.now[1, 0:-1:2] = 0.5
    begin(body, 0.0, -G, m)
    m.tally[GROUND_WORK] = 0.0
    weighed = body.mass[:-2:2].sum()

    run(body, m, 1.0, gravity=slope(0))

    assert -m.tally[GROUND_WORK] == pytest.approx(0.5 * weighed * 0.5**2, rel=0.02)
    assert centre(body, m.now[0])[0] == pytest.approx(0.5**2 / (2 * 0.3 * G), rel=0.02)


def test_the_ground_carries_the_weight_and_gives_way_by_less_than_a_tenth_of_a_millimetre():
    body, m = dented()

    weight = body.mass[:-2:2].sum() * G
    assert m.ground[NORMAL].sum() == pytest.approx(weight, rel=1e-4)
    assert -1e-4 < m.now[0, 1:-3:2].min() < 0.0


def test_a_dropped_ring_never_gains_energy_and_comes_to_rest():
    body = ring(drag=0.5)
    m = standing(body, height=0.05)
    begin(body, 0.0, -G, m)
    weighed, energies = body.mass[:-2:2].sum(), []

    for _ in range(500):
        run(body, m, 0.01, gravity=(0.0, -G))
        fall = weighed * G * (centre(body, m.now[0])[1] - 0.02)
        energies.append(fall + rim_energy(body, m.now[0]) + 0.5 * body.mass @ m.now[1] ** 2)

    assert max(energies) < 1.001 * energies[0]
    assert energies[-1] < 0.05 * energies[0]
    assert np.abs(m.now[1]).max() < 0.01


def test_nothing_holds_a_ring_that_leaves_the_ground():
    body, m = nut()
    run(body, m, 0.5, gravity=(0.0, -G))
    m.now[1, 1:-1:2] = 0.5
    begin(body, 0.0, -G, m)

    run(body, m, 0.05, gravity=(0.0, -G))

    assert m.ground[NORMAL].max() == 0.0
    assert centre(body, m.now[0])[1] - 0.02 * np.cos(np.pi / 8) > 0.9 * (0.5 * 0.05 - 0.5 * G * 0.05**2)


def test_a_hub_that_is_thrown_at_the_rim_bounces_back():
    body = ring(drag=0.0)
    m = floating(body)
    m.now[1, -3] = 1.0
    begin(body, 0.0, 0.0, m)

    run(body, m, 0.2)

    x, y = m.now[0, :-3].reshape(-1, 2).T
    assert np.hypot(x - m.now[0, -3], y - m.now[0, -2]).min() > 0.5 * body.hub_radius
    assert crossings(body, m.now[0]) == 0


def test_a_rim_that_is_pulled_together_stops_at_its_own_thickness():
    """Two opposite spokes draw the rim to a figure of eight; without contact it would cross."""
    body = ring(r_hub=1e-4, drag=50.0)
    m = floating(body)
    m.spokes[SOFT, [2, 6]], m.spokes[FREE, [2, 6]] = 1000.0, 1e-5

    run(body, m, 1.0)

    gap = m.now[0, 2 * 8] - m.now[0, 2 * 24]
    assert 0.0005 < gap < 0.0011
    assert crossings(body, m.now[0]) == 0


def test_a_rim_that_crosses_itself_and_a_hub_outside_are_counted():
    body = ring()
    q = floating(body).now[0]
    assert crossings(body, q) == 0

    outside = q.copy()
    outside[-3] = 0.03
    assert crossings(body, outside) == 1

    crossed = q.copy()
    crossed[[0, 1]] = 0.0, q[2 * 16 + 1] + 0.001  # the lowest node pulled out through the top
    assert crossings(body, crossed) >= 2
