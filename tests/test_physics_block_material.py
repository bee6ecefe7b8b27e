"""The rheological material at a point: exact updates, plane stress, and what is refused."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from hil_sim.physics.block.block import Block, hold
from hil_sim.physics.block.law import push_and_hold
from hil_sim.physics.block.material import BlockError, Material, Maxwell, checked, isotropic, update_of
from hil_sim.physics.block.mesh import rectangle
from hil_sim.physics.block.step import advance, rest
from tests.block_samples import FIVE, MIXED, THREE, materials

CELL = rectangle(1.0, 1.0, 1, 1)


def strained(material, strain, steps, dt):
    """Return the states of one cell whose corners are moved by `strain` (x, y) times what steps(k) says."""
    block, states = Block(CELL, material), []
    state = rest(block)
    for step in steps:
        parts = [([node], *(step * np.array(strain) * CELL.points[node])) for node in range(4)]
        state = advance(block, state, hold(*parts), dt)
        states.append(state)
    return states


@pytest.mark.parametrize("dt", [0.1, 0.05, 0.025])
@pytest.mark.parametrize("material", [THREE, FIVE, FIVE._replace(E0=3e3)])
def test_a_point_relaxes_exactly_whatever_the_step(material, dt):
    t = dt * np.arange(1, round(5 / dt) + 1)

    states = strained(material, (0.0, 0.1), np.minimum(1.0, t / 2.0), dt)

    found = np.array([state.stress[1, 0] for state in states])
    expected = 0.1 * isotropic(0.35)[1, 1] * push_and_hold(material, np.where(t < 2.01, np.minimum(t, 2.0), t), 2.0)
    assert found == pytest.approx(expected, rel=1e-12)
    for x, y, z, _ in (state.stress[:, 0] for state in states):
        assert z == pytest.approx(0.35 * (x + y), rel=1e-12)


def crept(E, c, c0, pull, t, steps):
    """Return the strain of one cell without lateral contraction that is pulled from t = 0 on."""
    block = Block(CELL, Material((Maxwell(E, c, 0.0),), c0=c0, nu_c=0.0))
    top, held = CELL.where(CELL.points[:, 1] == 1.0), hold((range(4), 0.0, None), ([0, 2], None, 0.0))
    force, state = np.zeros((4, 2)), rest(block)
    force[top, 1] = pull / 2
    for _ in range(steps):
        state = advance(block, state, held, t / steps, force)
    return state.u[top[0], 1]


def test_creep_is_of_first_order_in_the_step():
    E, c, c0, pull, t = 60e3, 300e3, 6e3, 1e3, 1.0
    k = E / c0 + E / c
    q = E / c0 / k  # what the branch bears of the pull in the end
    strain = pull / c0 * ((1.0 - q) * t + q / k * (1.0 - np.exp(-k * t)))

    errors = np.array([crept(E, c, c0, pull, t, steps) / strain - 1.0 for steps in (10, 20, 40, 80)])

    assert errors[1:] == pytest.approx(errors[:-1] / 2, rel=0.15)
    assert abs(errors[-1]) < 0.01


@given(material=materials(one_nu=False), dt=st.floats(1e-3, 10.0))
def test_the_matrix_of_a_step_is_positive_definite(material, dt):
    assert np.linalg.eigvalsh(update_of(material, dt).C).min() > 0.0


@given(material=materials(one_nu=False), dt=st.floats(1e-3, 1.0))
def test_two_half_steps_at_one_rate_are_one_step(material, dt):
    half, whole = (strained(material, (0.02, -0.03), np.linspace(0, 1, n + 1)[1:], dt / n)[-1] for n in (2, 1))

    free_of_z = [0, 1, 3] if material.plane == "strain" else []  # along z the strain's rate is not constant
    scale = np.abs(whole.stress).max()
    assert half.stress[free_of_z] == pytest.approx(whole.stress[free_of_z], abs=1e-10 * scale)


def test_a_very_slow_branch_is_a_spring_and_a_very_fast_one_a_dashpot():
    slow, fast = (update_of(Material((Maxwell(1e4, c),)), 0.01) for c in (1e13, 1e-4))

    assert pytest.approx(1e4 * isotropic(0.35), rel=1e-9) == slow.C
    assert pytest.approx(1e-4 / 0.01 * isotropic(0.35), rel=1e-5) == fast.C


def z_strain(material, rate, t):
    """Return the strain along z of plane stress, by integrating all components of spring and branches at a point."""
    spring, dashpot = material.E0 * isotropic(material.nu0), material.c0 * isotropic(material.nu_c)
    parts = [(branch.E * isotropic(branch.nu), branch.E / branch.c) for branch in material.branches]

    def slopes(t, y):
        q = y[1:].reshape(-1, 4)
        past = spring @ [*(rate * t), y[0], 0.0] + q.sum(axis=0)
        change = np.array([*rate, 0.0, 0.0])
        change[2] = -(past[2] + dashpot[2] @ change) / dashpot[2, 2]
        return np.r_[change[2], *(C @ change - k * each for (C, k), each in zip(parts, q, strict=True))]

    return solve_ivp(slopes, (0.0, t), np.zeros(1 + 4 * len(parts)), rtol=1e-10, atol=1e-12).y[0, -1]


def test_plane_stress_leaves_none_along_z_where_poisson_ratios_differ():
    material, rate = MIXED._replace(plane="stress"), np.array([0.01, -0.02])
    true = z_strain(material, rate, 1.0)

    coarse, fine = (strained(material, rate, np.linspace(0, 1, n + 1)[1:], 1 / n)[-1] for n in (200, 400))

    assert not fine.stress[2].any()
    assert fine.strain[2] == pytest.approx(true, rel=2e-3)
    assert abs(fine.strain[2, 0] - true) == pytest.approx(abs(coarse.strain[2, 0] - true) / 2, rel=0.1)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"E0": -1.0}, r"E0 = -1 Pa, at least 0 Pa"),
        ({"c0": float("nan")}, r"c0 = nan Pa s is not a finite number"),
        ({"nu0": 0.5}, r"nu0 = 0\.5, must be above -1 and below 0\.5"),
        ({"nu_c": -1.0}, r"nu_c = -1, must be above -1"),
        ({"branches": (Maxwell(0.0, 1.0),)}, r"branches\[0\]\.E = 0 Pa, must be above 0 Pa"),
        ({"branches": (Maxwell(1.0, 1.0), Maxwell(1.0, -3.0))}, r"branches\[1\]\.c = -3 Pa s, must be above 0 Pa s"),
        ({"branches": (Maxwell(1.0, 1.0, 0.7),)}, r"branches\[0\]\.nu = 0\.7"),
        ({"branches": (Maxwell(1.0, 1.0, 0.3, 0.0),)}, r"branches\[0\]\.c_unloading = 0 Pa s, must be above"),
        ({"c0_unloading": -1.0}, r"c0_unloading = -1 Pa s, at least 0 Pa s"),
        ({"branches": (), "c0": 0.0}, r"the material resists nothing"),
        ({"branches": (), "c0_unloading": 0.0}, r"the material resists nothing"),
        ({"plane": "axial"}, r"plane 'axial' is not known: strain, stress"),
    ],
)
def test_a_material_that_cannot_be_is_refused_by_name(change, words):
    with pytest.raises(BlockError, match=words):
        checked(THREE._replace(**change))


@pytest.mark.parametrize("dt", [0.0, -0.1, float("nan"), float("inf")])
def test_a_step_of_no_length_is_refused(dt):
    with pytest.raises(BlockError, match=r"dt = .* s, must be above 0 s and finite"):
        update_of(THREE, dt)


@settings(max_examples=20)
@given(material=materials(), strain=st.tuples(st.floats(-0.1, 0.1), st.floats(-0.1, 0.1)))
def test_no_cycle_of_strain_yields_energy(material, strain):
    states = strained(material, strain, [1.0, 2.0, 2.0, 1.0, 0.0, -1.0, 0.5, 0.0], 0.2)

    moved = np.diff([np.zeros((4, 2))] + [state.u for state in states], axis=0)
    work = sum(float((state.force * move).sum()) for state, move in zip(states, moved, strict=True))
    assert work >= 0.0
