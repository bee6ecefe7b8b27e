"""Thermistor, monostable, bus and pins."""

from math import exp

import pytest

from hil_sim.clock import Clock
from hil_sim.devices import gpio
from hil_sim.devices.gpio import Gpio
from hil_sim.devices.i2c import Bus, bus_time_us
from hil_sim.devices.monostable import Monostable
from hil_sim.devices.ntc import Ntc, scaled_to_u16
from hil_sim.journal import Journal


def test_the_thermistor_divides_in_half_at_25_degc():
    assert Ntc().counts(25.0) == round(4095 / 2)


def test_the_thermistor_follows_its_beta():
    r_ohm = 10_000 * exp(3950 * (1 / 373.15 - 1 / 298.15))

    assert Ntc().counts(100.0) == round(4095 * r_ohm / (r_ohm + 10_000))


def test_a_broken_or_shorted_thermistor_reads_a_rail():
    ntc = Ntc()
    ntc.fault = "open"
    assert scaled_to_u16(ntc.counts(25.0)) == 0xFFFF

    ntc.fault = "short"

    assert ntc.counts(25.0) == 0


def test_a_drifting_thermistor_reads_more_with_every_second_up_to_an_end():
    ntc = Ntc()
    ntc.drift_k_per_s, ntc.drifts_from_us = 2.0, 1_000_000

    assert ntc.counts(25.0, 6_000_000) == Ntc().counts(35.0)

    ntc.drift_k_per_s = -1e6
    assert ntc.counts(25.0, 6_000_000) == Ntc().counts(-100.0)


def test_twelve_bits_are_scaled_to_sixteen_as_the_port_does():
    assert [scaled_to_u16(counts) for counts in (0, 1, 0x800, 0xFFF)] == [0, 0x10, 0x8008, 0xFFFF]


@pytest.fixture
def window():
    clock, changes = Clock(), []
    monostable = Monostable(clock, 50_000, lambda: changes.append((clock.now_us, monostable.running)))
    return clock, monostable, changes


def test_the_monostable_opens_50_ms_after_the_last_edge(window):
    clock, monostable, changes = window
    for time_us in (0, 10_000, 30_000):
        clock.at(time_us, monostable.edge)

    clock.run_until(200_000)

    assert changes == [(0, True), (80_000, False)]


def test_clear_ends_the_monostable_at_once_and_blocks_its_trigger(window):
    clock, monostable, changes = window
    for time_us, act in ((0, monostable.edge), (10_000, lambda: monostable.clear(True)), (20_000, monostable.edge)):
        clock.at(time_us, act)

    clock.run_until(200_000)

    assert changes == [(0, True), (10_000, False)]


def test_the_release_of_clear_starts_nothing_before_the_next_edge(window):
    clock, monostable, changes = window
    acts = (monostable.edge, lambda: monostable.clear(True), lambda: monostable.clear(False), monostable.edge)
    for time_us, act in zip((0, 10_000, 20_000, 40_000), acts, strict=True):
        clock.at(time_us, act)

    clock.run_until(200_000)

    assert changes == [(0, True), (10_000, False), (40_000, True), (90_000, False)]


def test_the_monostable_starts_again_at_the_next_edge(window):
    clock, monostable, changes = window
    for time_us in (0, 50_001):
        clock.at(time_us, monostable.edge)

    clock.run_until(50_001)

    assert changes == [(0, True), (50_000, False), (50_001, True)]


def test_bus_time_is_nine_bits_a_byte_rounded_up():
    assert bus_time_us(1, 400_000) == 23
    assert bus_time_us(66, 400_000) == 1485


def test_an_address_that_nobody_has_is_not_acknowledged():
    bus = Bus()

    assert not bus.at(0x40)
    assert bus.write(0x40, b"\x00") == -1
    assert bus.read(0x40, 1) is None


@pytest.fixture
def pins():
    return Gpio(Clock(), Journal())


def test_after_reset_every_pin_is_an_input_pulled_down(pins):
    pins.configure(2, gpio.OUT, value=1)

    pins.reset()

    assert pins.mode(2) == gpio.IN
    assert pins.read(2) == 0


def test_watchers_hear_changes_only_and_a_reset_is_one(pins):
    seen = []
    pins.watchers[3] = seen.append

    pins.configure(3, gpio.OUT, value=0)
    for level in (1, 1, 0, 1):
        pins.write(3, level)
    pins.reset()

    assert seen == [1, 0, 1, 0]


def test_a_value_given_with_the_mode_makes_no_glitch(pins):
    seen = []
    pins.configure(3, gpio.OUT, value=0)
    pins.reset()
    pins.watchers[3] = seen.append

    pins.configure(3, gpio.OUT, value=1)

    assert seen == [1]


def test_an_input_reads_its_source_and_without_one_its_pull(pins):
    level: list[int | None] = [1]
    pins.sources[6] = lambda: level[0]
    pins.configure(6, gpio.IN, gpio.PULL_DOWN)
    assert pins.read(6) == 1

    level[0] = None
    assert pins.read(6) == 0
    pins.configure(6, pull=gpio.PULL_UP)

    assert pins.read(6) == 1


def test_an_open_drain_pin_is_low_or_let_go(pins):
    pins.configure(7, gpio.OPEN_DRAIN, gpio.PULL_UP, value=0)
    assert pins.read(7) == 0

    pins.write(7, 1)

    assert pins.read(7) == 1
