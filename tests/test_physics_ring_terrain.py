"""The ring on steps and rough ground: its edges rest on corners, nothing passes through, forces are those of energy."""

import numpy as np
import pytest

from hil_sim.physics.contact import NORMAL
from hil_sim.physics.corners import NORMAL as CORNER_NORMAL
from hil_sim.physics.gauge import centre
from hil_sim.physics.ring import round_pose
from hil_sim.physics.spokes import FREE, SOFT
from hil_sim.physics.state import motion_of
from hil_sim.physics.tally import GROUND_WORK
from hil_sim.physics.terrain import Terrain, surface
from tests.ring_samples import crawl, new_plant, ring, run, take_hold

G = 9.81
WEIGHT = 1.8e-3 * G
NODES = 32


def standing(body, x=0.0, height=0.02, turn=0.0):
    """Return the motion of a round ring at rest in the air whose hub hangs in eight cold spokes."""
    m = motion_of(body, round_pose(body, 0.02, height, turn))
    m.now[0, 0:-1:2] += x
    m.spokes[SOFT], m.spokes[FREE] = 42.0, 0.02
    return m


def on(terrain, **changes):
    """Return a ring, heavily damped, on a ground of these vertices."""
    return ring(drag=20.0)._replace(terrain=Terrain(*map(np.asarray, terrain)), **changes)


def kerb(height=0.01, edge=0.0):
    """Return the vertices of a step."""
    return np.array([-1.0, edge, edge, 1.0]), np.array([0.0, 0.0, height, height])


def ridges(height=0.003, apart=0.0098, width=0.001):
    """Return the vertices of two sharp ridges, narrower than an edge of the rim."""
    x = [-1.0, *(place + side * width / 2 for place in (-apart / 2, apart / 2) for side in (-1, 0, 1)), 1.0]
    return np.array(x), np.array([0.0, 0.0, height, 0.0, 0.0, height, 0.0, 0.0])


def test_edges_of_the_rim_rest_on_ridges_between_their_nodes():
    """All nodes are in the air: without the corners the ring would sink down to the floor."""
    body = on(ridges())
    m = standing(body, height=0.0225)

    run(body, m, 2.0, gravity=(0.0, -G))

    assert m.ground[NORMAL].max() == 0.0
    assert m.corners[CORNER_NORMAL].sum() == pytest.approx(WEIGHT, rel=0.02)  # a little askew, so friction helps
    assert m.now[0, 1:-3:2].min() > 1e-3


def test_a_ring_that_leans_against_a_step_is_held_by_floor_and_edge():
    """On a slope of 5 degrees, rolling against the edge: the floor carries one part, the edge the other."""
    body = on(kerb(height=0.006))
    m = standing(body, x=-0.03)

    run(body, m, 4.0, gravity=(G * np.sin(0.087), -G * np.cos(0.087)))

    x, _ = centre(body, m.now[0])
    touch = np.sqrt(0.02**2 - 0.014**2)  # of a round ring with a corner 6 mm high
    assert x == pytest.approx(-touch, abs=1e-3)
    assert m.corners[CORNER_NORMAL].max() > 0.05 * WEIGHT
    assert np.abs(m.now[1]).max() < 1e-3


@pytest.mark.parametrize("speed", [0.1, 0.5])
def test_a_ring_thrown_at_a_riser_does_not_pass_through(speed):
    body = on(kerb(height=0.05), mu=0.0, drag=0.0)
    m = standing(body, x=-0.03)
    m.now[1, 0:-1:2] = speed

    deepest = 0.0
    for _ in range(100):
        run(body, m, 0.002, gravity=(0.0, -G))
        deepest = max(deepest, m.now[0, 0:-3:2].max())

    assert deepest < 0.1 * np.pi * 0.04 / NODES  # a tenth of an edge of the rim
    assert centre(body, m.now[0])[0] < -0.02


def test_what_stands_on_rough_ground_does_not_creep():
    x = np.linspace(-0.1, 0.1, 101)
    body = on((x, 3e-4 * np.sin(2e3 * x)))
    m = standing(body, height=0.0205)
    run(body, m, 3.0, gravity=(0.0, -G))
    before = centre(body, m.now[0])[0]

    run(body, m, 5.0, gravity=(0.0, -G))

    assert abs(centre(body, m.now[0])[0] - before) / 5.0 < 1e-8


def test_the_ground_takes_no_energy_of_a_ring_that_slides_over_bumps_without_friction():
    """Undamped: what the bumps take while they push the rim up they give back, but for what the contacts store."""
    x = np.linspace(-0.5, 0.5, 501)
    body = on((x, 1e-4 * np.sin(200 * x)), mu=0.0, tau_v=0.0, drag=0.0, c_n=0.0)
    m = standing(body, height=0.02)
    m.now[1, 0:-1:2] = 0.2

    run(body, m, 0.5, gravity=(0.0, -G))

    kinetic = 0.5 * 1.8e-3 * 0.2**2
    assert abs(m.tally[GROUND_WORK]) < 0.04 * kinetic
    assert centre(body, m.now[0])[0] == pytest.approx(0.1, rel=0.02)  # over 100 vertices and three bumps


def test_on_level_pieces_of_terrain_the_robot_crawls_as_on_the_plane():
    plane, pieces = new_plant(), new_plant(ground__step_mm=1, ground__step_at_mm=500)

    for plant in (plane, pieces):
        take_hold(plant)
        crawl(plant, 2)

    assert pieces.observe()["travel_mm"] == pytest.approx(plane.observe()["travel_mm"], rel=1e-6)


def test_the_nodes_stay_on_rough_ground_while_the_robot_crawls():
    plant = new_plant(ground__roughness_mm=0.5, ground__roughness_length_mm=10)
    take_hold(plant)

    crawl(plant, 4)

    nodes = 1e-3 * np.array(plant.snapshot()["nodes"])
    sunk = [surface(plant._ring.terrain, x) - z for x, z in nodes]
    assert max(sunk) < 2e-4
    assert plant.observe()["travel_mm"] > 30
