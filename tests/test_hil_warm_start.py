"""A robot whose power was gone for an instant does not take hot coils for cold."""

from contextlib import suppress

import pytest

from hil_sim.clock import Clock
from hil_sim.devices.remanence import FULL_V, Remanence
from host.errors import SoftrigError
from tests.hil_rig import HilRig
from tests.invariants import TRIP_MARGIN_K


@pytest.fixture
def cell():
    """A capacitor and its clock."""
    clock = Clock()
    return Remanence(clock), clock


def after(clock, seconds):
    """Let time pass."""
    clock.run_until(clock.now_us + round(seconds * 1e6))


def test_a_board_that_never_closed_its_supply_is_cold(cell):
    remanence, clock = cell
    after(clock, 1000)

    assert remanence.level() == 1


def test_a_supply_that_was_closed_is_remembered_for_a_minute(cell):
    remanence, clock = cell
    remanence.feed(1)
    after(clock, 1)
    remanence.feed(0)

    levels = []
    for _ in range(4):
        after(clock, 30)
        levels.append(remanence.level())

    assert levels == [0, 0, 1, 1]


def test_the_voltage_follows_its_resistors(cell):
    remanence, clock = cell
    remanence.feed(1)
    after(clock, 0.1)  # 1 kohm * 100 uF
    assert remanence.voltage_v() == pytest.approx(FULL_V * 0.6321, rel=1e-3)

    remanence.feed(0)
    after(clock, 100)  # 1 Mohm * 100 uF
    assert remanence.voltage_v() == pytest.approx(FULL_V * 0.6321 * 0.3679, rel=1e-3)


@pytest.mark.parametrize("robot", ["circular", "sphere-a", "sphere-b"])
def test_bursts_with_a_power_cycle_after_each_heat_no_coil_beyond_its_limit(robot):
    """Without the capacitor four bursts reach 155, 247 and 179 C."""
    rig = HilRig(f"sim:{robot}?body=still")
    coil, trip_degc = rig.bench.plant.labels[0], rig.robot.profile.coil.trip_degc
    peak_degc = 0.0
    for _ in range(4):
        with suppress(SoftrigError):  # it trips, and says so
            rig.fire(coil, duty_percent=100, hold_s=2.0)
            rig.run(seconds=2.2)
        peak_degc = max(peak_degc, rig.bench.coil(coil).peak_degc)
        rig.happens("power-cycle")
        rig.bench.run(0.1)
        rig.connect_again()
    rig.link.close()

    assert peak_degc < trip_degc + TRIP_MARGIN_K


def test_after_a_pause_the_robot_starts_cold(rig):
    rig.fire("A", duty_percent=100, hold_s=0.5)
    rig.run(seconds=1)
    rig.robot.disarm()
    rig.run_alone(seconds=90)
    rig.happens("power-cycle")
    rig.bench.run(0.1)

    rig.connect_again()
    rig.fire("A", duty_percent=50, hold_s=0.3)
    rig.run(seconds=0.5)

    assert rig.robot.status().code == 0
