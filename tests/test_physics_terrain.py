"""The ground's profile: steps and roughness as told, level under the start, and the nearest way out of it."""

from dataclasses import replace

import numpy as np
import pytest

from hil_sim.physics.terrain import depth, surface, terrain_of
from tests.ring_samples import robot

STEP = {"step": 0.01, "step_at": 0.05}
ROUGH = {"rough": 0.001, "rough_length": 0.01}


def ground(**numbers):
    return replace(robot().ground, **numbers)


def heights(terrain, x):
    return np.array([surface(terrain, place) for place in x])


def test_without_numbers_the_ground_is_a_plane():
    terrain = terrain_of(ground(), seed=1)

    assert terrain.x.size == 0
    assert depth(terrain, 0.3, -0.002) == (0.002, 0.0, 1.0)
    assert surface(terrain, 0.3) == 0.0


@pytest.mark.parametrize("edge", [0.05, -0.05])
@pytest.mark.parametrize("height", [0.01, -0.01])
def test_a_step_lies_beyond_its_edge_seen_from_the_start(edge, height):
    terrain = terrain_of(ground(step=height, step_at=edge), seed=1)

    assert heights(terrain, [0.0, 0.99 * edge, -edge]) == pytest.approx(0.0)
    assert heights(terrain, [1.01 * edge, 100 * edge]) == pytest.approx(height)


PLACES = {  # x, z: depth, normal; the edge at (0.05, 0.01), the foot of the riser at (0.05, 0)
    "below the floor": ((0.02, -0.001), (0.001, 0.0, 1.0)),
    "on the step, under its top": ((0.08, 0.009), (0.001, 0.0, 1.0)),
    "in the riser": ((0.0504, 0.005), (0.0004, -1.0, 0.0)),
    "near the edge, nearer to the top": ((0.0505, 0.0098), (0.0002, 0.0, 1.0)),
    "near the edge, nearer to the riser": ((0.0502, 0.0095), (0.0002, -1.0, 0.0)),
    "behind the foot: the way out goes through the corner": ((0.0503, -0.0004), (0.0005, -0.6, 0.8)),
    "in the air above the floor": ((0.04, 0.002), (-0.002, 0.0, 1.0)),
    "in the air above the step": ((0.06, 0.013), (-0.003, 0.0, 1.0)),
}


@pytest.mark.parametrize("place", PLACES)
def test_the_way_out_of_a_step_is_the_shortest(place):
    (x, z), expected = PLACES[place]

    assert depth(terrain_of(ground(**STEP), seed=1), x, z) == pytest.approx(expected, abs=1e-12)


def test_the_way_out_of_rough_ground_is_the_shortest_to_any_of_its_points():
    terrain = terrain_of(ground(**ROUGH, **STEP), seed=3)
    pieces = np.linspace(0.0, 1.0, 400)
    near = np.flatnonzero((terrain.x > 0.0) & (terrain.x < 0.12))
    along = np.concatenate([terrain.x[k] + pieces * (terrain.x[k + 1] - terrain.x[k]) for k in near])
    up = np.concatenate([terrain.z[k] + pieces * (terrain.z[k + 1] - terrain.z[k]) for k in near])
    for x, below in np.random.default_rng(1).uniform((0.03, 0.0), (0.09, 0.006), (200, 2)):
        z = surface(terrain, x) - below

        d, nx, nz = depth(terrain, x, z)

        assert d == pytest.approx(np.hypot(along - x, up - z).min(), abs=1e-5)
        assert surface(terrain, x + (d - 1e-6) * nx) > z + (d - 1e-6) * nz
        assert depth(terrain, x + (d + 1e-6) * nx, z + (d + 1e-6) * nz)[0] < 1e-9


def test_roughness_has_the_height_and_the_correlation_it_was_asked_for():
    x = np.arange(0.2, 1.9, 0.0005)
    profiles = [heights(terrain_of(ground(**ROUGH), seed), x) for seed in range(20)]

    rms = np.sqrt(np.mean(np.square(profiles)))
    apart = round(0.01 / 0.0005)
    alike = np.mean([z[:-apart] * z[apart:] for z in profiles]) / rms**2

    assert rms == pytest.approx(0.001, rel=0.05)  # 20 x 170 correlation lengths: 2 %
    assert alike == pytest.approx(np.exp(-1.0), abs=0.05)


def test_the_start_is_level_for_a_body_of_that_width():
    terrain = terrain_of(ground(**ROUGH), seed=1, width=0.04)

    assert np.abs(heights(terrain, np.linspace(-0.02, 0.02, 99))).max() < 1e-5  # the pieces beside it begin within
    assert min(np.abs(heights(terrain, side * np.linspace(0.04, 0.2, 99))).max() for side in (-1, 1)) > 0.001


def test_the_same_seed_gives_the_same_ground_and_another_one_another():
    first, again, other = (terrain_of(ground(**ROUGH), seed).z for seed in (1, 1, 2))

    assert np.array_equal(first, again)
    assert not np.array_equal(first, other)


@pytest.mark.parametrize("numbers", [{"step": 0.001, "step_at": 0.0}, {"rough": 0.001, "rough_length": 1e-5}])
def test_ground_that_cannot_be_made_is_refused(numbers):
    with pytest.raises(ValueError, match=" mm: "):
        terrain_of(ground(**numbers), seed=1)
