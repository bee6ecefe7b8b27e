"""Joints on the bench: pulses in, current on the rail, converter and camera out."""

import numpy as np
import pytest

from hil_sim.bench import Bench, Parts
from hil_sim.devices.anglecamera import Optics
from hil_sim.supply import Supply
from hil_sim.worlds.image import Image
from tests.bench_fakes import FakePlant

PULSES = b"""
from machine import PWM, Pin
import time
power = Pin(2, Pin.OUT, value=0)
right, left = PWM(Pin(8), freq=200), PWM(Pin(9), freq=200)
right.duty_ns(1_600_000)
left.duty_ns(1_400_000)
time.sleep_ms(100)
power.value(1)
time.sleep_ms(100)
right.duty_ns(0)
time.sleep_ms(200)
power.value(0)
time.sleep_ms(1000)
"""


class FakeHand(FakePlant):
    """Two joints that are where they are told to be, and take 1 A and 2 A while they are driven, 5 mA while limp."""

    def __init__(self):
        super().__init__("")
        self.joints, self.joint_unit = ["R", "L"], "deg"
        self.joint_position = np.zeros(2)
        self.joint_current_a = np.full(2, 0.005)
        self.object_deg = None
        self.told = []

    def command(self, degrees):
        self.told.append(list(degrees))

    def advance(self, duration_us, coil_power_w):
        super().advance(duration_us, coil_power_w)
        for index, degree in enumerate(self.told[-1] if self.told else ()):
            self.joint_position[index] = self.joint_position[index] if degree is None else degree
            self.joint_current_a[index] = 0.005 if degree is None else 1.0 + index


@pytest.fixture
def bench():
    parts = Parts([], [], supply_v=6.0, shunt_ohm=0.01, servos=[8, 9], servo_dead_band_us=1.0, camera=Optics())
    bench = Bench(parts, FakeHand(), Image({"main.py": PULSES}))
    yield bench
    bench.close()


def test_a_servo_without_power_is_limp_whatever_its_pulses_say(bench):
    bench.run(0.09)

    assert bench.plant.told[-1] == [None, None]
    assert not bench.any_joint_driven


def test_a_servo_goes_where_its_pulses_say_until_they_end_or_the_power_does(bench):
    bench.run(0.19)
    assert bench.plant.told[-1] == pytest.approx([9.0, -9.0], abs=0.01)

    bench.run(0.2)  # a servo waits for 100 ms for a pulse
    assert bench.plant.told[-1] == [None, pytest.approx(-9.0, abs=0.01)]
    bench.run(0.2)

    assert bench.plant.told[-1] == [None, None]
    assert [deg for _, deg in bench.joint("R").history] == [pytest.approx(9.0, abs=0.01), None]
    assert bench.joint("L").driven_us(bench.clock.now_us) == pytest.approx(300_000, abs=5_000)
    assert bench.observe()["joint_driven_s"]["R"] == pytest.approx(0.2, abs=0.01)


def test_the_emergency_stop_lets_servos_go_whatever_the_firmware_does(bench):
    bench.run(0.15)
    assert bench.any_joint_driven

    bench.board.set_estop(False)
    bench.run(0.01)

    assert bench.plant.told[-1] == [None, None]
    assert (bench.supply.current_a, bench.joint("L").peak_a) == (0.0, 2.0)


def test_servos_load_the_rail_and_the_monitor_sees_it(bench):
    bench.run(0.19)

    shunt_v, bus_v = bench.supply.steady_v()

    assert bench.supply.current_a == 3.0
    assert (shunt_v, bus_v) == pytest.approx((0.03, 6.0 - 0.02 * 3.0))
    bench.run(0.4)
    assert bench.supply.steady_v() == (0.0, 6.0)


def test_the_converter_reads_currents_and_then_angles(bench):
    bench.run(0.19)

    counts = [bench.board.adc.counts(channel) for channel in range(5)]

    right, left = 2048 + 18.2 * 9, 2048 - 18.2 * 9
    assert counts == pytest.approx([0.5 / 3.3 * 4096, 1.0 / 3.3 * 4096, right, left, 0], abs=1)


@pytest.mark.parametrize(("degrees", "status"), [(12.34, 1), (None, 0)])
def test_the_camera_sees_the_object_if_there_is_one(bench, degrees, status):
    bench.plant.object_deg = degrees

    bench.run(0.1)

    bench.board.bus.write(0x33, b"\x01")
    seen, _, low, high = bench.board.bus.read(0x33, 4)
    angle = int.from_bytes(bytes((low, high)), "little", signed=True)
    assert seen == status
    assert angle == pytest.approx(100 * (degrees or 0.0), abs=10)  # five times its noise


def supply_of(gates, load_a):
    supply = Supply(np.full(len(gates), 0.5), source_ohm=0.02, shunt_ohm=0.01, voltage_v=6.0)
    supply.drive(gates, 655.36)
    supply.load_a = load_a
    supply.solve(np.full(len(gates), 9.5))
    return supply


def test_coils_beside_servos_have_less_voltage_by_what_the_source_drops():
    alone, beside = supply_of([(0.0, 1.0)], 0.0), supply_of([(0.0, 1.0)], 3.0)

    coil_a = (6.0 - 0.02 * 3.0) / 10.02
    assert beside.current_a == pytest.approx(coil_a + 3.0)
    assert beside.steady_v() == pytest.approx((0.01 * (coil_a + 3.0), 6.0 - 0.02 * (coil_a + 3.0)))
    assert beside.power_w[0] == pytest.approx(alone.power_w[0] * (1 - 0.01) ** 2)


def test_the_monitors_windows_count_the_load_too():
    supply = supply_of([(0.0, 0.0)], 3.0)

    shunt_vus, bus_vus = supply.integrals_vus(begun_us=0, from_us=0, until_us=47_200, shunt_us=332, bus_us=140)

    assert (shunt_vus, bus_vus) == pytest.approx((0.01 * 3.0 * 33_200, (6.0 - 0.02 * 3.0) * 14_000))


def test_the_peak_of_pulsed_coils_stands_on_the_load():
    assert supply_of([(0.0, 0.5)], 3.0).peak_shunt_v() == pytest.approx(0.01 * (3.0 + (6.0 - 0.06) / 10.02))


def test_a_load_that_has_changed_calls_for_another_solution():
    supply = supply_of([], 0.0)

    supply.load_a = 1.0

    assert supply.stale
    supply.solve(np.zeros(0))
    assert (supply.stale, supply.current_a) == (False, 1.0)
