"""The supply: exact means of a pulsed current over any window."""

import numpy as np
import pytest

from hil_sim.physics.circuit import circuit_of, solve
from hil_sim.physics.window import window_charges
from hil_sim.supply import Supply

OFF = (0.0, 0.0)
PERIOD_US = 655.36


def supply_of(gates, resistance_ohm=(9.5, 9.5)):
    supply = Supply(np.full(len(gates), 0.5), source_ohm=0.02, shunt_ohm=0.02, voltage_v=2.0)
    supply.drive(gates, PERIOD_US)
    supply.solve(np.array(resistance_ohm))
    return supply


def test_without_a_gate_nothing_flows_and_the_monitor_sees_the_supply():
    supply = supply_of([OFF, OFF])

    assert list(supply.power_w) == [0.0, 0.0]
    assert supply.steady_v() == (0.0, 2.0)


def test_a_coil_that_is_always_on_draws_a_steady_current():
    supply = supply_of([(0.0, 1.0), OFF])

    current_a = 2.0 / (9.5 + 0.5 + 0.02)
    assert supply.current_a == pytest.approx(current_a)
    assert supply.steady_v() == pytest.approx((0.02 * current_a, 2.0 - 0.02 * current_a))


def test_coils_that_take_turns_draw_a_current_with_ripple():
    supply = supply_of([(0.0, 0.25), (0.5, 0.25)])

    assert supply.steady_v() is None
    assert supply.current_a == pytest.approx(0.5 * 2.0 / 10.02)


def test_an_open_coil_takes_nothing():
    supply = supply_of([(0.0, 1.0), (0.0, 1.0)], (np.inf, 9.5))

    assert supply.power_w[0] == 0.0
    assert supply.current_a == pytest.approx(2.0 / 10.02)


@pytest.mark.parametrize(("begun", "t_0", "t_1"), [(0, 0, 10_624), (1234, 5000, 9999), (77, 90, 95)])
def test_the_charge_in_alternating_windows_is_that_of_a_fine_sum(begun, t_0, t_1):
    circuit = circuit_of(np.full(2, 0.5), 0.02, 2.0)
    solve(circuit, np.array([0.1, 0.9]), np.array([0.3, 0.4]), np.array([9.0, 11.0]), np.empty(2))

    seen = window_charges(circuit, PERIOD_US, begun, t_0, t_1, 332, 140)

    t = np.arange(t_0, t_1, 0.01) + 0.005
    edges, intervals = circuit.edges, int(circuit.intervals[0])
    current = circuit.current[np.searchsorted(edges[1:intervals], (t / PERIOD_US) % 1.0, side="right")]
    in_first = (t - begun) % 472 < 332
    expected = (current[in_first].sum() * 0.01, current[~in_first].sum() * 0.01, (~in_first).sum() * 0.01)
    assert seen == pytest.approx(expected, rel=1e-3, abs=1e-3)  # one step of the sum at each edge
