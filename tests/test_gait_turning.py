"""The worst case of joints: numbers worked out by hand, and every limit with the line that breaks it.

The joints of these tests turn 30 degrees to either side, 100 degrees a second, and hold for 5 seconds.
"""

import json

import pytest

from host.gait.checker import check
from host.profile import read_profile
from tests.gait_scripts import compiled, hand, hand_robot, mixed_robot
from tests.gait_scripts import report as round_report

HOME = "move both to 0 deg over 1 s\n"
STEP_MS = 5  # what is held is counted up to the control step after it


def report(body, **servo):
    return round_report(body, profile=hand_robot(**servo))


def joint(made, label="R"):
    return next(row for row in made.joints if row.label == label)


def limits(body, **servo):
    """Return (code, line, column) of each limit that a script breaks."""
    return [(item.code, item.place.line - 2, item.place.column) for item in report(body, **servo).diagnostics]


def speeds(body, label="R"):
    """Return the fastest that a joint may be told to turn, in degrees a second."""
    return joint(report(body), label).fastest_centi_per_s / 100


def test_orders_angles_and_speed_are_counted_for_each_joint():
    made = report(HOME + "move R to 20 deg over 1 s\nrepeat 3:\n    move both to -10 deg over 1 s\n    wait 1 s")

    assert (joint(made).orders, joint(made, "L").orders) == (5, 4)
    assert (joint(made).least_centi, joint(made).most_centi) == (-1000, 2000)
    assert (joint(made, "L").least_centi, joint(made, "L").most_centi) == (-1000, 0)


def test_a_joint_that_is_not_moved_has_no_angles():
    made = joint(report("move R to 8 deg over 1 s"), "L")

    assert (made.orders, made.least_centi, made.most_centi, made.held_ms) == (0, None, None, 0)


def test_time_is_the_sum_of_what_comes_one_after_another():
    made = report(HOME + "move R to 8 deg over 2 s overlap 500 ms\nwait 100 ms")

    assert made.shortest_ms == 1000 + 1500 + 500
    assert made.longest_ms == made.shortest_ms + 5


def test_a_joint_begins_at_the_farther_end_of_its_range_when_nothing_is_known():
    assert speeds("move R to 8 deg over 1 s") == 30 + 8
    assert speeds("move R to -20 deg over 2 s") == 25


def test_a_joint_goes_on_from_where_its_last_order_left_it():
    assert speeds("move R to 8 deg over 1 s\nmove R to 28 deg over 500 ms") == 40
    assert speeds(HOME + "move R to 10 deg over 300 ms") == 33.34  # never rounded in the script's favour


def test_a_joint_that_is_sent_elsewhere_on_its_way_begins_there():
    body = "move R to 0 deg over 1 s\nmove R to 20 deg over 1 s overlap 500 ms\nmove R to -25 deg over 500 ms"

    assert speeds(body) == 2 * (10 + 25)


def test_where_a_wait_may_cut_a_way_short_it_begins_at_the_worse_end():
    wait = "wait until R.angle > {} deg timeout 2 s else continue\n"
    body = "move R to 0 deg over 1 s\nmove R to 20 deg over 1 s overlap 500 ms\n" + wait.format(15)

    assert speeds(body + "move R to 30 deg over 500 ms") == 2 * 20
    assert speeds(body + "move R to -20 deg over 500 ms") == 2 * 40


def test_an_orient_may_swing_both_joints_as_far_as_it_is_allowed_from_their_grip():
    made = report("move R to 4 deg over 1 s\nmove L to -2 deg over 1 s\norient 5 deg for 1 s")

    assert (joint(made).least_centi, joint(made).most_centi) == (300 - 2000, 300 + 2000)
    assert (joint(made, "L").least_centi, joint(made, "L").most_centi) == (-2300, 1700)


def test_an_orient_keeps_joints_within_their_range():
    made = report("move R to 15 deg over 1 s\nmove L to -15 deg over 1 s\norient 5 deg for 1 s")

    assert (joint(made).least_centi, joint(made).most_centi) == (-500, 3000)
    assert (joint(made, "L").least_centi, joint(made, "L").most_centi) == (-3000, 500)


def test_an_orient_keeps_joints_within_a_range_that_is_not_the_same_on_both_sides():
    made = report("move R to 4 deg over 1 s\nmove L to -4 deg over 1 s\norient 5 deg for 1 s", least_centi=-1000)

    assert (joint(made).least_centi, joint(made).most_centi) == (-1000, 2400)
    assert (joint(made, "L").least_centi, joint(made, "L").most_centi) == (-1000, 1600)


def test_an_orient_leaves_a_third_joint_alone():
    data = hand()
    data["channels"] = [*data["channels"], {"label": "M", "kind": "servo", "pin": 10, "current": 4, "position": 5}]
    profile = read_profile(json.dumps(data).encode())
    body = "move both to 0 deg over 1 s\nmove M to 0 deg over 1 s\norient 5 deg for 1 s\nmove M to 5 deg over 1 s"

    made = round_report(body, profile=profile)

    assert made.sound
    assert (joint(made, "M").orders, joint(made, "M").most_centi) == (2, 500)


def test_after_an_orient_a_joint_is_anywhere_within_its_swing():
    grip = "move R to 4 deg over 1 s\nmove L to -2 deg over 1 s\norient 5 deg for 1 s\n"

    assert speeds(grip + "move R to 0 deg over 250 ms") == 4 * 23
    assert speeds(grip + "wait 1 s\nmove L to 0 deg over 250 ms", "L") == 4 * 23


def test_orients_that_follow_each_other_keep_their_grip():
    body = HOME + "repeat 5:\n    orient 5 deg for 1 s\n    orient -5 deg for 1 s overlap 200 ms"

    assert limits(body) == []
    assert joint(report(body)).most_centi == 2000


def test_time_held_counts_from_the_end_of_an_order_to_the_next_or_to_the_end():
    assert (
        joint(report("move R to 8 deg over 1 s\nwait 3 s\nmove R to 0 deg over 1 s\nwait 2 s")).held_ms
        == 3000 + STEP_MS
    )
    assert joint(report("move R to 8 deg over 1 s overlap 400 ms\nwait 3 s")).held_ms == 2600 + STEP_MS


def test_a_wait_counts_in_full_for_the_time_held():
    body = "move R to 8 deg over 1 s\nwait until R.angle > 9 deg timeout 2 s else continue\nwait 1 s"

    assert joint(report(body)).held_ms == 3000 + 2 * STEP_MS


def test_a_loop_of_many_turns_is_worked_out_as_one_of_few():
    body = "repeat {}:\n    move R to 8 deg over 1 s\n    wait 2 s\n    move R to -8 deg over 500 ms overlap 400 ms\n"
    after = "move R to 30 deg over 400 ms"  # from 4.8 deg on

    few, many = (joint(report(body.format(turns) + after)) for turns in (3, 9999))

    assert many.orders == 2 * 9999 + 1
    assert many.fastest_centi_per_s == 6300
    assert (many.held_ms, many.fastest_centi_per_s) == (few.held_ms, few.fastest_centi_per_s)


def test_a_joint_that_a_long_loop_forgets_is_told_for_how_long():
    (found,) = report(HOME + "repeat 600:\n    move R to 8 deg over 100 ms\n    wait 1 s").diagnostics

    message = "joint L would be without an order for 660005 ms after this one, at most 5000 ms"
    assert (found.code, found.place.line, found.message) == ("E319", 3, message)


@pytest.mark.parametrize(
    ("body", "found"),
    [
        ("move R to 31 deg over 2 s", [("E317", 1, 11)]),
        ("move R to -30.01 deg over 2 s", [("E317", 1, 11)]),
        ("move R to 30 deg over 599 ms", [("E318", 1, 23)]),
        (HOME + "move R to 10 deg over 99 ms", [("E318", 2, 23)]),
        (HOME + "move R to 10 deg over 1 s overlap 1 s\nmove R to -10 deg over 99 ms", [("E318", 3, 24)]),
        (HOME + "repeat 2:\n    move R to 10 deg over 1 s\n    move R to 0 deg over 99 ms", [("E318", 4, 26)]),
        ("move R to 8 deg over 1 s\nwait 5 s", [("E319", 1, 1)]),
        ("move both to 8 deg over 1 s\nwait 3 s\nmove L to 0 deg over 1 s\nwait 1 s", [("E319", 1, 1)]),
        (HOME + "orient 5 deg for 1 s\nwait 5 s", [("E319", 2, 1)]),
        ("orient 5 deg for 1 s", [("E320", 1, 1)]),
        ("move L to 8 deg over 1 s\norient 5 deg for 1 s", [("E320", 2, 1)]),
        ("move both to 20.01 deg over 1 s\norient 5 deg for 1 s", [("E321", 2, 1)]),
        ("move both to -20.01 deg over 1 s\norient 5 deg for 1 s", [("E321", 2, 1)]),
        (HOME + "orient 5 deg for 1 s\nmove R to 21 deg over 1 s\norient 5 deg for 1 s", [("E321", 4, 1)]),
    ],
)
def test_a_limit_is_reported_at_the_line_that_breaks_it(body, found):
    assert limits(body) == found


@pytest.mark.parametrize(
    "body",
    [
        "move R to 30 deg over 600 ms",
        "move R to -30 deg over 600 ms",
        "move R to 8 deg over 1 s\nwait 4995 ms",
        "move R to 8 deg over 10 s",
        HOME + "orient 5 deg for 10 s\nwait 4 s",
        "move both to -20 deg over 1 s\norient 5 deg for 1 s",
        "wait 20 s\nmove R to 8 deg over 1 s",
        HOME + "orient 5 deg for 1 s\nmove R to 18 deg over 1 s\norient 5 deg for 1 s",
    ],
)
def test_a_script_that_goes_up_to_the_limit_is_sound(body):
    assert limits(body) == []


def test_a_limit_names_joint_value_and_limit_and_where_it_may_begin():
    (found,) = report("move R to 8 deg over 100 ms").diagnostics

    assert found.message == "joint R would turn at 380 deg/s, at most 100 deg/s"
    assert found.help == "it begins between -30 deg and 30 deg"
    assert found.exit_code == 4


def test_a_robot_without_coils_has_a_report_without_coils():
    text = "\n".join(report(HOME + "move R to -8 deg over 500 ms\nwait 1 s").lines())

    assert text == (
        "script.gait keeps the limits of round\n"
        "  time      2.5 s at least, 2.5 s at most\n"
        "  program   43 of 1024 bytes, 3 steps\n"
        "  joint orders   angles                  speed (of 100)       held (of 5)      driven\n"
        "  R          2   -8.0 .. 0.0 deg             30.0 deg/s            1.00 s      1.50 s\n"
        "  L          1   0.0 .. 0.0 deg              30.0 deg/s            1.50 s      1.00 s"
    )


def test_the_numbers_for_json_are_those_of_the_parts_that_the_robot_has():
    data = report(HOME + "move R to -8 deg over 500 ms").as_dict()

    assert json.loads(json.dumps(data)) == data
    assert data["speed_centi_per_s"] == {"most": 3000, "limit": 10000}
    assert data["held_ms"] == {"most": 505, "limit": 5000}
    assert data["joints"]["R"] == {
        "orders": 2, "least_centi": -800, "most_centi": 0, "fastest_centi_per_s": 3000, "held_ms": 0,
        "driven_ms": 1500,
    }  # fmt: skip
    assert data["coils"] == {}
    assert not {"at_once", "supply_current_ma", "heat_mj"} & set(data)


def test_a_robot_of_both_kinds_has_both_tables():
    made = check(compiled("fire A at 50 % for 1 s\nmove R to 8 deg over 1 s\nwait 1 s", profile=mixed_robot()))

    text = "\n".join(made.lines())

    assert "  A          1    1.00 s" in text
    assert "  R          1   8.0 .. 8.0 deg" in text
    assert set(made.as_dict()) >= {"at_once", "heat_mj", "held_ms", "speed_centi_per_s"}
