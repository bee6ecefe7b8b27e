"""PWM of the processor, and the servo that is driven with it."""

import pytest

from hil_sim.clock import Clock
from hil_sim.devices.pwm import PwmSlices
from hil_sim.devices.servo import Servo
from hil_sim.journal import KINDS, Journal

FRAME_US = 20_000.0


@pytest.fixture
def servo() -> Servo:
    return Servo()


@pytest.mark.parametrize(
    ("width_us", "angle_deg"), [(500, -90), (1000, -45), (1500, 0), (2500, 90), (450, -90), (2590, 90)]
)
def test_the_width_of_the_pulse_is_the_angle_within_the_range(servo, width_us, angle_deg):
    servo.pulsed(0, width_us, FRAME_US)

    assert servo.commanded_deg(width_us) == pytest.approx(angle_deg)


def test_a_pulse_that_does_not_come_any_more_is_not_followed(servo):
    servo.pulsed(0, 2000, FRAME_US)
    servo.pulsed(1000, 1500, FRAME_US)

    assert servo.commanded_deg(2400) is None
    assert servo.commanded_deg(2500) == 0.0


def test_a_servo_without_pulses_is_limp(servo):
    assert servo.commanded_deg(1_000_000) is None


@pytest.mark.parametrize(("width_us", "period_us"), [(399, FRAME_US), (2601, FRAME_US), (1500, 25_001), (1500, 3000)])
def test_what_is_no_servo_pulse_moves_nothing(servo, width_us, period_us):
    servo.pulsed(0, width_us, period_us)

    assert servo.commanded_deg(1_000_000) is None


@pytest.mark.parametrize(("width_us", "angle_deg"), [(500, -90), (2500, 90)])
def test_the_widest_and_the_narrowest_pulse_are_followed_200_times_a_second(servo, width_us, angle_deg):
    for turn in range(10):
        servo.pulsed(5_000 * turn, width_us, 5_000.0)

    assert servo.commanded_deg(width_us) == pytest.approx(angle_deg)
    assert servo.commanded_deg(50_000) == pytest.approx(angle_deg)


@pytest.mark.parametrize("period_us", [25_000, 3004])
def test_the_slowest_and_the_fastest_pulses_are_followed(servo, period_us):
    servo.pulsed(0, 1500, period_us)

    assert servo.commanded_deg(1500) == pytest.approx(0)


def test_a_pulse_is_known_at_its_end(servo):
    servo.pulsed(0, 1500, FRAME_US)
    servo.pulsed(20_000, 2000, FRAME_US)

    assert servo.commanded_deg(21_999) == pytest.approx(0)
    assert servo.commanded_deg(22_000) == pytest.approx(45)


def test_a_change_within_the_dead_band_moves_nothing(servo):
    servo.pulsed(0, 1500, FRAME_US)
    servo.pulsed(20_000, 1504, FRAME_US)
    assert servo.commanded_deg(40_000) == pytest.approx(0)

    servo.pulsed(40_000, 1505, FRAME_US)

    assert servo.commanded_deg(60_000) == pytest.approx(0.45)


def test_a_digital_servo_has_a_narrower_dead_band():
    servo = Servo(dead_band_us=1.0)
    servo.pulsed(0, 1500, FRAME_US)
    servo.pulsed(20_000, 1500.9, FRAME_US)
    assert servo.commanded_deg(40_000) == pytest.approx(0)

    servo.pulsed(40_000, 1501, FRAME_US)

    assert servo.commanded_deg(60_000) == pytest.approx(0.09)


def test_a_servo_goes_limp_100_ms_after_its_last_pulse(servo):
    servo.pulsed(0, 1500, FRAME_US)
    servo.pulsed(40_000, 0, FRAME_US)

    assert servo.commanded_deg(139_999) == pytest.approx(0)
    assert servo.commanded_deg(140_000) is None


def test_being_told_again_that_there_are_none_does_not_put_that_off(servo):
    servo.pulsed(0, 1500, FRAME_US)
    for turn in range(6):
        servo.pulsed(40_000 + 20_000 * turn, 0, FRAME_US)

    assert servo.commanded_deg(140_000) is None


def test_pulses_that_come_again_in_time_keep_a_servo_where_it_is(servo):
    servo.pulsed(0, 1500, FRAME_US)
    servo.pulsed(20_000, 0, FRAME_US)
    servo.pulsed(100_000, 1500, FRAME_US)

    assert servo.commanded_deg(119_999) == pytest.approx(0)
    assert servo.commanded_deg(120_001) == pytest.approx(0)


def test_a_pulse_that_was_measured_counts_although_another_follows(servo):
    servo.pulsed(0, 1000, FRAME_US)
    servo.pulsed(1000, 2000, FRAME_US)

    assert servo.commanded_deg(1000) == pytest.approx(-45)
    assert servo.commanded_deg(3000) == pytest.approx(45)


def test_two_changes_within_a_frame_leave_the_last(servo):
    servo.pulsed(20_000, 1000, FRAME_US)
    servo.pulsed(20_000, 2000, FRAME_US)

    assert servo.commanded_deg(25_000) == pytest.approx(45)


def test_a_new_level_is_taken_over_when_the_counter_wraps():
    clock, told = Clock(), []
    slices = PwmSlices(clock, Journal())
    slices.watch(8, lambda *pulses: told.append(pulses))
    counter, channel = slices.of(8)
    counter.div16, counter.top, counter.enabled = 16 * 100, 24_999, True  # 20 ms

    clock.run_until(30_000)
    counter.levels[channel] = 1875
    slices.connect(8)

    assert told == [(40_000, pytest.approx(1500), pytest.approx(20_000))]


@pytest.fixture
def driven():
    """A pin that is driven with 1.5 ms in 20 ms, and what its watcher was told."""
    told = []
    slices = PwmSlices(Clock(), Journal(keep=True))
    slices.watch(8, lambda *pulses: told.append(pulses))
    counter, _ = slices.of(8)
    counter.div16, counter.top, counter.levels[0], counter.enabled = 1600, 24_999, 1875, True
    slices.connect(8)
    return slices, told


@pytest.mark.parametrize("end", [lambda slices: slices.reset(), lambda slices: slices.release(8)])
def test_a_pin_that_is_let_go_has_no_pulses(driven, end):
    slices, told = driven
    assert told[-1][1] == pytest.approx(1500)

    end(slices)
    count = len(told)
    slices.changed(9)

    assert told[count - 1][1] == 0
    assert len(told) == count


def test_a_change_of_the_slice_is_told_for_both_of_its_pins(driven):
    slices, told = driven
    other = []
    slices.watch(9, lambda *pulses: other.append(pulses))
    slices.connect(9)

    slices.of(9)[0].top = 49_999
    slices.changed(9)

    assert told[-1][2] == other[-1][2] == pytest.approx(40_000)


def test_what_a_pin_is_set_to_is_noted(driven):
    slices, _ = driven

    ((_, kind, pin, data),) = slices._journal.kept()

    assert (KINDS[kind], pin) == ("pwm", 8)
    assert [int.from_bytes(data[at : at + 4], "little") for at in range(0, 16, 4)] == [1600, 24_999, 1875, 1]


@pytest.mark.parametrize(
    ("pin", "index", "channel"), [(0, 0, 0), (1, 0, 1), (15, 7, 1), (16, 0, 0), (21, 2, 1), (29, 6, 1)]
)
def test_pins_belong_to_slices_as_on_the_rp2040(pin, index, channel):
    slices = PwmSlices(Clock(), Journal())

    assert slices.of(pin) == (slices.slices[index], channel)


def test_a_level_beyond_the_top_is_always_on(driven):
    slices, told = driven
    slices.of(8)[0].levels[0] = 0xFFFF

    slices.changed(8)

    assert told[-1][1] == told[-1][2] == pytest.approx(20_000)


def test_a_counter_wraps_on_its_own_grid():
    clock, told = Clock(), []
    slices = PwmSlices(clock, Journal())
    slices.watch(8, lambda *pulses: told.append(pulses[0]))
    clock.run_until(7_000)
    counter, _ = slices.of(8)
    counter.div16, counter.top, counter.enabled, counter.begun_us = 1600, 24_999, True, 7_000
    clock.run_until(30_000)

    slices.connect(8)

    assert told == [47_000]
