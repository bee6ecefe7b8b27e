"""Faults of joints and camera on a bench whose firmware does nothing but send pulses."""

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
right, left = PWM(Pin(8), freq=200), PWM(Pin(9), freq=200)
width_ns = 1_500_000
while True:
    width_ns = min(width_ns + 1_000, 1_588_889)  # 8 degrees, within half a second
    right.duty_ns(width_ns)
    left.duty_ns(3_000_000 - width_ns)
    time.sleep_ms(5)
"""
STALL_A = 2.5
OF_JOINTS = ("joint-jam:R", "servo-dead:R", "pot-open:R")
OF_CAMERA = ("camera-lost", "camera-frozen", "object-hidden")


@pytest.fixture
def bench():
    """A bench whose fingers grip by 8 degrees within a second."""
    robot = load("fingers")
    bench = Bench(parts_of(robot), plant_of(robot, 1, "moving"), Image({"main.py": PULSES}))
    yield bench
    bench.close()


def angle_deg(bench, joint=0):
    return float(bench.plant.joint_position[joint])


def camera(bench):
    """Return status and frame counter as the bus gives them, None when nobody answers."""
    bench.board.bus.write(0x33, b"\x01")
    return bench.board.bus.read(0x33, 2)


def test_a_joint_that_is_jammed_stays_and_takes_its_stall_current(bench):
    happening = schedule(bench, 250_000, "joint-jam:R")
    bench.run(0.25)
    stuck_deg = angle_deg(bench)

    bench.run(0.75)

    assert angle_deg(bench) == pytest.approx(stuck_deg, abs=0.5)  # the step in which it happens
    assert angle_deg(bench, 1) == pytest.approx(-8.0, abs=0.1)
    assert bench.plant.joint_current_a[0] == pytest.approx(STALL_A, rel=0.01)
    happening.mend()
    bench.run(0.5)
    assert angle_deg(bench) == pytest.approx(8.0, abs=0.1)


def test_a_servo_without_torque_is_pushed_away_by_the_other(bench):
    bench.run(1.0)
    schedule(bench, 1_000_000, "servo-dead:R", for_us=1_000_000)

    bench.run(0.9)
    assert bench.plant.joint_current_a[0] < 0.2
    assert angle_deg(bench) < 0.5
    bench.run(1.0)

    assert angle_deg(bench) == pytest.approx(8.0, abs=0.1)


def test_a_potentiometer_that_is_cut_off_reads_0_and_its_neighbours_what_they_did(bench):
    bench.run(1.0)
    counts = [bench.board.adc.counts(channel) for channel in range(4)]
    happening = schedule(bench, 1_000_000, "pot-open:L")

    bench.run(0.001)

    assert [bench.board.adc.counts(channel) for channel in range(4)] == [*counts[:3], 0]
    happening.mend()
    assert bench.board.adc.counts(3) == counts[3]


def test_a_camera_that_is_lost_does_not_answer_until_it_is_mended(bench):
    schedule(bench, 100_000, "camera-lost", for_us=100_000)

    bench.run(0.15)
    assert camera(bench) is None
    bench.run(0.1)

    assert camera(bench)[0] == 1


def test_a_frozen_camera_goes_on_showing_its_last_frame(bench):
    schedule(bench, 100_000, "camera-frozen", for_us=100_000)
    bench.run(0.12)
    shown = camera(bench)

    bench.run(0.07)
    assert camera(bench) == shown
    bench.run(0.04)

    assert camera(bench) != shown


def test_a_hidden_object_is_not_seen_in_frames_that_go_on(bench):
    schedule(bench, 100_000, "object-hidden", for_us=100_000)
    bench.run(0.12)
    (seen, frame), (seen_later, later) = camera(bench), (bench.run(0.05), camera(bench))[1]

    assert (seen, seen_later) == (0, 0)
    assert later == frame + 5
    bench.run(0.06)
    assert camera(bench)[0] == 1


@pytest.mark.parametrize("fault", OF_JOINTS)
def test_a_robot_without_joints_refuses_their_faults_by_name(fault):
    link = open_link("sim:circular?body=still")

    with pytest.raises(ValueError, match=f"fault {fault}: this robot has no joints"):
        schedule(link.bench, link.bench.clock.now_us, fault)
    link.close()


@pytest.mark.parametrize("fault", OF_CAMERA)
def test_a_robot_without_a_camera_refuses_its_faults_by_name(fault):
    link = open_link("sim:circular?body=still")

    with pytest.raises(ValueError, match=f"fault {fault}: this robot has no camera"):
        schedule(link.bench, link.bench.clock.now_us, fault)
    link.close()


@pytest.mark.parametrize(
    ("fault", "words"),
    [("joint-jam:X", "name a joint of this robot, as in joint-jam:R"), ("coil-open:A", "this robot has no coils")],
)
def test_fingers_refuse_a_joint_that_they_have_not_and_every_coil(bench, fault, words):
    with pytest.raises(ValueError, match=f"fault {fault}: {words}"):
        schedule(bench, 0, fault)
