"""Looking at a robot while the host waits: often in a jump, seldom at rest, and never felt by host or robot."""

from itertools import pairwise

from hil_sim.faults.happening import schedule
from host.gait.compiler import compile_script
from host.gait.script import loads
from host.keeper import Keeper
from host.link import open_link
from host.records import Telemetry
from host.robot import Robot
from host.run import run
from tests.rolling_sphere import APEX_S, SNAP_S, JumpingSphere, RollingSphere

SCRIPT = "gait 1\nrobot circular\nfire A at 60 % for 300 ms\n"
PERIOD_MS = 5


class Watched(JumpingSphere):
    """A jumping sphere that can be watched."""

    def watch(self, glance):
        self.glance = glance


def watched_jump():
    """Return the scenes of a jump that was looked at each 5 ms, with a telemetry each 50 ms."""
    sphere = Watched()
    keeper = Keeper(observer=sphere)
    for now_ms in range(0, 6000, PERIOD_MS):
        sphere.t_s = now_ms / 1000
        sphere.glance(now_ms)
        if now_ms % 50 == 0:
            keeper.record(Telemetry(now_ms, 0, "running", 1, 5000, 0, 25.0, (), ()))
    return keeper.recording.scenes


def test_a_release_is_seen_every_few_milliseconds_and_rest_beside_the_telemetry():
    times = [scene["host_ms"] / 1000 for scene in watched_jump()]

    release = [t for t in times if SNAP_S - 0.001 < t < SNAP_S + 0.03]
    rest = [t for t in times if t < 0.3]
    assert max(b - a for a, b in pairwise(release)) * 1000 <= 2 * PERIOD_MS + 0.1  # it rings at 80 Hz
    assert [round(1000 * t) for t in rest] == list(range(0, 300, 50))


def test_a_flight_is_seen_more_often_than_the_telemetry_comes():
    times = [scene["host_ms"] / 1000 for scene in watched_jump()]

    flight = [t for t in times if SNAP_S < t < APEX_S]
    assert len(flight) > 10
    assert len(times) < 400  # of 1200 glances


def test_no_instant_of_a_body_is_kept_twice():
    scenes = watched_jump()

    assert len({scene["t_s"] for scene in scenes}) == len(scenes)


def test_nothing_is_kept_before_the_robot_tells_anything():
    sphere = Watched()
    keeper = Keeper(observer=sphere)

    sphere.glance(5)

    assert keeper.recording.scenes == []


def test_an_observer_that_cannot_be_watched_is_asked_beside_each_telemetry():
    keeper = Keeper(observer=RollingSphere())

    keeper.record(Telemetry(50, 0, "running", 1, 5000, 0, 25.0, (), ()))

    assert [scene["host_ms"] for scene in keeper.recording.scenes] == [50]


def test_a_run_is_the_same_for_the_robot_whether_it_is_watched_or_not():
    hashes = []
    for looks in (True, False):
        link = open_link("sim:circular")
        keeper = Keeper(observer=link.observer if looks else None)
        with Robot(link, keeper) as robot:
            robot.connect()
            run(robot, compile_script(loads(SCRIPT), robot.profile).program, lambda stage, done: None)
            hashes.append((link.observer.trace_sha256(), link.now_s()))

    assert hashes[0] == hashes[1]


class Announced:
    """A progress that lets something happen to the bench in the last moment of a program."""

    def __init__(self, link, fault):
        self.bench, self.fault = link.bench, fault

    def __call__(self, stage, done):
        if stage == "run" and done > 0.28 and self.fault:
            schedule(self.bench, self.bench.clock.now_us + 60_000, self.fault)
            self.fault = ""


def test_a_trip_just_after_the_end_of_a_program_is_how_it_ended():
    link = open_link("sim:circular?body=still")
    robot = Robot(link)
    robot.connect()
    compiled = compile_script(loads(SCRIPT), robot.profile)

    ending = run(robot, compiled.program, Announced(link, "estop-open"))

    assert (ending.result, ending.event.event) == ("fault", "tripped")
