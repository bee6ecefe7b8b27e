"""docs/press.md says what a run says: its commands run, its measured numbers come out again."""

import json
import re
import shlex
import subprocess
from contextlib import chdir
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from hil_sim.physics.block.indenters import Cylinder, Punch
from hil_sim.physics.block.law import push_and_hold, recovery
from hil_sim.physics.block.stress import Cells
from host.cli import main as softrig
from host.gait.compiler import compile_script
from host.gait.script import load
from host.keeper import Keeper
from host.link import open_link
from host.recording import Recording
from host.robot import Robot
from host.run import run
from host.view.instants import Numbers
from host.view.pressing import of_scenes, press_of
from tests.block_samples import THREE
from tests.press_samples import press_of as made_press
from tests.press_samples import program
from tests.pressed_block import CELLS_MM, LABELS

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "press.md").read_text(encoding="utf-8")
FENCED = re.findall(r"^```(\w*)\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
BLOCKS, SCRIPTS = ([text for kind, text in FENCED if kind == wanted] for wanted in ("", "python"))
LINEAR = re.findall(r"^\| `(set=\S+)` \| ([\d.]+) N \| ([\d.]+) N \| ([\d.]+) % \| ([\d.]+) % \|$", PAGE, re.MULTILINE)
FIVE = next(re.finditer(r"`(sim:press\?set=material.youngs_modulus_kpa:40&\S+)`", PAGE))[1]
STEP_S = 0.01
HELD = "force at the end of the hold"
PHASE = 0.005  # a push of 2 s begins at any time between two steps of the block's solver, 10 ms apart
COARSE = "set=block.columns_count:16&set=block.rows_count:8"


@cache
def recorded(address: str, *params: str) -> Recording:
    """Return the recording of a push, hold and release on the bench."""
    link = open_link(address)
    keeper = Keeper(observer=link.observer, slice_ms=50)
    with Robot(link, keeper) as robot:
        robot.connect()
        keeper.know(robot.profile.parts)
        compiled = compile_script(load(str(ROOT / "gaits" / "press-hold-release.gait")), robot.profile, params)
        run(robot, compiled.program, lambda stage, done: None)
    return keeper.recording


def told(recording: Recording) -> dict[str, float]:
    """Return what the tables of the page tell of a run; times since the push began."""
    scenes, press, seen = recording.scenes, press_of(recording), recording.scenes[-1]["observed"]
    times, force = of_scenes(recording, "host_ms") / 1000, of_scenes(recording, "force_n")
    steps = [event.host_ms / 1000 for event in recording.events if event.event == "step"]
    begin = max(step for step in steps if step < times[press.push] - 0.3)
    cells = {label: cell["pressure_kpa"] for label, cell in scenes[press.push]["cells"].items()}
    return {
        "force after 1 s": float(np.interp(begin + 1, times, force)),
        "greatest force, at the end of the push": seen["force_peak_n"],
        HELD: float(force[int(np.searchsorted(times, begin + 5.01)) - 1]),
        "the indenter lets go of the block": seen["lost_contact_s"] - begin,
        "dent that stays": seen["dent_mm"],
        **named(cells),
    }


def exact(indenter) -> dict[str, float]:
    """Return the same of the physics alone, below an axis that goes as it is told."""
    press = made_press(indenter, columns=64)
    cells = Cells(press.block.mesh, [(x / 1000, y / 1000) for x, y in CELLS_MM], 0.005)
    state, force, told = press.start(), {}, {}
    for step in range(1, round(8 / STEP_S) + 1):
        if indenter.bonded and step == round(5 / STEP_S) + 1:
            state = press.release(state)
        touched, gone = state.active.any(), indenter.bonded and step > round(5 / STEP_S)
        state = press.advance(state, STEP_S, depth=-0.010 if gone else program(step * STEP_S))
        force[step] = state.force
        if step == round(2 / STEP_S):
            told = named(dict(zip(LABELS, (-cells.mean(state.block.stress[1]) / 1000).tolist(), strict=True)))
        if touched and not state.active.any():
            told["the indenter lets go of the block"] = step * STEP_S
    told["force after 1 s"], told[HELD] = (force[round(t / STEP_S)] for t in (1, 5))
    told["greatest force, at the end of the push"] = max(force.values())
    return told | {"dent that stays": -1000 * float(state.block.u[:, 1].min())}


def named(cells: dict[str, float]) -> dict[str, float]:
    """Return what presses on the cells under the names of the page."""
    rows = {"pressure on C1 at the end of the push": "C1", "on C4": "C4", "on C5 and C6": "C5", "on C2 and C3": "C2"}
    return {row: cells[label] for row, label in rows.items()}


def times_of(recording: Recording) -> Numbers:
    """Return the bench's times of the scenes."""
    return of_scenes(recording, "t_s")


def left_kpa(recording: Recording, seconds: float) -> float:
    """Return the greatest von Mises stress of a triangle, so long after the indenter let go."""
    lost = recording.scenes[-1]["observed"]["lost_contact_s"]
    times, most = zip(*((each.t_s, float(each.von_mises_kpa.max())) for each in recording.slices), strict=True)
    return float(np.interp(lost + seconds, times, most))


def coarse(line: str) -> str:
    """Return a command for a block of few cells: what is tried is whether it runs."""
    return re.sub(r"sim:press(\??)", lambda found: f"sim:press?{COARSE}{'&' if found[1] else ''}", line)


def table(head: str) -> dict[str, tuple[float, float]]:
    """Return the two columns of numbers of the page's table of that name."""
    body = PAGE.split(f"| {head} | exact axis | robot on the bench |\n")[1].split("\n\n")[0]
    rows = re.findall(r"^\| (.*?) \| ([\d.]+) \S+ \| ([\d.]+) \S+ \|$", body, re.MULTILINE)
    return {name: (float(alone), float(bench)) for name, alone, bench in rows}


@pytest.fixture(scope="module")
def played(tmp_path_factory):
    """Return what runs the commands of a block, once, and tells in which folder."""

    @cache
    def play(block: str) -> Path:
        folder = tmp_path_factory.mktemp("page")
        for name in ("gaits", "hil_sim"):
            (folder / name).symlink_to(ROOT / name)
        (folder / "out").mkdir()
        with chdir(folder):
            exec(SCRIPTS[0], {})
            for line in block.splitlines():
                if line.startswith("softrig "):
                    softrig(shlex.split(coarse(line))[1:], standalone_mode=False)
                else:
                    subprocess.run(line, shell=True, check=True)
        return folder

    return play


@pytest.mark.parametrize("block", BLOCKS, ids=lambda block: " ".join(block.split()[:2]))
def test_the_commands_of_the_page_run(block, played):
    folder = played(block)

    written = re.findall(r"out/\S+", block)
    assert [name for name in written if not (folder / name).stat().st_size] == []


def test_the_material_that_is_found_is_that_of_the_page(played, capsys):
    log = played(next(block for block in BLOCKS if "fit press" in block)) / "out/flat.mcap"
    capsys.readouterr()

    softrig(["fit", "press", str(log), "--json"], standalone_mode=False)

    found = json.loads(capsys.readouterr().out)
    rows = re.findall(
        r"^\| \*(E₁|c₁|c₂)\* \| (\d+) \S.*?\| ([\d.]+) \S.*?\| ([\d.]+) to ([\d.]+) \|$", PAGE, re.MULTILINE
    )
    for (name, *told), key in zip(rows, ("youngs_modulus_kpa", "viscosity_kpa_s", "damping_kpa_s"), strict=True):
        planted, value, low, high = map(float, told)
        assert found[key]["value"] == pytest.approx(value, abs=2 * found[key]["error"]), name  # another draw
        assert (found[key]["low"], found[key]["high"]) == pytest.approx((low, high), abs=2 * found[key]["error"]), name
        assert low <= planted <= high


@pytest.mark.parametrize(
    ("head", "address", "indenter"),
    [
        ("cylinder", "sim:press", Cylinder(R=0.015)),
        ("bonded punch", "sim:press?indenter=bonded", Punch(0.020, bonded=True)),
    ],
)
def test_the_tables_are_those_of_the_model_and_of_runs(head, address, indenter):
    alone, bench = exact(indenter), told(recorded(address))

    rows = table(head)

    assert len(rows) >= 4
    for name, (first, second) in rows.items():
        coarse = 0.015 * second if name == HELD else 0.012 + PHASE * second  # scenes are 50 ms apart
        assert first == pytest.approx(alone[name], abs=0.0051), name
        assert second == pytest.approx(bench[name], abs=coarse), name


@pytest.mark.parametrize("address", ["sim:press?indenter=polygon"])
def test_the_dent_is_the_same_for_every_shape(address):
    dents = [told(recorded(each))["dent that stays"] for each in ("sim:press", address)]

    assert dents[1] == pytest.approx(dents[0], rel=1e-6)


def test_the_page_tells_of_five_materials():
    assert len(LINEAR) == 5


@pytest.mark.parametrize("row", LINEAR, ids=lambda row: row[0])
def test_residuals_in_closed_form_are_those_of_the_law(row):
    name, value = row[0].removeprefix("set=material.").split(":")
    c2 = float(value) * 1000
    material = THREE._replace(c0_unloading=c2) if name.startswith("unloading") else THREE._replace(c0=c2)

    assert 100 * recovery(material, 1e3, 2.0, 3.0) == pytest.approx(float(row[3]), abs=0.051)


@pytest.mark.parametrize("row", LINEAR[1:2], ids=lambda row: row[0])
def test_force_and_residual_of_a_material_are_those_of_a_run(row):
    setting, greatest, held, _, residual = row

    record = told(recorded(f"sim:press?indenter=flat&{setting}", "depth=2mm"))

    assert record["greatest force, at the end of the push"] == pytest.approx(
        float(greatest), abs=0.012 + PHASE * float(greatest)
    )
    assert record[HELD] == pytest.approx(float(held), rel=0.015)
    assert 100 * record["dent that stays"] / 2.0 == pytest.approx(float(residual), abs=0.06)


def test_another_viscosity_in_unloading_changes_the_residual_and_not_the_force():
    coarse = f"sim:press?indenter=flat&{COARSE}"

    one, dual = (told(recorded(address, "depth=2mm")) for address in (coarse, f"{coarse}&{LINEAR[-1][0]}"))

    for force in ("greatest force, at the end of the push", HELD):
        assert dual[force] == pytest.approx(one[force], abs=1e-3)
    assert 100 * dual["dent that stays"] / 2.0 == pytest.approx(float(LINEAR[-1][-1]), abs=0.06)  # on any mesh


def test_what_falls_when_the_axis_stops_and_what_can_come_back_at_most_are_those_of_the_law():
    stiff, (before, after) = THREE._replace(c0=150e3), (2.0, 2.0 + 1e-9)
    fall = 1 - push_and_hold(stiff, after, 2.0) / push_and_hold(stiff, before, 2.0)
    least = recovery(THREE._replace(c0=1e-3), 1e3, 2.0, 3.0)

    assert f"{100 * fall:.0f} % of it are gone the moment the axis stops" in PAGE
    assert f"= {100 * least:.1f} %, for what" in PAGE


def test_a_spring_beside_the_dashpot_lets_the_dent_creep_back():
    record = recorded(f"sim:press?set=material.parallel_modulus_kpa:5&{COARSE}", "rest=11s")
    dents, times = [scene["observed"]["dent_mm"] for scene in record.scenes], times_of(record)
    lost = record.scenes[-1]["observed"]["lost_contact_s"]

    first, later = (float(np.interp(lost + after, times, dents)) for after in (1, 10))

    assert f"it is {first:.2f} mm one second after the indenter let go, {later:.2f} mm after ten" in PAGE


@pytest.mark.parametrize(
    ("name", "address"),
    [
        (r"one ratio, 0.35 \(`sim:press`\)", "sim:press"),
        (r"the dashpot .*? 0.45 \(.*?\)", "sim:press?set=material.damping_poisson_ratio:0.45"),
        ("five elements, .*?", FIVE),
    ],
)
def test_the_stress_that_stays_is_that_of_runs(name, address):
    row = re.search(rf"^\| {name} \| ([\d.]+) kPa \| ([\d.]+) kPa \| ([\d.]+) kPa \|$", PAGE, re.MULTILINE)

    record = recorded(address)

    stays = [left_kpa(record, seconds) for seconds in (0.2, 1, 5)]
    assert [float(each) for each in row.groups()] == pytest.approx(
        stays, abs=0.03
    )  # 0.2 s after it let go it falls by 0.01 kPa in 5 ms


def test_the_greatest_strains_are_those_of_runs():
    coarse = "sim:press?indenter=bonded&set=block.columns_count:32&set=block.rows_count:16"
    addresses = ("sim:press", "sim:press?indenter=bonded", coarse, "sim:press?indenter=polygon")

    found = [recorded(each).scenes[-1]["observed"]["strain_peak_percent"] for each in addresses]

    pushing = recorded("sim:press").scenes[: press_of(recorded("sim:press")).push]
    depths, strains = zip(
        *((each["depth_mm"], each["observed"]["strain_peak_percent"]) for each in pushing), strict=True
    )
    shallow = f"{np.interp(2.0, depths, strains):.0f} % when it is 2 mm deep"
    cylinder, punch, half, wedge = (f"{percent:.0f} %" for percent in found)
    assert f"{cylinder} under the cylinder ({shallow}) and {punch} at the corners of the punch, {half} there" in PAGE
    assert f"{wedge} under the wedge" in PAGE


@pytest.mark.parametrize("address", ["sim:press?indenter=bonded", f"sim:press?indenter=flat&{LINEAR[1][0]}"])
def test_force_over_depth_and_modulus_is_a_length_of_a_punch_on_this_block(address):
    seen = recorded(address, *["depth=2mm"] * ("flat" in address)).scenes[-1]["observed"]

    assert f"the modulus of (B4): {1000 * seen['shape_m']:.0f} mm for the punch" in PAGE
