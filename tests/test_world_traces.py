"""The firmware that runs in CPython and the one that runs in real MicroPython do the same thing at the same time.

One hash covers every bus transfer, pin edge, conversion, flash operation and byte on the line with its time: it is
compared over whole scripts and the beginning of all, with faults, looked at often or seldom, and is shown to feel the
smallest difference.
"""

import json
from functools import cache
from pathlib import Path

import pytest
from click.testing import CliRunner

from hil_sim.faults.happening import schedule
from hil_sim.link import open_link
from host.cli import main
from host.gait.compiler import compile_script
from host.gait.script import load
from host.records import Event
from host.robot import Robot
from host.run import upload

GAITS = sorted(Path("gaits").glob("*.gait"))
WORLDS = ("cpython", "micropython")
WHOLE = ("circular-crawl", "sphere-a-attitude-crawl", "sphere-b-jump", "fingers-orient", "press-hold-release")
BEGINNING_MS = 4000
LIGHT = {"press": "set=block.columns_count:16&set=block.rows_count:8", "fingers": "", "fingers-experiment": ""}
BRIEF = """gait 1
robot circular
repeat 2:
    fire A at 100 % for 200 ms until 60 C
    together:
        fire {first} at 60 % for 150 ms
        fire {second} at 40 % for 150 ms ramp 100 ms
    wait until any.temperature < 100 C timeout 1 s else continue
"""


def report(script, address):
    """Run a script and return its report, whatever came of it."""
    result = CliRunner().invoke(main, ["run", str(script), "--robot", address, "--json"])
    return json.loads(result.stdout.splitlines()[-1])


@cache
def traced(script, robot, world):
    """Return the trace and the outcome of a script that comes with softrig."""
    done = report(script, f"sim:{robot}?world={world}")
    return done["trace_sha256"], done["result"], done["duration_s"]


def robot_of(path):
    """Return the robot that a script names."""
    return next(line.split()[1] for line in path.read_text().splitlines() if line.startswith("robot "))


def begun(robot, world):
    """Return the trace after the beginning of each script of a robot, one after another, and the step it came to."""
    link = open_link(f"sim:{robot}?world={world}&{LIGHT.get(robot, 'body=still')}")
    face = Robot(link)
    face.connect()
    traces = {}
    for path in (path for path in GAITS if robot_of(path) == robot):
        upload(face, compile_script(load(path), face.profile).program, lambda stage, done: None)
        face.clear()
        face.arm()
        face.start()
        steps = [record.step for record in face.listen(BEGINNING_MS) if isinstance(record, Event)]
        traces[path.stem] = max(steps), link.bench.trace_sha256()
        face.disarm()
    link.close()
    return traces


@pytest.fixture
def brief(tmp_path):
    """Return a short script on file that fires two coils in that order."""

    def written(first="B", second="C"):
        path = tmp_path / f"{first}{second}.gait"
        path.write_text(BRIEF.format(first=first, second=second))
        return path

    return written


@pytest.mark.parametrize("robot", sorted({robot_of(path) for path in GAITS}))
def test_every_script_begins_with_the_same_trace_in_both_worlds(robot):
    here, there = (begun(robot, world) for world in WORLDS)

    assert here == there
    assert all(step for step, _ in here.values())


@pytest.mark.parametrize("path", [path for path in GAITS if path.stem in WHOLE], ids=lambda path: path.stem)
def test_whole_scripts_leave_the_same_trace_in_both_worlds(path):
    here, there = (traced(path, robot_of(path), world) for world in WORLDS)

    assert here == there
    assert here[1] == "done"


@pytest.mark.parametrize("world", WORLDS)
def test_two_runs_of_one_seed_leave_the_same_trace_and_another_seed_another(brief, world):
    one, again, other = (report(brief(), f"sim:circular?world={world}&seed={seed}") for seed in (1, 1, 2))

    assert one["trace_sha256"] == again["trace_sha256"] != other["trace_sha256"]


@pytest.mark.parametrize("world", WORLDS)
def test_one_coil_order_more_or_less_or_changed_changes_the_trace(brief, world):
    bc, cb, bd = (report(brief(*coils), f"sim:circular?world={world}") for coils in ("BC", "CB", "BD"))

    assert len({run["trace_sha256"] for run in (bc, cb, bd)}) == 3


def driven(world, step_s, faults=(), pause=False):
    """Fire two coils on a bench that is looked at every `step_s` and return its trace."""
    link = open_link(f"sim:circular?world={world}&body=still")
    robot = Robot(link)
    robot.connect()
    robot.arm()
    robot.fire(["A", "C"], 600, 300)
    begun_us = link.bench.clock.now_us
    for after_us, fault in faults:
        schedule(link.bench, begun_us + after_us, fault)
    until_us = begun_us + 1_500_000
    while (left_us := until_us - link.bench.clock.now_us) > 0:
        link.bench.run(min(step_s, left_us / 1e6))
        if pause:
            link.bench.observe()
            link.bench.snapshot()
    trace = link.bench.trace_sha256()
    link.close()
    return trace


def test_how_fast_and_how_often_the_bench_is_driven_does_not_change_the_trace():
    traces = {driven(world, step_s) for world in WORLDS for step_s in (1.5, 0.0137, 0.001)}

    assert len(traces) == 1


def test_a_pause_to_look_at_the_robot_does_not_change_the_trace():
    assert driven("micropython", 0.1, pause=True) == driven("cpython", 1.5)


@pytest.mark.parametrize(
    "faults",
    [
        ["cable-cut"],
        ["hang"],
        ["reset"],
        ["power-cycle"],
        ["pwm-dead"],
        ["monitor-forgets"],
        ["i2c-stuck", "i2c-free"],
        ["thermistor-short"],
        ["estop-open", "estop-close"],
        ["coil-open:A"],
        ["coil-short:A"],
        ["mosfet-stuck:B"],
        ["monostable-bypassed"],
        ["brown-out"],
        ["i2c-nack:5"],
        ["i2c-bit-error:50"],
        ["hang:control"],
        ["line-flip:50"],
        ["line-delay:100"],
        ["line-lose:50"],
        ["line-double:50"],
        ["line-baud:57600"],
        ["host-killed"],
        ["hang:receive"],
        ["hang:send"],
        ["pwm-forgets"],
        ["monitor-dead"],
        ["contactor-welded"],
        ["supply-sag:30"],
        ["thermistor-open"],
        ["thermistor-drift:60"],
    ],
    ids=" ".join,
)
def test_a_fault_leaves_the_same_trace_in_both_worlds(faults):
    plan = [(100_000 + 137_000 * turn, fault) for turn, fault in enumerate(faults)]

    here, there = (driven(world, 0.05, plan) for world in WORLDS)

    assert here == there != driven("cpython", 0.05)


def turned(world, fault):
    """Grip and turn an object, with a fault on the way, and return the trace."""
    link = open_link(f"sim:fingers-experiment?world={world}")
    robot = Robot(link)
    robot.connect()
    robot.arm()
    robot.move(["R"], 250, 300, 3000)
    robot.move(["L"], -250, 300, 3000)
    schedule(link.bench, link.bench.clock.now_us + 700_000, fault, for_us=500_000)
    list(robot.listen(500))
    robot.orient(200, 1000, 500)
    list(robot.listen(2000))
    trace = link.bench.trace_sha256()
    link.close()
    return trace


@pytest.mark.parametrize(
    "fault", ["joint-jam:R", "servo-dead:L", "pot-open:R", "camera-lost", "camera-frozen", "object-hidden"]
)
def test_a_fault_of_joints_or_camera_leaves_the_same_trace_in_both_worlds(fault):
    here, there = (turned(world, fault) for world in WORLDS)

    assert here == there
