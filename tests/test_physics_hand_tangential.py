"""Two soft fingers that hold by friction: the experiment of the paper, sticking, slipping and what is refused."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from hil_sim.physics.hand.fingertip import ContactLost, HandError, OutOfRange, springs
from hil_sim.physics.hand.friction import slipped
from hil_sim.physics.hand.geometry import meet
from hil_sim.physics.hand.grasp_tangential import STEP, carry
from hil_sim.physics.hand.numbers import fingers_of
from tests.hand_samples import CUBE, PAPER, joints, narrow

CYCLES = (0, 10, 0, -10, 0, 10, 0, -10, 0)
SLIPPERY = CUBE._replace(contact="coulomb", mu=0.15)
VARIED = (  # what is other than in the experiment, psi at a swing of 10 deg, and how near
    ({}, -7.775, 1e-3),
    ({"contact": "coulomb", "mu": 0.3}, -7.775, 1e-3),
    ({"g": 9.81}, -7.775, 2e-3),
    ({"k": 0.33}, -10.39, 5e-3),
    ({"k": 3.0}, -7.23, 5e-3),
)


def swung(hand, *swing_deg, inward_deg=2.5, step=STEP):
    """Return what a hand does that grips and swings to these angles."""
    return carry(hand, *joints(inward_deg, (0, *swing_deg)), step)


def resultant(hand, held, i, q):
    """Return what the tips exert on the object at pose i of a path: force along x and y [N], moment [N m]."""
    fingers, pose = fingers_of(hand), (held.x[i], held.y[i], held.psi[i])
    n = np.array([np.cos(pose[2]), np.sin(pose[2])])
    t, force, moment = np.array([-n[1], n[0]]), np.zeros(2), 0.0
    for tip, s in ((0, 1), (1, -1)):
        sigma = meet.py_func(fingers, s, q[tip], *pose)[2]
        N, M, T = held.N[i, tip], held.M[i, tip], held.T[i, tip]
        force += -(N * s * n - T * s * t)
        moment += -(-N * s * sigma + M - hand.w / 2 * T)
    return [*force, moment]


def test_the_object_of_the_experiment_tilts_against_the_fingers_and_comes_back():
    held = swung(CUBE, 5, 10, 0, 10, 0, 10, 0)
    psi = np.degrees(held.psi)

    assert psi[1] == pytest.approx(-3.923, rel=1e-3)
    assert psi[[2, 4, 6]] == pytest.approx([-7.775] * 3, rel=1e-3)
    assert np.abs(psi[[0, 3, 5, 7]]).max() < 1e-6
    assert held.used[2] == pytest.approx([0.196, 0.196], rel=5e-3)
    assert held.d[2, 1] > held.d[2, 0]


@pytest.mark.parametrize(("other", "psi", "near"), VARIED)
def test_friction_gravity_and_shear_stiffness_change_the_tilt_as_computed_before(other, psi, near):
    held = swung(CUBE._replace(**other), 10)

    assert np.degrees(held.psi[1]) == pytest.approx(psi, abs=near)


@pytest.mark.parametrize(("width_mm", "psi"), [(30, -9.13), (34, -8.32), (40, -7.28), (45, -6.57)])
def test_a_wider_cube_tilts_less(width_mm, psi):
    assert np.degrees(swung(narrow(1e-3 * width_mm), 10).psi[1]) == pytest.approx(psi, abs=0.006)


def test_a_radial_tip_that_sticks_tilts_the_object_too():
    """So a tilt against the fingers does not tell the two tips apart; 6.16 was computed before, by other steps."""
    assert np.degrees(swung(CUBE._replace(tip="radial"), 10).psi[1]) == pytest.approx(-6.16, rel=5e-3)


def test_gravity_is_carried_by_the_friction_of_both_tips():
    held = swung(CUBE._replace(g=9.81), 0)

    assert held.along == "determined"
    assert held.T[1] == pytest.approx([0.5 * 0.030 * 9.81, -0.5 * 0.030 * 9.81], rel=1e-6)
    assert held.used[1].max() < 0.01


def test_the_answer_does_not_depend_on_the_step():
    coarse, fine = (swung(CUBE, 10, step=np.radians(step)).psi[1] for step in (0.5, 0.0625))

    assert np.degrees(coarse) == pytest.approx(np.degrees(fine), abs=1e-3)


def test_a_slippery_object_tilts_less_and_does_not_come_all_the_way_back():
    psi, used = np.degrees(swung(SLIPPERY, *CYCLES[1:]).psi), swung(SLIPPERY, *CYCLES[1:]).used

    assert psi[[1, 3, 5, 7]] == pytest.approx([-6.29, 6.29, -6.29, 6.29], rel=0.03)
    assert psi[[2, 4, 6, 8]] == pytest.approx([1.5, -1.5, 1.5, -1.5], rel=0.03)
    assert used[[1, 3, 5, 7]] == pytest.approx(0.150, rel=1e-3)


@pytest.mark.parametrize("mu", [0.05, 0.1, 0.19])
def test_the_loop_of_a_slippery_object_closes(mu):
    psi = swung(SLIPPERY._replace(mu=mu), *CYCLES[1:]).psi

    assert psi[5:] == pytest.approx(psi[1:5], abs=1e-6)


@given(
    w=st.floats(0.004, 0.06),
    mu=st.floats(0.02, 0.9),
    inward=st.floats(1, 6),
    swing=st.floats(-15, 15),
    tip=st.sampled_from(("nail", "radial")),
    g=st.sampled_from((0.0, 9.81)),
)
def test_forces_balance_and_friction_stays_within_its_bound(w, mu, inward, swing, tip, g):
    hand = narrow(w, PAPER)._replace(contact="coulomb", mu=mu, tip=tip, g=g, m=0.005)
    q_r, q_l = joints(inward, (0, swing, 0.5 * swing))
    try:
        held = carry(hand, q_r, q_l)
    except (OutOfRange, ContactLost):
        assume(False)

    assert held.used.max() <= mu + 1e-3
    for i in range(3):
        assert resultant(hand, held, i, (q_r[i], q_l[i])) == pytest.approx(
            [0, hand.m * g, 0], abs=1e-6 * held.N[i].max()
        )


@given(swing=st.floats(-15, 15), inward=st.floats(1, 4))
def test_the_mirrored_path_leads_to_the_mirrored_pose(swing, inward):
    hand = SLIPPERY._replace(g=9.81)
    there, mirrored = swung(hand, swing, inward_deg=inward), swung(hand, -swing, inward_deg=inward)

    assert mirrored.psi == pytest.approx(-there.psi, abs=1e-9)
    assert mirrored.y == pytest.approx(there.y, abs=1e-11)
    assert mirrored.T[:, ::-1] == pytest.approx(-there.T, abs=1e-6)


def test_the_torques_do_the_work_that_the_tips_store():
    """Sticking without gravity loses nothing: the work of the joints over a swing is the change of energy."""
    swing = np.linspace(0, 10, 401)
    held = carry(CUBE, *joints(2.5, swing), np.radians(0.025))
    middle = 0.5 * (held.torque[1:] + held.torque[:-1]).sum(axis=1)

    assert -(middle * np.diff(np.radians(swing))).sum() == pytest.approx(held.U[-1] - held.U[0], rel=1e-5)


@given(
    d=st.floats(0.001, 0.005), theta=st.floats(-0.5, 0.5), d_t=st.floats(-0.02, 0.02), mu=st.floats(0, 0.7),
    b=st.sampled_from((0.0, 1.0)), k=st.floats(0.4, 3),
)  # fmt: skip
def test_a_slipping_tip_bears_its_bound_and_what_is_left_of_its_way(d, theta, d_t, mu, b, k):
    fingers = fingers_of(CUBE._replace(contact="coulomb", mu=mu))._replace(b=b, k=k)
    kept, by_d, by_theta, by_way = slipped(fingers, d, theta, d_t)
    assume(by_way < 1)
    bare = (kept - by_way * d_t) / (1 - by_way)
    _, N, _, T, *_ = springs.py_func(b, 1.0, k, d, theta, bare)
    h = 1e-7

    assert abs(T) == pytest.approx(mu * N, rel=1e-9, abs=1e-15)
    assert by_d == pytest.approx((slipped(fingers, d + h, theta, d_t)[0] - kept) / h, rel=1e-4, abs=1e-6)
    assert by_theta == pytest.approx((slipped(fingers, d, theta + h, d_t)[0] - kept) / h, rel=1e-3, abs=1e-6)


def test_an_object_without_width_cannot_stick():
    with pytest.raises(HandError, match=r"contact 'stick' with w = 0 m is over-constrained"):
        carry(PAPER._replace(contact="stick"), *joints(8, (0, 1)))


def test_what_the_friction_does_not_carry_slides_out_of_the_fingers():
    heavy = SLIPPERY._replace(m=3.0, g=9.81)

    with pytest.raises(ContactLost, match=r"friction of ratio 0\.15 does not carry the object"):
        swung(heavy, 1)


def test_a_grip_that_opens_loses_contact():
    with pytest.raises(ContactLost, match=r"finger R: d = .* mm, must be above 0 mm|does not carry"):
        carry(CUBE, *joints((2.5, 1, 0, -1), 0))


def test_a_tip_pressed_to_its_edge_by_the_swing_is_out_of_range():
    with pytest.raises(OutOfRange, match=r"finger [RL]: d = .* mm at theta = .* deg, at most"):
        swung(CUBE, 40)


def test_a_path_needs_friction_and_steps():
    with pytest.raises(HandError, match="contact 'frictionless' carries nothing along the faces"):
        swung(CUBE._replace(contact="frictionless"), 1)
    with pytest.raises(HandError, match=r"step = 0 rad, must be above 0 rad"):
        swung(CUBE, 1, step=0)
