"""The law of one dimension: numbers of the three-element model, and a fine integration for any other."""

import numpy as np
import pytest
from hypothesis import given, settings
from scipy.integrate import solve_ivp

from hil_sim.physics.block.law import fastest, push_and_hold, recovery
from hil_sim.physics.block.material import BlockError, Material, Maxwell
from tests.block_samples import FIVE, THREE, materials


def integrated(material, t, t_push, t_hold):
    """Return modulus at the end of the hold and strain at t after it, by integrating the branches."""
    E, c = (np.array([branch[k] for branch in material.branches]) for k in (0, 1))
    options = {"method": "LSODA", "rtol": 1e-10, "atol": 1e-12}
    v = solve_ivp(lambda t, v: E / c * (t / t_push - v), (0, t_push), 0 * E, **options).y[:, -1]
    v = solve_ivp(lambda t, v: E / c * (1.0 - v), (0, t_hold), v, **options).y[:, -1]
    modulus = material.E0 + (E * (1.0 - v)).sum()

    def freed(t, y):
        springs = E * (y[0] - y[1:])
        return np.r_[-(material.E0 * y[0] + springs.sum()) / material.c0, springs / c]

    return modulus, solve_ivp(freed, (0, t), np.r_[1.0, v], **options).y[0, -1]


def test_scenario_a_keeps_the_listed_residual():
    assert recovery(THREE, 1e4, 2.0, 3.0) * 4e-3 == pytest.approx(2.226155e-3, abs=1e-9)


@pytest.mark.parametrize(("E0", "depths_mm"), [(1e3, (2.1835, 2.1211, 1.8353)), (5e3, (2.0273, 1.7693, 0.8957))])
def test_a_spring_in_parallel_lets_it_creep_back(E0, depths_mm):
    found = 4.0 * recovery(THREE._replace(E0=E0), [1.0, 10.0, 55.0], 2.0, 3.0)

    assert found == pytest.approx(depths_mm, abs=1e-4)


def test_the_fastest_rate_of_three_elements_is_that_of_its_closed_form():
    assert fastest(THREE) == pytest.approx(60e3 / 6e3 + 60e3 / 300e3)
    assert fastest(Material(E0=1e3, c0=10.0)) == pytest.approx(100.0)
    assert fastest(Material(E0=1e3)) == fastest(Material(c0=1e3)) == 0.0


@settings(max_examples=25)
@given(material=materials())
def test_modulus_and_recovery_are_those_of_the_branches_integrated(material):
    modulus, strain = integrated(material, 3.0, 2.0, 1.5)

    assert push_and_hold(material, 3.5, 2.0) == pytest.approx(modulus, abs=1e-7 * sum(E for E, *_ in material.branches))
    assert recovery(material, 3.0, 2.0, 1.5) == pytest.approx(strain, abs=1e-7)


def test_without_a_dashpot_the_strain_jumps_to_where_the_springs_balance():
    branch = Maxwell(60e3, 300e3)
    damped, free = (Material((branch,), E0=20e3, c0=c0) for c0 in (1e-3, 0.0))

    assert recovery(free, [0.0, 1.0], 2.0, 3.0)[1] == pytest.approx(recovery(damped, 1.0, 2.0, 3.0), rel=1e-6)
    assert recovery(free, 0.0, 2.0, 3.0) < 0.9


def test_a_free_spring_alone_returns_at_once():
    assert recovery(Material(E0=1e3), [0.0, 5.0], 2.0, 3.0).tolist() == [0.0, 0.0]


def test_recovery_takes_the_viscosities_of_unloading():
    softer = FIVE._replace(c0_unloading=1e3)

    assert fastest(softer) > fastest(FIVE) == pytest.approx(fastest(softer, unloading=False))
    assert recovery(softer, 0.05, 2.0, 3.0) < recovery(FIVE, 0.05, 2.0, 3.0) < recovery(FIVE, 0.0, 2.0, 3.0)
    assert recovery(FIVE, 0.0, 2.0, 3.0) == pytest.approx(1.0)


def test_a_push_without_duration_is_refused():
    with pytest.raises(BlockError, match=r"t_push = 0 s, must be above 0 s"):
        push_and_hold(THREE, 1.0, 0.0)
