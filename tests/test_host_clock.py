"""The robot's clock on the host's: never further off than is said, whatever jitter, drift and steps do to the line."""

import random
from math import ceil

import pytest
from hypothesis import given
from hypothesis import strategies as st

from host.clockbounds import Bound, Lines
from host.robotclock import WRAP, RobotClock, since

STEP_MS = 5
BYTE_MS = 10 / 115.2
REQUEST_MS, ANSWER_MS, TELEMETRY_MS = 14 * BYTE_MS, 22 * BYTE_MS, 90 * BYTE_MS


class Pair:
    """A host that hears a robot: telemetry each 50 ms, a question about twice a second, delays of the seed's choice."""

    def __init__(self, seed, drift_ppm, jitter_ms=1.0, ahead_ms=None):
        self.random = random.Random(seed)
        self.clock = RobotClock()
        self.rate = 1 + drift_ppm * 1e-6
        self.ahead_ms = self.random.uniform(0, WRAP) if ahead_ms is None else ahead_ms
        self.jitter_ms = jitter_ms
        self.now_ms = 0.0  # of the host, when it last read something
        self._phase_ms = self.random.uniform(0, STEP_MS)
        self._asked_ms = self._told_ms = 0.0

    def robot_ms(self, host_ms):
        """Return the true time of the robot, before it is rounded or wraps."""
        return host_ms * self.rate + self.ahead_ms

    def listen(self, minutes):
        """Exchange for that long, and yield after each frame the figures and how far they are from the truth."""
        until_ms = self.now_ms + minutes * 60_000
        while min(self._asked_ms, self._told_ms) < until_ms:
            if self._asked_ms <= self._told_ms:
                self._ask(self._asked_ms)
                self._asked_ms += self.random.uniform(400, 600)
            else:
                self._hear(self._told_ms, TELEMETRY_MS)
                self._told_ms += 50
            figures = self.clock.figures(self.now_ms)
            if figures:
                yield figures, abs(figures.offset_ms % WRAP - (self.robot_ms(self.now_ms) - self.now_ms) % WRAP)

    def _ask(self, host_ms):
        step_ms = self._hear(host_ms + REQUEST_MS + self.random.uniform(0, self.jitter_ms), ANSWER_MS)
        self.clock.answered(host_ms, int(self.robot_ms(step_ms)) % WRAP, REQUEST_MS)

    def _hear(self, host_ms, line_ms):
        """Have the robot say its time at its next step, and read it some time later; return when that step was."""
        steps = ceil((self.robot_ms(host_ms) - self._phase_ms) / STEP_MS)
        step_ms = (steps * STEP_MS + self._phase_ms - self.ahead_ms) / self.rate
        self.now_ms = step_ms + line_ms + self.random.uniform(0.05, 0.05 + self.jitter_ms)
        self.clock.read(int(self.robot_ms(step_ms)) % WRAP, self.now_ms, line_ms)
        return step_ms


@given(seed=st.integers(0, 2**32), drift_ppm=st.floats(-100, 100), jitter_ms=st.floats(0, 20))
def test_the_truth_never_lies_outside_the_bound(seed, drift_ppm, jitter_ms):
    for figures, off_ms in Pair(seed, drift_ppm, jitter_ms).listen(minutes=0.2):
        assert off_ms <= figures.bound_ms + 2e-3


@pytest.mark.parametrize("drift_ppm", [-50, 50])
def test_after_ten_minutes_of_drift_and_jitter_the_clock_is_known_to_a_millisecond(drift_ppm):
    *_, (figures, off_ms) = Pair(1, drift_ppm).listen(minutes=10)

    assert off_ms < 1
    assert figures.bound_ms < 1.2  # half of it are the robot's whole milliseconds
    assert figures.drift_ppm == pytest.approx(drift_ppm, abs=5)


def test_a_drift_that_wanders_contradicts_nothing():
    """Exact readings of a clock whose drift grows by 0.05 ppm a second."""
    bounds = [Bound(at_ms, 0.05e-9 * at_ms**2 / 2, side) for at_ms in (60_000, 30_000, 0) for side in (1, -1)]

    lines, agreeing = Lines.through(bounds[0], bounds)
    low_ms, high_ms = lines.ahead_ms(90_000)

    assert len(agreeing) == len(bounds)
    assert low_ms <= 0.05e-9 * 90_000**2 / 2 <= high_ms


def test_a_long_silence_widens_the_bound_and_one_answer_mends_it():
    pair = Pair(3, 80)
    *_, (before, _) = pair.listen(minutes=1)

    silent = pair.clock.figures(pair.now_ms + 600_000)
    pair._asked_ms = pair._told_ms = pair.now_ms + 600_000
    figures, _ = next(pair.listen(minutes=15))

    assert before.bound_ms < 2
    assert silent.bound_ms > 5
    assert figures.bound_ms < 6


def test_the_robots_clock_may_wrap():
    pair = Pair(4, 10, ahead_ms=WRAP - 30_000)
    *_, (_, off_ms) = pair.listen(minutes=1)

    assert off_ms < 2
    assert pair.clock.at(pair.now_ms) == pytest.approx(pair.robot_ms(pair.now_ms) - WRAP, abs=2)


def test_the_earliest_time_is_never_ahead_of_the_robot():
    pair = Pair(5, -60, jitter_ms=30)

    for _ in pair.listen(minutes=1):
        assert since(int(pair.robot_ms(pair.now_ms)) % WRAP, pair.clock.earliest(pair.now_ms)) >= 0


def test_without_an_answer_only_the_quickest_telemetry_counts():
    clock = RobotClock()
    for at_ms, late_ms in ((100, 40), (150, 0), (200, 25)):
        clock.read(7000 + at_ms - late_ms, at_ms)

    assert clock.at(200) == pytest.approx(7200, abs=1)
    assert clock.figures(200) is None


def test_a_clock_that_jumps_is_believed_anew():
    pair = Pair(6, 20)
    list(pair.listen(minutes=1))

    pair.ahead_ms -= 5000
    *_, (_, off_ms) = pair.listen(minutes=1)

    assert off_ms < 2


@pytest.mark.parametrize("stall_ms", [30, 300, 2000])
def test_a_clock_that_stood_still_is_known_again_after_five_seconds(stall_ms):
    pair = Pair(8, 20)
    list(pair.listen(minutes=1))

    pair.ahead_ms -= stall_ms
    list(pair.listen(minutes=1 / 12))

    assert all(off_ms <= figures.bound_ms for figures, off_ms in pair.listen(minutes=1))
    assert pair.clock.figures(pair.now_ms).bound_ms < 2


@pytest.mark.parametrize("speed", [0.5, 2, 100])
def test_of_a_clock_at_another_speed_nothing_is_called_known(speed):
    """As that of `softrig sim --speed 2`."""
    pair = Pair(9, (speed - 1) * 1e6)
    list(pair.listen(minutes=1 / 60))

    told = list(pair.listen(minutes=1))

    assert all(off_ms <= figures.bound_ms for figures, off_ms in told)


def test_a_clock_at_another_speed_is_still_reckoned_by_what_it_told_last():
    pair = Pair(10, 1e6)
    list(pair.listen(minutes=1))

    assert pair.clock.at(pair.now_ms) == pytest.approx(pair.robot_ms(pair.now_ms) % WRAP, abs=150)


def test_what_is_kept_is_bounded():
    pair = Pair(7, 30, jitter_ms=50)

    list(pair.listen(minutes=20))

    assert all(len(bounds) <= 24 for bounds in pair.clock._bounds.values())
    assert len(pair.clock._lines._corners) <= 52


def test_before_any_time_was_told_nothing_is_known():
    clock = RobotClock()

    assert clock.at(5) is None
    assert clock.earliest(5) is None
    assert clock.figures(5) is None
