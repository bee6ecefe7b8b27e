"""The coil as a spring: rates, stretch, slack, solid height and resistance, against the rows that are known."""

from math import pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hil_sim.physics.coilset import coils_of, joined
from hil_sim.physics.spring import force_and_tangent, resistance, tension
from tests.coil_samples import at_rest, ring_coil

COIL = coils_of(ring_coil(), 1)
GRAM_FORCE = 9.81e-3  # N
FRACTION = st.floats(0, 1)
LENGTH = st.floats(0.005, 0.030)


# Turns, then closed length and stretch in mm, rates in N/m and resistances in ohm: locomotion prototype.
@pytest.mark.parametrize(
    ("turns", "L_A", "dL", "k_A", "k_M", "R_A", "R_M"),
    [
        (88, 8.8, 11.2, 116, 42, 9.3, 10.1),
        (197, 19.7, 25.0, 51.8, 18.8, 20.8, 22.5),
        (273, 27.3, 34.7, 37.3, 13.6, 28.8, 31.3),
    ],
)
def test_the_coils_of_the_three_robots_have_the_rates_of_the_prototype(turns, L_A, dL, k_A, k_M, R_A, R_M):
    coils = coils_of(ring_coil(n=turns), 1)

    found = [coils.L_A * 1e3, coils.dL * 1e3, coils.k_A, coils.k_M, coils.R_A, coils.R_M]

    assert np.ravel(found) == pytest.approx([L_A, dL, k_A, k_M, R_A, R_M], rel=0.006)  # rows have three digits


@pytest.mark.parametrize(("stress_mpa", "force_n"), [(71, 0.09), (150, 0.20), (299, 0.39)])
def test_force_and_shear_stress_of_a_bmx100_coil_agree_with_the_derived_rows(stress_mpa, force_n):
    numbers = ring_coil()

    force = COIL.c_F[0] * stress_mpa * 1e6 / numbers.c_tau

    assert force == pytest.approx(force_n, rel=0.04)  # rows have two digits


def test_ten_millimetres_of_bmx100_hold_94_mm_of_wire_and_stretch_by_12_mm():
    numbers = ring_coil(n=100, gamma=0.0436, G_A=18e9)
    coils = coils_of(numbers, 1)

    assert numbers.L_w == pytest.approx(0.0942, rel=0.001)
    assert coils.dL[0] == pytest.approx(0.0124, rel=0.01)
    assert coils.k_A[0] == pytest.approx(83, rel=0.01)


def test_scaled_to_bmx150_it_meets_the_observed_resistance_and_stretch():
    """Observed on 20 mm samples: 9.5 to 10.8 ohm; 30 gf stretches them by 20 to 30 mm."""
    numbers = ring_coil(d=0.15e-3, D=0.47e-3, n=20 / 0.15)
    coils = coils_of(numbers, 1)

    stress = 8 * 30 * GRAM_FORCE * numbers.D / (pi * numbers.d**3)

    assert stress == pytest.approx(104e6, rel=0.01)  # inside the plateau of 71 to 299 MPa
    assert 9.4 < coils.R_A[0] < coils.R_M[0] < 10.9
    assert 0.020 < coils.dL[0] < 0.030


def test_scaled_up_it_is_the_measured_coil_from_which_its_numbers_come():
    """Kolyvas 2018: wire 0.51 mm, winding 3.45 mm, 7.5 to 8 turns: 50 and 80 gf/mm, 10.6 gf/K, 24 mm."""
    numbers = ring_coil(d=0.51e-3, D=3.45e-3, n=7.75, G_A=28.6e9, G_M=17.9e9, gamma=0.0436)
    coils = coils_of(numbers, 1)

    assert coils.k_M[0] == pytest.approx(50 * GRAM_FORCE * 1e3, rel=0.04)
    assert coils.k_A[0] == pytest.approx(80 * GRAM_FORCE * 1e3, rel=0.04)
    assert coils.c_F[0] == pytest.approx(10.6 * GRAM_FORCE, rel=0.02)
    assert coils.dL[0] == pytest.approx(0.024, rel=0.04)


def test_a_coil_that_is_shorter_than_its_free_length_hangs_slack():
    free = COIL.L_A[0] + 0.5 * COIL.dL[0]

    assert force_and_tangent(0, free - 1e-4, 0.5, COIL) == (0, 0)
    assert force_and_tangent(0, free + 1e-3, 0.5, COIL)[0] == pytest.approx(78.9e-3, rel=0.01)


def test_a_coil_in_a_guide_pushes_like_a_rod_below_its_solid_height():
    guided = coils_of(ring_coil(k_s=2000), 1)
    solid = (88.02 + 1) * 0.1e-3

    above, _ = force_and_tangent(0, solid + 1e-6, 1.0, guided)
    below, rate = force_and_tangent(0, solid - 1e-4, 1.0, guided)

    assert above == 0
    assert below == pytest.approx(-0.2)
    assert rate == 2000


def test_a_free_closed_coil_gives_way_under_its_buckling_load():
    """Its turns bend and twist in series, half of the wire each."""
    numbers, L = ring_coil(), COIL.L_s[0]
    G = np.array([numbers.G_M, numbers.G_A])
    E, moment = 2.66 * G, pi * numbers.d**4 / 64

    rigidity = L / (0.5 * numbers.L_w * (1 / (E * moment) + 1 / (2 * G * moment)))
    buckling = pi**2 * rigidity / L**2

    pushes = -force_and_tangent(0, L - 2e-3, 1.0, COIL)[0]
    assert buckling[0] < pushes < buckling[1]
    assert buckling == pytest.approx([1.2e-3, 3.3e-3], rel=0.05)


@settings(deadline=None)  # the first call compiles
@given(L=LENGTH, xi=FRACTION)
def test_the_tangent_is_the_derivative_of_the_force(L, xi):
    kinks = (COIL.L_A[0] + xi * COIL.dL[0], COIL.L_s[0])
    step = 1e-7
    if min(abs(L - kink) for kink in kinks) <= step:
        return

    rise = force_and_tangent(0, L + step, xi, COIL)[0] - force_and_tangent(0, L - step, xi, COIL)[0]

    assert force_and_tangent(0, L, xi, COIL)[1] == pytest.approx(rise / (2 * step), rel=1e-6, abs=1e-6)


@settings(deadline=None)  # the first call compiles
@given(L=LENGTH, xi=st.floats(1e-6, 1 - 1e-6))
def test_the_pull_falls_as_martensite_grows_at_the_stated_rate(L, xi):
    step = 1e-7
    if abs(L - COIL.L_A[0] - xi * COIL.dL[0]) <= step * COIL.dL[0]:
        return

    rise = tension(0, L, xi + step, COIL)[0] - tension(0, L, xi - step, COIL)[0]

    assert rise <= 0
    assert tension(0, L, xi, COIL)[1] == pytest.approx(rise / (2 * step), rel=1e-5, abs=1e-6)


def test_austenite_has_92_percent_of_the_resistance_of_martensite():
    closed = COIL.L_A[0]

    ratio = resistance(0, closed, 0.0, COIL) / coils_of(ring_coil(k_e=0), 1).R_M[0]

    assert ratio == pytest.approx(0.92, abs=0.005)


def test_stretch_raises_the_resistance_and_slack_does_not_lower_it():
    closed, full = COIL.L_A[0], COIL.L_A[0] + COIL.dL[0]

    assert resistance(0, full, 0.0, COIL) == pytest.approx(1.0225 * resistance(0, closed, 0.0, COIL))
    assert resistance(0, closed, 1.0, COIL) == resistance(0, full, 1.0, COIL)


def test_two_kinds_of_coil_stand_in_one_set():
    both = joined(coils_of(ring_coil(n=10), 2), coils_of(ring_coil(n=20), 1))
    state, _ = at_rest(both, 0.002)

    assert list(both.L_A * 1e3) == pytest.approx([1, 1, 2])
    assert state.R.shape == (3,)
