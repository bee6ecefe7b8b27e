"""`softrig fit press`: a material that was planted on the bench is found in the log of a press."""

import json
import sys

import pytest
from click.testing import CliRunner

from host.cli import main

PRESS = "gaits/press-hold-release.gait"
SETS = [(60.0, 300.0, 6.0), (30.0, 60.0, 3.0)]
SMALL = "set=block.columns_count:32&set=block.rows_count:16&set=load_cell.noise_n:0.02"


def cli(*arguments):
    return CliRunner().invoke(main, [str(each) for each in arguments])


def pressed(path, options, planted=SETS[0]):
    """Run the script on a coarse block and return the path of its log."""
    names = ("youngs_modulus_kpa", "viscosity_kpa_s", "damping_kpa_s")
    material = "&".join(f"set=material.{name}:{value}" for name, value in zip(names, planted, strict=True))
    done = cli("run", PRESS, "--robot", f"sim:press?{options}&{SMALL}&{material}", "-p", "rest=1s", "--log", path)
    assert done.exit_code == 0, done.output
    return path


@pytest.fixture(scope="module")
def flat(tmp_path_factory):
    return pressed(tmp_path_factory.mktemp("fit") / "flat.mcap", "indenter=flat&seed=3")


@pytest.mark.parametrize("planted", SETS)
def test_what_was_planted_on_a_noisy_bench_is_found(tmp_path, planted):
    log = pressed(tmp_path / "press.mcap", "indenter=flat&seed=5", planted)

    found = json.loads(cli("fit", "press", log, "--json").output)

    names = ("youngs_modulus_kpa", "viscosity_kpa_s", "damping_kpa_s")
    for name, true, share in zip(names, planted, (0.01, 0.01, 0.05), strict=True):
        assert found[name]["low"] - 0.003 * true < true < found[name]["high"] + 0.003 * true, name
        assert found[name]["value"] == pytest.approx(true, rel=share), name
    assert found["noise_n"] == pytest.approx(0.02, rel=0.2)
    assert found["notes"] == []


def test_a_part_of_the_material_that_was_not_asked_for_is_told(tmp_path):
    log = pressed(tmp_path / "press.mcap", "indenter=flat&seed=3&set=material.parallel_modulus_kpa:5")

    (note,) = json.loads(cli("fit", "press", log, "--json").output)["notes"][:1]

    assert "kPa beside the dashpots fits better" in note
    assert json.loads(cli("fit", "press", log, "--json", "--spring").output)["parallel_modulus_kpa"]["low"] > 2.0


def test_the_result_is_told_with_errors_and_limits(flat, tmp_path):
    done = cli("fit", "press", flat, "--plot", tmp_path / "fit.svg")

    assert done.exit_code == 0
    assert done.stdout.splitlines()[0].startswith("press of 4.00 mm in 1.9")
    assert "Young's modulus E" in done.stdout
    assert "95 %:" in done.stdout
    assert (tmp_path / "fit.svg").read_text().lstrip().startswith("<?xml")


def test_a_shape_that_is_given_takes_the_place_of_the_observers(flat):
    told, halved = (
        json.loads(cli("fit", "press", flat, "--json", *more).output) for more in ((), ("--shape", "22.95mm"))
    )

    assert halved["shape_m"] == 0.02295
    ratio = told["shape_m"] / 0.02295
    assert halved["youngs_modulus_kpa"]["value"] == pytest.approx(ratio * told["youngs_modulus_kpa"]["value"], rel=1e-3)


def test_a_cylinder_is_refused_with_what_to_do(tmp_path):
    log = pressed(tmp_path / "round.mcap", "indenter=cylinder")

    done = cli("fit", "press", log)

    assert done.exit_code == 2
    assert "whose contact grows with the depth" in done.stderr
    assert "sim:press?indenter=flat" in done.stderr


@pytest.mark.parametrize("shape", ["0mm", "-3mm", "wide", "3 kg"])
def test_a_shape_that_is_no_length_is_refused(flat, shape):
    assert cli("fit", "press", flat, f"--shape={shape}").exit_code == 2


def test_where_scipy_is_missing_the_extra_is_named(flat, monkeypatch):
    monkeypatch.setitem(sys.modules, "scipy", None)

    assert "pip install 'softrig[fit]'" in cli("fit", "press", flat).stderr
