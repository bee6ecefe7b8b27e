"""Self-tests and sweeps of gaits/ on the bench: what they find, what they note, where they leave the robot."""

import json

import pytest
from click.testing import CliRunner

from host.cli import main

COARSE = "set=block.columns_count:16&set=block.rows_count:8"


def ran(script, robot, *params):
    """Return the report of a script of gaits/ on a robot of the bench."""
    given = [word for param in params for word in ("-p", param)]
    result = CliRunner().invoke(main, ["run", f"gaits/{script}.gait", "--robot", f"sim:{robot}", "--json", *given])
    return next(line for line in map(json.loads, result.stdout.splitlines()) if "result" in line)


@pytest.mark.parametrize(("robot", "labels"), [("circular", 8), ("sphere-a", 18), ("sphere-b", 22)])
def test_a_self_test_warms_every_coil_and_moves_nothing(robot, labels):
    report = ran(f"{robot}-selftest", f"{robot}?body=still")

    warmest = [coil["peak_estimated_degc"] for coil in report["coils"].values()]
    assert (report["result"], len(warmest)) == ("done", labels)
    assert 40 < min(warmest) <= max(warmest) < 60
    assert len(report["notes"]) == labels + 2


@pytest.mark.parametrize("change", ["set=wiring.lead_ohm:1.5", "set=coils.resistivity_martensite_uohm_m:0.75"])
def test_a_self_test_ends_at_a_coil_whose_resistance_is_out_of_its_band(change):
    report = ran("circular-selftest", f"circular?body=still&{change}")

    assert report["result"] == "timeout"
    assert [note["text"] for note in report["notes"]] == ["A"]


def test_fingers_that_do_not_feel_their_object_let_it_go():
    report = ran("fingers-selftest", "fingers", "felt=200mA")

    assert (report["result"], report["observed"]["gripped"]) == ("timeout", False)


def test_fingers_whose_camera_is_lost_let_the_cube_go(tmp_path):
    faults = tmp_path / "faults.toml"
    faults.write_text('seed = 1\n[[fault]]\nname = "camera-lost"\nat_ms = 4500\n')

    report = ran("fingers-orient", f"fingers-experiment?faults={faults}")

    assert (report["result"], report["caught"]["code"]) == ("camera lost", "F27")
    assert not report["observed"]["gripped"]


def test_a_press_whose_cells_feel_nothing_lifts():
    report = ran("press-selftest", f"press?{COARSE}", "cells=1kPa")

    assert report["result"] == "timeout"
    assert report["observed"]["depth_mm"] == pytest.approx(-2, abs=0.1)


@pytest.mark.parametrize(("robot", "notes"), [("circular?body=still", 8), ("fingers", 4), (f"press?{COARSE}", 1)])
def test_every_step_of_a_sweep_is_noted(robot, notes):
    report = ran(f"{robot.split('?')[0]}-sweep", robot, "steps=1")

    assert (report["result"], len(report["notes"])) == ("done", notes)


def test_a_step_of_a_sweep_heats_every_coil_with_the_same_energy():
    report = ran("circular-sweep", "circular?body=still", "steps=2")

    energies = [coil["energy_j"] for coil in report["coils"].values()]
    assert max(energies) == pytest.approx(min(energies), rel=0.02)


def test_two_coils_do_not_lift_the_spherical_robot_a_off_the_ground(tmp_path):
    """It cannot jump: a coil at full power raises its middle a little, and nothing more."""
    script = tmp_path / "hop.gait"
    script.write_text("gait 1\nrobot sphere-a\nfire A001 at 100 % for 700 ms until 125 C\nwait 2 s\n")

    result = CliRunner().invoke(main, ["run", str(script), "--robot", "sim:sphere-a", "--json"])

    seen = json.loads(result.stdout.splitlines()[-1])["observed"]
    assert 1 < seen["apex_mm"] < 2.5
    assert seen["clearance_mm"] == 0


def test_the_spherical_robot_a_climbs_six_degrees():
    seen = ran("sphere-a-climb", "sphere-a?slope=6")["observed"]

    assert seen["travel_mm"] == pytest.approx(614, rel=0.03)
    assert abs(seen["lateral_mm"]) < 20
    assert seen["peak_coil_degc"] < 140
