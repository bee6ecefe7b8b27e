"""The press at the ends of what its profile and its orders may say: integers stay small, nothing leaves its range."""

import json
from types import SimpleNamespace

import pytest

from firmware.jointlimits import (
    FORCE_MAX_MN,
    PRESS_GAIN_MAX,
    RESET_MAX,
    SLEW_MAX_CENTI_PER_S,
    SMOOTH_MIN_MS,
    LoadLimits,
    ServoLimits,
)
from firmware.joints import Joints
from firmware.press import Press
from tests.firmware_press import PRESS
from tests.small_integers import Small

DATA = json.loads(PRESS.read_bytes())
WIDEST = DATA["servo"] | {
    "least_centi": -18_000, "most_centi": 18_000, "span_centi": 36_000, "slew_centi_per_s": SLEW_MAX_CENTI_PER_S,
}  # fmt: skip


class Pulses:
    """A servo that keeps the width of its pulses."""

    def pulse(self, width_ns: int) -> None:
        self.width_ns = width_ns

    def off(self) -> None:
        self.width_ns = None


def loop_of(reset: int, target_mn: int, force_mn: int):
    """Return a loop with the greatest gain there may be, which has just been given its target."""
    servo = ServoLimits(WIDEST)
    joints = Joints([Pulses()], 0, servo)
    load = SimpleNamespace(force_mn=Small(force_mn))
    limits = SimpleNamespace(
        gain_um_per_s_per_n=Small(PRESS_GAIN_MAX), reset_permille_per_s=Small(reset), smooth_ms=SMOOTH_MIN_MS,
        approach_um_per_s=Small(10**6), touch_mn=50,
    )  # fmt: skip
    loop = Press(joints, load, limits, servo, FORCE_MAX_MN)
    loop._most_um_per_s = Small(loop._most_um_per_s)
    loop.begin(target_mn, 65_535, 600_000, 0, Small(1 << 28))
    loop._nm, loop._target_mn = Small(loop._nm), Small(target_mn)
    return loop, joints


@pytest.mark.parametrize("reset", [0, RESET_MAX])
@pytest.mark.parametrize(("target_mn", "force_mn"), [(FORCE_MAX_MN, -FORCE_MAX_MN), (0, FORCE_MAX_MN), (60, 51)])
def test_no_number_of_the_press_is_beyond_the_small_integers_of_a_board(reset, target_mn, force_mn):
    loop, joints = loop_of(reset, target_mn, force_mn)

    for passed_ms in range(5, 70_000, 20):
        loop.update(Small((1 << 28) + passed_ms))
        joints.write()

    assert loop.active
    assert abs(joints.commanded_centi[0]) <= 18_000


def test_a_position_is_told_to_the_nearest_hundredth_of_all_that_its_potentiometer_may_read():
    limits = ServoLimits(WIDEST)
    way, half = limits.high_counts - limits.low_counts, limits._span_centi // 2

    for counts in range(4096):
        told = int(limits.position_centi(Small(counts)))
        assert abs(told - ((counts - limits.low_counts) * 36_000 / way - half)) <= 0.5


@pytest.mark.parametrize("load", [{"full_mn": FORCE_MAX_MN, "trip_mn": 70_000, "most_mn": 70_000}, {}])
def test_no_reading_of_the_load_cell_is_beyond_them(load):
    limits = LoadLimits(DATA["load"] | load)
    limits._full_mn = Small(limits._full_mn)

    assert limits.force_mn(Small(4095)) > limits.trip_mn > 0 > limits.force_mn(Small(0))
