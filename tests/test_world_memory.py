"""Memory of the whole firmware under real MicroPython: none is allocated in a control step, in any state.

The heap is locked around every control step of the image that a board would run, on its own drivers and chips: an
allocation in it raises MemoryError, which ends the firmware.
"""

from functools import partial

import pytest

from hil_sim.address import parse
from hil_sim.assembly import parts_of, plant_of
from hil_sim.bench import Bench
from hil_sim.faults.happening import schedule
from hil_sim.link import BOOTED_US, SimLink
from hil_sim.robots.file import load
from hil_sim.worlds import micropython
from hil_sim.worlds.image import Image
from host.gait.compiler import compile_script
from host.gait.script import loads
from host.keeper import Keeper
from host.robot import Robot
from host.run import run
from protocol import messages
from tests.hil_rig import HilRig

LOCK = b"""

import micropython
_step = Control.step

def _locked(self, now_ms, state):
    micropython.heap_lock()
    try:
        return _step(self, now_ms, state)
    finally:
        micropython.heap_unlock()

Control.step = _locked
"""
ALLOCATES = b"""
    micropython.heap_lock()
    bytearray(now_ms & 7)
"""
EVERYTHING = """gait 1
robot sphere-a
circle roll = A00m1 A10m1 A100 A101 A001 Am101 Am100 Am10m1
guard any.temperature > 130 C
let next = roll[down + 1]
fire A100 A010 at 60 % for 200 ms until 60 C ramp 100 ms
wait until all.heat < 900 mJ timeout 1 s else continue
repeat 3:
    fire $next at 50 % for 100 ms
    wait until down is $next timeout 100 ms else continue
    wait until pitch > 170 deg timeout 50 ms else continue
    wait until $next.temperature > 100 C timeout 50 ms else continue
wait until supply.current > 9000 mA timeout 50 ms else continue
note "half of it"
hold A100 at 45 C with 30 % for 300 ms
repeat 2:
    wait until all.martensite < 1 % timeout 50 ms else rest
    wait 1 s
label rest
wait until any.resistance > 300 ohm timeout 50 ms else continue
wait until time > 100 s timeout 50 ms else continue
wait until roll > 170 deg timeout 50 ms else abort
on fault:
    note "aborted"
    fire A010 at 30 % for 100 ms
"""


FINGERS = """gait 1
robot fingers-experiment
guard any.current > 2400 mA
together:
    move R to 2.5 deg over 500 ms
    move L to -2.5 deg over 500 ms
wait until all.angle < 30 deg timeout 1 s else continue
orient 2 deg for 1 s
wait until orientation > 1 deg timeout 50 ms else continue
"""


def locked(name="sphere-a", lock=LOCK):
    """Return a robot whose firmware locks its heap in each control step, connected."""
    robot = load(name, {})
    image = Image.installed(robot.profile.read_bytes())
    files = {path: image.read(path) for path in image.paths()}
    files["a/firmware/control.py"] += lock
    address = parse(f"sim:{name}" if name.startswith("fingers") else f"sim:{name}?body=still")
    bench = Bench(parts_of(robot), plant_of(robot, 1, address.body), Image(files), micropython.execute)
    bench.clock.run_until(BOOTED_US)
    link = SimLink(bench)
    robot = Robot(link, Keeper())
    robot.connect()
    return robot, bench


def test_no_control_step_of_a_whole_session_allocates():
    robot, bench = locked()
    robot.arm()
    robot.fire(["A100", "Am100"], 600, 400)
    list(robot.listen(800))
    states = {robot.status().state}
    run(robot, compile_script(loads(EVERYTHING), robot.profile, ()).program, lambda stage, done: None)
    robot.stop()
    states.add(robot.status().state)
    robot.clear()
    states.add(robot.status().state)

    assert states == {"armed", "tripped", "idle"}
    assert bench.crashes == []
    assert bench.world.resets == 0


@pytest.mark.parametrize(
    "fault", ["pwm-dead", "monitor-dead", "imu-dead", "coil-open:A100", "i2c-stuck", "supply-sag:60"]
)
def test_no_control_step_allocates_when_a_chip_or_coil_fails(fault):
    robot, bench = locked()
    robot.arm()
    robot.fire(["A100"], 800, 2000)
    schedule(bench, bench.clock.now_us + 300_000, fault)
    list(robot.listen(2500))

    assert bench.crashes == []


@pytest.mark.parametrize("fault", ["", "camera-lost", "camera-frozen", "pot-open:R", "joint-jam:R"])
def test_no_control_step_allocates_while_joints_move_and_an_object_is_turned(fault):
    robot, bench = locked("fingers-experiment")
    if fault:
        schedule(bench, bench.clock.now_us + 600_000, fault)
    run(robot, compile_script(loads(FINGERS), robot.profile, ()).program, lambda stage, done: None)

    assert bench.crashes == []
    assert bench.world.resets == 0


@pytest.mark.parametrize("request_of", [messages.COILS_REQUEST, messages.SETTINGS_REQUEST, messages.STATUS_REQUEST])
def test_a_burst_of_questions_leaves_memory_for_their_answers(request_of):
    rig = HilRig("sim:circular?body=still&world=micropython")
    for _ in range(4):
        asked = [rig.robot.talk.ask(request_of) for _ in range(40)]
        assert all(rig.robot.talk.answer(seq) for seq in asked)

    assert rig.bench.crashes == []
    rig.link.close()


def test_the_lock_finds_a_step_that_allocates():
    bad = LOCK.replace(b"    micropython.heap_lock()\n", ALLOCATES.lstrip(b"\n"))
    with pytest.raises(Exception, match="answers"):
        locked(lock=bad)


@pytest.mark.parametrize("name", ["sphere-b", "fingers", "press"])
def test_every_robot_starts_with_memory_to_spare(name):
    robot = load(name, {})
    scant = partial(micropython.execute, heap_bytes=micropython.HEAP_BYTES - 48 * 1024)
    bench = Bench(parts_of(robot), plant_of(robot, 1), Image.installed(robot.profile.read_bytes()), scant)
    bench.clock.run_until(BOOTED_US)
    SimLink(bench).close()

    assert bench.crashes == []
