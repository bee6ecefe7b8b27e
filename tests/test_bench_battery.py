"""A battery on board: it sags, runs down and dies as a battery does, and takes board and coils with it."""

import numpy as np
import pytest

from hil_sim.faults.happening import schedule
from hil_sim.physics.battery import BatteryNumbers, open_voltage
from hil_sim.supply import Battery, Supply
from tests.bench_fakes import bench_of

HEATING = "begin()\nbeat.toggle()\nset_output(0, 1000)\nwhile True: beat_for(1000)"
HOUR_US = 3_600_000_000


def battery_of(z=0.5, cells=2.0, Q=36.0, r=0.5, V_cut=5.6, I_board=0.0):
    return Battery(BatteryNumbers(cells, Q, z, r, V_cut, I_board))


def supply_of(battery, gates=((0.0, 1.0),)):
    supply = Supply(np.full(len(gates), 0.5), 0.02, 0.02, 0.0, battery)
    supply.drive(gates, 655.36)
    supply.solve(np.full(len(gates), 28.5))
    return supply


@pytest.fixture
def bench(tmp_path):
    bench = bench_of(tmp_path, HEATING, battery=battery_of())
    yield bench
    bench.close()


def test_the_voltage_of_a_cell_is_that_of_the_source_and_falls_with_its_charge():
    """Chen and Rincon-Mora's figure: 4.1 V full, 3.8 V at half charge, 2.65 V empty."""
    charges = np.linspace(0.0, 1.0, 101)

    volts = [open_voltage(z, 1.0) for z in charges]

    assert [volts[100], volts[50], volts[0]] == pytest.approx([4.103, 3.803, 2.654], abs=0.001)
    assert all(np.diff(volts) > 0)


def test_a_battery_sags_by_its_internal_resistance():
    supply = supply_of(battery_of())

    current_a = open_voltage(0.5, 2.0) / (28.5 + 0.5 + 0.02 + 0.5)
    assert supply.current_a == pytest.approx(current_a)
    shunt_v, bus_v = supply.steady_v()
    assert bus_v == pytest.approx(open_voltage(0.5, 2.0) - 0.52 * current_a)
    assert shunt_v == pytest.approx(0.02 * current_a)


def test_a_battery_gives_the_charge_it_has_lost():
    supply = supply_of(battery_of(Q=3600.0))

    supply.spend(HOUR_US // 10)

    assert 0.5 - supply.battery.charge == pytest.approx(supply.current_a * 360 / 3600)


def test_the_board_runs_the_battery_down_while_no_coil_is_on():
    supply = supply_of(battery_of(I_board=0.01), [(0.0, 0.0)])

    supply.spend(HOUR_US // 10)

    assert supply.battery.charge == pytest.approx(0.4)
    assert supply.stale
    supply.solve(np.array([28.5]))
    assert supply.steady_v()[1] == pytest.approx(open_voltage(0.4, 2.0) - 0.5 * 0.01)


def test_the_protection_opens_under_a_load_that_the_open_voltage_would_bear_and_stays_open():
    battery = battery_of(z=0.005)
    assert open_voltage(0.005, 2.0) > 5.6
    supply = supply_of(battery, [(0.0, 1.0)] * 4)

    supply.spend(5000)
    supply.drive([(0.0, 0.0)] * 4, 655.36)
    supply.solve(np.full(4, 28.5))

    assert battery.cut
    assert supply.steady_v() == (0.0, 0.0)


def test_a_bench_supply_does_not_run_down():
    supply = Supply(np.full(1, 0.5), 0.02, 0.02, 2.0)
    supply.drive([(0.0, 1.0)], 655.36)
    supply.solve(np.array([9.5]))

    supply.spend(HOUR_US)

    assert not supply.stale
    assert supply.steady_v()[1] == pytest.approx(2.0, rel=0.01)


def test_a_run_draws_the_battery_down_and_says_so(bench):
    bench.run(10)

    drawn_as = 7.55 / (9.5 + 0.5 + 0.02 + 0.5) * 10  # at the mean of its voltages at 50 and 30 %
    assert bench.observe()["battery_percent"] == pytest.approx(100 * (0.5 - drawn_as / 36), abs=0.2)
    assert bench.supply.steady_v()[1] == pytest.approx(7.49 * 10.0 / 10.52, abs=0.02)


def test_a_battery_at_its_end_takes_coils_and_board_with_it(bench):
    schedule(bench, 500_000, "battery-empty")

    bench.run(2.0)

    assert bench.coil_gate("A") == 0
    assert bench.coil("A").off_at_us == pytest.approx(500_000, abs=10_000)
    assert not bench.world.running
    assert bench.supply.power_w.tolist() == [0.0] * 8
    assert bench.crashes == []


def test_switching_a_dead_battery_off_and_on_does_not_revive_it(bench):
    schedule(bench, 500_000, "battery-empty")
    schedule(bench, 1_000_000, "power-cycle")

    bench.run(2.0)

    assert not bench.world.running
    assert bench.coil("A").off_at_us < 600_000


def test_a_robot_on_a_bench_supply_has_no_battery_to_be_empty(tmp_path):
    bench = bench_of(tmp_path, HEATING)

    with pytest.raises(ValueError, match="fault battery-empty: this robot has no battery"):
        schedule(bench, 0, "battery-empty")
    assert "battery_percent" not in bench.observe()
    bench.close()
