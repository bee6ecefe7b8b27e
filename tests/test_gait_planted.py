"""Planted mistakes: more than sixty kinds, each found at its line and column, and none that brings another with it.

Those of the first statements of the language stand in test_gait_errors.py; here are those of the later ones, and the
limits that single orders break, which are told in the same round.
"""

import pytest

from host.gait.checker import check
from tests.gait_scripts import HEAD, ball_robot, compiled, diagnostics, hand_robot, mistakes, press_robot, round_robot
from tests.test_gait_errors import PLANTED

ROBOTS = {"round": round_robot, "ball": ball_robot, "hand": hand_robot, "press": press_robot}
FIRE = "fire A at 60 % for 600 ms"
FIRE_C = "fire $c at 5 % for 1 s"
UNTIL = "wait until A.temperature > 60 C timeout 4 s else"
LET = "circle roll = A00m1 A10m1 A100\nlet next = roll[down + 1]\n"
LATER = (
    ("round", "hold at 80 C with 40 % for 2 s", "E130", 1, 1),
    ("round", "hold Q at 80 C with 40 % for 2 s", "E131", 1, 6),
    ("round", "hold A with 40 % for 2 s", "E126", 1, 1),
    ("round", "hold A at 80 C for 2 s", "E132", 1, 1),
    ("round", "hold A at 80 C with 40 %", "E133", 1, 1),
    ("round", "hold A at 80 C with 40 % for 2 s overlap 3 s", "E134", 1, 34),
    ("round", "together:\n    hold A at 80 C with 40 % for 2 s\n    " + FIRE, "E135", 3, 5),
    ("round", "hold A at 80 % with 40 % for 2 s", "E122", 1, 11),
    ("round", "hold A at 80 C with 140 % for 2 s", "E125", 1, 21),
    ("round", "hold A at 80 C at 70 C with 40 % for 2 s", "E111", 1, 16),
    ("round", "hold A at 80 C with 40 % for 2 s until 90 C", "E101", 1, 34),
    ("round", "hold A at 80 C wiht 40 % for 2 s", "E101", 1, 16),
    ("hand", "hold R at 80 C with 40 % for 2 s", "E139", 1, 6),
    ("round", "for c in A B\n    " + FIRE_C, "E104", 1, 13),
    ("round", "for c in A B:", "E105", 1, 1),
    ("round", "for in A B:\n    wait 1 s", "E101", 1, 8),
    ("round", "for c of A B:\n    wait 1 s", "E101", 1, 7),
    ("round", "for c in Q:\n    " + FIRE_C, "E131", 1, 10),
    ("round", "for c in A front:\n    " + FIRE_C, "E136", 1, 12),
    ("round", "for c in 20 %:\n    " + FIRE_C, "E165", 2, 10),
    ("round", "for d in A, B:\n    fire A at $d for 1 s", "E165", 2, 15),
    ("round", "param d = 1 s\nfor d in 1 .. 3:\n    wait $d * 1 s", "E161", 2, 5),
    ("round", "for k in 1 .. 3:\n    for k in 1 .. 3:\n        wait 1 s", "E161", 2, 9),
    ("round", "for k in 1.5 .. 3:\n    wait 1 s", "E154", 1, 10),
    ("round", "for k in 1 .. 7 / 2:\n    wait 1 s", "E154", 1, 15),
    ("round", "for k in 1 .. 99999:\n    wait 1 s", "E154", 1, 10),
    ("round", "for k in 3 .. 1:\n    wait 1 s", "E155", 1, 10),
    ("round", "for k in 1 s .. 3 s:\n    wait 1 s", "E122", 1, 10),
    ("round", "for k in 1 .. 3:\n    guard any.temperature > 90 C", "E112", 2, 5),
    ("round", "sym 45 deg\n    " + FIRE, "E104", 1, 11),
    ("round", "sym:\n    " + FIRE, "E101", 1, 4),
    ("round", "sym 30 deg:\n    " + FIRE, "E156", 1, 5),
    ("round", "sym z 90 deg:\n    " + FIRE, "E157", 1, 5),
    ("round", "sym 45:\n    " + FIRE, "E120", 1, 5),
    ("round", "sym 45 ms:\n    " + FIRE, "E122", 1, 5),
    ("ball", "sym 90 deg:\n    wait 1 s", "E157", 1, 5),
    ("ball", "sym w 90 deg:\n    wait 1 s", "E157", 1, 5),
    ("ball", "sym z 90 deg, x 45 deg:\n    wait 1 s", "E156", 1, 17),
    ("ball", "sym z 90 deg:\n    fire A100 at 5 % for 1 s", "E158", 2, 10),
    ("ball", "sym x 90 deg:\n    wait until A101.heat < 5 mJ timeout 1 s else abort", "E158", 2, 16),
    ("ball", "circle roll = A100 A001\nsym z 90 deg:\n    let c = roll[down]", "E158", 3, 13),
    ("hand", "sym z 90 deg:\n    wait 1 s", "E326", 1, 1),
    ("round", "note", "E109", 1, 5),
    ("round", "note foot", "E101", 1, 6),
    ("round", 'note "foot', "E113", 1, 6),
    ("round", 'note "at $duty"', "E160", 1, 10),
    ("ball", LET + 'note "push $next"', "E138", 3, 12),
    ("round", "label", "E109", 1, 6),
    ("round", "label abort", "E161", 1, 7),
    ("round", "label a\nwait 1 s\nlabel a", "E171", 3, 7),
    ("round", UNTIL + " recover", "E172", 1, 50),
    ("round", "label recover\n" + UNTIL + " recover", "E173", 2, 50),
    ("round", f"{UNTIL} recover\nrepeat 2:\n    wait 1 s\n    label recover", "E112", 4, 5),
    ("ball", f"{UNTIL.replace('A.', 'any.')} go\n{LET}label go\nfire $next at 5 % for 1 s", "E176", 5, 6),
    ("ball", LET + "on fault:\n    fire $next at 5 % for 1 s", "E176", 4, 10),
    ("round", "on fault:\n    wait 1 s\non fault:\n    wait 1 s", "E174", 3, 1),
    ("round", "on fault:\n    wait 1 s\n" + FIRE, "E175", 1, 1),
    ("round", "repeat 2:\n    wait 1 s\n    on fault:\n        wait 1 s", "E112", 3, 5),
    ("round", "on fault:\n    label a", "E112", 2, 5),
    ("round", "on fault\n    wait 1 s", "E104", 1, 9),
    ("round", "on fualt:\n    wait 1 s", "E101", 1, 4),
    ("round", "guard time > -1 s", "E125", 1, 14),
    ("round", "guard time > 90000 s", "E125", 1, 14),
    ("round", "guard time > 60 mA", "E122", 1, 14),
    ("round", "guard A.time > 60 s", "E144", 1, 9),
    ("round", "guard tme > 60 s", "E144", 1, 7),
    ("round", "guard A.resistance > 4 kohm", "E121", 1, 22),
    ("round", "guard A.resistance > 400 ohm", "E125", 1, 22),
    ("round", "guard front.martensite < 20 %", "E146", 1, 7),
    ("hand", "guard R.martensite < 20 %", "E148", 1, 9),
    ("ball", "circle ring = A100", "E137", 1, 1),
    ("ball", LET + "let other = roll[up]", "E147", 3, 18),
    ("ball", LET + "fire $next A101 at 5 % for 1 s", "E138", 3, 6),
    ("round", "guard roll > 30 deg", "E313", 1, 7),
    ("hand", "guard A.angle > 8 deg", "E131", 1, 7),
    ("hand", "move at 8 deg over 1 s", "E101", 1, 6),
    ("hand", "move to 8 deg over 1 s", "E190", 1, 1),
    ("hand", "move R over 1 s", "E192", 1, 1),
    ("hand", "move R to 8 deg", "E193", 1, 1),
    ("hand", "orient for 1 s", "E194", 1, 1),
    ("hand", "orient 4 deg", "E195", 1, 1),
    ("press", "press over 1 s for 2 s", "E196", 1, 1),
    ("press", "press to 5 N for 2 s", "E197", 1, 1),
    ("press", "press to 5 N over 1 s", "E198", 1, 1),
    ("press", "move C1 to 2 mm over 1 s", "E199", 1, 6),
    ("round", "orient 4 deg for 1 s", "E316", 1, 1),
    ("round", "press to 5 N over 1 s for 2 s", "E322", 1, 1),
)  # fmt: skip
LIMITS = (
    ("round", "fire A at 95 % for 1 s", "E301", 1, 11),
    ("round", "hold A at 80 C with 95 % for 500 ms", "E301", 1, 21),
    ("round", "hold A at 80 C with 5 % for 5 s", "E302", 1, 29),
    ("round", "hold A at 120 C with 5 % for 1 s", "E310", 1, 11),
    ("round", "hold A at 80 C with 5 % for 4 s\nhold A at 80 C with 5 % for 4 s", "E303", 2, 1),
    ("round", "hold A at 80 C with 80 % for 4 s", "E306", 1, 1),
    ("round", "for c in A B C D E:\n    fire $c at 5 % for 1 s overlap 1 s", "E304", 2, 5),
    ("round", "\n".join(f"label l{k}" for k in range(9)), "E327", 9, 1),
    ("hand", "move all to 0 deg over 1 s\nmove R to 31 deg over 2 s", "E317", 2, 11),
    ("hand", "move all to 0 deg over 1 s\nmove R to 30 deg over 20 ms", "E318", 2, 23),
    ("press", "press to 60 N over 1 s for 2 s", "E323", 1, 10),
    ("press", "press to 5 N over 1 s for 99 s", "E324", 1, 27),
)


def found(robot, body):
    return mistakes(body, profile=ROBOTS[robot]())


@pytest.mark.parametrize(("robot", "body", "code", "line", "column"), LATER)
def test_a_planted_mistake_is_found_at_its_line_and_column_and_brings_no_others(robot, body, code, line, column):
    assert found(robot, body)[:1] == [(code, line, column)]
    assert {item[0] for item in found(robot, body)} == {code}


@pytest.mark.parametrize(("robot", "body", "code", "line", "column"), LIMITS)
def test_a_limit_that_is_broken_is_told_at_its_line_and_column(robot, body, code, line, column):
    told = check(compiled(body, profile=ROBOTS[robot]())).diagnostics

    assert (code, line, column) in [(item.code, item.place.line - 2, item.place.column) for item in told]


def test_more_than_sixty_kinds_are_planted():
    codes = {row[1] for row in PLANTED} | {row[2] for row in (*LATER, *LIMITS)}

    assert len(codes) > 60
    assert len(PLANTED) + len(LATER) + len(LIMITS) > 160


@pytest.mark.parametrize(
    ("body", "help"),
    [
        (UNTIL + " recover\nlabel recovery", "did you mean `recovery`?"),
        (UNTIL + " contine", "did you mean `continue`?"),
        ("label top\n" + UNTIL + " top", "a wait goes on further down: move the label below it, or use `repeat`"),
        ("for k in 3 .. 1:\n    wait 1 s", "write `1 .. 3`"),
        ("sym z 90 deg:\n    " + FIRE, "write the angle alone: `sym 45 deg:`"),
        ("guard A.time > 60 s", "write `time` by itself: it counts from the start of the program"),
        ("guard A.resistance > 4 Ohm", "did you mean `ohm`?"),
        ("guard A.martensit > 4 %", "did you mean `martensite`?"),
        ("hold A at 80 C for 2 s", "add `with 40 %`"),
        ("on fault:\n    wait 1 s\nwait 1 s", "move it to the end"),
        ('param duty = 5 %\nnote "$duti"', "did you mean `duty`?"),
    ],
)
def test_the_nearest_known_word_is_offered(body, help):
    assert diagnostics(body)[-1].help == help


def test_an_axis_in_capitals_is_taken_for_what_it_means():
    (told,) = diagnostics("sym Z 90 deg:\n    wait 1 s", profile=ball_robot())

    assert told.help == "did you mean `z`?"


def test_the_limits_of_single_orders_are_told_with_the_mistakes():
    body = (
        "fire Q at 95 % for 11 s\nhold A at 130 C for 9 s\nfire A at 5 % fro 1 s\nfire A B C D E at 5 % for 1 s\nwait"
    )

    assert [item[:2] for item in mistakes(body)] == [
        ("E131", 1), ("E301", 1), ("E302", 1), ("E132", 2), ("E310", 2), ("E302", 2), ("E101", 3), ("E304", 4),
        ("E140", 5),
    ]  # fmt: skip


def test_what_orders_come_to_over_time_is_told_once_there_are_no_mistakes():
    hot = "fire A at 80 % for 2 s\nfire A at 80 % for 2 s"

    assert mistakes(hot + "\nwait") == [("E140", 3, 1)]
    assert [item.code for item in check(compiled(hot)).diagnostics] == ["E306"]


def test_a_def_that_nobody_calls_may_go_on_at_any_label_and_break_limits():
    assert compiled(f"def f(c):\n    fire $c at 99 % for 9 s\n    {UNTIL} anywhere\nwait 1 s").code


def test_a_mistake_in_a_for_is_told_once_however_often_it_runs():
    assert mistakes("for c in A B C:\n    fire $c at 60 for 1 s") == [("E120", 2, 16)]


def test_a_group_without_members_is_nothing_to_go_through():
    profile = round_robot()
    profile.groups["none"] = ()

    assert mistakes("for c in none:\n    " + FIRE_C, head=HEAD, profile=profile) == [("E153", 1, 10)]
