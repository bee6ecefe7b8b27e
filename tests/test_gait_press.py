"""A press in a script: from orders and questions to op-codes, and what is wrong with such a script."""

import json

import pytest

from host.profile import read_profile
from protocol import verify
from protocol.program import ABORT, ABOVE, ALL, ANY, BELOW, FORCE, JOINT_CURRENT, POSITION, PRESSURE, Condition
from tests.gait_scripts import block, compiled, diagnostics, hand_robot, mistakes, press_robot, round_robot
from tests.gait_scripts import ops as round_ops

P = 0b1
MOVE = "move P to 4 mm over 2 s"
PRESS = "press to 5 N over 1 s for 4 s"
ROBOTS = {"press": press_robot(), "hand": hand_robot(), "round": round_robot()}


def without(*names):
    """Return the press without these parts of its profile."""
    data = {name: value for name, value in block().items() if name not in names}
    return read_profile(json.dumps(data).encode())


def ops(body, *overrides):
    """Return the ops of a script for the press."""
    return round_ops(body, *overrides, profile=ROBOTS["press"])


def wrong(body, robot="press"):
    """Return (code, line, column) of each mistake on that robot."""
    return mistakes(body, profile=ROBOTS[robot])


def said(body, robot="press"):
    """Return message and help of the only mistake."""
    (found,) = diagnostics(body, profile=ROBOTS[robot])
    return found.message, found.help


def test_a_press_is_an_order_and_the_time_it_takes():
    assert ops(PRESS) == [("press", 5000, 1000, 4000), ("delay", 4000)]


def test_a_press_may_last_longer_than_the_way_of_a_move():
    assert ops("press to 0 N over 65535 ms for 10 * 60 s")[0] == ("press", 0, 65535, 600_000)


def test_an_overlap_lets_the_next_statement_start_while_the_press_presses():
    assert ops(PRESS + " overlap 3 s\nwait 1 s") == [
        ("press", 5000, 1000, 4000), ("delay", 1000), ("delay", 1000),
    ]  # fmt: skip
    assert ops(PRESS + " overlap 4 s\nwait 1 s") == [("press", 5000, 1000, 4000), ("delay", 1000)]


@pytest.mark.parametrize(
    ("written", "force_mn"), [("800 mN", 800), ("0.5 N + 250 mN", 750), ("$f / 3", 667), ("2.5 * $f", 5000)]
)
def test_a_force_may_be_written_in_either_unit_and_reckoned(written, force_mn):
    body = f"param f = 2 N [1 N .. 5000 mN]\npress to {written} over 1 s for 2 s"

    assert ops(body)[0] == ("press", force_mn, 1000, 2000)


def test_a_force_may_be_given_on_the_command_line():
    assert ops("param f = 2 N [1 N .. 5 N]\npress to $f over 1 s for 2 s", "f=4500mN")[0][1] == 4500


def test_a_press_goes_by_millimetres():
    assert ops(MOVE) == [("move", P, 400, 2000), ("delay", 2000)]
    assert ops("move axis to -(1 mm + 0.25 mm) over 2 s")[0] == ops("move all to -1.25 mm over 2 s")[0]


def test_a_whole_number_of_steps_may_be_reckoned_from_lengths():
    assert ops("param deep = 4 mm\nrepeat $deep / 0.5 mm:\n    wait 1 s")[0] == ("repeat", 8)


def test_force_depth_and_forces_may_be_arguments():
    body = "def load(f, j, back):\n    press to $f over 1 s for 2 s\n    move $j to $back over 2 s\nload(3 N, P, -1 mm)"

    assert [row for row in ops(body) if row[0] != "delay"] == [("press", 3000, 1000, 2000), ("move", P, -100, 2000)]


def test_a_robot_may_be_called_as_the_statement_is():
    for name in ("press", "press-soft", "my-press"):
        profile = read_profile(json.dumps({**block(), "robot": name}).encode())

        assert compiled(PRESS, profile=profile, head=f"gait 1\nrobot {name}\n").code


@pytest.mark.parametrize(
    ("text", "condition"),
    [
        ("force > 5 N", Condition(FORCE, ANY, ABOVE, 5000, 0)),
        ("force < -200 mN", Condition(FORCE, ANY, BELOW, -200, 0)),
        ("C1.pressure > 5 kPa", Condition(PRESSURE, ANY, ABOVE, 5000, 0b1)),
        ("any C1 C6.pressure > 800 Pa", Condition(PRESSURE, ANY, ABOVE, 800, 0b100001)),
        ("all C2 C3.pressure < 1.5 kPa", Condition(PRESSURE, ALL, BELOW, 1500, 0b000110)),
        ("all.pressure < 1 kPa", Condition(PRESSURE, ALL, BELOW, 1000, 0b111111)),
        ("any all.pressure > 1 kPa", Condition(PRESSURE, ANY, ABOVE, 1000, 0b111111)),
        ("P.depth > 3 mm", Condition(POSITION, ANY, ABOVE, 300, P)),
        ("P.depth < -0.25 mm", Condition(POSITION, ANY, BELOW, -25, P)),
        ("any.depth > 3 mm", Condition(POSITION, ANY, ABOVE, 300, P)),
        ("P.current > 500 mA", Condition(JOINT_CURRENT, ANY, ABOVE, 500, P)),
    ],
)
def test_a_condition_on_force_pressure_and_depth_is_left_for_the_robot_to_evaluate(text, condition):
    assert ops(f"guard {text}") == [("guard", condition)]
    assert ops(f"wait until {text} timeout 4 s else abort") == [("wait", condition, 4000, ABORT)]


def test_a_condition_on_an_argument_is_on_its_force_cells():
    body = "def felt(c):\n    wait until all $c.pressure > 2 kPa timeout 4 s else abort\nfelt(C2 C3)\nfelt(C1)"

    assert [row[1].mask for row in ops(body)] == [0b110, 0b1]


def test_a_robot_may_have_force_cells_and_load_cell_without_a_press():
    profile = without("press")

    rows = round_ops("guard force > 5 N\nguard C1.pressure > 5 kPa", profile=profile)

    assert [row[1].source for row in rows] == [FORCE, PRESSURE]
    assert mistakes(PRESS, profile=profile) == [("E322", 1, 1)]


def test_what_is_compiled_is_what_the_robot_accepts():
    body = f"guard any.pressure > 9 kPa\n{PRESS}\nwait until force < 1 N timeout 1 s else continue\n{MOVE}"

    made = compiled(body, profile=ROBOTS["press"])

    verify.check_code(made.code, 0, 1024, joints=1, cells=6)


PLANTED = (
    ("press", "E196", 1, 1, "E197", "E198"),
    ("press over 1 s for 2 s", "E196", 1, 1),
    ("press to 5 N for 2 s", "E197", 1, 1),
    ("press to 5 N over 1 s", "E198", 1, 1),
    ("press to over 1 s for 2 s", "E109", 1, 10),
    ("press to 5 over 1 s for 2 s", "E120", 1, 10),
    ("press to 5 mm over 1 s for 2 s", "E122", 1, 10),
    ("press to 5 kPa over 1 s for 2 s", "E122", 1, 10),
    ("press to 5 N over 1 mm for 2 s", "E122", 1, 19),
    ("press to 5 N over 1 s for 2 N", "E122", 1, 27),
    ("press to 5 newton over 1 s for 2 s", "E121", 1, 10),
    ("press to -5 N over 1 s for 2 s", "E125", 1, 10),
    ("press to 70 N over 1 s for 2 s", "E125", 1, 10),
    ("press to 5 N over 0 s for 2 s", "E125", 1, 19),
    ("press to 5 N over 66 s for 4 s", "E125", 1, 19),
    ("press to 5 N over 1 s for 90000 s", "E125", 1, 27),
    ("press to 5 N over 1 s for 2 s for 3 s", "E111", 1, 31),
    ("press to 5 N over 3 s for 2 s", "E134", 1, 14),
    ("press to 5 N over 1 s for 2 s overlap 3 s", "E134", 1, 31),
    ("press 5 N over 1 s for 2 s", "E101", 1, 7),
    ("press P to 5 N over 1 s for 2 s", "E101", 1, 7),
    ("press to 5 N ovr 1 s for 2 s", "E101", 1, 14),
    ("press to 5 N at 1 s for 2 s", "E101", 1, 14),
    ("pres to 5 N over 1 s for 2 s", "E107", 1, 1),
    ("def press(f):\n    wait $f", "E161", 1, 5),
    ("param press = 5 N", "E161", 1, 7),
    ("press(5 N)", "E101", 1, 6),
    (f"repeat 2:\n    {PRESS} overlap 4 s", "E152", 1, 1),
    (f"together:\n    {MOVE}\n    {PRESS}", "E135", 3, 5),
    (f"together:\n    {PRESS}\n    {MOVE}", "E135", 3, 5),
    (f"together:\n    {PRESS}\n    {PRESS}", "E135", 3, 5),
    ("move P over 2 s", "E192", 1, 1),
    ("move P to 4 deg over 2 s", "E122", 1, 11),
    ("move P to 4 over 2 s", "E120", 1, 11),
    ("move P to 400 mm over 2 s", "E125", 1, 11),
    ("move P to 4 cm over 2 s", "E121", 1, 11),
    ("move C1 to 4 mm over 2 s", "E199", 1, 6),
    ("move Q to 4 mm over 2 s", "E131", 1, 6),
    ("orient 5 deg for 3 s", "E316", 1, 1),
    ("fire P at 60 % for 1 s", "E139", 1, 6),
    ("fire C1 at 60 % for 1 s", "E199", 1, 6),
    ("guard force > 5 kPa", "E122", 1, 15),
    ("guard force > 5", "E120", 1, 15),
    ("guard force > 40 N", "E125", 1, 15),
    ("guard force >= 4 N", "E145", 1, 7),
    ("guard forse > 5 N", "E144", 1, 7),
    ("guard P.force > 5 N", "E144", 1, 9),
    ("guard C1.force > 5 N", "E144", 1, 10),
    ("guard pressure > 5 kPa", "E144", 1, 7),
    ("guard depth > 5 mm", "E144", 1, 7),
    ("guard P.angle > 5 deg", "E144", 1, 9),
    ("guard P.depth > 5 deg", "E122", 1, 17),
    ("guard P.temperature > 5 C", "E148", 1, 9),
    ("guard C1.temperature > 5 C", "E144", 1, 10),
    ("guard C1.pressure > 5 N", "E122", 1, 21),
    ("guard C1.pressure > 40 kPa", "E125", 1, 21),
    ("guard P.pressure > 5 kPa", "E199", 1, 7),
    ("guard any C1 P.pressure > 5 kPa", "E199", 1, 14),
    ("guard axis.pressure > 5 kPa", "E199", 1, 7),
    ("guard any C1 P.depth > 5 mm", "E199", 1, 11),
    ("guard C9.pressure > 5 kPa", "E131", 1, 7),
    ("guard any C1 C2 C1.pressure > 5 kPa", "E136", 1, 17),
    ("guard C1 C2.pressure > 5 kPa", "E146", 1, 7),
    ("guard all C1 C2 C3.pressur > 5 kPa", "E144", 1, 20),
    ("def f(c):\n    guard $c.pressure > 5 kPa\nf(C1)", "E112", 2, 5),
    ("def f(c):\n    move $c to 4 mm over 2 s\nf(C1)", "E199", 2, 10),
    ("def f(c):\n    wait $c\nf(C1)", "E165", 2, 10),
    ("def f(c):\n    wait until $c.pressure > 1 kPa timeout 1 s else abort\nf(P)", "E199", 2, 16),
    ("def f(c):\n    wait until $c.pressure > 1 kPa timeout 1 s else abort\nf(5 N)", "E165", 2, 16),
    ("def f(c):\n    wait until $c.pressure > 1 kPa timeout 1 s else abort\nf(C1 P)", "E199", 3, 3),
    ("guard orientation > 5 deg", "E316", 1, 7),
    ("guard roll > 5 deg", "E313", 1, 7),
)  # fmt: skip


@pytest.mark.parametrize(("body", "code", "line", "column", "others"), [(*row[:4], row[4:]) for row in PLANTED])
def test_a_planted_mistake_is_found_at_its_line_and_column_and_brings_no_others(body, code, line, column, others):
    found = wrong(body)

    assert (code, line, column) in found
    assert sorted(item[0] for item in found) == sorted((code, *others))


@pytest.mark.parametrize("robot", ["hand", "round"])
@pytest.mark.parametrize(("body", "column"), [(PRESS, 1), ("guard force > 5 N", 7), ("guard C1.pressure > 5 kPa", 7)])
def test_a_robot_without_load_cell_is_not_asked_to_press(robot, body, column):
    assert wrong(body, robot) == [("E322", 1, column)]


def test_a_robot_whose_joints_turn_takes_no_millimetres():
    assert wrong("move R to 4 mm over 2 s", "hand") == [("E122", 1, 11)]
    assert said("guard R.depth > 4 mm", "hand")[1] == "write `angle`: the joints of round go by deg"


@pytest.mark.parametrize(
    ("body", "message", "help"),
    [
        ("move P to 4 deg over 2 s", "a length (mm) is needed here, not 4 deg", ""),
        ("move P to 4 over 2 s", "4 what? write `4 mm`", ""),
        ("press to 5 over 1 s for 2 s", "5 what? write `5 N` or `5 mN`", ""),
        ("press to 5 mm over 1 s for 2 s", "a force (N or mN) is needed here, not 5 mm", ""),
        ("press to 5 newton over 1 s for 2 s", "`newton` is no unit", "did you mean `N`?"),
        ("pres to 5 N over 1 s for 2 s", "`pres` is no statement", "did you mean `press`?"),
        ("press to 5 N ovr 1 s for 2 s", "`ovr` is not expected here", "did you mean `over`?"),
        ("press to 5 N over 1 s", "press has no time", "add `for 20 s`"),
        ("press to 5 N for 2 s", "press has no time to get there", "add `over 1 s`"),
        ("press over 1 s for 2 s", "press has no force", "add `to 5 N`"),
        ("press to 5 N over 3 s for 2 s", "the over of 3000 ms is longer than the press of 2000 ms", ""),
        ("move P over 2 s", "move has no depth", "add `to 4 mm`"),
        ("fire P at 60 % for 1 s", "P is a joint", "move it: `move P to 4 mm over 2 s`"),
        ("move C1 to 4 mm over 2 s", "C1 is a force cell, not a joint", "ask it: `C1.pressure > 5 kPa`"),
        ("guard P.pressure > 5 kPa", "P is a joint, not a force cell", "force cells are: C1 C2 C3 C4 C5 C6"),
        ("guard c1.pressure > 5 kPa", "the robot round has no force cell `c1`", "did you mean `C1`?"),
        ("guard P.angle > 5 deg", "there is no `angle` to compare", "write `depth`: the joints of round go by mm"),
        ("guard P.force > 5 N", "there is no `force` to compare",
         "write `force` by itself: the robot has one load cell"),
        ("guard pressure > 5 kPa", "there is no `pressure` to compare", "write `any.pressure`"),
        ("guard C1.presure > 5 kPa", "there is no `presure` to compare", "did you mean `pressure`?"),
        ("guard C1 C2.pressure > 5 kPa", "`C1` is neither any nor all",
         "write `any C1 C2.pressure` or `all C1 C2.pressure`"),
        ("guard forse > 5 N", "there is no `forse` to compare", "did you mean `force`?"),
        ("press P to 5 N over 1 s for 2 s", "`P` is not expected here",
         "the form is: press to 5 N over 1 s for 20 s [overlap 5 s]"),
    ],
)  # fmt: skip
def test_each_mistake_says_what_to_do(body, message, help):
    assert said(body) == (message, help)
