"""The firmware's core in the real MicroPython interpreter: the same bytes as in CPython, and no allocation in a step.

An interpreter that is missing fails these tests; nothing is skipped. SOFTRIG_MICROPYTHON names another one.
"""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
TRIAL = ROOT / "tests" / "image_trial.py"
ROBOTS = ROOT / "firmware" / "robots"
MICROPYTHON = os.environ.get("SOFTRIG_MICROPYTHON", str(Path(sys.executable).with_name("micropython")))


def printed(interpreter, robot, *arguments):
    """Return what the trial of a robot prints under that interpreter."""
    paths = {"MICROPYPATH": f"{ROOT}:.frozen", "PYTHONPATH": str(ROOT)}
    command = [interpreter, str(TRIAL), str(ROBOTS / f"{robot}.json"), *arguments]
    done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, **paths}, check=False)
    assert done.returncode == 0, done.stdout[-500:] + done.stderr
    return done.stdout.splitlines()


@pytest.fixture(scope="module", params=["circular", "sphere-a", "fingers", "press"])
def robot(request):
    """A robot of coils, one with an attitude sensor, one of joints with a camera, and a press."""
    return request.param


@pytest.fixture(scope="module")
def here(robot):
    """What the trial prints in CPython."""
    return printed(sys.executable, robot)


def test_both_interpreters_send_the_same_bytes_and_set_the_same_duties(here, robot):
    assert printed(MICROPYTHON, robot) == here


def test_the_trial_looks_at_orders_programs_faults_and_telemetry(here, robot):
    kinds = {line.split()[1] for line in here if line[0].isdigit()}
    driven = {"pulse", "limp"} if robot in ("fingers", "press") else {"set", "off"}

    assert kinds == {*driven, "power", "wait", "hasten", "average", "sent"}
    assert len([line for line in here if f" {max(driven)} " in line]) > 10
    assert len([line for line in here if " sent " in line]) > 50


def test_the_control_step_allocates_no_memory_in_any_state(robot):
    assert printed(MICROPYTHON, robot, "lock")[-1].startswith("dictionary")
