"""The attitude sensor of sphere-a through every layer: chip, bus, driver, estimate, wire; and its faults."""

import math

import pytest

from host.errors import Refused
from host.gait.compiler import compile_script
from host.gait.script import loads
from tests.hil_rig import HilRig

HEAD = "gait 1\nrobot sphere-a\n"
CRAWL = "circle roll = A00m1 A10m1 A100 A101 A001 Am101 Am100 Am10m1\n"
ASKS = "guard roll > 80 deg\nfire A100 at 5 % for 3 s"


@pytest.fixture
def ball():
    """The robot at rest, connected."""
    rig = HilRig("sim:sphere-a")
    rig.run(0.3)
    yield rig
    rig.link.close()


def started(rig, body):
    """Compile, upload and start a script."""
    made = compile_script(loads(HEAD + body + "\n"), rig.robot.profile)
    rig.robot.upload(made.program[:16], made.code)
    rig.robot.arm()
    rig.robot.start()


def told(rig, seconds, name):
    """Return the events of that name within that time."""
    return [record for record in rig.run(seconds) if getattr(record, "event", "") == name]


@pytest.mark.parametrize(
    ("start", "pitch_deg", "roll_deg", "down"),
    [
        ("start.pitch_deg:0", 0, 0, "A00m1"),
        ("start.pitch_deg:135", 135, 0, "A101"),
        ("start.pitch_deg:-90", -90, 0, "Am100"),
        ("start.roll_deg:45", 0, 45, "A0m1m1"),
        ("start.roll_deg:-45", 0, -45, "A01m1"),
    ],
)
def test_the_robot_tells_how_it_lies_whichever_way_it_was_put_down(start, pitch_deg, roll_deg, down):
    rig = HilRig(f"sim:sphere-a?set={start}")
    rig.run(3)

    status = rig.robot.status()

    assert status.down == down == rig.bench.observe()["down"]
    assert abs(status.pitch_deg - pitch_deg) < 7  # the zero levels of its sensor
    assert abs(status.roll_deg - roll_deg) < 7
    rig.link.close()


def test_each_chip_has_zero_levels_of_its_own():
    seen = set()
    for seed in (1, 2, 3):
        rig = HilRig(f"sim:sphere-a?seed={seed}")
        rig.run(1)
        status = rig.robot.status()
        seen.add((status.pitch_deg, status.roll_deg))
        rig.link.close()

    assert len(seen) == 3


def test_the_estimate_follows_the_core_through_a_roll(ball):
    started(ball, "fire A00m1 at 100 % for 550 ms\nfire A10m1 at 100 % for 550 ms\nfire A10m1 at 24 % for 2 s")
    errors, turned = [], []

    for _ in range(60):
        ball.run(0.05)
        pitch_deg = ball.robot.status().pitch_deg
        turned.append(pitch_of(ball.bench.plant.attitude()))
        errors.append(abs(pitch_deg - turned[-1]))

    assert max(turned) > 30  # it did roll
    assert max(errors) < 10  # its zero levels, and what the answer takes on the line


@pytest.mark.parametrize("fault", ["imu-dead", "imu-stuck"])
def test_a_program_that_asks_where_down_is_trips_when_the_sensor_fails(ball, fault):
    started(ball, ASKS)
    ball.happens(fault)

    (tripped,) = told(ball, 1.5, "tripped")

    assert tripped.code == 117
    assert ball.coil("A100").duty_percent == 0


@pytest.mark.parametrize("fault", ["imu-dead", "imu-stuck"])
def test_a_program_that_does_not_ask_goes_on(ball, fault):
    started(ball, "fire A100 at 5 % for 2 s")
    ball.happens(fault)

    records = ball.run(2.5)

    events = [record.event for record in records if hasattr(record, "event")]
    assert events.count("lost") == 1
    assert events[-1] == "finished"
    assert ball.robot.status().down is None


def test_a_sensor_that_was_switched_off_for_an_instant_is_set_again(ball):
    ball.happens("imu-forgets")
    ball.run(1.3)

    assert ball.robot.status().down == "A00m1"


def test_a_start_is_refused_while_nobody_knows_where_down_is(ball):
    ball.happens("imu-dead")
    ball.run(0.5)

    with pytest.raises(Refused, match="R20"):
        started(ball, CRAWL + "let next = roll[down]\nfire $next at 5 % for 1 s")


def test_an_empty_place_is_told_and_the_robot_works_without_it():
    rig = HilRig("sim:sphere-a?set=sensors.imu_count:0")
    rig.run(0.5)

    assert rig.robot.status().down is None
    rig.fire("A100", duty_percent=5, hold_s=0.2)
    assert rig.coil("A100").duty_percent == pytest.approx(5, abs=0.1)
    rig.link.close()


def test_the_coil_is_chosen_by_the_attitude_at_the_start():
    rig = HilRig("sim:sphere-a?set=start.pitch_deg:90")
    rig.run(1)

    started(rig, CRAWL + "let next = roll[down + 1]\nfire $next at 5 % for 1 s")
    rig.run(0.2)

    assert rig.coil("A101").duty_percent == pytest.approx(5, abs=0.1)
    rig.link.close()


def pitch_of(attitude):
    """Return by how much a body of that attitude has turned forward [deg]."""
    w, x, y, z = attitude
    return math.degrees(math.atan2(-2 * (x * z - w * y), 1 - 2 * (x * x + y * y)))
