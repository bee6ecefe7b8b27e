"""The rate of the serial line: the robot finds that of its host, and noise never takes it away for long."""

import pytest

from docs import board as pico
from firmware.rates import FRAME_MS, QUIET_MS, RATES, TRY_MS, Rates
from hil_sim.link import open_link
from host.errors import NotOurs, Silent
from host.robot import Robot
from tests.hil_rig import HilRig

HOME, FAST, THIRD, FOURTH = RATES


class Line:
    """A board that remembers its rate."""

    def __init__(self) -> None:
        self.noise = 0
        self.baud = HOME
        self.rates = Rates(self)
        self.now_ms = 0

    def tune(self, baud: int) -> None:
        self.baud = baud

    def run(self, ms: int, noise: int = 0, intact: bool = False, at_rest: bool = True) -> int:
        """Let time pass with so many bytes in each step; return the rate."""
        for _ in range(0, ms, 5):
            self.now_ms += 5
            self.noise += noise
            self.rates.look(self.now_ms, intact, at_rest)
        return self.baud


@pytest.fixture
def line():
    return Line()


def connected(address: str) -> Robot:
    robot = Robot(open_link(address))
    robot.connect()
    return robot


def rate_of(link) -> int:
    """Return the rate at which the robot of a bench sends."""
    return link.bench.board.uart.outward.baud


def test_the_first_rate_is_that_of_the_board():
    assert pico.constants()["BAUD"] == RATES[0]


@pytest.mark.parametrize("baud", RATES)
def test_a_robot_finds_the_rate_of_its_host(baud):
    robot = connected(f"sim:circular?baud={baud}&body=still")

    robot.arm()

    assert robot.status().state == "armed"
    assert rate_of(robot.link) == baud
    assert robot.link.now_s() < 2.0


def test_a_host_at_a_rate_that_no_robot_has_is_told_so_and_the_next_one_is_heard():
    link = open_link("sim:circular?baud=57600&body=still")
    with pytest.raises((Silent, NotOurs)):
        Robot(link).connect()

    link.bench.board.uart.retune(HOME, link.bench.clock.now_us)
    Robot(link).connect()


def test_a_stop_at_another_rate_reaches_an_idle_robot():
    robot = Robot(open_link("sim:circular?baud=921600&body=still"))

    stopped = robot.stop()

    assert stopped.state == "tripped"


def test_a_robot_that_is_at_work_keeps_its_rate_whatever_arrives():
    rig = HilRig("sim:circular")
    rig.fire("A", duty_percent=50, hold_s=9)

    rig.happens("line-baud:57600")
    rig.bench.board.host_write(bytes(range(1, 100)) * 3)
    rig.run_alone(0.4)

    assert rate_of(rig.link) == HOME


def test_a_frame_that_takes_several_steps_to_arrive_changes_nothing(line):
    assert line.run(25, noise=57) == HOME
    assert line.run(5, noise=57, intact=True) == HOME
    assert line.run(QUIET_MS - 5, noise=57) == HOME


def test_noise_on_a_quiet_line_costs_a_second_at_most(line):
    line.run(5, noise=20, intact=True)
    line.run(QUIET_MS)

    assert line.run(FRAME_MS + 5, noise=4) == HOME
    assert line.run(10, noise=4) == FAST
    assert line.run(TRY_MS - 10) == FAST
    assert line.run(10) == HOME


def test_bytes_that_go_on_are_tried_at_each_rate_in_turn_with_the_last_good_one(line):
    seen = [line.baud]
    for _ in range(100):
        baud = line.run(5, noise=20)
        if baud != seen[-1]:
            seen.append(baud)

    assert seen[:8] == [HOME, FAST, HOME, THIRD, HOME, FOURTH, HOME, FAST]


def test_the_rate_at_which_a_frame_was_intact_is_the_one_to_return_to(line):
    while line.run(5, noise=20) != FAST:
        pass
    line.run(5, noise=20, intact=True)
    line.run(QUIET_MS)

    while line.run(5, noise=20) == FAST:
        pass

    assert line.baud == THIRD
    assert line.run(TRY_MS) == FAST


def test_some_bytes_alone_are_no_host(line):
    line.run(5, noise=7)

    assert line.run(5000) == HOME


def test_noise_that_came_while_a_coil_was_on_is_forgotten(line):
    seen = {line.run(5, noise=20, at_rest=False) for _ in range(40)}

    assert seen == {HOME}
    assert line.run(5000) == HOME
