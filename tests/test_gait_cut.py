"""A run that ended early is taken up from one of its steps: the plan is cut on the host."""

import pytest

from host.errors import BadRequest
from host.gait.checker import check
from host.gait.cut import cut
from protocol.program import disassemble
from protocol.verify import check_code
from tests.gait_scripts import CIRCLE, ball_robot, compiled, hand_robot

LOOPED = """\
guard any.temperature > 110 C
fire A at 50 % for 200 ms
repeat 5:
    fire B at 50 % for 200 ms
    fire C at 50 % for 200 ms
fire D at 50 % for 200 ms"""


def rows(made):
    """Return (name, arguments...) of each op, but for the halt."""
    return [row[1:] for row in disassemble(made.code)][:-1]


def fired(made):
    """Return (step, mask of coils) of the orders in the code, loops as "repeat" and "next"."""
    told, step = [], 0
    for name, *arguments in rows(made):
        step = arguments[0] if name == "step" else step
        if name == "fire":
            told.append((step, arguments[0]))
        elif name in ("repeat", "next"):
            told.append((name, *arguments))
    return told


def test_a_script_from_its_first_step_on_is_the_whole_script():
    whole = compiled(LOOPED)

    assert cut(whole, 1).code == whole.code


def test_a_step_behind_a_loop_leaves_the_loop_out():
    assert fired(cut(compiled(LOOPED), 4)) == [(4, 0b1000)]


def test_a_step_within_a_loop_finishes_its_turn_and_has_the_other_turns():
    rest = cut(compiled(LOOPED), 3)

    assert fired(rest) == [(3, 0b100), ("repeat", 4), (2, 0b10), (3, 0b100), ("next",), (4, 0b1000)]


def test_the_last_turn_of_nested_loops_needs_no_loop():
    text = "repeat 2:\n    repeat 1:\n        fire A at 50 % for 200 ms\n        fire B at 50 % for 200 ms"

    assert fired(cut(compiled(text), 2))[:2] == [(2, 0b10), ("repeat", 1)]


def test_guards_before_the_step_go_on_guarding():
    assert rows(cut(compiled(LOOPED), 4))[0] == rows(compiled(LOOPED))[0]


def test_the_last_let_of_each_name_is_chosen_anew():
    text = CIRCLE + "let x = roll[down]\nlet y = roll[down + 1]\nlet x = roll[down + 2]\nfire $x at 50 % for 200 ms"
    whole = compiled(text, profile=ball_robot())

    rest = [row for row in rows(cut(whole, 4)) if row[0] != "step"]

    assert sorted(row[1:3] for row in rest if row[0] == "aim") == [(0, 2), (1, 1)]
    assert rest[-2][0] == "aimed"


CAUGHT = """\
fire A at 50 % for 200 ms
wait until A.temperature > 90 C timeout 1 s else recover
fire B at 50 % for 200 ms
label recover
fire C at 50 % for 200 ms
on fault:
    fire D at 10 % for 200 ms"""


def test_what_runs_on_fault_stays_and_is_no_place_to_begin_from():
    whole = compiled(CAUGHT)

    assert ("label", 255) in rows(cut(whole, 5))
    with pytest.raises(BadRequest, match=r"has steps 1 to 5$"):
        cut(whole, 7)


def test_a_label_that_no_wait_goes_on_at_any_more_does_no_harm():
    rest = cut(compiled(CAUGHT), 3)

    assert fired(rest) == [(3, 0b10), (5, 0b100), (7, 0b1000)]
    check_code(rest.code, 8, 1024)


def test_a_step_keeps_its_number_and_its_line():
    rest = cut(compiled(LOOPED), 4)

    assert rest.step(4).text == "fire D at 50 % for 200 ms"
    assert ("step", 4) in rows(rest)


@pytest.mark.parametrize("step", [0, 5, -1, 70000])
def test_an_unknown_step_names_those_there_are(step):
    with pytest.raises(BadRequest, match=f"no step {step} to begin from: .* has steps 1 to 4$"):
        cut(compiled(LOOPED), step)


def test_what_is_left_is_held_against_the_limits_by_itself():
    text = "move R L to 8 deg over 2 s\norient 4 deg for 1 s"
    whole = compiled(text, profile=hand_robot())

    assert check(whole).sound
    assert [item.code for item in check(cut(whole, 2)).diagnostics] == ["E320"]
