"""Joints in a script: from moves to op-codes, what is wrong with such a script, what the robot evaluates of them."""

import pytest

from protocol import verify
from protocol.program import ABORT, ABOVE, ALL, ANY, BELOW, JOINT_CURRENT, ORIENTATION, POSITION, TEMPERATURE, Condition
from tests.gait_scripts import compiled, diagnostics, hand_robot, mistakes, mixed_robot, round_robot
from tests.gait_scripts import ops as round_ops

R, L = 0b01, 0b10
MOVE = "move R to 8 deg over 2 s"
ORIENT = "orient 5 deg for 3 s"
ROBOTS = {"hand": hand_robot(), "mixed": mixed_robot(), "round": round_robot()}


def ops(body, *overrides, robot="hand"):
    """Return the ops of a script for a robot that has joints."""
    return round_ops(body, *overrides, profile=ROBOTS[robot])


def wrong(body, robot="hand"):
    """Return (code, line, column) of each mistake on that robot."""
    return mistakes(body, profile=ROBOTS[robot])


def said(body, robot="hand"):
    """Return message and help of the only mistake."""
    (found,) = diagnostics(body, profile=ROBOTS[robot])
    return found.message, found.help


def test_a_move_is_an_order_and_the_time_it_takes():
    assert ops("move R to 28 deg over 2 s") == [("move", R, 2800, 2000), ("delay", 2000)]


def test_a_move_may_be_of_several_joints_or_a_group():
    assert ops("move R L to 0 deg over 1 s") == ops("move both to 0 deg over 1 s") == ops("move all to 0 deg over 1 s")
    assert ops("move L R to 0 deg over 1 s")[0] == ("move", R | L, 0, 1000)


@pytest.mark.parametrize(
    ("written", "centideg"),
    [
        ("-8 deg", -800),
        ("- 8 deg", -800),
        ("-$a", -250),
        ("$a - 5 deg", -250),
        ("-(2 deg + $a)", -450),
        ("0.004 deg", 0),
        ("-2.345 deg * 2", -469),
    ],
)
def test_an_angle_may_be_negative_and_reckoned(written, centideg):
    assert ops(f"param a = 2.5 deg [-3 deg .. 3 deg]\nmove R to {written} over 2 s")[0] == ("move", R, centideg, 2000)


def test_an_angle_below_zero_may_be_given_on_the_command_line():
    body = "param a = 2.5 deg [-3 deg .. 3 deg]\nmove R to $a over 2 s"

    assert ops(body, "a=-3deg")[0] == ("move", R, -300, 2000)


def test_an_overlap_lets_the_next_statement_start_while_a_joint_turns():
    assert ops("move R to 8 deg over 2 s overlap 500 ms\nwait 1 s") == [
        ("move", R, 800, 2000), ("delay", 1500), ("delay", 1000),
    ]  # fmt: skip


def test_joints_and_angles_may_be_arguments():
    body = "def bend(j, by, t):\n    move $j to -$by over $t\nbend(R, 8 deg, 1 s)\nbend(R L, -3 deg, 2 s)"

    assert [row for row in ops(body) if row[0] == "move"] == [("move", R, -800, 1000), ("move", R | L, 300, 2000)]


def test_two_moves_in_a_together_start_at_once_and_it_ends_with_the_longer():
    assert ops("together:\n    move R to 8 deg over 2 s\n    move L to -8 deg over 1 s\nwait 1 s") == [
        ("move", R, 800, 2000), ("move", L, -800, 1000), ("delay", 2000), ("delay", 1000),
    ]  # fmt: skip


def test_coils_and_joints_may_be_together_and_all_is_all_of_a_kind():
    body = "together:\n    fire all at 50 % for 1 s\n    move all to 8 deg over 2 s"

    assert ops(body, robot="mixed") == [("fire", 0b11, 500, 1000, 0), ("move", 0b1100, 800, 2000), ("delay", 2000)]


def test_an_orient_is_an_order_and_the_time_it_takes():
    assert ops("orient -5 deg for 3 s\norient 0 deg for 1 s overlap 1 s") == [
        ("orient", -500, 3000), ("delay", 3000), ("orient", 0, 1000),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("text", "condition"),
    [
        ("R.angle > 10 deg", Condition(POSITION, ANY, ABOVE, 1000, R)),
        ("R.angle < -10.25 deg", Condition(POSITION, ANY, BELOW, -1025, R)),
        ("any R L.current > 500 mA", Condition(JOINT_CURRENT, ANY, ABOVE, 500, R | L)),
        ("all both.angle < 4 deg", Condition(POSITION, ALL, BELOW, 400, R | L)),
        ("any.current > 500 mA", Condition(JOINT_CURRENT, ANY, ABOVE, 500, R | L)),
        ("all all.angle > 0 deg", Condition(POSITION, ALL, ABOVE, 0, R | L)),
        ("orientation > 4.9 deg", Condition(ORIENTATION, ANY, ABOVE, 490, 0)),
        ("orientation < -4.9 deg", Condition(ORIENTATION, ANY, BELOW, -490, 0)),
    ],
)
def test_a_condition_on_joints_and_object_is_left_for_the_robot_to_evaluate(text, condition):
    assert ops(f"guard {text}") == [("guard", condition)]
    assert ops(f"wait until {text} timeout 4 s else abort") == [("wait", condition, 4000, ABORT)]


def test_any_and_all_mean_the_channels_that_have_what_is_asked_for():
    rows = ops("guard any.temperature > 90 C\nguard any.angle > 20 deg\nguard any A B.heat > 9 mJ", robot="mixed")

    assert [row[1].mask for row in rows] == [0b0011, 0b1100, 0b0011]
    assert rows[0][1].source == TEMPERATURE


def test_a_condition_on_an_argument_is_on_its_joints():
    body = "def reach(j):\n    wait until all $j.angle > 5 deg timeout 4 s else abort\nreach(R L)\nreach(L)"

    assert [row[1].mask for row in ops(body)] == [R | L, L]


@pytest.mark.parametrize("robot", ["hand", "mixed"])
def test_what_is_compiled_is_what_the_robot_accepts(robot):
    body = (
        "move all to -8 deg over 1 s\nwait until any.angle > 3 deg timeout 1 s else continue\nmove L to 0 deg over 1 s"
    )
    profile = ROBOTS[robot]

    made = compiled(body, profile=profile)

    verify.check_code(made.code, len(profile.coil_labels), 1024, len(profile.joint_labels))


PLANTED = (
    ("move", "E190", 1, 1, "E192", "E193"),
    ("move to 8 deg over 2 s", "E190", 1, 1),
    ("move R over 2 s", "E192", 1, 1),
    ("move R to 8 deg", "E193", 1, 1),
    ("move R to over 2 s", "E109", 1, 11),
    ("move R to 8 over 2 s", "E120", 1, 11),
    ("move R to -8 over 2 s", "E120", 1, 11),
    ("move R to 8 deg over 2", "E120", 1, 22),
    ("move R to 8 % over 2 s", "E122", 1, 11),
    ("move R to 8 deg over 2 deg", "E122", 1, 22),
    ("move R to 400 deg over 2 s", "E125", 1, 11),
    ("move R to 8 deg over 66 s", "E125", 1, 22),
    ("move R to 8 deg over 0 s", "E125", 1, 22),
    ("move R to 8 deg over 2 s over 3 s", "E111", 1, 26),
    ("move R to 8 deg over 2 s overlap 3 s", "E134", 1, 26),
    ("move R to 8 deg for 2 s", "E101", 1, 17),
    ("move R to 8 deg ovre 2 s", "E101", 1, 17),
    ("moev R to 8 deg over 2 s", "E107", 1, 1),
    ("to 8 deg", "E107", 1, 1),
    ("move Q to 8 deg over 2 s", "E131", 1, 6),
    ("move R both to 8 deg over 2 s", "E136", 1, 8),
    ("move $j to 8 deg over 2 s", "E160", 1, 6),
    ("param over = 2 s", "E161", 1, 7),
    ("fire R at 60 % for 1 s", "E139", 1, 6),
    ("fire both at 60 % for 1 s", "E139", 1, 6),
    (f"together:\n    {MOVE}\n    move both to 3 deg over 1 s", "E135", 3, 5),
    (f"together:\n    {ORIENT}\n    {MOVE}", "E135", 3, 5),
    (f"together:\n    {MOVE}\n    {ORIENT}", "E135", 3, 5),
    ("orient", "E194", 1, 1, "E195"),
    ("orient for 3 s", "E194", 1, 1),
    ("orient 5 deg", "E195", 1, 1),
    ("orient 5 for 3 s", "E120", 1, 8),
    ("orient 5 deg over 3 s", "E101", 1, 14),
    ("orient 5 deg for 3 s overlap 4 s", "E134", 1, 22),
    ("orient R to 5 deg", "E101", 1, 8),
    ("guard R.temperature > 60 C", "E148", 1, 9),
    ("guard R.heat > 60 mJ", "E148", 1, 9),
    ("guard R.angl > 6 deg", "E144", 1, 9),
    ("guard R.angle > 6 C", "E122", 1, 17),
    ("guard R.current > 6", "E120", 1, 19),
    ("guard R.angle >= 6 deg", "E145", 1, 7),
    ("guard both.angle > 6 deg", "E146", 1, 7),
    ("guard R L.angle > 6 deg", "E146", 1, 7),
    ("guard any R R.angle > 6 deg", "E136", 1, 13),
    ("guard orientaton > 6 deg", "E144", 1, 7),
    ("guard orientation > 6 C", "E122", 1, 21),
    ("guard orientation > 400 deg", "E125", 1, 21),
    ("guard roll > 6 deg", "E313", 1, 7),
)  # fmt: skip


@pytest.mark.parametrize(("body", "code", "line", "column", "others"), [(*row[:4], row[4:]) for row in PLANTED])
def test_a_planted_mistake_is_found_at_its_line_and_column_and_brings_no_others(body, code, line, column, others):
    found = wrong(body)

    assert (code, line, column) in found
    assert sorted(item[0] for item in found) == sorted((code, *others))


@pytest.mark.parametrize(
    ("body", "code", "line", "column"),
    [
        ("move A to 8 deg over 2 s", "E191", 1, 6),
        ("move odd to 8 deg over 2 s", "E191", 1, 6),
        ("fire odd at 60 % for 1 s", "E139", 1, 6),
        ("guard A.angle > 6 deg", "E149", 1, 9),
        ("guard A.current > 6 mA", "E149", 1, 9),
        ("guard any odd.angle > 6 deg", "E149", 1, 15),
        ("guard any odd.temperature > 6 C", "E148", 1, 15),
        ("guard orientation > 6 deg", "E316", 1, 7),
        ("orient 6 deg for 1 s", "E316", 1, 1),
    ],
)
def test_a_robot_of_both_kinds_keeps_them_apart(body, code, line, column):
    assert wrong(body, "mixed") == [(code, line, column)]


@pytest.mark.parametrize(
    ("body", "code", "column"),
    [
        ("move A to 8 deg over 2 s", "E191", 6),
        ("move all to 8 deg over 2 s", "E191", 6),
        ("guard A.angle > 6 deg", "E149", 9),
        ("guard any.angle > 6 deg", "E149", 11),
        ("orient 6 deg for 1 s", "E316", 1),
    ],
)
def test_a_robot_of_coils_is_told_that_it_has_no_joints(body, code, column):
    assert wrong(body, "round") == [(code, 1, column)]


@pytest.mark.parametrize(
    ("body", "message", "help"),
    [
        ("fire R at 60 % for 1 s", "R is a joint", "move it: `move R to 8 deg over 2 s`"),
        ("move A to 8 deg over 2 s", "A is a coil", "fire it: `fire A at 60 % for 600 ms`"),
        ("guard R.temperature > 6 C", "R is a joint: it has no `temperature` to compare", "it has: angle current"),
        (
            "guard A.angle > 6 deg",
            "A is a coil: it has no `angle` to compare",
            "it has: temperature heat resistance martensite",
        ),
        ("move Q to 8 deg over 2 s", "the robot round has no coil or joint `Q`", "it has: A B R L all front odd"),
        ("guard R.voltage < 5 mA", "there is no `voltage` to compare", "write `supply.voltage`"),
        ("guard R L.angle > 6 deg", "`R` is neither any nor all", "write `any R L.angle` or `all R L.angle`"),
        ("move R to 8 deg", "move has no time", "add `over 2 s`"),
        ("moev R to 8 deg over 2 s", "`moev` is no statement", "did you mean `move`?"),
        ("move R to 8 deg ovr 2 s", "`ovr` is not expected here", "did you mean `over`?"),
        ("orient 6 deg for 1 s", "the robot round has no camera", ""),
    ],
)
def test_each_mistake_says_what_to_do(body, message, help):
    assert said(body, "mixed") == (message, help)


def test_a_quantity_without_its_owner_is_told_whose_it_is():
    assert said("guard angle > 6 deg") == ("there is no `angle` to compare", "write `any.angle`")


def test_the_nearest_known_quantity_is_offered():
    assert said("guard orientaton > 6 deg")[1] == "did you mean `orientation`?"
    assert said("guard R.angel > 6 deg")[1] == "did you mean `angle`?"
