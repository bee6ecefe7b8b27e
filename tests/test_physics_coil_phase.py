"""The change of phase: where it happens, that stress moves it, and that its minor loops are closed."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hil_sim.physics.coilset import coils_of
from hil_sim.physics.phase import ramp, settle
from hil_sim.physics.spring import tension
from tests.coil_samples import ring_coil

COIL = coils_of(ring_coil(), 1)
SLACK = COIL.L_A[0]  # no pull at any fraction
TAUT = 0.015
LATENT_RISE = COIL.Q[0] / COIL.C[0]  # K that a full change warms or cools the wire by

TEMPERATURE = st.floats(20, 140)
LENGTH = st.floats(0.0085, 0.022)


def through(temperatures, L, xi=1.0):
    """Return the fractions along a path of given temperatures."""
    path = []
    for T in temperatures:
        xi = settle(0, xi, T, 0.0, L, COIL)
        path.append(xi)
    return path


def test_a_wire_without_load_turns_to_austenite_between_68_and_78_degrees():
    assert through([67.9, 73, 78.1], SLACK) == pytest.approx([1, 0.5, 0], abs=1e-3)


def test_it_turns_back_between_52_and_42_degrees():
    assert through([80, 52.1, 47, 41.9], SLACK) == pytest.approx([0, 0, 0.5, 1], abs=1e-3)


def test_a_pull_shifts_the_transformation_by_its_shear_stress_over_69_mpa_a_kelvin():
    xi = 0.5
    F, _ = tension(0, TAUT, xi, COIL)
    shifted = 73 + F / COIL.c_F[0]

    assert F > 0
    assert through([shifted], TAUT)[-1] == pytest.approx(xi, abs=1e-9)


@settings(deadline=None)  # the first call compiles
@given(a=TEMPERATURE, b=TEMPERATURE, before=st.lists(TEMPERATURE, max_size=5), L=LENGTH)
def test_minor_loops_are_closed(a, b, before, L):
    path = through([*before, a, b, a, b, a, b], L)

    assert path[-2:] == pytest.approx(path[-4:-2], abs=1e-9)


@settings(deadline=None)  # the first call compiles
@given(T=TEMPERATURE, before=st.lists(TEMPERATURE, max_size=5), L=LENGTH)
def test_a_ripple_of_the_temperature_does_not_ratchet(T, before, L):
    """The multiplicative minor loops of the literature transform a coil that should stand still."""
    after_one = through([*before, T + 0.15, T - 0.15], L)[-1]
    after_many = through([*before, *[T + 0.15, T - 0.15] * 500], L)[-1]

    assert after_many == pytest.approx(after_one, abs=1e-9)


@settings(deadline=None)  # the first call compiles
@given(start=TEMPERATURE, end=TEMPERATURE, L=LENGTH)
def test_the_fraction_depends_on_the_path_and_not_on_the_number_of_steps(start, end, L):
    at_once = through([start, end], L)[-1]
    gradually = through(np.linspace(start, end, 60), L, through([start], L)[-1])[-1]

    assert gradually == pytest.approx(at_once, abs=1e-9)


@settings(deadline=None)  # the first call compiles
@given(xi=st.floats(0, 1), T=TEMPERATURE, L=LENGTH, B=st.floats(0, 60))
def test_the_coil_ends_each_step_between_the_two_envelopes(xi, T, L, B):
    end = settle(0, xi, T, B, L, COIL)

    s = T + B * (end - xi) - tension(0, L, end, COIL)[0] / COIL.c_F[0]
    lower, upper = ramp(s, 42.0, 52.0)[0], ramp(s, 68.0, 78.0)[0]
    assert lower - 1e-9 <= end <= upper + 1e-9
    assert end == pytest.approx(np.clip(xi, lower, upper), abs=1e-9)


@settings(deadline=None)  # the first call compiles
@given(s=st.floats(42.01, 51.99))
def test_the_slope_of_a_ramp_is_its_derivative(s):
    step = 1e-6

    rise = ramp(s + step, 42.0, 52.0)[0] - ramp(s - step, 42.0, 52.0)[0]

    assert ramp(s, 42.0, 52.0)[1] == pytest.approx(rise / (2 * step), abs=1e-6)


def test_latent_heat_holds_the_temperature_back_during_the_change():
    T = 90.0
    xi = settle(0, 1.0, T, LATENT_RISE, SLACK, COIL)

    reached = T + LATENT_RISE * (xi - 1.0)

    assert 0.3 < xi < 0.7
    assert 68 < reached < 78
