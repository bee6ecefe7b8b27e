"""Coils on one supply under PWM: what duty averages, what coils share, and what the current monitor sees."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hil_sim.physics.circuit import circuit_of, mean_current, mean_voltage, solve

FINE = 4096  # the PWM counter of the chip: edges on this grid are met exactly by sampling its cells


def solved(on, width, R, series=0.5, source=0.02, voltage=2.0):
    """Return the solved circuit and the mean power of each coil."""
    R = np.array(R, dtype=float)
    circuit = circuit_of(np.full(R.size, series), source, voltage)
    P = np.empty(R.size)
    solve(circuit, np.array(on, dtype=float), np.array(width, dtype=float), R, P)
    return circuit, P


def sampled(on, width, R, series=0.5, source=0.02, voltage=2.0):
    """Return power of each coil and current of the supply in each of the FINE cells of the period, the slow way."""
    on, width, R = np.array(on), np.array(width), np.array(R)
    phase = (np.arange(FINE)[:, None] + 0.5) / FINE
    G = np.where((phase - on) % 1.0 < width, 1 / (R + series), 0.0)
    U = voltage / (1 + source * G.sum(axis=1))
    return (U[:, None] * G) ** 2 * R, U * G.sum(axis=1)


counts = st.integers(0, FINE - 1).map(lambda count: count / FINE)
gates = st.lists(st.tuples(counts, st.one_of(counts, st.just(1.0)), st.floats(5, 12)), min_size=1, max_size=22).map(
    lambda rows: [list(column) for column in zip(*rows, strict=True)]
)


def test_duty_averages_power_and_not_voltage():
    _, full = solved([0], [1], [9.3], source=0)
    _, third = solved([0], [1 / 3], [9.3], source=0)

    assert full[0] == pytest.approx(2.0**2 * 9.3 / 9.8**2)
    assert third[0] == pytest.approx(full[0] / 3)


def test_coils_that_conduct_together_share_the_drop_over_the_source():
    _, together = solved([0, 0], [0.4, 0.4], [9.3, 9.3], source=1.0)
    _, in_turns = solved([0, 0.5], [0.4, 0.4], [9.3, 9.3], source=1.0)

    assert together[0] == pytest.approx(0.4 * 9.3 * (2 / (9.8 + 2)) ** 2)
    assert in_turns[0] == pytest.approx(0.4 * 9.3 * (2 / (9.8 + 1)) ** 2)


def test_a_pulse_that_wraps_around_the_period_gives_the_same_power():
    _, plain = solved([0.1], [0.3], [9.3])
    _, wrapped = solved([0.9], [0.3], [9.3])

    assert wrapped[0] == pytest.approx(plain[0])


def test_an_open_coil_takes_nothing_and_a_shorted_one_heats_only_its_wiring():
    circuit, P = solved([0, 0, 0], [1, 1, 0], [np.inf, 0.0, 9.3])

    assert list(P) == [0, 0, 0]
    assert mean_current(circuit, 0, 1) == pytest.approx(2 / 0.52)


def test_with_all_gates_off_there_is_no_current_and_the_full_voltage():
    circuit, P = solved([0, 0.5], [0, 0], [9.3, 9.3])

    assert list(P) == [0, 0]
    assert mean_current(circuit, 0.3, 0.9) == 0
    assert mean_voltage(circuit, 0.3, 0.9) == 2.0


def test_a_negative_resistance_is_refused():
    with pytest.raises(ValueError, match=r"at least 0"):
        circuit_of(np.array([0.5, -0.1]), 0.02, 2.0)


@settings(deadline=None)  # the first call compiles
@given(gates)
def test_the_powers_are_those_of_the_finely_sampled_period(columns):
    on, width, R = columns

    _, found = solved(on, width, R)

    assert found == pytest.approx(sampled(on, width, R)[0].mean(axis=0), rel=1e-9, abs=1e-12)


@settings(deadline=None)  # the first call compiles
@given(gates, st.integers(-2 * FINE, 2 * FINE), st.integers(1, 4 * FINE))
def test_the_mean_current_over_any_window_is_that_of_the_sampled_one(columns, first, cells):
    on, width, R = columns

    circuit, _ = solved(on, width, R)

    current = np.tile(sampled(on, width, R)[1], 8)[first + 2 * FINE :][:cells]
    found = mean_current(circuit, first / FINE, (first + cells) / FINE)
    assert found == pytest.approx(current.mean(), rel=1e-9, abs=1e-12)
    assert mean_voltage(circuit, first / FINE, (first + cells) / FINE) == pytest.approx(2.0 - 0.02 * found)


@settings(deadline=None)  # the first call compiles
@given(gates)
def test_the_supply_gives_what_coils_wiring_and_source_take(columns):
    on, width, R = columns
    circuit, P = solved(on, width, R)
    intervals = int(circuit.intervals[0])

    given_w = 2.0 * mean_current(circuit, 0, 1)

    in_source = 0.02 * np.sum(circuit.current[:intervals] ** 2 * np.diff(circuit.edges[: intervals + 1]))
    assert given_w == pytest.approx(np.sum(P * (1 + 0.5 / np.array(R))) + in_source, rel=1e-9, abs=1e-12)
