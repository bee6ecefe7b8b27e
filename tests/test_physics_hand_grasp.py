"""Two soft fingers without friction: Figure 13 of the paper, the gain law, other geometries and what is refused."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.optimize import minimize

from hil_sim.physics.hand.fingertip import ContactLost, HandError, OutOfRange, deepest, pressed
from hil_sim.physics.hand.geometry import centre, meet
from hil_sim.physics.hand.grasp import grasp
from hil_sim.physics.hand.numbers import HandNumbers, fingers_of
from tests.hand_samples import PAPER, joints
from tests.test_physics_hand_fingertip import integral

TABLE = (  # facts of Figure 13: inward and swing deg, psi deg, U mJ, d_r and d_l mm, N, K_psi N m/rad
    (4, 0, 0.0, 28.429052, 3.557580, 3.557580, 11.98668, 0.45104),
    (8, 0, 0.0, 229.113541, 7.097828, 7.097828, 48.41908, 1.70765),
    (8, 10, -1.329601, 225.170741, 6.768780, 7.161020, 48.49404, 1.72062),
    (8, 20, -2.588097, 213.519958, 6.189405, 6.958104, 48.72101, 1.75996),
    (8, -20, 2.588097, 213.519958, 6.958104, 6.189405, 48.72101, 1.75996),
)
OTHERS = (  # what is other than in the paper, and psi at a swing of 20 deg
    ({"L": 0.0561}, -2.88),
    ({"L": 0.0459}, -2.30),
    ({"a": 0.022, "B": 0.022}, -2.33),
    ({"a": 0.018, "B": 0.018}, -2.91),
    ({"B": 0.021}, -3.31),
    ({"B": 0.019}, -1.84),
    ({"w": 0.010, "B": 0.025}, -2.02),
    ({"w": 0.020, "B": 0.030}, -1.66),
    ({"w": 0.040, "B": 0.040}, -1.22),
    ({"e": 0.002, "B": 0.022}, -4.87),
    ({"e": 0.005, "B": 0.025}, -8.29),
    ({"e": 0.010, "B": 0.030}, -14.02),
    ({"E": 3e6}, -2.588),
)
RADIAL = PAPER._replace(tip="radial")


@st.composite
def grasps(draw):
    """Draw a hand of any geometry, and angles at which its tips hold the object within the model's range."""
    a, L, w = draw(st.floats(0.005, 0.04)), draw(st.floats(0.03, 0.2)), draw(st.floats(0, 0.06))
    e, squeeze = draw(st.floats(-0.004, 0.01)), draw(st.floats(0.02, 0.6))
    hand = HandNumbers(a=a, E=draw(st.floats(1e4, 1e7)), L=L, B=a + w / 2 + e, e=e, w=w)
    inward = np.degrees(np.arcsin(min(0.9, squeeze * a / L)))
    q_r, q_l = joints(inward, draw(st.floats(-25, 25)))
    q_r = q_r + np.radians(draw(st.floats(-2, 2)))
    hand = hand._replace(tip=draw(st.sampled_from(("nail", "radial"))))
    try:
        return hand, q_r, q_l, grasp(hand, q_r, q_l)
    except (OutOfRange, ContactLost):
        assume(False)


def energy(hand, pose, q, store=lambda d, theta, hand: pressed(d, theta, hand.a, hand.E).U):
    """Return the energy of both tips around an object at x, y, psi."""
    met = [meet.py_func(fingers_of(hand), s, angle, *pose) for s, angle in zip((1, -1), q, strict=True)]
    return sum(float(store(d, theta, hand)) for d, theta, _ in met)


@pytest.mark.parametrize(("inward", "swing", "psi", "U", "d_r", "d_l", "N", "K"), TABLE)
def test_the_object_rests_as_in_figure_13(inward, swing, psi, U, d_r, d_l, N, K):
    found = grasp(PAPER, *joints(inward, swing))

    assert np.degrees(found.psi[0]) == pytest.approx(psi, abs=1e-6)
    assert found.U[0] == pytest.approx(1e-3 * U, rel=1e-7)
    assert found.d[0] == pytest.approx([1e-3 * d_r, 1e-3 * d_l], abs=1e-9)
    assert found.N[0] == pytest.approx([N, N], abs=1e-5)
    assert found.K_psi[0] == pytest.approx(K, abs=1e-5)


def test_between_phases_0_and_1_the_energy_rises_and_the_object_stands():
    inward = np.linspace(0.1, 8, 80)
    found = grasp(PAPER, *joints(inward, 0))

    assert (np.diff(found.U) > 0).all()
    assert np.abs(np.degrees(found.psi)).max() < 1e-9
    assert np.abs(found.d[:, 0] - found.d[:, 1]).max() < 1e-12
    assert found.torque[-1] == pytest.approx([-2.477541, 2.477541], rel=1e-6)
    phi = np.radians(inward)
    assert pytest.approx(2 * np.pi * PAPER.E / 3 * PAPER.L**3 * np.sin(phi) ** 3 / np.cos(phi) ** 2) == found.U


def test_the_object_turns_against_the_fingers_and_the_energy_falls_on_either_side():
    swing = np.linspace(-20, 20, 81)
    found = grasp(PAPER, *joints(8, swing))

    assert (np.diff(found.psi) < 0).all()
    assert found.U.argmax() == 40
    assert (np.sign(found.d[:, 1] - found.d[:, 0]) == np.sign(swing))[swing != 0].all()


@given(hold=grasps())
def test_the_mirrored_grasp_rests_mirrored(hold):
    hand, q_r, q_l, found = hold
    mirrored = grasp(hand, -q_l, -q_r)

    assert mirrored.psi == pytest.approx(-found.psi, rel=1e-9, abs=1e-12)
    assert mirrored.d == pytest.approx(found.d[:, ::-1], rel=1e-9, abs=1e-13)
    assert pytest.approx(found.U, rel=1e-9) == mirrored.U


@given(hold=grasps())
def test_forces_and_moments_on_the_object_balance(hold):
    hand, q_r, q_l, found = hold
    q = (float(q_r), float(q_l))
    sigma = [
        meet.py_func(fingers_of(hand), s, a, found.x[0], found.y[0], found.psi[0])[2]
        for s, a in zip((1, -1), q, strict=True)
    ]
    moment = -found.N[0, 0] * sigma[0] + found.N[0, 1] * sigma[1] + found.M.sum()

    assert found.N[0, 0] == pytest.approx(found.N[0, 1], rel=1e-9)
    assert moment == pytest.approx(0.0, abs=1e-9 * found.N[0, 0] * hand.a)


@given(hold=grasps())
def test_the_depths_add_up_to_what_the_fingers_leave_no_room_for(hold):
    hand, q_r, q_l, found = hold
    fingers = fingers_of(hand)
    between = np.subtract(centre.py_func(fingers, 1, float(q_r)), centre.py_func(fingers, -1, float(q_l)))
    n = np.array([np.cos(found.psi[0]), np.sin(found.psi[0])])

    assert found.d[0].sum() == pytest.approx(2 * hand.a + hand.w - n @ between, abs=1e-12)
    assert (found.d[0] <= deepest(hand.a, found.theta[0, 0]) + hand.a).all()


@given(hold=grasps(), dx=st.floats(-1, 1), turn=st.floats(-1, 1))
def test_no_pose_nearby_stores_less(hold, dx, turn):
    hand, q_r, q_l, found = hold
    pose = np.array([found.x[0], found.y[0], found.psi[0]])
    near = pose + 0.01 * found.d.min() * np.array([dx, 0, turn / hand.a])
    q = (float(q_r), float(q_l))
    store = lambda d, theta, hand: pressed(d, theta, 1e3, hand.E, nail=hand.tip == "nail").U  # noqa: E731

    assert energy(hand, near, q, store) >= found.U[0] * (1 - 1e-12)


@given(hold=grasps())
def test_the_torques_are_what_the_energy_says(hold):
    """The object at rest, moving it changes no energy: the total derivative by a joint is the partial one."""
    hand, q_r, q_l, found = hold
    h = 1e-6

    for i, step in enumerate(((h, 0), (0, h))):
        ahead, behind = (grasp(hand, q_r + sign * step[0], q_l + sign * step[1]).U[0] for sign in (1, -1))
        assert found.torque[0, i] == pytest.approx(
            -(ahead - behind) / (2 * h), rel=1e-4, abs=1e-4 * found.N[0, 0] * hand.a
        )


@given(hold=grasps())
def test_the_answer_does_not_depend_on_the_stiffness_of_the_rubber(hold):
    hand, q_r, q_l, found = hold
    harder = grasp(hand._replace(E=7 * hand.E), q_r, q_l)

    assert harder.psi == pytest.approx(found.psi, rel=1e-9, abs=1e-12)
    assert pytest.approx(7 * found.U, rel=1e-9) == harder.U


def test_the_gain_of_the_paper_follows_the_law():
    found = grasp(PAPER, *joints(8, 0.5))

    assert np.degrees(found.psi[0]) / 0.5 == pytest.approx(-0.134169, rel=1e-3)


@given(
    a=st.floats(0.005, 0.04),
    L=st.floats(0.04, 0.2),
    w=st.floats(0, 0.06),
    e=st.floats(-0.002, 0.01),
    squeeze=st.floats(0.05, 0.4),
)
def test_the_gain_law_holds_for_any_geometry(a, L, w, e, squeeze):
    phi = np.arcsin(min(0.5, squeeze * a / L))
    hand = HandNumbers(a=a, E=0.3e6, L=L, B=a + w / 2 + e, e=e, w=w)
    d, h = L * np.sin(phi) - e * (1 - np.cos(phi)), 1e-4

    gain = (grasp(hand, phi + h, h - phi).psi[0] - grasp(hand, phi - h, -h - phi).psi[0]) / (2 * h)

    assert gain == pytest.approx(-(d + 3 * e) / (3 * a + 1.5 * w - d), rel=1e-5, abs=1e-5)


@pytest.mark.parametrize(("other", "psi"), OTHERS)
def test_another_geometry_turns_the_object_by_another_angle(other, psi):
    found = grasp(PAPER._replace(**other), *joints(8, 20))

    assert np.degrees(found.psi[0]) == pytest.approx(psi, abs=0.006)


def test_the_place_along_the_faces_is_undetermined():
    """The Hessian over x, y, psi, lengths in units of the radius, has an eigenvalue of zero."""
    q = [float(angle) for angle in joints(8, 0)]
    found = grasp(PAPER, *q)
    pose, unit = np.array([found.x[0], found.y[0], found.psi[0]]), np.array([PAPER.a, PAPER.a, 1.0])
    H, h = np.empty((3, 3)), 1e-4
    for i in range(3):
        for j in range(3):
            corners = [
                (s * t, pose + h * unit * (s * np.eye(3)[i] + t * np.eye(3)[j])) for s in (1, -1) for t in (1, -1)
            ]
            H[i, j] = sum(sign * energy(PAPER, corner, q) for sign, corner in corners) / (4 * h * h)

    assert found.along == "undetermined"
    assert np.linalg.eigvalsh(H) == pytest.approx([0, 1.703, 10.947], abs=2e-3)
    assert np.linalg.eigvalsh(H)[0] == pytest.approx(0, abs=1e-5)


def test_a_minimiser_that_knows_only_the_integral_of_the_paper_finds_the_same_rest():
    q = [float(angle) for angle in joints(8, 20)]
    found = grasp(PAPER, *q)

    best = minimize(
        lambda u: (
            1e3 * energy(PAPER, (0.001 * u[0], found.y[0], 0.1 * u[1]), q, lambda d, theta, hand: integral(d, theta))
        ),
        (-17.0, 0.0),
        method="Nelder-Mead",
        options={"xatol": 1e-8, "fatol": 1e-12},
    )

    assert np.degrees(0.1 * best.x[1]) == pytest.approx(np.degrees(found.psi[0]), abs=1e-5)
    assert best.fun == pytest.approx(1e3 * found.U[0], rel=1e-9)


def test_a_tip_that_knows_depth_alone_follows_the_line_of_the_centres():
    found = grasp(RADIAL, *joints(8, 20))

    assert np.degrees(found.psi[0]) == pytest.approx(-10.321169, abs=1e-6)
    assert found.d[0] == pytest.approx([6.450532e-3, 6.450532e-3], abs=1e-9)
    assert found.d[0, 0] == pytest.approx(found.d[0, 1], abs=1e-12)


@pytest.mark.parametrize("power", [2.0, 2.5, 3.0])
def test_so_does_every_law_of_depth_alone_also_that_of_hertz(power):
    q = [float(angle) for angle in joints(8, 20)]
    y = grasp(RADIAL, *q).y[0]

    best = minimize(
        lambda u: energy(RADIAL, (1e-3 * u[0], y, 0.1 * u[1]), q, lambda d, theta, hand: (200 * d) ** power),
        (-17.0, 0.0),
        method="Nelder-Mead",
        options={"xatol": 1e-8, "fatol": 1e-14},
    )

    assert np.degrees(0.1 * best.x[1]) == pytest.approx(-10.321169, abs=1e-4)


def test_the_nail_effect_stiffens_the_grip_and_reduces_turn_and_instability():
    nail, radial = (grasp(hand, *joints(8, [0, 10, 20])) for hand in (PAPER, RADIAL))

    assert nail.U[2] / nail.U[0] == pytest.approx(0.932, abs=5e-4)
    assert radial.U[2] / radial.U[0] == pytest.approx(0.751, abs=5e-4)
    assert nail.K_psi[0] == pytest.approx(1.707650, abs=1e-6)
    assert radial.K_psi[0] == pytest.approx(1.225222, abs=1e-6)
    assert nail.d[2, 1] - nail.d[2, 0] == pytest.approx(0.769e-3, abs=5e-7)
    falls = [float(found.U[0] - found.U[1]) for found in (nail, radial)]
    assert falls[1] / falls[0] == pytest.approx(4, rel=0.05)


def test_ten_thousand_poses_take_four_steps_of_newton_at_most():
    found = grasp(PAPER, *joints(8, np.linspace(-20, 20, 10_001)))

    assert found.psi.shape == (10_001,)
    assert found.iterations.max() == 4


@pytest.mark.parametrize(
    ("inward", "swing", "error", "text"),
    [
        (-1, 0, ContactLost, r"finger R: d = -0\.8901 mm, must be above 0 mm"),
        (30, 0, OutOfRange, r"finger R: d = 25\.5000 mm at theta = -30\.000 deg, at most .* = 10\.0000 mm"),
        (8, 45, OutOfRange, r"finger R: d = .* mm at theta = .* deg, at most"),
        (float("nan"), 0, HandError, r"finger R: q = nan rad is not a finite number"),
    ],
)
def test_poses_that_cannot_be_are_refused_by_finger_value_and_limit(inward, swing, error, text):
    with pytest.raises(error, match=text):
        grasp(PAPER, *joints(inward, swing))


@pytest.mark.parametrize(
    ("other", "text"),
    [
        ({"w": -0.003}, r"w = -0\.003 m, at least 0 m"),
        ({"a": 0.0}, r"a = 0 m, must be above 0 m"),
        ({"E": float("nan")}, r"E = nan Pa is not a finite number"),
        ({"e": float("inf")}, r"e = inf m is not a finite number"),
        ({"tip": "nails"}, r"tip 'nails' is not known: nail, radial"),
    ],
)
def test_numbers_of_a_hand_that_cannot_be_are_refused_by_name(other, text):
    with pytest.raises(HandError, match=text):
        grasp(PAPER._replace(**other), *joints(8, 0))
