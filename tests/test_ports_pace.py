"""Wall time into virtual time: never faster than the wall, never a jump."""

from hil_sim.ports import Pace


class Wall:
    """A clock that a test moves."""

    def __init__(self) -> None:
        self.s = 100.0

    def __call__(self) -> float:
        return self.s


def test_virtual_time_follows_the_wall_at_its_speed():
    wall = Wall()
    pace = Pace(2.0, wall)

    wall.s += 0.010

    assert abs(pace.passed_us() - 20_000) <= 1
    assert pace.passed_us() == 0


def test_a_stall_lets_the_schedule_slip_instead_of_jumping():
    wall = Wall()
    pace = Pace(1.0, wall)

    wall.s += 0.5

    assert pace.passed_us() == 20_000
    assert abs(pace.slipped_s - 0.48) < 1e-9
    wall.s += 0.001
    assert abs(pace.passed_us() - 1000) <= 1


def test_fractions_of_a_microsecond_are_not_lost():
    wall = Wall()
    pace = Pace(0.01, wall)

    passed_us = 0
    for _ in range(1000):
        wall.s += 0.000_05
        passed_us += pace.passed_us()

    assert abs(passed_us - 500) <= 1
