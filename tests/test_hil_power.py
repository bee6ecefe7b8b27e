"""Power that fails, on the whole path: an old battery on board of sphere A, a broken wire on sphere B."""

import pytest

from host.errors import LinkLost, Refused
from tests.hil_rig import HilRig


@pytest.fixture
def rig_of():
    rigs = []

    def built(address):
        rigs.append(HilRig(address))
        return rigs[-1]

    yield built
    for rig in rigs:
        rig.link.close()


def test_a_battery_near_its_end_heats_a_coil_less(rig_of):
    peaks = []
    for charge in (25, 3):
        rig = rig_of(f"sim:sphere-a?set=battery.charge_percent:{charge}")
        rig.fire("A00m1", duty_percent=100, hold_s=0.6)
        rig.run(seconds=1)
        peaks.append(rig.bench.coil("A00m1").peak_degc)

    assert peaks[1] < peaks[0] - 10


def test_a_battery_that_sags_below_its_limit_is_a_fault_and_the_coil_goes_off(rig_of):
    rig = rig_of("sim:sphere-a?set=battery.charge_percent:2")
    on_s = rig.fire("A00m1", duty_percent=100, hold_s=1)

    rig.run(seconds=1)

    with pytest.raises(Refused, match="F07"):
        rig.robot.arm()
    assert rig.coil("A00m1").off_at_s - on_s < 0.15
    assert rig.bench.world.running


def test_a_battery_that_dies_silences_the_robot_and_its_coil_is_off(rig_of):
    rig = rig_of("sim:sphere-a")
    on_s = rig.fire("A00m1", duty_percent=100, hold_s=5)
    rig.run(seconds=0.2)

    died_s = rig.happens("battery-empty")
    with pytest.raises(LinkLost):
        rig.robot.status()

    assert on_s + 0.19 < rig.coil("A00m1").off_at_s <= died_s + 0.01
    assert rig.bench.supply.power_w.sum() == 0.0
    assert rig.bench.crashes == []


def test_two_coils_make_a_battery_sag_and_hardly_a_bench_supply(rig_of):
    sagged_v = {}
    for name in ("sphere-a", "sphere-b"):
        rig = rig_of(f"sim:{name}")
        before_v = rig.bench.supply.steady_v()[1]
        rig.fire("A100", "Am100", duty_percent=100, hold_s=0.3)
        rig.run(seconds=0.1)
        sagged_v[name] = before_v - rig.bench.supply.steady_v()[1]

    assert 0.75 < sagged_v["sphere-a"] < 0.85  # 1.5 A through 0.52 ohm
    assert 0.005 < sagged_v["sphere-b"] < 0.01  # 0.4 A through 0.02 ohm


def test_an_open_jump_coil_stays_cold_and_the_others_do_not_care(rig_of):
    rig = rig_of("sim:sphere-b?open=B10m1")
    rig.fire("B10m1", "B01m1", duty_percent=100, hold_s=0.5, without=("B10m1",))

    rig.run(seconds=0.5)

    assert rig.coil("B10m1").degc == pytest.approx(25.0, abs=0.5)  # its stretch alone moves it
    assert rig.coil("B01m1").degc > 60
