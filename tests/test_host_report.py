"""The report of a run, worked out by hand from a few records."""

from dataclasses import replace

import pytest

from host.drivenreport import coils
from host.errors import Mismatch
from host.gait.compiler import compile_script
from host.gait.script import load, loads
from host.profile import read_profile
from host.recording import Recording
from host.records import Event, Telemetry
from host.report import Facts, Took, lines, report
from host.run import Ending
from tests.fake_robot import PROFILE

SCRIPT = "gait 1\nrobot circular\nparam duty = 60 %\nfire A at $duty for 600 ms\n"
INFO = {
    "session": 7,
    "robot": "circular",
    "firmware": "0.1.0",
    "protocol": 1,
    "dictionary": "1648c81d",
    "state": "idle",
}
LINE = {
    "bytes_sent": 1,
    "bytes_received": 2,
    "frames_resent": 0,
    "frames_damaged": 0,
    "telemetry_missed": 12,
    "telemetry_missed_by_slot": {"0": 12},
}


class Watcher:
    def observe(self) -> dict:
        return {"travel_mm": 12.345678, "peak_coil_degc": 81.0}


@pytest.fixture
def profile():
    return read_profile(PROFILE)


@pytest.fixture
def facts(profile):
    compiled = compile_script(loads(SCRIPT), profile)
    return Facts(compiled, "sim:circular", INFO, LINE, Watcher(), Took(wall_s=0.5, line_s=20.0))


def record(now_ms: int, duty_permille: int, degc: float, supply_mv: int = 2000) -> Telemetry:
    rest = len(read_profile(PROFILE).labels) - 1
    duties, temperatures = (duty_permille, *[0] * rest), (degc, *[25.0] * rest)
    return Telemetry(now_ms + 3, now_ms, "running", 1, supply_mv, 100, 25.0, duties, temperatures)


def recording() -> Recording:
    seen = Recording(("A",))
    seen.telemetry += [record(0, 500, 30.0), record(400, 1000, 70.0, 1900), record(600, 0, 85.5), record(1000, 0, 60.0)]
    seen.events += [Event(3, 0, "started", 0, 0, None, 0), Event(1003, 1000, "finished", 0, 1, None, 0)]
    return seen


def done() -> Ending:
    return Ending("done", recording().events[-1])


def test_on_time_and_energy_are_summed_over_the_telemetry(profile):
    coil = coils(recording(), profile)["A"]

    ohm, wiring_ohm = profile.coil.resistance_mohm / 1000, profile.coil.wiring_mohm / 1000
    at_2_0_v = (2.0 / (ohm + wiring_ohm)) ** 2 * ohm
    at_1_9_v = (1.9 / (ohm + wiring_ohm)) ** 2 * ohm
    assert coil["on_s"] == 0.6
    assert coil["energy_j"] == pytest.approx(0.4 * 0.5 * at_2_0_v + 0.2 * at_1_9_v, abs=1e-4)
    assert coil["peak_estimated_degc"] == 85.5


def test_a_report_says_what_ran_where_and_with_what_result(facts):
    fields = report(done(), recording(), facts)

    assert fields["result"] == "done"
    assert fields["parameters"] == {"duty": "60 %"}
    assert fields["duration_s"] == 1.0
    assert fields["observed"] == {"travel_mm": 12.3457, "peak_coil_degc": 81.0}
    assert fields["wall"] == {"time_s": 0.5, "real_time_factor": 40.0}


def test_a_report_without_an_observer_claims_nothing_about_the_body(facts):
    assert "observed" not in report(done(), recording(), replace(facts, observer=None))


def test_a_fault_is_told_with_its_code_coil_value_and_line(facts):
    seen = recording()
    seen.events[-1] = Event(1003, 1000, "tripped", 105, 1, "A", 1213)

    (fault,) = report(Ending("fault", seen.events[-1]), seen, facts)["faults"]

    assert fault["code"] == "F05"
    assert (fault["coil"], fault["value"], fault["unit"]) == ("A", 1213, "0.1 C")
    assert (fault["at_s"], fault["line"]) == (1.0, 4)


def test_a_line_of_an_included_file_is_told_with_the_file_and_the_line_that_led_there(profile, facts, tmp_path):
    (tmp_path / "push.gait").write_text('gait 1\ndef push(c):\n    fire $c at 60 % for 600 ms\n    note "pushed"\n')
    (tmp_path / "main.gait").write_text('gait 1\nrobot circular\ninclude "push.gait"\npush(A)\n')
    seen = recording()
    seen.events.insert(1, Event(900, 900, "noted", 0, 2, None, 0))
    seen.events[-1] = Event(1003, 1000, "tripped", 105, 1, "A", 1213)

    own = replace(facts, compiled=compile_script(load(tmp_path / "main.gait"), profile))
    fields = report(Ending("fault", seen.events[-1]), seen, own)

    places = [(item["file"], item["line"]) for item in (*fields["faults"], *fields["notes"], fields["ended_in"])]
    assert places == [(str(tmp_path / "push.gait"), line) for line in (3, 4, 3)]
    assert f", line 3 of {tmp_path / 'push.gait'}, called on line 4, coil A:" in "\n".join(lines(fields))


def test_a_report_of_nothing_is_still_a_report(facts):
    fields = report(None, Recording(("A",)), facts)

    assert fields["result"] == "dry run"
    assert fields["coils"]["A"] == {"on_s": 0.0, "energy_j": 0.0, "peak_estimated_degc": None}
    assert any("dry run" in line for line in lines(fields))


def test_the_text_names_only_coils_that_were_on(facts):
    text = "\n".join(lines(report(done(), recording(), facts)))

    assert "A        0.60 s" in text
    assert "\n  B " not in text
    assert "travel           12.3 mm" in text


def test_the_clock_of_the_robot_may_wrap_during_a_run(facts):
    seen = recording()
    seen.events[0] = Event(3, 2**32 - 500, "started", 0, 0, None, 0)
    seen.events[1] = Event(1003, 500, "finished", 0, 1, None, 0)

    assert report(done(), seen, facts)["duration_s"] == 1.0


def test_a_run_that_was_cut_off_lasted_until_the_last_word(facts):
    seen = recording()
    del seen.events[1:], seen.telemetry[-1:]

    assert report(Ending("link lost"), seen, facts)["duration_s"] == 0.6


def test_a_profile_knows_labels_groups_and_masks(profile):
    assert profile.labels == tuple("ABCDEFGH")
    assert profile.mask(["A", "C"]) == 0b101
    assert profile.mask(["all"]) == 0xFF
    assert profile.named(0b1000_0001) == ("A", "H")


def test_a_profile_from_a_newer_robot_may_say_more(profile):
    more = PROFILE.replace(b'"trip_degc"', b'"colour": 3, "trip_degc"')

    assert read_profile(more).coil == profile.coil


@pytest.mark.parametrize("text", [b"", b"[]", b"{}", PROFILE.replace(b"as_degc", b"as_degf"), PROFILE[:-20]])
def test_a_profile_that_cannot_be_used_is_a_mismatch(text):
    with pytest.raises(Mismatch, match="profile cannot be read"):
        read_profile(text)


JUMP = {
    "stored_mj": 36.123456,
    "released_mj": 20.4,
    "takeoff_m_per_s": 1.912,
    "takeoff_s": 4.94,
    "apex_mm": 186.2,
    "losses_mj": 11.3,
}


class Jumper:
    def observe(self) -> dict:
        return {"travel_mm": 0.0, "attitude": [1.0, 0.0, 0.123456, 0.0], "down": "A00m1", "contacts": 3, "jump": JUMP}


def test_a_jump_is_told_in_one_line_and_whole_in_the_fields(facts):
    fields = report(done(), recording(), replace(facts, observer=Jumper()))

    (line,) = [line for line in lines(fields) if line.startswith("  jump ")]
    assert fields["observed"]["jump"] == JUMP | {"stored_mj": 36.1235}
    assert line.endswith("stored 36.1 mJ, released 20.4 mJ, take-off 1.91 m/s at 4.94 s, apex 186 mm, losses 11.3 mJ")


def test_of_an_attitude_the_text_tells_only_which_coil_is_down(facts):
    fields = report(done(), recording(), replace(facts, observer=Jumper()))

    text = "\n".join(lines(fields))
    assert fields["observed"]["attitude"] == [1.0, 0.0, 0.1235, 0.0]
    assert "down             A00m1" in text
    assert "attitude" not in text


def test_a_run_without_a_jump_has_no_line_of_one(facts):
    assert not any("jump" in line for line in lines(report(done(), recording(), facts)))


@pytest.mark.parametrize(
    ("by_slot", "told"),
    [({}, "12 missed"), ({"0": 12}, "12 missed"), ({"0": 3, "2": 9}, "12 missed (slot 0: 3, slot 2: 9)")],
)
def test_what_was_missed_is_told_by_slot_where_there_were_several(facts, by_slot, told):
    link = {**LINE, "telemetry_missed_by_slot": by_slot}

    said = list(lines(report(done(), recording(), replace(facts, statistics=link))))

    assert said[-1] == f"  line             1 bytes out, 2 in, 0 frames resent, 0 damaged, {told}"
