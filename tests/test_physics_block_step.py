"""Steps of a block: patch test, the bonded punch against its closed forms, release, equilibrium, dual modulus."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hil_sim.physics.block.block import Block, hold
from hil_sim.physics.block.law import push_and_hold, recovery
from hil_sim.physics.block.material import BlockError, Material, Maxwell
from hil_sim.physics.block.mesh import rectangle
from hil_sim.physics.block.step import accept, advance, attempt, release, rest, substeps
from tests.block_samples import (
    DEPTH,
    FIVE,
    HOLD_S,
    MIXED,
    PUSH_S,
    THICK,
    THREE,
    block_of,
    distorted,
    ends,
    materials,
    pressed,
    scattered,
)


def elastic_force(mesh, plane, nu, width=0.020):
    """Return the force of the bonded punch on an elastic block of modulus 1 pushed by DEPTH, per thickness THICK."""
    block = Block(mesh, Material(E0=1.0, nu0=nu, plane=plane), THICK)
    (bottom, punch), state = ends(mesh, width), rest(block)
    state = advance(block, state, hold((bottom, 0.0, 0.0), (punch, 0.0, -DEPTH)), 1.0)
    return -state.force[punch, 1].sum()


@pytest.mark.parametrize("plane", ["strain", "stress"])
@pytest.mark.parametrize("material", [THREE, MIXED])
def test_a_distorted_mesh_passes_the_patch_test(plane, material):
    mesh = distorted(7, 5, seed=3)
    block, gradient = Block(mesh, material._replace(plane=plane), THICK), np.array([[0.01, -0.03], [0.02, 0.015]])
    linear = mesh.points @ gradient.T

    state = rest(block)
    for share in (0.5, 1.0, 1.0):
        parts = [([node], *(share * linear[node])) for node in mesh.boundary]
        state = advance(block, state, hold(*parts), 0.1)

    assert state.u == pytest.approx(linear, abs=1e-12 * np.abs(linear).max())
    assert state.stress == pytest.approx(np.tile(state.stress[:, :1], mesh.area.size), rel=1e-12, abs=1e-8)
    assert np.abs(state.force[np.setdiff1d(np.arange(mesh.nodes), mesh.boundary)]).max() < 1e-12 * state.force.max()


def test_a_pulled_bar_has_the_stress_of_the_pull_in_every_triangle():
    mesh = distorted(8, 4, seed=5)
    block, (x, y) = Block(mesh, MIXED._replace(plane="stress"), THICK), mesh.points.T
    right = mesh.where(x == x.max())
    share = np.gradient(np.sort(y[right]))[np.argsort(np.argsort(y[right]))]
    share[(y[right] == 0.0) | (y[right] == y.max())] /= 2.0
    forces = np.zeros((mesh.nodes, 2))
    forces[right, 0] = 500.0 * THICK * share

    state = rest(block)
    for _ in range(3):
        state = advance(block, state, hold((mesh.where(x == 0.0), 0.0, None), ([0], None, 0.0)), 0.5, forces)

    assert state.stress[0] == pytest.approx(np.full(mesh.area.size, 500.0), rel=1e-9)
    assert np.abs(state.stress[1:]).max() < 1e-6


@pytest.mark.parametrize(("columns", "force"), [(16, 10.3276), (32, 9.878779802), (64, 9.6687), (128, 9.5678)])
def test_the_bonded_punch_needs_the_listed_force(columns, force):
    (state,) = pressed(block_of(columns, columns // 2), [PUSH_S], 0.5)

    assert -state.force[ends(block_of(columns, columns // 2).mesh)[1], 1].sum() == pytest.approx(force, abs=5e-5)


@pytest.mark.parametrize("mesh", [rectangle(0.08, 0.04, 80, 40), distorted(64, 32, share=0.2), distorted(96, 48, 2)])
def test_the_force_lies_in_the_band_on_other_meshes(mesh):
    unit = elastic_force(mesh, "strain", 0.35)

    assert 9.46 < unit * push_and_hold(THREE, PUSH_S, PUSH_S) < 9.70


def test_the_force_converges_with_first_order_from_above():
    forces = [elastic_force(block_of(n, n // 2).mesh, "strain", 0.35) for n in (16, 32, 64)]

    coarse, fine = -np.diff(forces)
    assert np.log2(coarse / fine) == pytest.approx(1.06, abs=0.1)


@settings(max_examples=20)
@given(material=materials(), seed=st.integers(0, 99), dt=st.sampled_from([0.1, 0.25, 0.5]))
def test_the_bonded_punch_follows_the_law_of_one_dimension(material, seed, dt):
    mesh, times_s = scattered(60, seed), [0.5, 1.0, 2.0, 3.0, 5.0]
    unit = elastic_force(mesh, material.plane, material.nu0, width=0.040)

    states = pressed(Block(mesh, material, THICK), times_s, dt, width=0.040)

    found = [-state.force[ends(mesh, 0.040)[1], 1].sum() for state in states]
    assert found == pytest.approx(unit * push_and_hold(material, times_s, PUSH_S), rel=1e-9)


@settings(max_examples=15)
@given(material=st.one_of(materials(), materials(dashpot=False)), seed=st.integers(0, 99))
def test_a_block_set_free_recovers_as_the_law_of_one_dimension(material, seed):
    mesh, after_s = scattered(40, seed), np.array([0.5, 2.0, 10.0])

    states = pressed(Block(mesh, material, THICK), PUSH_S + HOLD_S + after_s, 0.1, width=0.040)

    shape = states[0].u / np.abs(states[0].u).max()
    depths = recovery(material, after_s, PUSH_S, HOLD_S)
    for state, depth in zip(states, depths, strict=True):
        share = state.u[ends(mesh, 0.040)[1], 1].mean() / -DEPTH
        assert share == pytest.approx(depth, abs=0.012)  # backward differences of c0
        assert state.u == pytest.approx(shape * np.abs(state.u).max(), abs=1e-9)


@pytest.mark.parametrize(("dt", "tolerance"), [(0.05, 5e-4), (0.1, 1e-3)])
def test_the_residual_of_scenario_a_is_the_listed_one(dt, tolerance):
    (state,) = pressed(block_of(32, 16), [25.0], dt)

    depth = -state.u[ends(block_of(32, 16).mesh)[1], 1]
    assert depth == pytest.approx(np.full(depth.size, 2.226155e-3), rel=tolerance)
    assert np.abs(state.stress).max() < 1e-8  # a residual shape without residual stress


@pytest.mark.parametrize(("E0", "depths_mm"), [(1e3, (2.1835, 2.1211, 1.8353)), (5e3, (2.0273, 1.7693, 0.8957))])
def test_with_a_spring_in_parallel_the_punch_mark_fades(E0, depths_mm):
    block = block_of(16, 8, THREE._replace(E0=E0))

    states = pressed(block, [6.0, 15.0, 60.0], 0.1)

    found = [-1e3 * state.u[ends(block.mesh)[1], 1].mean() for state in states]
    assert found == pytest.approx(depths_mm, rel=2e-3)


def test_different_poisson_ratios_leave_stress_that_relaxes_and_a_shape_that_stays():
    block = block_of(16, 8, MIXED._replace(E0=0.0))

    soon, late, later = pressed(block, [5.3, 30.0, 40.0], 0.1)

    assert np.abs(soon.stress).max() > 100.0
    assert np.abs(late.stress).max() < 1e-9
    assert later.u == pytest.approx(late.u, abs=1e-12)
    assert np.abs(late.u).max() > 0.5 * DEPTH


@settings(max_examples=10)
@given(material=materials(one_nu=False), seed=st.integers(0, 99))
def test_forces_and_moments_balance(material, seed):
    mesh = scattered(30, seed)
    state = pressed(Block(mesh, material, THICK), [4.0], 0.5, width=0.040)[0]

    (x, y), (fx, fy) = mesh.points.T, state.force.T
    scale = np.abs(state.force).sum()
    assert np.abs([fx.sum(), fy.sum()]).max() < 1e-9 * scale
    assert abs((x * fy - y * fx).sum()) < 1e-9 * scale * x.max()


def test_steps_are_cut_while_the_block_finds_its_shape_after_a_release():
    block = block_of(8, 4)
    state = pressed(block, [5.0], 0.1)[0]
    bottom = hold((ends(block.mesh)[0], 0.0, 0.0))

    assert substeps(state) == 1
    freed = advance(block, state, bottom, 0.1)
    assert substeps(freed) == 10
    assert freed.settled == pytest.approx(5.0 + 5.0 / block.fastest)
    for _ in range(5):
        freed = advance(block, freed, bottom, 0.1)
    assert substeps(freed) == 1
    assert freed.t == pytest.approx(5.6)


def test_what_is_held_moves_evenly_over_the_parts_of_a_step():
    block = block_of(8, 4)
    bottom, punch = ends(block.mesh)
    begin = release(block, pressed(block, [2.0], 0.5)[0])

    def down(share):
        return hold((bottom, 0.0, 0.0), (punch, 0.0, -DEPTH * (1.0 + share)))

    whole, state = advance(block, begin, down(1.0), 0.1), begin
    for part in range(1, 11):
        state = accept(attempt(block, state, down(part / 10), 0.01))

    assert whole.force == pytest.approx(state.force, rel=1e-12, abs=1e-12)
    assert whole.t == pytest.approx(state.t)


def test_a_material_that_settles_at_once_needs_no_cut_steps():
    block = block_of(8, 4, Material(E0=1e3))

    assert substeps(release(block, rest(block))) == 1


def test_an_attempt_becomes_a_step_with_forces_found_by_influence():
    """As contact does it: a force added by the influence is the same as one given from outside."""
    block, force = block_of(8, 4), np.zeros((45, 2))
    (bottom, punch), state = ends(block.mesh), rest(block)
    force[punch, 1] = -1.0

    tried = attempt(block, state, hold((bottom, 0.0, 0.0)), 0.1)
    du = tried.du + np.full(punch.size, -1.0) @ tried.stiffness.influence(2 * punch + 1)
    given_force = attempt(block, state, hold((bottom, 0.0, 0.0)), 0.1, force)

    assert du == pytest.approx(given_force.du, abs=1e-15)


def test_viscosities_of_unloading_that_are_the_same_change_nothing():
    twin = THREE._replace(c0_unloading=6e3, branches=(Maxwell(60e3, 300e3, 0.35, 300e3),))

    plain, dual = (pressed(block_of(8, 4, each), [7.0], 0.1)[0] for each in (THREE, twin))

    assert dual.u == pytest.approx(plain.u, abs=1e-15)


@settings(max_examples=10)
@given(share=st.floats(0.1, 10.0), c_share=st.floats(0.3, 3.0))
def test_a_dual_modulus_loads_with_one_set_of_viscosities_and_recovers_with_the_other(share, c_share):
    branches = tuple(branch._replace(c_unloading=c_share * branch.c) for branch in FIVE.branches)
    dual, block = FIVE._replace(c0_unloading=share * FIVE.c0, branches=branches), block_of(8, 4)

    loaded, plain = (pressed(Block(block.mesh, each, THICK), [5.0], 0.25)[0] for each in (dual, FIVE))
    freed = pressed(Block(block.mesh, dual, THICK), [15.0], 0.1)[0]

    assert loaded.force == pytest.approx(plain.force, abs=1e-12)
    depth = freed.u[ends(block.mesh)[1], 1].mean() / -DEPTH
    assert depth == pytest.approx(recovery(dual, 10.0, PUSH_S, HOLD_S), abs=0.012)


def test_a_punch_that_is_drawn_back_unloads_the_block_and_one_that_waits_changes_nothing():
    block = block_of(8, 4, THREE._replace(c0_unloading=3e3))
    (bottom, punch), state, flags = ends(block.mesh), rest(block), []

    for depth in (1e-3, 2e-3, 2e-3, 1.9e-3, 1.9e-3, 2.1e-3, 2.1e-3):
        state = advance(block, state, hold((bottom, 0.0, 0.0), (punch, 0.0, -depth)), 0.1)
        flags.append(state.unloading)

    assert flags == [False, False, False, True, True, False, False]


def test_a_step_that_cannot_be_is_refused():
    block = block_of(4, 2)
    with pytest.raises(BlockError, match=r"dt = 0 s, must be above 0 s"):
        advance(block, rest(block), hold((ends(block.mesh)[0], 0.0, 0.0)), 0.0)
    with pytest.raises(BlockError, match=r"free to move"):
        advance(block, rest(block), hold(), 0.1)
