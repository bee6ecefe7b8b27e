"""The host's closed form of the force is the bench's."""

import numpy as np
import pytest

from hil_sim.physics.block import law
from hil_sim.physics.block.material import Material as Block
from hil_sim.physics.block.material import Maxwell
from host.fit.law import Material, force

SETS = [Material(60e3, 300e3, 6e3), Material(20e3, 20e3, 2e3, 1e3), Material(100e3, 2e6, 0.0, 5e3)]


@pytest.mark.parametrize("material", SETS)
@pytest.mark.parametrize("pieces", [1, 7, 200])
def test_a_push_and_its_hold_are_those_of_the_bench(material, pieces):
    t = np.r_[np.linspace(0.0, 2.0, pieces + 1), np.linspace(2.0, 5.0, pieces + 1)[1:]]
    depth = 4e-3 * np.minimum(t / 2.0, 1.0)
    block = Block((Maxwell(material.E, material.c1),), E0=material.E0, c0=material.c2)

    found = force(material, t, depth, shape=0.046)

    told = 0.046 * 4e-3 * law.push_and_hold(block, t, 2.0)
    assert found[1:] == pytest.approx(told[1:], rel=1e-12)


def test_forces_of_two_histories_add_up():
    t = np.sort(np.random.default_rng(1).uniform(0.0, 5.0, 50))
    one, other = np.random.default_rng(2).uniform(0.0, 1e-3, (2, 50))

    whole = force(SETS[1], t, one + 2.0 * other, 0.05)

    assert whole == pytest.approx(
        force(SETS[1], t, one, 0.05) + 2.0 * force(SETS[1], t, other, 0.05), rel=1e-9, abs=1e-9
    )
