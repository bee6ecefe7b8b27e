"""The sphere's solver against theory and against a MuJoCo chain of links, each extrapolated in the number of nodes.

The chain shares nothing with the solver: other unknowns, another program. Loads follow the strip's stiffness, so that
the shapes stay the same when a robot file is tuned.
"""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.chain_rest import extrapolated, frequencies, pole_distance
from hil_sim.robots.file import load
from tests.net_rest import net_pole_distance
from tests.sphere_laws import pole_compliance, squash_frequency

SPHERE = load("sphere-b").sphere
SMALL_N = 1e-4  # the squash of a ten-thousandth of the diameter
# To a third of the diameter, close to where the poles snap through.
LOADS_N = [load * SPHERE.EI / SPHERE.R**2 for load in (0.9, 4.5, 9.0, 13.5, 18.0)]


def squash(distances: np.ndarray) -> np.ndarray:
    """Return by how much the poles came together [m]."""
    return 2 * SPHERE.R - distances


@pytest.fixture(scope="module")
def chain_squash() -> np.ndarray:
    """The squash of the chain under the loads, at its limit for many links."""
    return extrapolated(*(squash(pole_distance(SPHERE, nodes, LOADS_N)) for nodes in (24, 48)))


def test_the_chain_gives_under_a_small_load_as_theory_says_with_the_second_order():
    give = [squash(pole_distance(SPHERE, nodes, [SMALL_N])) for nodes in (12, 24, 48)]

    order = np.log2((give[1] - give[0]) / (give[2] - give[1]))

    assert extrapolated(give[1], give[2]) / SMALL_N == pytest.approx(pole_compliance(SPHERE), rel=1e-3)
    assert order == pytest.approx(2.0, abs=0.15)


def test_the_chain_without_stretch_vibrates_in_its_squash_mode_as_theory_says():
    theory = squash_frequency(SPHERE)
    found = extrapolated(*(frequencies(SPHERE, nodes)[3:5] for nodes in (24, 48)))  # a pair: any two of three axes

    assert found == pytest.approx([theory, theory], rel=1e-3)


def test_the_solver_gives_under_a_small_load_as_theory_says():
    give = extrapolated(*(squash(net_pole_distance(SPHERE, nodes, [SMALL_N])) for nodes in (24, 48)))

    assert give / SMALL_N == pytest.approx(pole_compliance(SPHERE), rel=3e-3)  # measured 1e-3


def test_the_solver_squashes_to_a_third_of_its_height_as_the_chain_does(chain_squash):
    solver = extrapolated(*(squash(net_pole_distance(SPHERE, nodes, LOADS_N)) for nodes in (48, 96)))

    assert chain_squash[-1] > 0.3 * 2 * SPHERE.R
    assert solver == pytest.approx(chain_squash, rel=2e-3)  # measured 5e-4


def test_the_mesh_of_the_robot_file_is_right_to_one_percent_up_to_a_sixth_and_to_two_at_a_third(chain_squash):
    solver = squash(net_pole_distance(SPHERE, SPHERE.nodes, LOADS_N))

    assert SPHERE.nodes == 24
    assert solver[:-1] == pytest.approx(chain_squash[:-1], rel=0.01)  # measured 0.6 %
    assert solver[-1] == pytest.approx(chain_squash[-1], rel=0.02)  # measured 1.4 %


def test_a_stiffer_strip_is_stiffer_in_both():
    """The comparison can tell ten percent of stiffness: it would see a wrong one."""
    stiffer = replace(SPHERE, EI=1.1 * SPHERE.EI)

    solver, chain = (
        squash(distance(stiffer, 24, [SMALL_N])) / squash(distance(SPHERE, 24, [SMALL_N]))
        for distance in (net_pole_distance, pole_distance)
    )

    assert solver == pytest.approx(1 / 1.1, rel=2e-3)
    assert chain == pytest.approx(1 / 1.1, rel=2e-3)
