"""The commands on a robot with a press: what they order, and what they print."""

import json
import sys

import pytest

from host.cli.gauge import gauge, reading
from host.profile import read_profile
from host.records import Telemetry
from protocol import codes, messages
from tests.fake_robot import FakeLine, FakeRobot, plug_in
from tests.joint_samples import FINGERS
from tests.press_profiles import PRESS

AXIS = read_profile(PRESS)
LIFT = "P stays where it is: `softrig move P --to 0mm` lifts it"


@pytest.fixture
def peer():
    return FakeRobot(PRESS)


@pytest.fixture
def line(peer, monkeypatch):
    """A line to `peer`, at the address fake:."""
    line = FakeLine(peer)
    plug_in(line, monkeypatch)
    return line


def interrupt():
    raise KeyboardInterrupt


def test_press_arms_presses_watches_to_the_end_of_the_hold_and_disarms(softrig, peer, line):
    told = softrig("press", "5N", "--over", "0.5s", "--for", "2s", "--hold", "300ms")

    assert told.status == 0
    assert [name for name, *_ in peer.taken("arm", "press", "disarm")] == ["arm", "press", "disarm"]
    assert peer.taken("press") == [("press", 5000, 500, 2000, 300)]
    assert told.out.splitlines() == [
        "pressing at 5.00 N, told 5 N",
        "force 5.00 N at most",
        "cells at most C1 5.00, C2 5.00, C3 5.00, C4 5.00, C5 5.00, C6 5.00 kPa",
        "P reached 5.00 mm; 1.20 A at most",
        LIFT,
    ]


def test_press_tells_the_same_as_json(softrig, line):
    told = json.loads(softrig("press", "500 mN", "--over", "100ms", "--for", "1s", "--hold", "0.2", "--json").out)

    assert told == {
        "target_n": 0.5,
        "reached_n": 0.5,
        "most_mm": 10.0,
        "load_peak_n": 0.5,
        "cell_peak_kpa": dict.fromkeys(AXIS.cell_labels, 0.5),
        "over_ms": 100,
        "for_ms": 1000,
        "hold_ms": 200,
        "joints": {"P": {"reached_mm": 0.5, "peak_ma": 1200}},
    }


def test_the_force_that_was_reached_is_the_one_before_the_axis_is_only_held(softrig, peer, line):
    line.at[2700] = lambda: setattr(peer, "load_mn", 3000)  # the block relaxes

    told = json.loads(softrig("press", "5N", "--for", "1s", "--hold", "3s", "--json").out)

    assert (told["reached_n"], told["load_peak_n"]) == (5.0, 5.0)


def test_an_axis_that_touches_nothing_is_told(softrig, peer, line):
    line.at[1500] = lambda: setattr(peer, "load_mn", 8)

    told = softrig("press", "5N", "--for", "1s").out

    assert "P touches nothing: bring it closer with `softrig move P`, or regulate for longer\n" in told
    assert LIFT not in told


def test_an_axis_at_the_end_of_its_range_is_told(softrig, line):
    told = softrig("press", "10N", "--for", "1s").out  # this robot gives way 1 mm for each newton

    assert "P is at the end of its range, 10 mm: it presses no harder\n" in told


@pytest.mark.parametrize(("text", "mn"), [("5", 5000), ("5N", 5000), ("5.25 N", 5250), ("250mN", 250), ("0N", 0)])
def test_forces_are_read_as_an_operator_writes_them(softrig, peer, line, text, mn):
    softrig("press", text, "--over", "50ms", "--for", "50ms", "--hold", "50ms")

    assert peer.taken("press")[0][1] == mn


@pytest.mark.parametrize("text", ["", "5n", "5 kg", "5 NN", "N", "5mm", "1e1"])
def test_a_force_that_is_none_is_a_mistake_of_usage(softrig, peer, line, text):
    told = softrig("press", text)

    assert told.status == 2
    assert peer.orders == []


def test_a_force_cannot_take_longer_than_it_is_regulated(softrig, peer, line):
    told = softrig("press", "5N", "--over", "3s", "--for", "2s")

    assert told.status == 2
    assert "--for 2000 ms is less than --over 3000 ms" in told.err
    assert peer.orders == []


def test_a_robot_without_a_press_refuses_before_anything_is_armed(softrig, monkeypatch):
    peer = FakeRobot(FINGERS)
    plug_in(FakeLine(peer), monkeypatch)

    told = softrig("press", "5N")

    assert (told.status, told.err.startswith("softrig: press refused: R35 ")) == (4, True)
    assert peer.taken("arm", "press") == []


def test_more_than_the_robot_allows_is_refused_in_newtons(softrig, peer, line):
    peer.refuse["press"] = (codes.FORCE_LIMIT, 0, 19_000, 18_000)

    told = softrig("press", "19N")

    assert told.status == 4
    assert "press (joint P) refused: R36" in told.err
    assert " 19 N, at most 18. " in told.err
    assert peer.taken("disarm")


def test_an_overload_ends_a_press_as_a_robot_fault(softrig, peer, line):
    line.at[2000] = lambda: peer.tell(messages.TRIP, codes.OVERLOAD, 0, 20_480, line.now_ms)

    told = softrig("press", "5N")

    assert told.status == 6
    assert "the robot tripped (joint P): F29" in told.err
    assert " 20.48 N. " in told.err


def test_ctrl_c_in_a_press_stops_the_robot_and_names_the_joint(softrig, peer, line):
    line.at[2000] = interrupt

    told = softrig("press", "5N", "--for", "9s")

    assert told.status == 130
    assert (
        "stop acknowledged, joints P were driven and are limp now where they stand; the robot is tripped (F01)"
        in told.err
    )
    assert peer.stops > 0


def test_an_axis_moves_by_millimetres(softrig, peer, line):
    told = softrig("move", "P", "--to", "-1.5mm", "--over", "0.5s", "--hold", "300ms")

    assert told.status == 0
    assert peer.taken("move") == [("move", 1, -150, 500, 300)]
    assert told.out.splitlines()[0] == "P reached -1.50 mm, told -1.5 mm; 1.20 A at most"


def test_a_move_that_presses_tells_what_was_felt(softrig, peer, line):
    peer.load_mn, peer.cell_pa = 6400, [8230, 0, 0, 0, 0, 0]

    told = json.loads(softrig("move", "P", "--to", "4mm", "--json").out)

    assert (told["target_mm"], told["joints"]["P"]["reached_mm"]) == (4.0, 4.0)
    assert (told["load_peak_n"], told["cell_peak_kpa"]["C1"]) == (6.4, 8.23)


def test_a_position_without_a_unit_is_in_that_of_the_joints(softrig, peer, line):
    softrig("move", "P", "--to", "4")

    assert peer.taken("move")[0][2] == 400


@pytest.mark.parametrize(("profile", "to", "unit"), [(PRESS, "4deg", "mm"), (FINGERS, "4mm", "deg")])
def test_a_position_in_another_unit_is_refused_before_anything_is_armed(softrig, monkeypatch, profile, to, unit):
    peer = FakeRobot(profile)
    plug_in(FakeLine(peer), monkeypatch)

    told = softrig("move", peer.parts.joints[0], "--to", to)

    assert (told.status, told.err) == (2, f"softrig: {to}: the joints of this robot count in {unit}\n")
    assert peer.taken("arm", "move") == []


def test_status_shows_depth_force_and_cells(softrig, peer, line):
    peer.joints[0].centi, peer.load_mn, peer.cell_pa = 321, 4984, [1200, 0, 0, 0, 0, 20_000]

    assert softrig("status").out.splitlines()[-3:] == [
        "  P           3.21 mm, limp, 0.12 A",
        "  force       4.98 N",
        "  cells       C1 1.20, C2 0.00, C3 0.00, C4 0.00, C5 0.00, C6 20.00 kPa",
    ]
    fields = json.loads(softrig("status", "--json").out)
    assert fields["joints"] == {"P": {"mm": 3.21, "commanded_mm": None, "ma": 120}}
    assert (fields["load_n"], fields["cell_kpa"]["C6"]) == (4.984, 20.0)
    assert "object_deg" not in fields


def test_info_tells_what_a_press_may_and_what_it_feels_with(softrig, line):
    told = softrig("info").out

    assert "  one move    -5 to 10 mm, at most 10 mm/s, then held for 600 s\n" in told
    assert "  astray      trips 0.5 mm beside its order for 1500 ms\n" in told
    assert "  force       at most 18 N, trips at 20 N\n" in told
    assert "  press       regulates the force: gain 2 mm/s per N, reset 0.3 /s\n" in told
    assert "  cells       C1 C2 C3 C4 C5 C6, up to 20 kPa\n" in told


def test_info_tells_the_same_as_json(softrig, line):
    told = json.loads(softrig("info", "--json").out)

    assert told["cells"] == ["C1", "C2", "C3", "C4", "C5", "C6"]
    assert told["limits"]["joint"]["unit"] == "mm"
    assert (told["limits"]["load"]["most_mn"], told["limits"]["cell"]["full_pa"]) == (18000, 20000)


def test_watch_tells_depth_force_and_cells(softrig, peer, line):
    peer.load_mn = 4984

    told = [json.loads(row) for row in softrig("watch", "--for", "300ms").out.splitlines()]

    assert (told[-1]["joint_mm"], told[-1]["commanded_mm"]) == ({"P": 0.0}, {"P": None})
    assert (told[-1]["load_n"], told[-1]["cell_kpa"]["C1"]) == (4.984, 0.0)


def test_the_list_of_variables_says_which_are_of_load_cell_and_force_cells(softrig):
    told = softrig("watch", "--list").out

    assert "Only where there is a load cell." in told
    assert "One value per force cell." in told


def test_codes_of_joints_are_explained_in_the_unit_that_each_has(softrig):
    assert json.loads(softrig("explain", "R31", "--json").out)["unit"] == "0.01 of the joint's unit"
    assert json.loads(softrig("explain", "F29", "--json").out)["unit"] == "mN"


def told_of(load_n, mm) -> Telemetry:
    return Telemetry(
        0, 0, "armed", 0, 6000, 0, 25.0, (), (),
        joint_position=(mm,), commanded_position=(mm,), joint_ma=(5,), load_n=load_n, cell_kpa=(1.25,) * 6,
    )  # fmt: skip


def test_the_force_is_shown_beside_the_one_that_was_asked_for():
    assert reading(told_of(4.984, 3.21), AXIS.parts, 5.0).startswith("4.98 N of 5 N   P 3.21 mm   C1 1.25 C2 1.25 ")


def test_the_force_is_shown_at_a_terminal_while_it_presses(monkeypatch, capsys):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    monkeypatch.setenv("TERM", "xterm")

    with gauge(5.0, AXIS.parts) as show:
        show(told_of(4.984, 3.21))

    assert "4.98 N of 5 N" in capsys.readouterr().err


def test_nothing_is_shown_in_a_pipe(capsys):
    with gauge(5.0, AXIS.parts) as show:
        show(told_of(4.984, 3.21))

    assert capsys.readouterr().err == ""
