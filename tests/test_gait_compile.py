"""From script to op-codes: timing, names, params and conditions, to the millisecond and the bit."""

import pytest

from host.gait.compiler import compile_script
from host.gait.script import load
from protocol import program, verify
from protocol.program import ABORT, ABOVE, ALL, ANY, BELOW, BOARD, CONTINUE, CURRENT, TEMPERATURE, VOLTAGE, Condition
from tests.gait_scripts import HEAD, compiled, diagnostics, mistakes, ops, reader, round_robot

EVEN = 0b01010101


def test_a_fire_is_an_order_and_the_time_it_takes():
    assert ops("fire A at 60 % for 600 ms") == [("fire", 1, 600, 600, 0), ("delay", 600)]


def test_all_values_become_the_robots_own_integers():
    (order, _) = ops("fire B C at 12.5 % for 1.2 s until 95.5 C ramp 0.1 s")

    assert order == ("ramp", 0b110, 125, 1200, 955, 100)


def test_an_overlap_lets_the_next_statement_start_that_much_earlier():
    assert ops("fire A at 60 % for 600 ms overlap 200 ms\nfire B at 60 % for 300 ms") == [
        ("fire", 1, 600, 600, 0), ("delay", 400), ("fire", 2, 600, 300, 0), ("delay", 300),
    ]  # fmt: skip


def test_a_full_overlap_starts_the_next_statement_at_once():
    assert ops("fire A at 60 % for 1 s overlap 1 s\nwait 5 ms") == [("fire", 1, 600, 1000, 0), ("delay", 5)]


def test_an_overlap_at_the_end_of_a_turn_reaches_into_the_next():
    assert ops("repeat 2:\n    fire A at 50 % for 1 s overlap 250 ms") == [
        ("repeat", 2), ("fire", 1, 500, 1000, 0), ("delay", 750), ("next",),
    ]  # fmt: skip


def test_a_cut_off_does_not_change_the_timeline():
    with_cut_off = ops("fire A at 60 % for 600 ms until 95 C\nwait 1 s")

    assert [row[1:] for row in with_cut_off if row[0] == "delay"] == [(600,), (1000,)]


def test_together_starts_its_statements_at_once_and_ends_with_the_longest():
    assert ops("together:\n    fire A at 40 % for 500 ms\n    fire B C at 30 % for 800 ms\nwait 1 s") == [
        ("fire", 0b1, 400, 500, 0), ("fire", 0b110, 300, 800, 0), ("delay", 800), ("delay", 1000),
    ]  # fmt: skip


def test_together_lays_nested_blocks_calls_and_repeats_on_one_exact_timeline():
    body = (
        "def late(c):\n    wait 100 ms\n    fire $c at 50 % for 200 ms\n"
        "together:\n"
        "    repeat 2:\n        fire A at 10 % for 150 ms\n"
        "    late(B)\n"
        "    together:\n        late(C)\n        fire D at 20 % for 120 ms\n"
    )

    assert ops(body) == [
        ("fire", 1, 100, 150, 0), ("fire", 8, 200, 120, 0), ("delay", 100),
        ("fire", 2, 500, 200, 0), ("fire", 4, 500, 200, 0), ("delay", 50),
        ("fire", 1, 100, 150, 0), ("delay", 150),
    ]  # fmt: skip


def test_together_keeps_a_gap_that_one_statement_leaves():
    assert ops("together:\n    wait 1 s\n    fire A at 10 % for 100 ms") == [("fire", 1, 100, 100, 0), ("delay", 1000)]


def test_the_same_coil_may_follow_itself_within_a_together():
    body = "def f():\n    fire A at 90 % for 100 ms\n    fire A at 30 % for 100 ms\ntogether:\n    f()\n    wait 1 ms"

    assert [row[2] for row in ops(body) if row[0] == "fire"] == [900, 300]


def test_one_statement_of_a_together_may_follow_another_on_the_same_coil():
    late = "def late():\n    wait 100 ms\n    fire A at 30 % for 100 ms\n"
    body = late + "together:\n    fire A at 90 % for {} ms\n    late()"

    assert [row[2] for row in ops(body.format(100)) if row[0] == "fire"] == [900, 300]
    assert mistakes(body.format(101)) == [("E135", 3, 5)]


def test_repeats_stay_loops_on_the_robot():
    assert ops("repeat 3:\n    repeat 2:\n        wait 1 s") == [
        ("repeat", 3), ("repeat", 2), ("delay", 1000), ("next",), ("next",),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("text", "condition"),
    [
        ("A.temperature > 95 C", Condition(TEMPERATURE, ANY, ABOVE, 950, 1)),
        ("any.temperature > 95 C", Condition(TEMPERATURE, ANY, ABOVE, 950, 255)),
        ("all.temperature < 45.5 C", Condition(TEMPERATURE, ALL, BELOW, 455, 255)),
        ("any even.temperature > 95 C", Condition(TEMPERATURE, ANY, ABOVE, 950, EVEN)),
        ("all even.temperature < 45 C", Condition(TEMPERATURE, ALL, BELOW, 450, EVEN)),
        ("supply.current > 800 mA", Condition(CURRENT, ANY, ABOVE, 800, 0)),
        ("supply.voltage < 1800 mV", Condition(VOLTAGE, ANY, BELOW, 1800, 0)),
        ("board.temperature > -5 C", Condition(BOARD, ANY, ABOVE, -50, 0)),
    ],
)
def test_a_condition_is_left_for_the_robot_to_evaluate(text, condition):
    assert ops(f"guard {text}") == [("guard", condition)]
    assert ops(f"wait until {text} timeout 4 s else continue") == [("wait", condition, 4000, CONTINUE)]


def test_a_wait_may_write_its_else_before_its_timeout():
    assert ops("wait until A.temperature < 45 C else abort timeout 4 s")[0][2:] == (4000, ABORT)


def test_an_argument_may_be_a_coil_a_group_a_value_or_another_argument():
    body = (
        "def inner(c, t):\n    fire $c at 10 % for $t\n"
        "def outer(c, d):\n    inner($c, 1 s)\n    inner($d, 2 * 300 ms)\n"
        "outer(A, C D)\nouter(even, B)"
    )

    assert [row[1] for row in ops(body) if row[0] == "fire"] == [1, 0b1100, EVEN, 2]


def test_a_condition_on_an_argument_is_on_its_coils():
    body = "def cool(c):\n    wait until all $c.temperature < 45 C timeout 4 s else abort\ncool(A B)\ncool(C)"

    assert [row[1].mask for row in ops(body)] == [0b11, 0b100]


def test_an_argument_hides_a_param_of_its_name():
    assert ops("param t = 1 s\ndef f(t):\n    wait $t\nf(2 s)") == [("delay", 2000)]


def test_params_fold_on_the_host_in_the_order_of_the_text():
    assert ops("param a = 1 s\nparam b = ($a + 500 ms) / 3\nwait 2 * $b - 1 ms") == [("delay", 999)]


def test_a_ratio_of_like_quantities_is_a_plain_number():
    assert ops("param all_time = 3 s\nrepeat $all_time / 500 ms:\n    wait 1 ms")[0] == ("repeat", 6)


def test_an_override_takes_the_place_of_the_default_everywhere():
    body = "param step = 2 s [1 s .. 6 s]\nparam half = $step / 2\nwait $half"

    assert ops(body, "step=3s") == [("delay", 1500)]
    assert ops(body, "step = 2 * 1.5 s") == [("delay", 1500)]


@pytest.mark.parametrize(
    ("override", "code", "exit_code"),
    [
        ("step=7s", "E182", 4),
        ("step=50%", "E122", 2),
        ("step=3", "E120", 2),
        ("step", "E183", 2),
        ("=3", "E183", 2),
        ("stp=3s", "E181", 2),
        ("step=3 parsec", "E121", 2),
        ("step=)", "E109", 2),
    ],
)
def test_a_bad_override_is_named_with_its_value_and_limit(override, code, exit_code):
    (found,) = diagnostics("param step = 2 s [1 s .. 6 s]\nwait $step", override)

    assert (found.code, found.exit_code) == (code, exit_code)
    assert found.place.file.startswith("-p")


def test_an_override_outside_its_range_quotes_the_range():
    (found,) = diagnostics("param step = 2 s [1 s .. 6 s]\nwait $step", "step=7s")

    assert str(found) == "-p step:1:1: error E182: 7 s is outside 1 s .. 6 s\n    7s\n    ^^"


def test_every_step_of_the_robot_leads_back_to_its_line():
    made = compiled("wait 1 s  # first\ndef f(c):\n    fire $c at 5 % for 1 s\nf(A)\nf(B)")

    steps = [row[2] for row in program.disassemble(made.code) if row[1] == "step"]

    assert steps == [1, 2, 3]
    assert [made.step(number).text for number in steps] == ["wait 1 s", *["fire $c at 5 % for 1 s"] * 2]
    assert str(made.step(3)) == "fire $c at 5 % for 1 s (script.gait:5, called from script.gait:7)"
    assert made.step(0) is None
    assert made.step(4) is None


def test_a_line_within_a_loop_is_one_step_in_every_turn():
    made = compiled("repeat 5:\n    fire A at 5 % for 1 s\n    wait 1 s")

    assert len(made.steps) == 2


def test_the_program_carries_the_robots_mark_and_is_accepted_by_the_robots_own_check():
    made = compiled("fire A at 60 % for 600 ms")

    header = program.read_header(made.program[: program.HEADER_BYTES])

    assert header.robot_crc == round_robot().crc
    assert header.length == len(made.code)
    verify.check_code(made.code, 8, 1024)


def test_the_same_script_makes_the_same_bytes():
    body = "together:\n    fire even at 10 % for 1 s\n    fire B at 10 % for 1 s"

    assert compiled(body).program == compiled(body).program


def included(files, body='include "lib/push.gait"\npush(A)'):
    texts = {"gaits/main.gait": HEAD + body + "\n", **files}
    return compile_script(load("gaits/main.gait", reader(texts)), round_robot())


def test_an_include_is_named_relative_to_the_file_it_stands_in():
    files = {
        "gaits/lib/push.gait": 'gait 1\ninclude "../more/base.gait"\ndef push(c):\n    fire $c at $duty for 1 s\n',
        "gaits/more/base.gait": "gait 1\nparam duty = 60 %\n",
    }

    assert included(files).steps[0].place.file == "gaits/lib/push.gait"


def test_a_file_included_twice_is_read_once():
    files = {
        "gaits/lib/push.gait": 'gait 1\ninclude "base.gait"\ndef push(c):\n    fire $c at $duty for 1 s\n',
        "gaits/lib/base.gait": "gait 1\nparam duty = 60 %\n",
    }

    body = 'include "lib/base.gait"\ninclude "lib/push.gait"\npush(A)'
    seen = []
    read = reader({"gaits/main.gait": HEAD + body, **files})

    load("gaits/main.gait", lambda path: seen.append(path) or read(path))

    assert sorted(seen) == ["gaits/lib/base.gait", "gaits/lib/push.gait", "gaits/main.gait"]
    assert included(files, body).code


def test_a_circle_of_includes_is_refused_where_it_closes():
    files = {"b.gait": 'gait 1\ninclude "script.gait"\n'}

    (found,) = diagnostics('include "b.gait"', files=files)

    assert (found.place.file, found.place.line, found.code) == ("b.gait", 2, "E170")
    assert "script.gait -> b.gait -> script.gait" in found.message


def test_an_included_file_may_only_declare():
    files = {"b.gait": "gait 1\nfire A at 5 % for 1 s\n"}

    (found,) = diagnostics('include "b.gait"', files=files)

    assert (found.place.file, found.place.line, found.code) == ("b.gait", 2, "E112")


def test_mistakes_of_main_and_included_files_are_told_together():
    files = {"b.gait": "gait 1\ndef push(c):\n    fire $c at 60 for 1 s\n"}

    found = diagnostics('include "b.gait"\nwait\npush(A)', files=files)

    assert [(item.place.file, item.code) for item in found] == [("b.gait", "E120"), ("script.gait", "E140")]


def test_a_library_for_another_robot_is_refused():
    files = {"b.gait": "gait 1\nrobot sphere-a\nparam x = 1 s\n"}

    assert [item.code for item in diagnostics('include "b.gait"', files=files)] == ["E300"]


def test_an_unreadable_library_is_told_without_guesses_about_the_rest():
    assert mistakes('include "b.gait"\npush(A)', files={"b.gait": "gait 1\n\tdef push(c):\n"}) == [("E106", 0, 1)]
