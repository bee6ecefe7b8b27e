"""Presses of other shapes, materials and meshes: punches glued and free, wedges, force control, rates, refusals."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hil_sim.physics.block.block import hold
from hil_sim.physics.block.indenters import Cylinder, Polygon, Punch
from hil_sim.physics.block.law import recovery
from hil_sim.physics.block.mesh import mesh_of
from hil_sim.physics.block.press import surface_of
from hil_sim.physics.block.step import advance
from tests.block_samples import HEIGHT, THREE
from tests.press_samples import MATERIALS, MESHES, assert_contact, press_of, program, run

WEDGE = Polygon(((-6e-3, 3e-3), (0.0, 0.0), (9e-3, 2e-3)))
SHAPES = {"punch": Punch(width=0.020), "cylinder": Cylinder(R=0.015), "wedge": WEDGE}
REFUSED = (
    (lambda: press_of(Punch(width=1e-3), at=0.0388), "no surface node lies below the indenter, 0.001 m wide"),
    (lambda: press_of(at=0.2), "no surface node .* from x = 0 to 0.08 m"),
    (lambda: press_of(at=np.nan), "at = nan m is not a finite number"),
    (lambda: press_of(rate=0.0), "rate = 0 m/s, must be above 0 m/s"),
    (lambda: press_of(least=0.001), "least = 0.001 m, must be below 0 m"),
    (lambda: press_of(most=-0.001), "most = -0.001 m, must be above 0 m"),
    (lambda: press_of().start(depth=0.001), "begins at depth = 0.001 m, must be from -0.01 to 0 m"),
    (lambda: press_of(Punch(width=0.02, bonded=True)).start(depth=-0.001), "must be from 0 to 0 m"),
    (lambda: run(press_of(), [{}]), "a depth or to a force: give one"),
    (lambda: run(press_of(), [{"depth": 0.001, "force": 1.0}]), "give one of them"),
    (lambda: run(press_of(most=0.004), [{"depth": 0.005}]), "depth = 0.005 m, must be from -0.01 to 0.004 m"),
    (lambda: run(press_of(), [{"depth": np.nan}]), "depth = nan m"),
    (lambda: run(press_of(), [{"force": -1.0}]), "force = -1 N, at least 0 N"),
    (lambda: run(press_of(), [{"force": np.inf}]), "force = inf N is not a finite number"),
    (
        lambda: run(press_of(), [{"depth": 0.041}]),
        "depth = 0.041 m: the indenter meets what the block stands on at 0.04",
    ),
    (lambda: run(press_of(), [{"force": 1e5}]), "the indenter meets what the block stands on at 0.04 m"),
    (lambda: run(press_of(), [{"depth": 0.001}], dt=0.0), "dt = 0 s, must be above 0 s"),
)


@pytest.mark.parametrize(("do", "reason"), REFUSED, ids=[reason for _, reason in REFUSED])
def test_what_a_press_cannot_do_is_refused_by_name(do, reason):
    with pytest.raises(ValueError, match=reason):
        do()


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("material", MATERIALS)
def test_contact_holds_in_every_step_for_any_material_and_shape(material, shape):
    press = press_of(SHAPES[shape], material=MATERIALS[material], at=0.035)
    states = run(press, ({"depth": program(0.05 * k, held=2.5)} for k in range(1, 70)), 0.05)

    for state in states[1:]:
        assert_contact(press, state)
    assert states[40].force > 1.0
    assert states[-1].force == 0.0


@pytest.mark.parametrize("mesh", MESHES)
@pytest.mark.parametrize("shape", SHAPES)
def test_contact_holds_on_irregular_meshes_with_a_hill(shape, mesh):
    press = press_of(SHAPES[shape], mesh=MESHES[mesh], material=MATERIALS["five"], at=0.043)
    states = run(press, ({"depth": program(0.05 * k, held=2.5)} for k in range(1, 70)), 0.05)

    for state in states[1:]:
        assert_contact(press, state)
    assert states[40].force > 1.0


@settings(max_examples=20)
@given(
    st.lists(st.tuples(st.sampled_from(("depth", "force")), st.floats(0.0, 1.0)), min_size=1, max_size=12),
    st.sampled_from(sorted(MATERIALS)),
    st.sampled_from(sorted(SHAPES)),
    st.floats(0.02, 0.06),
)
def test_whatever_is_ordered_nothing_pulls_and_nothing_is_inside(orders, material, shape, at):
    press = press_of(SHAPES[shape], columns=16, material=MATERIALS[material], at=at, rate=0.05, most=0.005)
    scale = {"depth": 0.005, "force": 10.0}

    states = run(press, ({what: share * scale[what]} for what, share in orders), 0.03)

    for before, state in pairwise(states):
        assert_contact(press, state)
        assert abs(state.depth - before.depth) <= 0.05 * 0.03 * (1 + 1e-9)
        assert press.axis.least <= state.depth <= press.axis.most


def test_a_flat_punch_presses_as_if_held_while_all_its_nodes_press():
    press = press_of(Punch(width=0.020))
    states = run(press, ({"depth": 1e-4 * k} for k in range(1, 41)), 0.05)
    bottom, block = press.supports.dofs[::2] // 2, press.start().block

    for k, state in enumerate(states[1:], 1):
        held = hold((bottom, 0.0, 0.0), (press.nodes, None, -1e-4 * k))
        block = advance(press.block, block, held, 0.05)
        assert state.active.all()
        assert state.force == pytest.approx(-block.force[press.nodes, 1].sum(), rel=1e-12)


def test_a_glued_punch_does_what_a_held_surface_does_also_when_it_is_released():
    """Scenario A: pushed 4 mm in 2 s, held for 3 s, released."""
    press = press_of(Punch(width=0.020, bonded=True))
    orders = [{"depth": min(2e-3 * 0.05 * k, 4e-3)} for k in range(1, 101)]
    states = run(press, orders, 0.05)
    after = run(press, [{"depth": press.axis.least}] * 40, 0.05, press.release(states[-1]))
    bottom, block = press.supports.dofs[::2] // 2, press.start().block
    for state, order in zip(states[1:], orders, strict=True):
        held = hold((bottom, 0.0, 0.0), (press.nodes, 0.0, -order["depth"]))
        block = advance(press.block, block, held, 0.05)
        assert state.force == pytest.approx(-block.force[press.nodes, 1].sum(), rel=1e-11)
    for state in after[1:]:
        block = advance(press.block, block, press.supports, 0.05)
        assert state.block.u == pytest.approx(block.u, abs=1e-15)

    assert states[40].force == pytest.approx(9.8788, abs=1e-4)  # at 2 s
    residual = -after[-1].block.u[press.nodes, 1]
    assert residual == pytest.approx(4e-3 * recovery(THREE, 2.0, 2.0, 3.0), rel=5e-4)


def test_a_glued_punch_pulls_and_a_free_one_does_not():
    glued, free = (press_of(Punch(width=0.020, bonded=bonded)) for bonded in (True, False))

    assert run(glued, [{"depth": -1e-3}])[-1].force < -1.0
    assert run(free, [{"depth": -1e-3}])[-1].force == 0.0


def test_glue_that_has_let_go_does_not_hold_again():
    press = press_of(Punch(width=0.020, bonded=True))
    states = run(press, [{"depth": 1e-3}])
    states = run(press, [{"depth": 1e-3}, {"depth": -1e-3}], state=press.release(states[-1]))

    assert states[1].force > 1.0
    assert states[2].force == 0.0
    assert_contact(press, states[1])


@pytest.mark.parametrize("indenter", [Cylinder(R=0.015), Punch(width=0.020), Punch(width=0.020, bonded=True), WEDGE])
def test_the_force_of_a_depth_leads_back_to_the_depth(indenter):
    press = press_of(indenter, material=MATERIALS["five"])
    depths = [program(0.05 * k, push=1.5) for k in range(1, 71)]
    states = run(press, ({"depth": depth} for depth in depths), 0.05)

    found = run(press, ({"force": state.force} for state in states[1:]), 0.05)

    assert [state.depth for state in found[1:]] == pytest.approx(depths, abs=1e-12)
    assert found[-1].block.u == pytest.approx(states[-1].block.u, abs=1e-12)


def test_under_a_constant_force_the_block_creeps():
    states = run(press_of(rate=0.010), [{"force": 4.0}] * 150)
    depth = np.array([state.depth for state in states])
    reached = int(np.argmax([state.force > 4.0 - 1e-9 for state in states]))

    assert 0.1 < 0.02 * reached < 1.0
    assert all(state.force == pytest.approx(4.0, rel=1e-10) for state in states[reached:])
    assert (np.diff(depth[reached:]) > 0.0).all()


def test_in_force_control_a_raised_shape_comes_down_at_its_rate_and_stays_at_no_force():
    press = press_of(rate=0.010)
    states = run(press, [{"force": 0.0}] * 30, state=press.start(depth=-0.004))

    assert [state.depth for state in states[:21]] == pytest.approx(-0.004 + 0.0002 * np.arange(21), abs=1e-12)
    assert [state.depth for state in states[20:]] == pytest.approx([0.0] * 11, abs=1e-12)
    assert all(state.force == 0.0 for state in states)


def test_the_axis_goes_no_faster_than_its_rate_and_no_deeper_than_its_end():
    press = press_of(rate=0.010, most=0.003)

    down = run(press, [{"depth": 0.003}] * 20 + [{"force": 100.0}] * 2)
    up = run(press, [{"depth": -0.010}] * 10, state=down[-1])

    assert [state.depth for state in down[:16]] == pytest.approx(0.0002 * np.arange(16), abs=1e-12)
    assert [state.depth for state in down[15:]] == pytest.approx([0.003] * 8, abs=1e-12)
    assert [state.depth for state in up] == pytest.approx(0.003 - 0.0002 * np.arange(11), abs=1e-12)


def test_a_glued_punch_pulls_no_further_than_the_upper_end_of_its_axis():
    press = press_of(Punch(width=0.020, bonded=True), rate=0.010, least=-0.0005)

    up = run(press, [{"force": -100.0}] * 5)

    assert [state.depth for state in up] == pytest.approx([0.0, -0.0002, -0.0004, -0.0005, -0.0005, -0.0005], abs=1e-12)


def test_a_shape_above_the_block_presses_when_it_gets_there():
    states = run(press_of(), ({"depth": -0.002 + 1e-4 * k} for k in range(1, 31)), state=press_of().start(-0.002))

    assert all(state.force == 0.0 for state in states[:21])
    assert all(state.force > 0.0 for state in states[21:])
    assert states[10].gap.min() == pytest.approx(0.001, abs=1e-12)


def test_a_second_push_meets_the_dent_of_the_first():
    press = press_of()
    depths = [program(0.05 * k, held=2.5) for k in range(1, 90)] + [program(0.05 * k) for k in range(1, 41)]
    states = run(press, ({"depth": depth} for depth in depths), 0.05)
    dent = -states[89].block.u[press.nodes, 1].min()
    again = next(state for state in states[90:] if state.force > 0.0)

    assert states[40].force > states[129].force > 0.0
    assert again.depth == pytest.approx(dent, abs=2e-4)  # within two steps


def test_after_a_release_steps_are_cut_until_the_block_has_settled():
    press, whole = press_of(), []
    for dt in (0.05, 0.005):
        down = run(press, ({"depth": program(0.05 * k)} for k in range(1, 41)), 0.05)
        after = run(press, [{"depth": -0.010}] * round(1.0 / dt), dt, press.release(down[-1]))
        whole.append(after[-1].block.u)

    assert whole[0] == pytest.approx(whole[1], abs=2e-6)
    assert press.release(down[-1]).gap.min() > 0.009


def test_a_cut_step_is_ten_short_ones_at_an_even_speed():
    press = press_of(rate=0.10)
    freed = press.release(run(press, [{"depth": 2e-3}])[-1])
    short = freed._replace(block=freed.block._replace(settled=0.0))
    for what in ({"depth": 2e-3}, {"force": 5.0}):
        whole = run(press, [what] * 6, 0.03, freed)[-1]
        ways = -0.010 + 0.10 * 0.003 * np.arange(1, 61)
        orders = [{"depth": min(way, 2e-3)} for way in ways] if "depth" in what else [what] * 60
        parts = run(press, orders, 0.003, short)[-1]

        assert whole.force == pytest.approx(parts.force, rel=1e-10)
        assert whole.force > 1.0


def test_a_surface_is_what_faces_upwards():
    points = [(0, 0), (4, 0), (4, 1), (3, 2), (1, 2), (0, 1), (2, 1)]
    around = [(k, (k + 1) % 6, 6) for k in range(6)]

    assert surface_of(mesh_of(points, around)).tolist() == [5, 4, 3, 2]
    assert surface_of(MESHES["distorted"]).size == 25


def test_the_shape_begins_at_the_highest_point_below_it():
    press = press_of(mesh=MESHES["distorted"])

    beside = press_of(Punch(width=0.010), mesh=MESHES["distorted"], at=0.005)

    assert beside.begin == pytest.approx(HEIGHT * (1 + 0.03 * np.sin(np.pi / 8)))
    assert press.begin == press.block.mesh.points[:, 1].max() == pytest.approx(1.03 * HEIGHT)
    assert press.start().gap.min() >= 0.0
