"""What is foretold of a script: temperatures by the bench's model, and both ways where the model does not know."""

import json
from dataclasses import replace

import pytest

from host.gait.compiler import compile_script
from host.gait.forecast import follow, foretell, model_of
from host.gait.model.course import ABORTED, GUARDED
from host.gait.script import load
from tests.gait_scripts import ROOT, circular, compiled, hand_robot, profile_of

HEAD = "gait 1\nrobot circular\n"


@pytest.fixture(scope="module")
def warm():
    """Load the model once, so that no test pays for it."""
    return foretold("wait 1 s")


def foretold(body, every_ms=0, profile=None):
    """Return the forecast of a script for the circular robot."""
    profile = profile or circular()
    return follow(compiled(body, profile=profile, head=HEAD), model_of("sim:circular", profile), every_ms)


def track(course, label):
    """Return what is foretold of a coil."""
    return next(each for each in course.tracks if each.label == label)


def test_the_peak_of_a_coil_is_that_of_a_still_bench(warm, softrig, tmp_path):
    script = tmp_path / "push.gait"
    script.write_text(HEAD + "fire A at 80 % for 700 ms\nfire A at 25 % for 1 s\nwait 200 ms\n")

    out = json.loads(softrig("run", str(script), "--robot", "sim:circular?body=still", "--json").out)
    found = foretell(compile_script(load(str(script)), circular()), "sim:circular")

    assert found.peaks()[0].degc == pytest.approx(out["observed"]["peak_coil_degc"], abs=0.3)
    assert found.peaks()[0].track.energy_mj == pytest.approx(1000 * out["observed"]["coil_energy_j"]["A"], rel=0.01)


def test_a_cut_off_ends_an_order_when_the_model_reaches_it(warm):
    a = track(foretold("fire A at 80 % for 3 s until 90 C").early, "A")

    assert 90 <= a.peak_degc < 91
    assert a.on_ms < 1500


def test_a_ramp_heats_less_than_its_duty_at_once(warm):
    at_once, ramped = (foretold(f"fire A at 60 % for 800 ms {ramp}").early for ramp in ("", "ramp 400 ms"))

    assert track(ramped, "A").energy_mj == pytest.approx(0.75 * track(at_once, "A").energy_mj, rel=0.02)


def test_a_hold_keeps_a_coil_near_its_temperature(warm):
    a = track(foretold("hold A at 80 C with 60 % for 4 s", every_ms=50).early, "A")

    late = [degc for ms, degc in a.curve if 2500 < ms <= 4000]
    assert 78.5 < min(late) <= max(late) < 81.5
    assert a.bars[0].keep_decidegc == 800


def test_a_wait_for_a_temperature_ends_when_the_model_has_cooled(warm):
    found = foretold("fire A at 60 % for 800 ms\nwait until A.temperature < 45 C timeout 20 s else abort\nwait 1 s")

    pause = found.early.pauses[0]
    assert not found.forked
    assert pause.known
    assert pause.met
    assert 1000 < pause.end_ms - pause.begin_ms < 5000


def test_a_wait_that_the_model_does_not_know_is_over_at_once_or_runs_out(warm):
    found = foretold(
        "fire A at 60 % for 1 s\nwait until supply.current < 20 mA timeout 4 s else continue\nfire A at 60 % for 1 s"
    )

    assert (found.early.end_ms, found.late.end_ms) == (2000, 6000)
    assert found.peaks()[0].way == "early"
    assert track(found.early, "A").peak_degc > track(found.late, "A").peak_degc + 10


def test_a_wait_that_runs_out_jumps_to_its_label_in_the_late_way(warm):
    rest = "fire A at 60 % for 1 s\nlabel rest\nfire B at 60 % for 1 s"

    found = foretold("wait until supply.current > 900 mA timeout 1 s else rest\n" + rest)

    assert [each.label for each in found.early.driven] == ["A", "B"]
    assert [each.label for each in found.late.driven] == ["B"]


def test_a_wait_that_cannot_be_met_aborts_and_what_follows_a_fault_runs(warm):
    found = foretold(
        "fire A at 60 % for 2 s overlap 1 s\nwait until A.temperature < 30 C timeout 100 ms else abort\n"
        "fire B at 60 % for 1 s\non fault:\n    fire C at 60 % for 500 ms"
    )

    assert found.early.outcome == ABORTED
    assert [each.label for each in found.early.driven] == ["A", "C"]
    assert track(found.early, "A").on_ms == 1100  # off before anything else
    assert "line 4 runs out" in "\n".join(found.lines())


def test_a_guard_that_trips_ends_the_forecast(warm):
    found = foretold("guard any.temperature > 80 C\nfire A at 80 % for 3 s\nfire B at 80 % for 1 s")

    assert found.early.outcome == GUARDED
    assert 80 <= track(found.early, "A").peak_degc < 81
    assert "guard on line 3 trips" in "\n".join(found.lines())


def test_a_line_that_heats_a_coil_to_the_trip_is_an_error(warm):
    cool = circular()
    profile = replace(cool, coil_limits=replace(cool.coil, trip_degc=90))

    found = foretold("fire A at 30 % for 1 s\nfire B at 80 % for 1 s", profile=profile).diagnostics

    assert [(item.code, item.place.line) for item in found] == [("E328", 4)]
    assert "coil B would come to" in found[0].message


def test_ten_thousand_turns_are_foretold_as_one(warm):
    found = foretold("repeat 10000:\n    fire A at 40 % for 500 ms\n    wait 8 s")

    a = track(found.early, "A")
    assert found.early.end_ms == 10_000 * 8500
    assert a.on_ms == 10_000 * 500
    assert found.early.gaps[0].turns > 9_900


def test_a_chosen_coil_is_as_hot_as_the_hottest_it_may_be():
    script = load(str(ROOT / "gaits" / "sphere-a-attitude-crawl.gait"))

    found = foretell(compile_script(script, profile_of("sphere-a")), "sim:sphere-a")

    peak = found.peaks()[0]
    assert peak.track.label == "$next"
    assert len(peak.track.reach) == 8
    assert 100 < peak.degc < 140
    assert any("the hottest way" in line for line in found.lines())


def test_a_robot_that_the_bench_does_not_know_has_no_temperatures(warm):
    stranger = replace(circular(), robot="stranger")

    found = foretell(compiled("fire A at 60 % for 1 s", profile=circular(), head=HEAD), "/dev/ttyACM0")
    unknown = foretell(replace(found.compiled, profile=stranger), "/dev/ttyACM0")

    assert found.peaks()[0].degc > 60  # by its name
    assert list(unknown.lines()) == ["  no model of the robot stranger is known: its temperatures are not predicted"]
    assert unknown.diagnostics == ()
    assert track(unknown.early, "A").on_ms == 1000


def test_nothing_is_said_of_temperatures_where_there_are_no_coils():
    script = compiled("move all to 8 deg over 2 s\nwait 1 s", profile=hand_robot(), head="gait 1\nrobot round\n")

    found = foretell(script, "sim:fingers")

    assert list(found.lines()) == []
    assert found.early.end_ms == 3000


def test_a_chosen_coil_begins_as_the_hottest_of_its_circle():
    head = "gait 1\nrobot sphere-a\ncircle roll = A00m1 A10m1 A100\n"
    choose = "let next = roll[down]\nfire $next at 60 % for 200 ms"

    cold, warmed = (
        foretell(compiled(before + choose, profile=profile_of("sphere-a"), head=head), "sim:sphere-a")
        for before in ("", "fire A100 at 60 % for 1 s\n")
    )

    assert track(warmed.early, "$next").peak_degc > track(cold.early, "$next").peak_degc + 30
