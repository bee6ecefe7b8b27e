"""The report of a run of a press, worked out by hand from a few records."""

import json
from types import SimpleNamespace

import pytest

from host.drivenreport import driven, driven_lines
from host.keeper import Keeper
from host.observed import observed, observed_lines
from host.profile import read_profile
from host.recording import Recording
from host.records import Event, Telemetry
from host.report import Facts, Took, lines, report
from protocol import codes, program
from tests.press_profiles import PRESS, without

AXIS = read_profile(PRESS)
SEEN = {
    "kind": "press",
    "depth_mm": 2.65,
    "axis_mm": 2.651,
    "force_n": 2.7475,
    "force_peak_n": 3.1122,
    "touching": True,
    "dent_mm": 2.65,
    "von_mises_peak_kpa": 6.1771,
    "strain_peak_percent": 15.1025,
    "cell_kpa": {"C1": 3.783, "C2": 0.2434},
    "joint_mm": {"P": 2.651},
    "lost_contact_s": None,
    "shape_m": None,
    "poisson_one": True,
    "model": {"indenter": "cylinder", "plane": "strain", "branches": 1, "dual": False, "backlash_mm": 0.2},
}
CODE = program.press(3000, 500, 1000) + program.press(5000, 500, 1000) + program.halt()


def record(now_ms, mm, commanded, load_n, kpa) -> Telemetry:
    return Telemetry(
        now_ms, now_ms, "running", 1, 6000, 100, 25.0, (), (),
        joint_position=(mm,), commanded_position=(commanded,), joint_ma=(120,), load_n=load_n, cell_kpa=(kpa,) * 6,
    )  # fmt: skip


@pytest.fixture
def recording():
    seen = Recording((), joints=("P",), unit="mm", cells=AXIS.cell_labels)
    seen.telemetry += [record(0, 0.0, None, -0.008, 0.0), record(500, 3.25, 3.3, 4.912, 6.5)]
    seen.telemetry += [record(1000, 3.3, None, 3.2, 4.5)]
    return seen


def test_an_axis_is_told_in_millimetres_and_what_was_felt_beside_it(recording):
    fields = driven(recording, AXIS)

    assert fields["joints"] == {"P": {"driven_s": 0.5, "least_mm": 0.0, "most_mm": 3.3, "peak_ma": 120}}
    assert fields["force"] == {"most_n": 4.912, "least_n": -0.008}
    assert fields["cells"]["C6"] == {"most_kpa": 6.5}
    assert list(driven_lines(fields)) == [
        "  joint    driven       least        most   peak current",
        "  P        0.50 s     0.00 mm     3.30 mm         0.12 A",
        "  force            -0.01 to 4.91 N",
        "  cells at most    C1 6.50, C2 6.50, C3 6.50, C4 6.50, C5 6.50, C6 6.50 kPa",
    ]


def test_nothing_that_was_heard_is_told_without_figures():
    fields = driven(Recording((), joints=("P",), unit="mm"), AXIS)

    assert fields["force"] == {"most_n": None, "least_n": None}
    assert fields["cells"]["C1"] == {"most_kpa": None}
    assert len(list(driven_lines(fields))) == 2


def test_a_robot_without_cells_has_none_in_its_report(recording):
    fields = driven(recording, read_profile(without("load", "press", "cells", "cell")))

    assert list(fields) == ["joints"]


def facts_of(recording, observer=None):
    compiled = SimpleNamespace(
        profile=AXIS, code=CODE, params={}, step=lambda number: None,
        script=SimpleNamespace(main=SimpleNamespace(name="creep.gait")),
    )  # fmt: skip
    info = dict.fromkeys(("robot", "firmware", "protocol", "dictionary", "session"), "")
    return Facts(compiled, "sim:press", info, {}, observer, Took(1.0, 2.0))


def test_the_greatest_force_that_the_program_asks_for_stands_beside_the_one_that_was_felt(recording):
    fields = report(None, recording, facts_of(recording))

    assert fields["force"] == {"most_n": 4.912, "least_n": -0.008, "asked_n": 5.0}
    assert "  force            -0.01 to 4.91 N, asked for 5 N" in list(driven_lines(fields))


@pytest.mark.parametrize(
    ("code", "value", "unit", "told"),
    [
        (codes.OVERLOAD, 20_480, "mN", "20.48 N"),
        (codes.ASTRAY, 52, "0.01 mm", "0.52 mm"),
        (codes.LOAD_CELL, 4095, "counts", "4095 counts"),
    ],
)
def test_a_fault_of_a_press_is_told_in_newtons_and_millimetres(recording, code, value, unit, told):
    recording.events.append(Event(600, 600, "tripped", code, 0, "P", value))

    fields = report(None, recording, facts_of(recording))

    assert (fields["faults"][0]["value"], fields["faults"][0]["unit"]) == (value, unit)
    assert next(line for line in lines(fields) if line.startswith("  fault")).endswith(told)


def test_what_the_press_felt_is_told_of_the_end_of_the_program_and_its_peak_of_the_whole_run(recording):
    after = {**SEEN, "touching": False, "force_n": 0.0, "force_peak_n": 6.5, "lost_contact_s": 8.48}
    views = [after, SEEN]
    watcher = SimpleNamespace(observe=views.pop)
    keeper = Keeper(observer=watcher, scenes=False)
    keeper.know(AXIS.parts)
    keeper.record(Event(400, 400, "finished", 0, 0, None, 0))

    seen = observed(watcher, keeper.recording)

    assert (seen["force_n"], seen["touching"]) == (2.7475, True)
    assert (seen["force_peak_n"], seen["lost_contact_s"]) == (6.5, 8.48)


def test_the_lines_about_a_press_say_how_deep_it_stands_and_what_the_block_bears():
    assert list(observed_lines(SEEN)) == [
        "  indenter         depth 2.65 mm, force 2.75 N, 3.11 N at most",
        "  cells            C1 3.78, C2 0.24 kPa",
        "  dent             2.65 mm",
        "  von Mises stress 6.18 kPa at most",
        "  strain           15.1 % at most",
        "  model            cylinder, plane strain, branches 1, backlash 0.2 mm",
    ]


def test_the_line_about_an_indenter_that_was_lifted_says_when_it_lost_contact():
    lifted = {**SEEN, "depth_mm": -2.0, "axis_mm": -1.8, "force_n": 0.0, "touching": False, "lost_contact_s": 8.48}

    assert next(observed_lines(lifted)) == (
        "  indenter         depth -2.00 mm, axis -1.80 mm, force 0.00 N, 3.11 N at most, not touching, "
        "contact lost at 8.48 s of the bench"
    )


def test_what_is_seen_of_a_press_can_be_written_as_json(recording):
    assert json.loads(json.dumps(report(None, recording, facts_of(recording, SimpleNamespace(observe=lambda: SEEN)))))
