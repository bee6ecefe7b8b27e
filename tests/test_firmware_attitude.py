"""Where down is: the firmware's estimate alone, on a body that turns as a test says."""

import math
import random
from array import array

import pytest

from firmware.attitude import Attitude, Blind
from tests.gait_scripts import BALL
from tests.small_integers import Small

ONE_G = 8197
DPS = 1 / 0.035


class Body:
    """A body in free rotation, its sensor ideal except for what a test adds."""

    def __init__(self, zero_dps=(0, 0, 0), zero_g=(0, 0, 0)) -> None:
        self.down = (0.0, 0.0, -1.0)
        self.rate_dps = (0.0, 0.0, 0.0)
        self.knock_g = (0.0, 0.0, 0.0)
        self.words = array("h", [0] * 6)
        self._zero = (zero_dps, zero_g)
        self._random = random.Random(1)

    def begin(self) -> None:
        """Nothing to set."""

    def configured(self) -> bool:
        return True

    def turn(self, ms: float) -> None:
        x, y, z = self.down
        for _ in range(100):
            p, q, r = (math.radians(rate) * ms / 1e5 for rate in self.rate_dps)
            x, y, z = x + y * r - z * q, y + z * p - x * r, z + x * q - y * p
        length = math.hypot(x, y, z)
        self.down = (x / length, y / length, z / length)

    def read(self) -> bool:
        rates = [(rate + zero) * DPS for rate, zero in zip(self.rate_dps, self._zero[0], strict=True)]
        forces = [
            (knock + zero - down) * ONE_G
            for knock, zero, down in zip(self.knock_g, self._zero[1], self.down, strict=True)
        ]
        for i, value in enumerate(rates + forces):
            self.words[i] = max(-0x8000, min(0x7FFF, round(value + self._random.gauss(0, 1))))
        return True


class Ride:
    """An estimate on a body."""

    def __init__(self, **faults) -> None:
        self.body = Body(**faults)
        self.attitude = Attitude(self.body, BALL)
        self.now_ms = 0
        self.attitude.begin(0)
        self.go(100)

    def go(self, ms: int, rate_dps=(0.0, 0.0, 0.0)) -> None:
        """Let time pass while the body turns at that rate."""
        self.body.rate_dps = rate_dps
        for _ in range(0, ms, 5):
            self.body.turn(5)
            self.now_ms += 5
            self.attitude.look(self.now_ms)

    def error_deg(self) -> float:
        """Return the angle between the estimate and the truth."""
        down = self.attitude.down
        cosine = sum(a * b for a, b in zip(down, self.body.down, strict=True)) / math.hypot(*down)
        return math.degrees(math.acos(max(-1.0, min(1.0, cosine))))


def test_upright_the_first_coil_points_down_and_all_angles_are_zero():
    ride = Ride()

    assert BALL[ride.attitude.down_channel()] == "A00m1"
    assert abs(ride.attitude.pitch_decideg()) <= 1
    assert abs(ride.attitude.roll_decideg()) <= 1


@pytest.mark.parametrize("pitch_deg", range(-170, 190, 20))
def test_pitch_counts_a_whole_turn_forward(pitch_deg):
    ride = Ride()

    ride.go(2000, (0.0, pitch_deg / 2, 0.0))

    assert ride.attitude.pitch_decideg() == pytest.approx(10 * pitch_deg, abs=3)
    assert abs(ride.attitude.roll_decideg()) <= 3


@pytest.mark.parametrize("roll_deg", [-80, -30, 30, 60, 85])
def test_roll_is_the_lean_to_the_right(roll_deg):
    ride = Ride()

    ride.go(1000, (roll_deg, 0.0, 0.0))

    assert ride.attitude.roll_decideg() == pytest.approx(10 * roll_deg, abs=3)


def test_rolling_forward_brings_the_coils_of_the_circle_down_in_their_order():
    ride, seen = Ride(), []

    for _ in range(8):
        seen.append(BALL[ride.attitude.down_channel()])
        ride.go(500, (0.0, 90.0, 0.0))

    assert seen == BALL


def test_the_gyroscope_carries_through_a_fast_roll_that_the_accelerometer_cannot_follow():
    ride = Ride()
    ride.body.knock_g = (1.5, 0.0, 1.0)

    ride.go(300, (0.0, 600.0, 0.0))

    assert ride.error_deg() < 2


def test_at_rest_the_accelerometer_draws_it_back_whatever_went_before():
    ride = Ride()
    ride.body.down = (math.sin(1.0), 0.0, -math.cos(1.0))  # turned unseen

    ride.go(1000)
    assert ride.error_deg() < 57.3 * math.exp(-1000 / 640) + 1
    ride.go(4000)
    assert ride.error_deg() < 0.3


def test_the_zero_levels_of_the_data_sheet_cost_seven_degrees_at_most():
    ride = Ride(zero_dps=(3, -3, 3), zero_g=(0.04, 0.04, -0.04))

    ride.go(5000)

    assert ride.error_deg() < 7  # 4 of the accelerometer, 3 of the gyroscope


def test_no_number_on_the_way_is_beyond_the_small_integers_of_a_board():
    imu = Extreme()
    attitude = Attitude(imu, BALL)
    for ways in range(3000):
        imu.words = [Small(imu.random.choice((-0x8000, 0x7FFF, 0, ONE_G, -ONE_G))) for _ in range(6)]
        attitude.look(5 * ways)
        attitude.pitch_decideg()
        attitude.roll_decideg()
        attitude.down_channel()

    assert Small.largest > 1 << 29


def test_a_robot_without_a_sensor_knows_nothing():
    blind = Blind()

    assert (blind.known, blind.lost, blind.down_channel(), blind.pitch_decideg()) == (False, False, 255, 0)


class Extreme:
    """A sensor whose words are set from outside."""

    def __init__(self) -> None:
        self.random = random.Random(7)
        self.words = [Small(0)] * 6

    def begin(self) -> None:
        """Nothing to set."""

    def read(self) -> bool:
        return True
