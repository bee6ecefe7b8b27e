"""Faults of load cell, force cells and converters on a bench whose firmware does nothing but send pulses."""

import pytest

from hil_sim.assembly import parts_of, plant_of
from hil_sim.bench import Bench
from hil_sim.faults.happening import schedule
from hil_sim.link import open_link
from hil_sim.robots.file import load
from hil_sim.worlds.image import Image

PULSES = b"""
from machine import PWM, Pin
import time
Pin(2, Pin.OUT, value=1)
axis = PWM(Pin(8), freq=200)
axis.duty_ns(1_800_000)  # 3 mm
while True:
    time.sleep_ms(5)
"""
CURRENT, POSITION, C1, C3, C6, LOAD_CELL = 0, 1, 2, 4, 7, 8


@pytest.fixture
def bench():
    """A bench whose press dents a coarse block by 3 mm."""
    robot = load("press", {"block.columns_count": 16, "block.rows_count": 8})
    bench = Bench(parts_of(robot), plant_of(robot, 1, "moving"), Image({"main.py": PULSES}))
    bench.run(1.0)
    yield bench
    bench.close()


def counts(bench):
    return [bench.board.adc.counts(number) for number in range(9)]


def lost(bench, fault):
    """Return which inputs read 0 while that is so, and none when it is mended."""
    before, at_us = counts(bench), bench.clock.now_us
    happening = schedule(bench, at_us, fault)
    bench.clock.run_until(at_us)
    now = counts(bench)
    happening.mend()
    assert counts(bench) == before
    assert all(now[number] in (0, before[number]) for number in range(9))
    return [number for number in range(9) if before[number] and not now[number]]


@pytest.mark.parametrize(
    ("fault", "inputs"),
    [
        ("load-cell-open", [LOAD_CELL]),
        ("cell-open:C1", [C1]),
        ("cell-open:C3", [C3]),
        ("cell-open:C6", [C6]),
        ("pot-open:P", [POSITION]),
        ("converter-dead:1", list(range(LOAD_CELL))),
        ("converter-dead:2", [LOAD_CELL]),
        ("converter-dead", list(range(9))),
    ],
)
def test_what_is_broken_reads_0_and_all_else_what_it_did(bench, fault, inputs):
    assert lost(bench, fault) == inputs


@pytest.mark.parametrize("fault", ["load-cell-open", "cell-open:C1"])
@pytest.mark.parametrize("robot", ["circular?body=still", "fingers"])
def test_a_robot_without_force_sensors_refuses_their_faults_by_name(fault, robot):
    link = open_link(f"sim:{robot}")

    with pytest.raises(ValueError, match=f"fault {fault}: this robot has no (load cell|force cells)"):
        schedule(link.bench, link.bench.clock.now_us, fault)
    link.close()


def test_a_robot_without_joints_has_no_converter_to_lose():
    link = open_link("sim:circular?body=still")

    with pytest.raises(ValueError, match="fault converter-dead:1: this robot has no converter"):
        schedule(link.bench, link.bench.clock.now_us, "converter-dead:1")
    link.close()


@pytest.mark.parametrize(
    ("fault", "words"),
    [
        ("cell-open:C7", "name a force cell of this robot, as in cell-open:C1"),
        ("cell-open", "write cell-open:CELL"),
        ("converter-dead:3", "after the colon stands 1 or 2"),
        ("load-cell-open:P", "takes nothing"),
        ("joint-jam:R", "name a joint of this robot, as in joint-jam:P"),
        ("camera-lost", "this robot has no camera"),
    ],
)
def test_what_this_press_has_not_is_refused_by_name(bench, fault, words):
    with pytest.raises(ValueError, match=f"fault {fault}: {words}"):
        schedule(bench, bench.clock.now_us, fault)
