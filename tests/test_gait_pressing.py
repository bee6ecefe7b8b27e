"""The worst case of a press: numbers worked out by hand, and every limit with the line that breaks it.

The axis of these tests goes from -5 to 10 mm, 10 mm a second, and holds for 5 seconds; the press takes up to 18 N.
"""

import json

import pytest

from tests.gait_scripts import hand_robot, press_robot
from tests.gait_scripts import report as round_report

HOME = "move P to -1 mm over 2 s\n"
PRESS = "press to 5 N over 1 s for 4 s\n"
STEP_MS = 5  # what is held is counted up to the control step after it


def report(body):
    return round_report(body, profile=press_robot())


def axis(body):
    """Return what the axis comes to at most."""
    (row,) = report(body).joints
    return row


def limits(body):
    """Return (code, line, column) of each limit that a script breaks."""
    return [(item.code, item.place.line - 2, item.place.column) for item in report(body).diagnostics]


def test_a_press_may_drive_the_axis_all_over_its_range():
    row = axis(HOME + PRESS)

    assert (row.orders, row.least_centi, row.most_centi) == (2, -500, 1000)


def test_after_a_press_a_move_begins_at_the_farther_end_of_the_range():
    assert axis(HOME + "move P to 0 mm over 1250 ms").fastest_centi_per_s == 550  # the first, from 10 mm
    assert axis(HOME + PRESS + "move P to 0 mm over 1250 ms").fastest_centi_per_s == 800
    assert axis(HOME + PRESS + "wait 1 s\nmove P to 5 mm over 1250 ms").fastest_centi_per_s == 800


def test_while_it_presses_the_axis_is_nowhere_in_particular():
    body = HOME + "press to 5 N over 1 s for 4 s overlap 3 s\nmove P to 10 mm over 1500 ms"

    assert axis(body).fastest_centi_per_s == 1000


def test_a_press_that_follows_a_press_changes_nothing():
    body = HOME + "repeat 50:\n    press to 5 N over 1 s for 4 s overlap 1 s\n    press to 2 N over 1 s for 4 s"

    assert limits(body) == []
    assert axis(body).orders == 101


def test_the_time_of_driving_is_that_of_moves_and_presses_and_not_of_holding():
    assert axis(HOME + "wait 3 s\n" + PRESS + "wait 4 s").driven_ms == 2000 + 4000
    assert axis(HOME + "repeat 1000:\n    " + PRESS + "    wait 1 s").driven_ms == 2000 + 1000 * 4000


def test_a_press_that_another_order_ends_drives_no_longer():
    assert axis("press to 5 N over 1 s for 4 s overlap 3 s\nmove P to 0 mm over 2 s").driven_ms == 1000 + 2000


def test_a_press_that_a_wait_may_prolong_drives_as_long_as_the_wait():
    wait = "wait until force > 4 N timeout 2 s else continue\n"

    assert axis("press to 5 N over 1 s for 4 s overlap 4 s\n" + wait + HOME).driven_ms == 2000 + STEP_MS + 2000
    assert axis("press to 5 N over 1 s for 4 s overlap 4 s\n" + wait).driven_ms == 4000


def test_time_is_the_sum_of_what_comes_one_after_another():
    made = report(HOME + "press to 5 N over 1 s for 4 s overlap 500 ms\nwait 100 ms")

    assert made.shortest_ms == 2000 + 3500 + 500
    assert made.longest_ms == made.shortest_ms + STEP_MS


def test_the_greatest_force_that_is_asked_for_counts():
    assert (
        report(HOME + "repeat 2:\n    press to 3 N over 1 s for 2 s\n    press to 2 N over 1 s for 2 s").force_mn
        == 3000
    )
    assert report(HOME).force_mn == 0


@pytest.mark.parametrize(
    ("body", "found"),
    [
        ("move P to 10.01 mm over 2 s", [("E317", 1, 11)]),
        ("move P to -5.01 mm over 2 s", [("E317", 1, 11)]),
        ("move P to 10 mm over 1499 ms", [("E318", 1, 22)]),
        (HOME + "move P to 1 mm over 199 ms", [("E318", 2, 21)]),
        (HOME + PRESS + "move P to -1 mm over 1 s", [("E318", 3, 22)]),
        (HOME + "repeat 2:\n    move P to 0 mm over 999 ms\n    press to 5 N over 1 s for 2 s", [("E318", 3, 25)]),
        (PRESS + "wait 5 s", [("E319", 1, 1)]),
        (HOME + "press to 5 N over 1 s for 2 s overlap 1 s\nwait 6 s", [("E319", 2, 1)]),
        ("press to 18.001 N over 1 s for 2 s", [("E323", 1, 10)]),
        ("press to 5 N over 1 s for 5001 ms", [("E324", 1, 27)]),
        ("guard force > 20 N", [("E310", 1, 15)]),
        ("wait until force > 21 N timeout 1 s else continue", [("E310", 1, 20)]),
        ("guard C1.pressure > 20 kPa", [("E325", 1, 21)]),
        ("wait until any.pressure > 21 kPa timeout 1 s else continue", [("E325", 1, 27)]),
    ],
)
def test_a_limit_is_reported_at_the_line_that_breaks_it(body, found):
    assert limits(body) == found


@pytest.mark.parametrize(
    "body",
    [
        "move P to 10 mm over 1500 ms",
        "move P to -5 mm over 1500 ms",
        HOME + "move P to 1 mm over 200 ms",
        HOME + PRESS + "move P to -1 mm over 1100 ms",
        PRESS + "wait 4995 ms",
        "press to 18 N over 1 s for 5 s",
        "press to 0 N over 5 s for 5 s",
        "guard force > 19.999 N\nguard any.pressure > 19.999 kPa\nguard force < 30 N\nguard all.pressure < 30 kPa",
    ],
)
def test_a_script_that_goes_up_to_the_limit_is_sound(body):
    assert limits(body) == []


def test_a_move_after_a_press_is_told_why_it_begins_so_far_away():
    (found,) = report(HOME + PRESS + "move P to 0 mm over 500 ms").diagnostics

    assert found.message == "joint P would move at 20 mm/s, at most 10 mm/s"
    assert found.help == "it begins between -5 mm and 10 mm: a press leaves it anywhere in its range"


def test_a_limit_names_value_and_limit():
    bodies = ("press to 19 N over 1 s for 2 s", "press to 5 N over 1 s for 6 s", "guard force > 20 N",
              "guard C1.pressure > 25 kPa", "move P to 12.5 mm over 9 s")  # fmt: skip

    assert [report(body).diagnostics[0].message for body in bodies] == [
        "19 N, at most 18 N",
        "a press of 6000 ms, at most 5000 ms",
        "20 N is not below the robot's own trip at 20 N",
        "it is never above 25 kPa: a force cell reads 20 kPa at most",
        "12.5 mm is outside -5 mm .. 10 mm",
    ]


def test_the_report_tells_force_depths_and_the_time_of_driving():
    text = "\n".join(report(HOME + PRESS + "wait 1 s").lines())

    assert text == (
        "script.gait keeps the limits of round\n"
        "  time      7.0 s at least, 7.0 s at most\n"
        "  program   43 of 1024 bytes, 3 steps\n"
        "  force     5 of 18 N\n"
        "  joint orders   depths                   speed (of 10)       held (of 5)      driven\n"
        "  P          2   -5.00 .. 10.00 mm             5.5 mm/s            1.00 s      6.00 s"
    )


def test_the_numbers_for_json_have_the_force_where_there_is_a_press():
    data = report(HOME + PRESS).as_dict()

    assert json.loads(json.dumps(data)) == data
    assert data["force_mn"] == {"most": 5000, "limit": 18000}
    assert data["joints"]["P"]["driven_ms"] == 6000
    assert "force_mn" not in round_report("move R to 8 deg over 1 s", profile=hand_robot()).as_dict()
