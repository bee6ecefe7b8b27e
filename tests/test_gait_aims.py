"""Coils chosen by the robot: from script to op-codes, what is wrong with such a script, and its worst case."""

import pytest

from protocol import verify
from protocol.program import ABORT, ABOVE, ANY, CHOSEN, CONTINUE, DOWN, HEAT, IS, PITCH, ROLL, Condition
from tests.gait_scripts import BALL, CIRCLE, ball_robot, compiled, diagnostics, mistakes, report, round_robot
from tests.gait_scripts import ops as round_ops

AIM = CIRCLE + "let next = roll[down + 1]\n"
ONCE = AIM + "fire $next at 50 % for 1 s"


def ops(body, *overrides):
    """Return the ops of a script for the robot that has a sensor."""
    return round_ops(body, *overrides, profile=ball_robot())


def wrong(body, profile=None):
    """Return (code, line, column) of each mistake on that robot."""
    return mistakes(body, profile=profile or ball_robot())


def sound(body):
    """Return whether the script keeps the limits of that robot, and the codes of those that it breaks."""
    return [item.code for item in report(body, profile=ball_robot()).diagnostics]


def test_a_let_is_an_aim_and_its_name_the_place_that_it_fills():
    assert ops(ONCE) == [("aim", 0, 1, list(range(8))), ("aimed", 0, 500, 1000, 0, 0), ("delay", 1000)]


def test_a_chosen_coil_takes_every_clause_of_a_fire():
    (_, order, delay) = ops(AIM + "fire $next at 50 % for 1 s until 95 C ramp 100 ms overlap 200 ms")

    assert order == ("aimed", 0, 500, 1000, 950, 100)
    assert delay == ("delay", 800)


@pytest.mark.parametrize(("written", "ahead"), [("down", 0), ("down + 3", 3), ("down - 1", 7), ("down + 2 * 5", 2)])
def test_places_are_counted_forward_and_back_round_the_circle(written, ahead):
    assert ops(f"{CIRCLE}let a = roll[{written}]")[0][:3] == ("aim", 0, ahead)


def test_each_name_has_a_place_of_its_own_and_keeps_it():
    lets = "let a = roll[down]\nlet b = roll[down + 4]\nlet a = roll[down + 1]"

    assert [row[1] for row in ops(CIRCLE + lets)] == [0, 1, 0]


def test_a_chosen_coil_may_be_an_argument():
    body = "def push(c, t):\n    fire $c at 50 % for $t\n" + AIM + "push($next, 1 s)\npush(A100, 2 s)"

    assert [row[:2] for row in ops(body) if row[0] in ("fire", "aimed")] == [("aimed", 0), ("fire", 4)]


@pytest.mark.parametrize(
    ("text", "condition"),
    [
        ("roll > 30 deg", Condition(ROLL, ANY, ABOVE, 300, 0)),
        ("pitch < -20.5 deg", Condition(PITCH, ANY, 0, -205, 0)),
        ("down is A10m1", Condition(DOWN, ANY, IS, 0, 2)),
        ("down is low", Condition(DOWN, ANY, IS, 0, 3)),
        ("down is $next", Condition(DOWN, CHOSEN, IS, 0, 0)),
        ("$next.heat < 300 mJ", Condition(HEAT, CHOSEN, 0, 300, 0)),
        ("A100.heat < 300 mJ", Condition(HEAT, ANY, 0, 300, 4)),
    ],
)
def test_conditions_on_the_attitude_are_left_for_the_robot(text, condition):
    assert ops(AIM + f"guard {text}")[-1] == ("guard", condition)
    assert ops(AIM + f"wait until {text} timeout 4 s else abort")[-1] == ("wait", condition, 4000, ABORT)


def test_the_robots_own_verification_takes_what_is_compiled():
    made = compiled(ONCE + "\nwait until down is $next timeout 1 s else continue", profile=ball_robot())

    verify.check_code(made.code, 8, 1024)
    assert ops(ONCE + "\nwait until down is $next timeout 1 s else continue")[-1][-1] == CONTINUE


PLANTED = (
    ("circle two = A100", "E137", 1, 1),
    ("circle two = A100 A101 A100", "E136", 1, 24),
    ("circle two = A100 low", "E137", 1, 1),
    ("circle two = A100 A102", "E131", 1, 19),
    ("circle = A100 A101", "E101", 1, 8),
    ("circle fire = A100 A101", "E161", 1, 8),
    (CIRCLE + CIRCLE, "E161", 2, 8),
    ("repeat 2:\n    circle two = A100 A101\n    wait 1 s", "E112", 2, 5),
    (CIRCLE + "let a = rol[down]", "E160", 2, 9),
    (CIRCLE + "let a = roll[up]", "E147", 2, 14),
    (CIRCLE + "let a = roll[down + 1.5]", "E147", 2, 21),
    (CIRCLE + "let a = roll[down + 1 s]", "E122", 2, 21),
    (CIRCLE + "let a = roll[down", "E113", 2, 18),
    (CIRCLE + "param a = 1\nlet a = roll[down]", "E161", 3, 5),
    (CIRCLE + "together:\n    let a = roll[down]", "E143", 3, 5),
    (CIRCLE + "fire $a at 5 % for 1 s\nlet a = roll[down]", "E160", 2, 6),
    (AIM + "fire $next A100 at 5 % for 1 s", "E138", 3, 6),
    (AIM + "wait $next", "E165", 3, 6),
    (CIRCLE + "\n".join(f"let {name} = roll[down]" for name in "abcde"), "E314", 6, 5),
    ("guard down is A10", "E131", 1, 15),
    ("guard up is A100", "E144", 1, 7),
    ("guard yaw > 3 deg", "E144", 1, 7),
    ("guard roll > 3", "E120", 1, 14),
    ("guard roll == 3 deg", "E145", 1, 7),
    ("guard A100.heat > 3 C", "E122", 1, 19),
    ("guard down is", "E109", 1, 14),
)


@pytest.mark.parametrize(("body", "code", "line", "column"), PLANTED, ids=[f"{row[1]} {row[0]}" for row in PLANTED])
def test_a_mistake_is_named_and_placed(body, code, line, column):
    assert (code, line, column) in wrong(body)


@pytest.mark.parametrize("body", ["let a = two[down]", "guard roll > 30 deg", "guard down is A", "guard pitch < 1 deg"])
def test_a_robot_without_a_sensor_is_refused_such_a_script(body):
    found = diagnostics("circle two = A B\n" + body, profile=round_robot())

    assert [(item.code, item.exit_code) for item in found] == [("E313", 4)]


def test_a_coil_whose_label_names_no_direction_is_not_for_a_circle():
    found = diagnostics("circle two = A B", profile=_blunt())

    assert [item.code for item in found] == ["E137"]


def _blunt():
    """Return a robot with a sensor whose coils have names only."""
    import dataclasses  # noqa: PLC0415

    return dataclasses.replace(round_robot(), imu={"address": 106})


def test_a_chosen_coil_counts_for_each_coil_of_its_circle():
    made = report(CIRCLE.replace(" Am10m1", "") + ONCE[len(CIRCLE) :] + "\nfire A100 at 50 % for 1 s", ball_robot())

    rows = {coil.label: (coil.orders, coil.on_ms) for coil in made.coils}
    assert rows["A100"] == (2, 2000)
    assert rows["A101"] == (1, 1000)
    assert rows["Am10m1"] == (0, 0)
    assert made.at_once == 1


def test_two_chosen_coils_may_be_one_and_add_their_heat():
    fires = "fire $a at 80 % for 1 s\nfire $b at 80 % for 1 s"
    apart = report(CIRCLE + "let a = roll[down]\nlet b = roll[down + 4]\n" + fires, ball_robot())
    alone = report(CIRCLE + "let a = roll[down]\nfire $a at 80 % for 1 s", ball_robot())

    assert apart.coils[0].heat_peak_mj == pytest.approx(2 * alone.coils[0].heat_peak_mj, abs=1)


HOT = "fire $next at 90 % for 1900 ms\nwait 20 ms\n"
COOL = "wait until $next.heat < 100 mJ timeout 9 s else abort\n"


@pytest.mark.parametrize(
    ("body", "codes"),
    [
        (AIM + HOT, []),
        (AIM + HOT * 2, ["E306"]),
        (AIM + HOT + AIM[len(CIRCLE) :] + HOT, ["E306"]),
        (AIM + HOT + AIM[len(CIRCLE) :] + COOL + HOT, []),
        (AIM + HOT + AIM[len(CIRCLE) :] + COOL.replace("abort", "continue") + HOT, ["E306"]),
        (AIM + HOT + AIM[len(CIRCLE) :] + COOL.replace("<", ">") + HOT, ["E306"]),
        # the wait is for another coil than the one that is hot and may be chosen again
        (AIM + HOT + AIM[len(CIRCLE) :] + COOL + AIM[len(CIRCLE) :] + HOT, ["E306"]),
    ],
    ids=["once", "twice", "chosen twice", "cooled", "not surely cooled", "surely hot", "another cooled"],
)
def test_a_coil_that_may_be_chosen_again_must_have_cooled(body, codes):
    assert sound(body) == codes


def test_a_coil_that_is_known_to_hold_less_heat_may_be_fired_again():
    hot = "fire A100 at 90 % for 1900 ms\nwait 20 ms\n"
    wait = "wait until {}.heat < 100 mJ timeout 9 s else abort\n"

    assert sound(hot * 2) == ["E306"]
    assert sound(hot + wait.format("A100") + hot) == []
    assert sound(hot + wait.format("all low") + hot) == ["E306"]
    assert sound(hot + wait.format("any") + hot) == ["E306"]


def test_a_coil_is_not_chosen_anew_while_the_last_one_may_be_on():
    again = "fire $next at 5 % for 1 s overlap 20 ms\nlet next = roll[down]"

    assert sound(AIM + again) == ["E315"]
    assert sound(AIM + again.replace(" overlap 20 ms", "")) == []


def test_a_coil_that_is_chosen_again_without_a_pause_counts_as_on_all_the_time():
    turn = "    let next = roll[down]\n    fire $next at 1 % for 3500 ms\n"

    assert sound(CIRCLE + "repeat 2:\n" + turn) == ["E303"]
    assert sound(CIRCLE + "repeat 2:\n" + turn + "    wait 10 ms") == []


def test_a_named_coil_and_a_chosen_one_that_follow_each_other_count_as_one():
    assert sound(AIM + "fire A100 at 1 % for 3 s\nfire $next at 1 % for 3500 ms") == ["E303"]
    assert sound(AIM + "fire A100 at 1 % for 3 s\nwait 10 ms\nfire $next at 1 % for 3500 ms") == []


def test_a_chosen_coil_may_be_one_that_must_rest():
    long = "fire A100 at 1 % for 3 s\nfire A100 at 1 % for 3 s\nwait 100 ms\n"

    assert sound(AIM + long + "fire $next at 1 % for 1 s") == ["E312"]


def test_two_coils_that_are_chosen_may_be_on_together_the_same_one_only_in_turn():
    lets = "let a = roll[down]\nlet b = roll[down + 4]\n"
    both = CIRCLE + lets + "together:\n    fire $a at 5 % for 1 s\n    fire ${} at 5 % for 1 s"

    assert report(both.format("b"), ball_robot()).at_once == 2
    assert ("E135", 6, 5) in wrong(both.format("a"))


def test_the_circle_of_the_tests_is_the_rolling_circle():
    assert CIRCLE.split()[3:] == BALL


def test_what_a_chosen_coil_takes_on_one_of_two_ways_is_counted_where_they_meet():
    body = f"{CIRCLE}let x = roll[down]\nwait until time > 1 s timeout 100 ms else end\nfire $x at 50 % for 1 s\n"
    made = report(body + "wait 1 s\nlabel end\nwait 3 s", profile=ball_robot())

    assert [coil.on_ms for coil in made.coils] == [1000] * 8
    assert all(coil.energy_mj >= 190 for coil in made.coils)


def test_the_shortest_time_does_not_wait_for_an_order_that_a_chosen_coil_may_take_over():
    body = f"{CIRCLE}let x = roll[down]\nfire A00m1 at 10 % for 1 s overlap 1 s\nfire $x at 10 % for 20 ms"

    assert report(body, profile=ball_robot()).shortest_ms == 20
