"""INA226 against the register description of its data sheet."""

import pytest

from hil_sim.clock import Clock
from hil_sim.devices.i2c import Bus
from hil_sim.devices.ina226 import Ina226


class Steady:
    """A source without ripple."""

    def __init__(self) -> None:
        self.volts = (0.0, 0.0)

    def steady_v(self):
        return self.volts

    def peak_shunt_v(self):
        return self.volts[0]

    def integrals_vus(self, *window):
        raise AssertionError("a steady source is not integrated")


class Rig:
    """One chip on a bus, with calibration 0x0800: current then equals the shunt reading."""

    def __init__(self) -> None:
        self.clock = Clock()
        self.source = Steady()
        self.chip = Ina226(0x40, self.clock, self.source)
        self.bus = Bus([self.chip])
        self.set(0x05, 0x0800)

    def set(self, register: int, value: int) -> None:
        self.bus.write(0x40, bytes((register, value >> 8, value & 0xFF)))

    def get(self, register: int) -> int:
        self.bus.write(0x40, bytes((register,)))
        return int.from_bytes(self.bus.read(0x40, 2), "big")

    def put(self, shunt_v: float, bus_v: float) -> None:
        self.chip.before_change()
        self.source.volts = (shunt_v, bus_v)
        self.chip.after_change()

    def wait_us(self, us: int) -> None:
        self.clock.run_until(self.clock.now_us + us)


@pytest.fixture
def rig() -> Rig:
    return Rig()


def test_registers_after_power_on_are_those_of_the_data_sheet(rig):
    rig.set(0x00, 0x8000)

    assert rig.get(0x00) == 0x4127
    assert [rig.get(register) for register in range(1, 8)] == [0] * 7
    assert rig.get(0xFE) == 0x5449
    assert rig.get(0xFF) == 0x2260


def test_shunt_and_bus_are_read_in_their_own_bits(rig):
    rig.put(0.01, 2.0)

    rig.wait_us(2200)

    assert rig.get(0x01) == 4000  # 2.5 uV
    assert rig.get(0x02) == 1600  # 1.25 mV


def test_nothing_is_read_before_the_conversion_ends(rig):
    rig.put(0.01, 2.0)

    rig.wait_us(2199)
    assert rig.get(0x01) == 0
    rig.wait_us(1)

    assert rig.get(0x01) == 4000


def test_current_and_power_follow_from_the_calibration(rig):
    rig.set(0x05, 512)
    rig.put(0.01, 2.0)

    rig.wait_us(2200)

    assert rig.get(0x04) == 4000 * 512 // 2048
    assert rig.get(0x03) == 1000 * 1600 // 20_000


def test_current_and_power_stay_zero_without_a_calibration(rig):
    rig.set(0x05, 0)
    rig.put(0.01, 2.0)

    rig.wait_us(10_000)

    assert (rig.get(0x04), rig.get(0x03)) == (0, 0)


def test_a_negative_shunt_voltage_is_twos_complement(rig):
    rig.put(-0.01, 2.0)

    rig.wait_us(2200)

    assert rig.get(0x01) == 0x10000 - 4000


def test_the_shunt_saturates_at_its_full_scale(rig):
    rig.put(0.2, 2.0)
    rig.wait_us(2200)
    assert rig.get(0x01) == 0x7FFF

    rig.put(-0.2, 2.0)
    rig.wait_us(4400)

    assert rig.get(0x01) == 0x8000


def test_a_conversion_is_the_mean_over_its_own_window(rig):
    rig.put(0.01, 2.0)

    rig.wait_us(550)
    rig.put(0.0, 2.0)
    rig.wait_us(1650)

    assert rig.get(0x01) == 2000  # half of the shunt's 1100 us


def test_the_shunt_converts_before_the_bus(rig):
    rig.put(0.01, 2.0)

    rig.wait_us(1100)
    rig.put(0.0, 0.0)
    rig.wait_us(1100)

    assert (rig.get(0x01), rig.get(0x02)) == (4000, 0)


def test_averages_and_conversion_times_stretch_the_cycle(rig):
    rig.put(0.01, 2.0)

    rig.set(0x00, 0x4497)  # 16 averages of 332 us each
    rig.wait_us(16 * 664 - 1)
    assert rig.get(0x01) == 0
    rig.wait_us(1)

    assert rig.get(0x01) == 4000


def test_a_triggered_conversion_happens_once(rig):
    rig.put(0.01, 2.0)
    rig.set(0x00, 0x4123)
    rig.wait_us(2200)
    assert rig.get(0x01) == 4000

    rig.put(0.0, 2.0)
    rig.wait_us(10_000)

    assert rig.get(0x01) == 4000


def test_in_power_down_nothing_is_converted(rig):
    rig.set(0x00, 0x4120)
    rig.put(0.01, 2.0)

    rig.wait_us(100_000)

    assert rig.get(0x01) == 0


def test_the_ready_flag_is_cleared_by_reading_it(rig):
    rig.wait_us(2200)

    assert rig.get(0x06) & 0x08
    assert not rig.get(0x06) & 0x08
    rig.wait_us(2200)

    assert rig.get(0x06) & 0x08


def test_the_alert_follows_the_limit_unless_latched(rig):
    rig.set(0x07, 3000)
    rig.set(0x06, 0x8000)
    rig.put(0.01, 2.0)
    rig.wait_us(2200)
    assert rig.chip.alert_level() == 0

    rig.put(0.0, 2.0)
    rig.wait_us(2200)

    assert rig.chip.alert_level() == 1


def test_a_latched_alert_holds_until_it_is_read(rig):
    rig.set(0x07, 3000)
    rig.set(0x06, 0x8001)
    rig.put(0.01, 2.0)
    rig.wait_us(2200)
    rig.put(0.0, 2.0)
    rig.wait_us(4400)
    assert rig.chip.alert_level() == 0

    assert rig.get(0x06) & 0x10

    assert rig.chip.alert_level() == 1


@pytest.mark.parametrize(
    ("mask", "limit", "shunt_v", "bus_v"),
    [(0x8000, 3999, 0.01, 2.0), (0x4000, 4001, 0.01, 2.0), (0x2000, 1599, 0.01, 2.0), (0x1000, 1601, 0.01, 2.0)],
)
def test_each_limit_is_watched_on_its_own_side(rig, mask, limit, shunt_v, bus_v):
    rig.set(0x07, limit)
    rig.set(0x06, mask)
    rig.put(shunt_v, bus_v)

    rig.wait_us(2200)

    assert rig.chip.alert_level() == 0


def test_the_alert_pin_can_be_turned_over(rig):
    rig.set(0x06, 0x8002)

    assert rig.chip.alert_level() == 0


def test_looking_often_changes_nothing(rig):
    other = Rig()
    for chip in (rig, other):
        chip.put(0.01, 2.0)
    for _ in range(50):
        other.wait_us(101)
        other.get(0x02)
    rig.wait_us(5050)

    assert [rig.get(register) for register in range(6)] == [other.get(register) for register in range(6)]


def test_a_missing_chip_does_not_answer(rig):
    rig.chip.alive = False

    assert rig.bus.write(0x40, b"\x00") == -1
    assert rig.bus.read(0x40, 2) is None


def test_a_change_after_a_long_quiet_time_is_weighed_within_its_conversion(rig):
    rig.put(0.01, 2.0)
    rig.wait_us(1_000 * 2200 + 275)

    rig.put(0.02, 2.0)
    rig.wait_us(2200 - 275)

    assert rig.get(0x01) == 4000 + 3000  # a quarter of 1100 us at 4000, the rest at 8000


def test_a_conversion_that_saw_a_change_is_followed_by_one_that_did_not(rig):
    rig.put(0.01, 2.0)
    rig.wait_us(275)
    rig.put(0.02, 2.0)
    rig.wait_us(2200 - 275)
    assert rig.get(0x01) == 7000

    rig.wait_us(2200)

    assert rig.get(0x01) == 8000


def test_reading_the_flags_does_not_silence_an_alert_that_is_not_latched(rig):
    rig.set(0x07, 3000)
    rig.set(0x06, 0x8000)
    rig.put(0.01, 2.0)
    rig.wait_us(2200)

    assert rig.get(0x06) & 0x10

    assert rig.chip.alert_level() == 0


class Pulsed:
    """A shunt voltage that is on for a share of each period, as under PWM; the bus stays at 2 V."""

    def __init__(self, volts: float, duty: float, period_us: float) -> None:
        self.volts, self.duty, self.period_us = volts, duty, period_us

    def steady_v(self):
        return None

    def peak_shunt_v(self):
        return self.volts

    def integrals_vus(self, begun_us, from_us, until_us, shunt_us, bus_us):
        turn_us = shunt_us + bus_us
        shunt = bus = 0
        for us in range(from_us, until_us):
            if (us - begun_us) % turn_us < shunt_us:
                shunt += us % self.period_us < self.duty * self.period_us
            else:
                bus += 1
        return shunt * self.volts, bus * 2.0


def pulsed(volts: float = 0.01, duty: float = 0.25, period_us: float = 656.0) -> Rig:
    rig = Rig()
    rig.chip = Ina226(0x40, rig.clock, Pulsed(volts, duty, period_us))
    rig.bus = Bus([rig.chip])
    rig.set(0x05, 0x0800)
    return rig


def test_a_short_conversion_of_a_pulsed_current_aliases():
    rig = pulsed()
    rig.set(0x00, 0x4007 | 1 << 6 | 1 << 3)  # 204 us of both, no averages: less than one period of the PWM
    seen = set()
    for _ in range(40):
        rig.wait_us(408)
        seen.add(rig.get(0x01))

    assert min(seen) == 0
    assert max(seen) > 3000  # of 4000 bits while it is on, 1000 on the average


def test_averages_over_many_phases_of_the_pwm_come_near_the_mean():
    rig = pulsed()
    rig.set(0x00, 0x42AF)
    rig.wait_us(9_792)

    assert rig.get(0x01) == pytest.approx(1000, abs=20)


def test_the_limit_is_held_against_each_conversion_and_not_against_the_average(rig):
    rig.set(0x00, 0x4200 | 0x127)  # 4 averages of 1100 us each
    rig.set(0x07, 3000)
    rig.set(0x06, 0x8001)
    rig.wait_us(2200)
    rig.put(0.01, 2.0)  # 4000 bits during the second of four shunt conversions
    rig.wait_us(1099)
    assert rig.chip.alert_level() == 1

    rig.wait_us(1)
    rig.put(0.0, 2.0)
    assert rig.chip.alert_level() == 0
    rig.wait_us(8800 - 3300)

    assert rig.get(0x01) == 1000
    assert rig.chip.alert_level() == 0


def test_a_bus_limit_is_held_against_each_conversion_of_the_bus(rig):
    rig.set(0x00, 0x4200 | 0x127)
    rig.set(0x07, 1000)
    rig.set(0x06, 0x1000)
    rig.put(0.0, 2.0)
    rig.wait_us(2200)
    assert rig.chip.alert_level() == 1

    rig.put(0.0, 1.0)
    rig.wait_us(2199)
    assert rig.chip.alert_level() == 1
    rig.wait_us(1)

    assert rig.chip.alert_level() == 0


def test_a_limit_that_is_set_within_a_turn_is_held_against_the_next(rig):
    rig.put(0.01, 2.0)
    rig.wait_us(100)

    rig.set(0x07, 3000)
    rig.set(0x06, 0x8000)
    rig.wait_us(1000)
    assert rig.chip.alert_level() == 1
    rig.wait_us(2200)

    assert rig.chip.alert_level() == 0


def test_the_alert_is_told_without_anybody_asking():
    told = []
    rig = Rig()
    rig.chip = Ina226(0x40, rig.clock, rig.source, lambda: told.append(rig.clock.now_us))
    rig.bus = Bus([rig.chip])
    rig.set(0x07, 3000)
    rig.set(0x06, 0x8000)
    rig.put(0.01, 2.0)

    rig.wait_us(3000)
    rig.put(0.0, 2.0)
    rig.wait_us(3000)

    assert told == [1100, 3300]  # the second conversion still saw 2909 bits


def test_of_two_functions_the_higher_bit_is_watched(rig):
    rig.set(0x07, 3000)
    rig.set(0x06, 0xC000)  # over and under
    rig.wait_us(2200)

    assert rig.chip.alert_level() == 1  # 0 is under the limit, but over is what counts


def test_power_is_watched_too(rig):
    rig.set(0x07, 319)
    rig.set(0x06, 0x0800)
    rig.put(0.01, 2.0)

    rig.wait_us(2200)

    assert rig.get(0x03) == 320
    assert rig.chip.alert_level() == 0


def test_the_alert_pin_may_tell_a_finished_conversion(rig):
    rig.set(0x06, 0x0400)
    rig.wait_us(2199)
    assert rig.chip.alert_level() == 1
    rig.wait_us(1)
    assert rig.chip.alert_level() == 0

    assert rig.get(0x06) & 0x18 == 0x08  # ready, and no alert function

    assert rig.chip.alert_level() == 1


def test_reading_the_flags_leaves_an_alert_that_is_not_latched_beside_the_ready_flag(rig):
    rig.set(0x07, 3000)
    rig.set(0x06, 0x8400)
    rig.put(0.01, 2.0)
    rig.wait_us(2200)

    assert rig.get(0x06) & 0x18 == 0x18

    assert rig.get(0x06) & 0x18 == 0x10


def test_configuring_clears_the_ready_flag_unless_it_is_for_power_down(rig):
    rig.wait_us(2200)
    rig.set(0x00, 0x4120)
    assert rig.get(0x06) & 0x08
    rig.set(0x00, 0x4127)
    rig.wait_us(2200)

    rig.set(0x00, 0x4127)

    assert not rig.get(0x06) & 0x08


def test_a_current_beyond_the_register_sets_the_overflow_flag(rig):
    rig.set(0x05, 0x7FFF)
    rig.put(0.01, 2.0)
    rig.wait_us(2200)

    assert rig.get(0x04) == 0x7FFF
    assert rig.get(0x06) & 0x04


def test_a_brown_out_clears_calibration_limit_and_alert(rig):
    rig.set(0x07, 3000)
    rig.set(0x06, 0x8001)
    rig.put(0.01, 2.0)
    rig.wait_us(2200)
    assert rig.chip.alert_level() == 0

    rig.chip.reset()
    rig.wait_us(4400)

    assert [rig.get(register) for register in (0x00, 0x04, 0x05, 0x07)] == [0x4127, 0, 0, 0]
    assert rig.get(0x01) == 4000
    assert rig.chip.alert_level() == 1


def test_each_register_keeps_its_own_bits(rig):
    for register, value, kept in ((0x00, 0x7FFF, 0x4FFF), (0x05, 0xFFFF, 0x7FFF), (0x07, 0xFFFF, 0xFFFF)):
        rig.set(register, value)
        assert rig.get(register) == kept
    for register in (0x01, 0x02, 0x03, 0x04, 0xFE, 0xFF):
        before = rig.get(register)
        rig.set(register, before ^ 0xFFFF)
        assert rig.get(register) == before
