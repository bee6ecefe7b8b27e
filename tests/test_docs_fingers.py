"""docs/fingers.md says what a run says: its commands run, its measured numbers come out again."""

import re
import shlex
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from host.cli import main as softrig
from host.gait.compiler import compile_script
from host.gait.script import load
from host.keeper import Keeper
from host.link import open_link
from host.recording import Recording
from host.robot import Robot
from host.run import run
from host.view.energy import energies_mj
from host.view.swings import joints_deg, object_deg, of_fingers, phases, swing_deg

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "fingers.md").read_text(encoding="utf-8")
COMMANDS = re.findall(r"^(softrig run .*|softrig figure 12 .*)$", PAGE, re.MULTILINE)
EXPERIMENTS = re.findall(r"^\| `(sim:fingers-experiment\S*)`.* \| ([\d.]+)° \| ([\d.]+) \|$", PAGE, re.MULTILINE)
SENSITIVITY = re.findall(r"\(`\?(set=\S+)`\) \| (−[\d.]+)°", PAGE)


@cache
def recorded(gait: str, address: str) -> Recording:
    """Return the recording of a gait on the bench."""
    link = open_link(address)
    keeper = Keeper(observer=link.observer)
    with Robot(link, keeper) as robot:
        robot.connect()
        keeper.know(robot.profile.parts)
        run(
            robot, compile_script(load(str(ROOT / "gaits" / gait)), robot.profile, ()).program, lambda stage, done: None
        )
    return keeper.recording


@pytest.fixture(scope="module")
def figure_13():
    return recorded("fingers-figure13.gait", "sim:fingers?set=servos.dead_band_us:0")


def row_of(phase):
    """Return the numbers of a phase's row of the page."""
    row = next(line for line in PAGE.splitlines() if line.startswith(f"| {phase}: "))
    cells = row.replace("−", "-").split("|")[2:]
    return [float(number) for cell in cells for number in re.findall(r"-?\d+\.\d+", cell)]


@pytest.mark.parametrize("line", COMMANDS)
def test_the_commands_of_the_page_run(line, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "gaits").symlink_to(ROOT / "gaits")
    (tmp_path / "out").mkdir()

    softrig(shlex.split(line)[1:], standalone_mode=False)

    written = re.findall(r"out/\S+", line)
    assert [name for name in written if not (tmp_path / name).stat().st_size] == []


@pytest.mark.parametrize("phase", [1, 2, 3])
def test_the_phases_are_those_of_a_run(phase, figure_13):
    i = phases(figure_13)[phase]
    depths, torques = of_fingers(figure_13, "d_mm")[i], np.abs(of_fingers(figure_13, "torque_nm")[i])
    normal, energy = of_fingers(figure_13, "normal_n")[i, 0], energies_mj(figure_13, "elastic")[i]

    told = row_of(phase)

    angles, (turned, stored, *pressed, force), torque = told[:2], told[2:7], told[7:]
    assert angles == pytest.approx(joints_deg(figure_13)[i], abs=0.006)
    assert turned == pytest.approx(object_deg(figure_13)[i], abs=0.006)
    assert [stored, force] == pytest.approx([energy, normal], abs=0.06)
    assert pressed == pytest.approx(depths, abs=0.006)
    assert torque == pytest.approx(torques[: len(torque)], abs=0.006)


def test_the_page_tells_of_five_experiments_and_three_assumptions():
    assert (len(EXPERIMENTS), len(SENSITIVITY)) == (5, 3)


@pytest.mark.parametrize(("address", "tilt", "used"), EXPERIMENTS[::2])
def test_experiments_are_those_of_runs(address, tilt, used):
    record = recorded("fingers-experiment.gait", address)
    left, right = phases(record)[2:4]

    tilted, swung = ((values[left] - values[right]) / 2 for values in (object_deg(record), swing_deg(record)))
    friction = [max(record.scenes[i]["observed"]["friction_used"].values()) for i in (left, right)]

    assert swung == pytest.approx(10, abs=0.06)
    assert -tilted == pytest.approx(float(tilt), abs=0.06)
    assert np.mean(friction) == pytest.approx(float(used), abs=0.006)


@pytest.mark.parametrize(("setting", "turned"), SENSITIVITY)
def test_what_the_assumptions_do_is_that_of_runs(setting, turned):
    record = recorded("fingers-figure13.gait", f"sim:fingers?{setting}")

    assert object_deg(record)[phases(record)[2]] == pytest.approx(float(turned.replace("−", "-")), abs=0.01)
