"""The soft tip: the paper's integral, its closed form, its range, and the nail effect."""

from math import pi, radians, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hil_sim.physics.hand.fingertip import ContactLost, HandError, OutOfRange, deepest, pressed, springs

A, E = 0.020, 0.30e6
TILT = st.floats(-radians(50), radians(50))
SHARE = st.floats(0.01, 1.0)  # of the greatest displacement
HEIGHTS, WEIGHTS = np.polynomial.legendre.leggauss(60)


def integral(d, theta, d_t=0.0):
    """Return the energy by quadrature over the ellipse S of the paper, with springs that are sheared by d_t too."""
    rho, c, s = np.sqrt(A**2 - (A - d) ** 2), np.cos(theta), np.sin(theta)
    angle, phi = 0.25 * pi * (HEIGHTS[:, None] + 1), 2 * pi * np.arange(128) / 128
    r = np.sin(angle)  # where the range ends, the integrand has a root at the edge
    x, y = (A - d) * s + rho * c * r * np.cos(phi), rho * r * np.sin(phi)
    length = np.sqrt(A**2 - x**2 - y**2)
    short = length - (A - d - x * s) / c
    strain = short**2 + 2 * short * s * d_t + d_t**2
    return float(
        (0.5 * E * strain / length * rho**2 * c * r * np.cos(angle) * WEIGHTS[:, None]).sum() * 0.25 * pi * 2 * pi / 128
    )


@pytest.mark.parametrize(
    ("d_mm", "theta_deg", "U_mj", "N", "M_mnm"),
    [(5, 20, 44.47216300, 26.68329780, 32.37308717), (8, 10, 165.85054987, 62.19395620, 58.48785341)],
)
def test_energy_force_and_moment_are_those_of_the_closed_form(d_mm, theta_deg, U_mj, N, M_mnm):
    tip = pressed(1e-3 * d_mm, radians(theta_deg), A, E)

    assert pytest.approx(1e-3 * U_mj, rel=1e-9) == tip.U
    assert pytest.approx(N, rel=1e-9) == tip.N
    assert pytest.approx(1e-3 * M_mnm, rel=1e-9) == tip.M


@given(share=st.floats(0.01, 0.95), theta=TILT)
def test_the_closed_form_is_the_integral_of_the_paper(share, theta):
    d = share * deepest(A, theta)

    assert pytest.approx(integral(d, theta), rel=1e-6) == pressed(d, theta, A, E).U


@given(share=st.floats(0.01, 0.95), theta=TILT, d_t=st.floats(-0.005, 0.005))
def test_a_sheared_tip_stores_the_integral_of_springs_stretched_by_both_displacements(share, theta, d_t):
    d = share * deepest(A, theta)

    scale = pi * E * d * (d**2 + d_t**2)  # the terms may cancel
    assert pytest.approx(integral(d, theta, d_t), abs=1e-6 * scale) == pressed(d, theta, A, E, d_t).U


@given(share=SHARE, theta=TILT, d_t=st.floats(-0.005, 0.005), nail=st.booleans(), k=st.floats(0.3, 3))
def test_the_derivatives_are_those_of_the_energy(share, theta, d_t, nail, k):
    d, h = 0.99 * share * deepest(A, theta), 1e-20  # complex steps have no rounding

    found = np.array(springs.py_func(float(nail), E, k, d, theta, d_t))
    stepped = [
        [value.imag / h for value in springs.py_func(float(nail), E, k, *np.add((d, theta, d_t), step))]
        for step in 1j * h * np.eye(3)
    ]

    assert found[1:4] == pytest.approx([step[0] for step in stepped], rel=1e-12, abs=1e-12)
    assert found[[4, 5, 6]] == pytest.approx([step[1] for step in stepped], rel=1e-12, abs=1e-12)
    assert found[[5, 7, 8]] == pytest.approx([step[2] for step in stepped], rel=1e-12, abs=1e-12)
    assert found[[6, 8, 9]] == pytest.approx([step[3] for step in stepped], rel=1e-12, abs=1e-12)


@given(share=SHARE, theta=TILT)
def test_the_energy_is_convex_everywhere(share, theta):
    tip = pressed(0.999 * share * deepest(A, theta), theta, A, E)

    assert tip.N_d * tip.M_theta > tip.N_theta**2


def test_the_nail_effect_rights_a_tilted_tip_and_a_radial_tip_is_neutral():
    theta = np.radians([-30, -10, 0, 10, 30])
    nail, radial = pressed(0.005, theta, A, E), pressed(0.005, theta, A, E, nail=False)

    assert pytest.approx(2 * pi * E * 0.005**3 * np.sin(theta) / (3 * np.cos(theta) ** 3)) == nail.M
    assert (np.diff(nail.U[2:]) > 0).all()
    assert (radial.M == 0).all()
    assert pytest.approx(np.full(5, pi * E * 0.005**3 / 3)) == radial.U


@given(share=SHARE, theta=TILT)
def test_a_tip_relaxed_along_its_face_stores_another_energy_than_a_guided_one(share, theta):
    d = 0.99 * share * deepest(A, theta)

    relaxed = pressed(d, theta, A, E, d_t=-0.5 * d * np.tan(theta))

    assert pytest.approx(0.0, abs=1e-9) == relaxed.T
    assert pytest.approx(pi * E * d**3 * (3 + np.cos(theta) ** -2) / 12) == relaxed.U


def test_the_range_ends_where_the_cut_reaches_the_edge_of_the_plate():
    assert deepest(A, radians(20)) == pytest.approx(13.159597e-3, abs=1e-8)
    assert pressed(13.1595e-3, radians(20), A, E).U > 0

    with pytest.raises(OutOfRange, match=r"d = 14\.0000 mm at theta = 20\.000 deg, at most .* = 13\.1596 mm"):
        pressed(0.014, radians(20), A, E)


def test_a_face_tilted_by_more_than_a_right_angle_is_out_of_range():
    with pytest.raises(OutOfRange):
        pressed(0.001, radians(100), A, E)


def test_a_tip_above_its_face_has_lost_contact():
    with pytest.raises(ContactLost, match=r"d = -1 mm, must be above 0 mm"):
        pressed([0.001, -0.001], 0.0, A, E)


@pytest.mark.parametrize(
    ("numbers", "text"),
    [
        ({"a": -0.02}, r"a = -0\.02 m, must be positive"),
        ({"E": 0.0}, r"E = 0 Pa, must be positive"),
        ({"k": float("nan")}, r"k = nan, must be positive and finite"),
        ({"d": float("nan")}, r"d = nan is not a finite number"),
        ({"theta": float("inf")}, r"theta = inf is not a finite number"),
    ],
)
def test_numbers_that_cannot_be_are_refused_by_name(numbers, text):
    with pytest.raises(HandError, match=text):
        pressed(**{"d": 0.005, "theta": 0.0, "a": A, "E": E, **numbers})


def test_springs_of_the_paper_have_no_length_left_exactly_where_the_range_ends():
    theta = radians(25)
    d = deepest(A, theta)

    assert (A - d) == pytest.approx(A * abs(sin(theta)))  # the cut meets the plate at its edge, x = a
