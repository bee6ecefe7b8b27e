"""INA226 that is not looked at while its source cannot reach the limit: it alerts when one that is looked at does."""

import random

import pytest

from hil_sim.clock import Clock
from hil_sim.devices.ina226 import Ina226

CONFIG, MASK, LIMIT = 0x00, 0x06, 0x07
OVER_SHUNT, OVER_SHUNT_LATCHED = 0x8000, 0x8001
LSB_V = 2.5e-6


class Stepped:
    """A shunt voltage that is given in bits; one that tells no peak has the chip look at every conversion."""

    def __init__(self, tells_peak: bool) -> None:
        self.bits = 0
        self._tells_peak = tells_peak

    def steady_v(self):
        return self.bits * LSB_V, 2.0

    def peak_shunt_v(self):
        return self.bits * LSB_V if self._tells_peak else float("inf")

    def integrals_vus(self, *window):
        raise AssertionError("a steady source is not integrated")


class Rig:
    """One chip with a limit of 1000 bits and turns of 2 * 1100 us; `told` is when its pin has changed."""

    def __init__(self, tells_peak: bool = True, mask: int = OVER_SHUNT, averages: int = 0) -> None:
        self.clock = Clock()
        self.source = Stepped(tells_peak)
        self.told: list[int] = []
        self.chip = Ina226(0x40, self.clock, self.source, lambda: self.told.append(self.clock.now_us))
        self.set(CONFIG, 0x4127 | averages << 9)
        self.set(LIMIT, 1000)
        self.set(MASK, mask)

    def set(self, register: int, value: int) -> None:
        self.chip.write(0x40, bytes((register, value >> 8, value & 0xFF)))

    def get(self, register: int) -> int:
        self.chip.write(0x40, bytes((register,)))
        return int.from_bytes(self.chip.read(2), "big")

    def put(self, at_us: int, bits: int) -> None:
        self.clock.run_until(at_us)
        self.chip.before_change()
        self.source.bits = bits
        self.chip.after_change()


def test_a_conversion_that_is_under_way_when_the_current_rises_counts_as_a_whole():
    rig = Rig()
    rig.put(22_000 + 549, 2001)  # 551 of its 1100 us at 2001 bits: 1002 in the mean

    rig.clock.run_until(30_000)

    assert rig.told == [23_100]


def test_a_conversion_whose_mean_stays_at_the_limit_does_not_alert():
    rig = Rig()
    rig.put(22_000 + 550, 2000)
    rig.put(22_000 + 1100, 0)

    rig.clock.run_until(30_000)

    assert rig.told == []


def test_what_was_drawn_before_in_the_same_conversion_is_in_it():
    rig = Rig()
    rig.put(22_000 + 100, 900)
    rig.put(22_000 + 700, 1200)  # 540 and 480 bits' worth of the conversion, none of them enough alone

    rig.clock.run_until(23_099)
    assert rig.told == []
    rig.put(23_100, 0)

    assert rig.told == []  # (600 * 900 + 400 * 1200) / 1100 = 927


def test_a_pulse_within_the_conversion_of_the_bus_is_not_seen():
    rig = Rig()
    rig.put(22_000 + 1100, 20_000)
    rig.put(22_000 + 2200, 0)

    rig.clock.run_until(40_000)

    assert rig.told == []


def test_a_limit_that_is_lowered_under_the_current_alerts_at_the_next_conversion():
    rig = Rig()
    rig.put(20_000, 900)
    rig.clock.run_until(30_000)

    rig.set(LIMIT, 800)
    rig.clock.run_until(40_000)

    assert rig.told == [31_900]  # the conversion from 30 800 us on


def test_an_alert_that_is_not_latched_ends_with_the_first_conversion_below():
    rig = Rig()
    rig.put(22_000, 5000)
    rig.put(24_000, 0)

    rig.clock.run_until(60_000)

    assert rig.told == [23_100, 25_300]


def test_no_event_is_due_while_the_limit_is_out_of_reach():
    rig = Rig(mask=OVER_SHUNT_LATCHED)
    rig.put(20_000, 900)
    rig.clock.run_until(30_000)

    rig.clock.at(10_000_000, lambda: None)
    rig.clock.at(30_001, lambda: seen.append(rig.clock.limit_us))
    seen: list[int] = []
    rig.clock.run_until(20_000_000)

    assert seen == [10_000_000]


def test_conversions_that_begin_anew_are_looked_at_when_they_end():
    rig = Rig()
    rig.put(20_000, 5000)
    rig.clock.run_until(20_500)

    rig.set(CONFIG, 0x4087 | 1 << 3)  # 332 us of the bus, 204 us of the shunt
    rig.clock.run_until(30_000)

    assert rig.told == [20_500 + 204]


@pytest.mark.parametrize("mask", [OVER_SHUNT, OVER_SHUNT_LATCHED])
@pytest.mark.parametrize("seed", range(20))
def test_alerts_and_results_are_those_of_a_chip_that_looks_at_every_conversion(seed, mask):
    runs = []
    for tells_peak in (True, False):
        rig, draw = Rig(tells_peak, mask, averages=1), random.Random(seed)
        for _ in range(60):
            rig.put(rig.clock.now_us + draw.choice((1, 90, 700, 1100, 5000, 40_000)), draw.choice((0, 400, 990, 1500)))
            if draw.random() < 0.3:
                rig.told.append(rig.get(draw.choice((1, 2, MASK))))
            if draw.random() < 0.1:
                rig.set(LIMIT, draw.choice((300, 1000, 2000)))
        runs.append((rig.told, rig.get(1), rig.get(MASK)))

    assert runs[0] == runs[1]
