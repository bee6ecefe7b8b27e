"""The circular robot crawls: script, host, wire, firmware, chips, coils, ring and ground, all real.

The figures are those of an independent calculation with the same equations: 15.7 mm a step (pi R / 4, an eighth of
the rim), peak 87 C and 0.11 N.
"""

import json
from functools import cache
from math import pi

import pytest
from click.testing import CliRunner

from hil_sim.link import open_link
from host.cli import main
from host.gait.compiler import compile_script
from host.gait.script import load
from host.robot import Robot
from host.run import run as run_program

EIGHTH_MM = pi * 20 / 4
CRAWL, BACK = "gaits/circular-crawl.gait", "gaits/circular-crawl-back.gait"


def run(script, options="", *arguments):
    """Run a script on a fresh bench and return its report."""
    result = CliRunner().invoke(main, ["run", script, "--robot", f"sim:circular{options}", "--json", *arguments])
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)


@cache
def report(script, options=""):
    """Return the report of a run that several tests look at."""
    return run(script, options)


def test_eight_steps_roll_the_robot_forward_by_an_eighth_of_its_rim_each():
    observed = report(CRAWL)["observed"]

    assert observed["travel_mm"] == pytest.approx(8 * EIGHTH_MM, rel=0.05)
    assert observed["rotation_deg"] == pytest.approx(360, abs=5)
    assert observed["lateral_mm"] == 0


def test_no_coil_is_hotter_or_stronger_than_it_should_be():
    observed = report(CRAWL)["observed"]

    assert observed["peak_coil_degc"] == pytest.approx(87, abs=3)
    assert observed["peak_coil_force_n"] == pytest.approx(0.11, rel=0.1)


def test_the_firmware_s_estimate_of_the_peak_is_within_six_kelvin_of_the_coil():
    seen = report(CRAWL)

    for label, coil in seen["coils"].items():
        assert coil["peak_estimated_degc"] == pytest.approx(seen["observed"]["coil_peak_degc"][label], abs=6)


def test_the_reported_energy_is_what_the_bench_s_coils_took():
    seen = report(CRAWL)

    for label, coil in seen["coils"].items():
        # The profile's one resistance stands for a coil that goes from 10.3 to 9.3 ohm.
        assert coil["energy_j"] == pytest.approx(seen["observed"]["coil_energy_j"][label], rel=0.05)


def test_the_mirrored_script_mirrors_the_motion():
    forward, back = report(CRAWL)["observed"], report(BACK)["observed"]

    assert back["travel_mm"] == pytest.approx(-forward["travel_mm"], rel=1e-3)
    assert back["rotation_deg"] == pytest.approx(-forward["rotation_deg"], rel=1e-3)


def test_the_same_script_gives_the_same_report_twice_but_for_the_wall_clock():
    first, second = dict(report(CRAWL)), run(CRAWL)

    assert first.pop("wall") != {}
    second.pop("wall")
    assert json.dumps(first) == json.dumps(second)


def test_looking_closer_changes_nothing(tmp_path):
    """A picture and a log need many more looks at the bench; not one byte on any wire may differ."""
    watched = run(CRAWL, "", "--plot", str(tmp_path / "run.svg"), "--log", str(tmp_path / "run.mcap"))

    assert watched["trace_sha256"] == report(CRAWL)["trace_sha256"]


def test_it_climbs_ten_degrees_as_it_rolls_on_the_flat():
    assert report(CRAWL, "?slope=10")["observed"]["travel_mm"] == pytest.approx(8 * EIGHTH_MM, rel=0.05)


def test_a_script_that_begins_later_climbs_the_same():
    """A bench behind a port has stood for a while when its host comes."""
    link = open_link("sim:circular?slope=10")
    link.bench.run(seconds=5)
    waited_mm = link.bench.observe()["travel_mm"]

    with Robot(link) as robot:
        robot.connect()
        program = compile_script(load(CRAWL), robot.profile, ()).program
        ending = run_program(robot, program, lambda stage, done: None)
        travel_mm = link.bench.observe()["travel_mm"]

    assert ending.result == "done"
    assert abs(waited_mm) < 1e-3
    assert travel_mm == pytest.approx(report(CRAWL, "?slope=10")["observed"]["travel_mm"], rel=0.02)


NOWHERE = {
    "without gravity": ("?gravity=0",),
    "with the coils' leads open": ("?set=wiring.lead_ohm:1e9", "--without=all"),
}


@pytest.mark.parametrize("why", NOWHERE)
def test_it_goes_nowhere(why):
    assert abs(run(CRAWL, *NOWHERE[why])["observed"]["travel_mm"]) < 0.05 * 8 * EIGHTH_MM


def test_without_friction_it_slips():
    slipping = report(CRAWL, "?mu=0.001")["observed"]

    assert abs(slipping["travel_mm"]) < 0.55 * 8 * EIGHTH_MM  # half, and what sense slots of 2 ms change by chance


def test_the_measured_current_is_the_duty_s_share_and_does_not_beat_with_the_pwm(rig):
    """The monitor's conversions must fall on all phases of the PWM, or its mean wanders between 0 and full."""
    rig.robot.arm()
    rig.robot.subscribe(20)
    rig.fire("A", duty_percent=32, hold_s=3)

    told = rig.run(seconds=2)

    currents_ma = [row.current_ma for row in told[25:] if hasattr(row, "current_ma")]
    full_ma = 2000 / 9.8
    assert len(currents_ma) > 50
    assert min(currents_ma) > 0.28 * full_ma
    assert max(currents_ma) < 0.36 * full_ma
