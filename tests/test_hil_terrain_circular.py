"""The circular robot on steps and rough ground, through every layer: what it crosses and what stops it.

Figures of docs/sensitivity.md; here the cases well inside and well beyond what it can do.
"""

import json
from functools import cache

import pytest
from click.testing import CliRunner

from host.cli import main

CRAWL_MM = 124.7  # eight steps on the plane
PLACES_MM = (52, 56, 60, 64)  # of the edge of a step, over an eighth of the rim


@cache
def observed(**ground):
    """Run the crawl, or another gait, on such ground and return what was observed."""
    seed, gait = ground.pop("seed", 1), ground.pop("gait", "crawl")
    settings = "".join(f"&set=ground.{key}:{value}" for key, value in ground.items())
    arguments = ["run", f"gaits/circular-{gait}.gait", "--robot", f"sim:circular?seed={seed}{settings}", "--json"]
    result = CliRunner().invoke(main, arguments)
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)["observed"]


@pytest.mark.parametrize("place_mm", PLACES_MM)
def test_it_climbs_a_step_of_a_millimetre(place_mm):
    seen = observed(step_mm=1, step_at_mm=place_mm)

    assert seen["travel_mm"] == pytest.approx(CRAWL_MM, rel=0.03)  # it goes on a millimetre up
    assert seen["rim_crossings"] == 0


@pytest.mark.parametrize("place_mm", PLACES_MM)
def test_a_step_of_three_millimetres_stops_it(place_mm):
    """It leans on the edge with its weight behind it, and that turns it back."""
    assert observed(step_mm=3, step_at_mm=place_mm)["travel_mm"] < place_mm


@pytest.mark.parametrize("place_mm", PLACES_MM)
def test_a_coil_and_its_opposite_take_it_up_a_step_of_a_quarter_of_its_radius(place_mm):
    seen = observed(gait="climb", step_mm=5, step_at_mm=place_mm)

    assert seen["travel_mm"] == pytest.approx(CRAWL_MM, rel=0.05)
    assert seen["rim_crossings"] == 0


@pytest.mark.parametrize("seed", range(1, 4))
def test_a_coil_and_its_opposite_take_it_over_hills_of_two_millimetres(seed):
    seen = observed(gait="climb", roughness_mm=2, roughness_length_mm=5, seed=seed)

    assert seen["travel_mm"] == pytest.approx(CRAWL_MM, rel=0.1)


def test_it_crawls_down_a_step_of_eight_millimetres():
    assert observed(step_mm=-8, step_at_mm=60)["travel_mm"] == pytest.approx(CRAWL_MM, rel=0.03)


@pytest.mark.parametrize("seed", range(1, 5))
def test_it_crawls_over_roughness_of_half_a_millimetre(seed):
    seen = observed(roughness_mm=0.5, roughness_length_mm=5, seed=seed)

    assert seen["travel_mm"] == pytest.approx(CRAWL_MM, rel=0.05)


def test_hills_of_two_millimetres_stop_it_more_often_than_not():
    """Steeper than its dent holds: root mean square slope of some 30 degrees."""
    travels = [observed(roughness_mm=2, roughness_length_mm=5, seed=seed)["travel_mm"] for seed in range(1, 6)]

    assert sum(travel < 0.85 * CRAWL_MM for travel in travels) >= 3


def test_the_seed_of_the_address_makes_the_ground():
    first, other = (observed(roughness_mm=0.5, roughness_length_mm=5, seed=seed)["travel_mm"] for seed in (1, 2))

    assert first != other
    assert observed(seed=1)["travel_mm"] == observed(seed=2)["travel_mm"]
