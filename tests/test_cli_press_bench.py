"""The commands on the press of the bench: from the line that is typed to the block that gives way."""

import csv
import json

import pytest

SETTLED_N = 0.15  # what the loop leaves of a force that a block creeps away from, and the load cell's counts
STOPS_MM = 0.1  # dead band of the servo, and a count of its potentiometer
GAIT = """gait 1
robot press
move P to 0 mm over 1500 ms
wait 200 ms
press to 3 N over 500 ms for 1500 ms
"""


@pytest.fixture
def script(tmp_path):
    path = tmp_path / "lean.gait"
    path.write_text(GAIT)
    return str(path)


@pytest.fixture
def faults(tmp_path):
    """A function that writes a file of one fault and returns the press's address with it."""

    def broken(name: str, at_ms: int) -> str:
        path = tmp_path / "faults.toml"
        path.write_text(f'[[fault]]\nname = "{name}"\nat_ms = {at_ms}\n')
        return f"sim:press?faults={path}"

    return broken


def told_as_json(told) -> dict:
    assert told.status == 0, told.err
    return json.loads(told.out)


def test_a_press_presses_as_hard_as_it_is_told(softrig):
    told = told_as_json(softrig("press", "3N", "--for", "3s", "--hold", "0.5s", "--robot", "sim:press", "--json"))

    assert told["reached_n"] == pytest.approx(3, abs=SETTLED_N)
    assert told["load_peak_n"] < 3.5
    assert 1 < told["joints"]["P"]["reached_mm"] < 5
    assert told["cell_peak_kpa"]["C1"] > 1


def test_an_axis_that_is_moved_down_tells_the_force_that_it_met(softrig):
    told = told_as_json(softrig("move", "P", "--to", "2mm", "--over", "1s", "--robot", "sim:press", "--json"))

    assert told["joints"]["P"]["reached_mm"] == pytest.approx(2, abs=STOPS_MM)
    assert told["load_peak_n"] > 1


def test_a_run_reports_the_force_that_was_asked_for_and_felt_and_what_the_block_did(softrig, script, tmp_path):
    run = ("run", script, "--robot", "sim:press", "--json", "--log", str(tmp_path / "a.mcap"))

    fields = told_as_json(softrig(*run))

    assert fields["force"]["asked_n"] == 3.0
    assert fields["force"]["most_n"] == pytest.approx(fields["observed"]["force_peak_n"], abs=0.1)
    assert fields["observed"]["touching"]
    assert fields["observed"]["depth_mm"] == pytest.approx(fields["joints"]["P"]["most_mm"], abs=STOPS_MM)
    softrig("log", "export", str(tmp_path / "a.mcap"), "-o", str(tmp_path / "a.csv"))
    with (tmp_path / "a.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert {"joint_mm.P", "commanded_mm.P", "joint_ma.P", "load_n", "cell_kpa.C6"} <= set(rows[0])
    assert max(float(row["load_n"]) for row in rows) == fields["force"]["most_n"]


@pytest.mark.parametrize(
    ("fault", "told_as"), [("load-cell-open", "F30 The load cell"), ("joint-jam:P", "(joint P): F2")]
)
def test_what_goes_wrong_while_it_presses_is_told_by_name(softrig, faults, fault, told_as):
    told = softrig("press", "5N", "--for", "4s", "--robot", faults(fault, 2500))

    assert (told.status, told_as in told.err) == (6, True), told.err


def test_a_load_cell_that_is_torn_off_is_found_before_arming(softrig, faults):
    told = softrig("press", "5N", "--robot", faults("load-cell-open", 0))

    assert told.status == 4
    assert "arm (joint P) refused: F30 The load cell" in told.err
