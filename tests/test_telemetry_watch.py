"""`softrig watch`: variables as they come, as lines in a pipe, as a table at a terminal."""

import json
from itertools import pairwise

import pytest

from host.log import LogWriter
from host.logbook import read_log
from host.records import Sample
from host.robot import Robot
from protocol import variables

STILL = "sim:circular?body=still"


def watched(softrig, *arguments: str) -> list[dict]:
    """Return the records that a watching printed."""
    told = softrig("watch", "--robot", STILL, *arguments)
    assert told.status == 0, told.err
    return [json.loads(line) for line in told.out.splitlines()]


def test_variables_are_printed_as_lines_at_their_period(softrig):
    rows = watched(softrig, "supply_mv", "coil_decidegc", "--every", "10ms", "--for", "0.5s")

    assert list(rows[0]) == ["host_ms", "now_ms", "slot", "supply_mv", "coil_decidegc"]
    assert rows[0]["supply_mv"] == 2000
    assert set(rows[0]["coil_decidegc"]) == set("ABCDEFGH")
    assert {b["now_ms"] - a["now_ms"] for a, b in pairwise(rows)} == {10}
    assert len(rows) == pytest.approx(50, abs=2)


def test_without_a_name_it_is_the_usual_variables(softrig):
    rows = watched(softrig, "--for", "250ms")

    assert rows[0]["state"] == "idle"
    assert rows[0]["temperature_degc"]["H"] == 25.0


def test_on_change_a_robot_at_rest_says_little(softrig):
    rows = watched(softrig, "state", "--every", "5ms", "--on-change", "--for", "2.5s")

    assert len(rows) == 3  # now, and again each second


def test_how_many_came_and_how_many_did_not_stands_on_stderr(softrig):
    told = softrig("watch", "--robot", "sim:sphere-b?body=still", "--every", "5ms", "--for", "1s")

    count, missed = [int(word) for word in told.err.split() if word.isdigit()]
    assert count == told.out.count("\n") < 110
    assert count + missed == pytest.approx(200, abs=12)


def test_all_variables_are_listed_without_a_robot(softrig):
    told = softrig("watch", "--list")

    assert [line.split()[0] for line in told.out.splitlines()] == [each.name for each in variables.VARIABLES]
    assert "coil_decidegc        Estimated temperature of the coil. One value per coil.\n" in told.out


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["suply_mv"], "no variable 'suply_mv'; did you mean 'supply_mv'?"),
        (["warp"], "no variable 'warp'; `softrig watch --list` lists them"),
        (["state", "--every", "0"], "--every 0: write at least 5ms, a control step"),
    ],
)
def test_what_cannot_be_watched_is_told_before_a_line_is_opened(softrig, arguments, told):
    answer = softrig("watch", "--robot", "/dev/nowhere", *arguments)

    assert (answer.status, answer.err) == (2, f"softrig: {told}\n")


def test_what_the_robot_cannot_send_is_its_refusal(softrig):
    too_fast = softrig("watch", "--robot", STILL, "state", "--every", "3ms", "--for", "1s")
    too_much = softrig("watch", "--robot", "sim:sphere-b?body=still", *[v.name for v in variables.VARIABLES[15:20]])

    assert (too_fast.status, too_much.status) == (4, 4)
    assert "R28" in too_fast.err
    assert "R27" in too_much.err


def test_ctrl_c_ends_the_watching_and_stops_nothing(softrig, monkeypatch):
    listen, stopped = Robot.listen, []

    def interrupted(face, time_ms):
        yield from listen(face, 300)
        raise KeyboardInterrupt

    monkeypatch.setattr(Robot, "stop", lambda *_: stopped.append(True))
    monkeypatch.setattr(Robot, "listen", interrupted)

    told = softrig("watch", "--robot", STILL, "state", "--every", "50ms")

    assert told.status == 0
    assert stopped == []
    assert told.out.count("\n") >= 5


def test_a_log_keeps_samples_and_exports_them(tmp_path):
    with LogWriter(tmp_path / "a.mcap") as log:
        for i in range(3):
            log.record(Sample(10 * i, 10 * i + 5, 1, {"supply_mv": 2000 + i, "coil_decidegc": {"A": 250, "B": 251}}))

    kept = read_log(tmp_path / "a.mcap")
    with (tmp_path / "a.csv").open("w") as file:
        kept.write_csv(file, "samples")

    assert [row["values"]["supply_mv"] for row in kept.rows["samples"]] == [2000, 2001, 2002]
    assert (tmp_path / "a.csv").read_text().splitlines()[0] == (
        "host_ms,now_ms,slot,values.supply_mv,values.coil_decidegc.A,values.coil_decidegc.B"
    )
