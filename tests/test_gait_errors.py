"""Mistakes in a script: each is found, named, placed to the column, and said in words a researcher can act on."""

import os

import pytest

from host.gait import errors
from host.gait.script import load, loads
from tests.gait_scripts import HEAD, compiled, diagnostics, mistakes, round_robot

FIRE = "fire A at 60 % for 600 ms"

PLANTED = (
    ("repeat 3\n    " + FIRE, "E104", 1, 9),
    ("together\n    " + FIRE, "E104", 1, 9),
    ("def f(c)\n    " + FIRE, "E104", 1, 9),
    ("repeat 3:\n" + FIRE, "E105", 1, 1),
    (FIRE + "\n    " + FIRE, "E105", 2, 5),
    ("repeat 3:\n    " + FIRE + "\n  " + FIRE, "E105", 3, 3),
    ("repeat 3:", "E105", 1, 1),
    ("repeat 3:\n\t" + FIRE, "E106", 2, 1),
    ("fier A at 60 % for 600 ms", "E107", 1, 1),
    ("for 600 ms", "E107", 1, 1),
    ("fire A at 60 % ; wait 1 s", "E108", 1, 16),
    ("wait 1 s \x07", "E108", 1, 10),
    ("fire A at for 600 ms", "E109", 1, 11),
    ("fire A at 60 % for", "E109", 1, 19),
    ("param = 3", "E101", 1, 7),
    ("push(3 * )", "E109", 1, 10),
    ("push(A", "E113", 1, 7),
    ("param x = 2 +", "E109", 1, 14),
    ("robot", "E109", 1, 6),
    ("guard", "E109", 1, 6),
    ("fire $ at 60 % for 600 ms", "E109", 1, 6),
    ("fire A at 60 % fro 600 ms", "E101", 1, 16),
    ("fire A at 0,6 % for 600 ms", "E101", 1, 12),
    ("fire A at 60 % for (600 ms", "E113", 1, 27),
    ('include "lib', "E113", 1, 9),
    ("param x = 3 [1 .. 5", "E113", 1, 20),
    ("param until = 3 s", "E161", 1, 7),
    ("repeat 3: " + FIRE, "E101", 1, 11),
    ("robot square", "E111", 1, 1),
    ("gait 1", "E111", 1, 1),
    ("repeat 2:\n    param x = 3", "E112", 2, 5),
    ("repeat 2:\n    guard any.temperature > 90 C", "E112", 2, 5),
    ("fire A at 60 % at 50 % for 1 s", "E111", 1, 16),
    ("fire A at 60 for 600 ms", "E120", 1, 11),
    ("fire A at 60 % for 600", "E120", 1, 20),
    ("param d = 60 [5 % .. 90 %]", "E120", 1, 11),
    ("wait 3 min", "E121", 1, 6),
    ("fire A at 60 ms for 600 ms", "E122", 1, 11),
    ("guard supply.current > 3 C", "E122", 1, 24),
    ("repeat 3 s:\n    " + FIRE, "E122", 1, 8),
    ("wait 3 s + 5 %", "E123", 1, 6),
    ("wait 3 s * 5 s", "E123", 1, 6),
    ("wait 3 s / (2 - 2)", "E124", 1, 6),
    ("fire A at 101 % for 600 ms", "E125", 1, 11),
    ("wait 0 s", "E125", 1, 6),
    ("wait 2 s - 3 s", "E125", 1, 6),
    ("wait 99999999999999 s", "E125", 1, 6),
    ("fire at 60 % for 600 ms", "E130", 1, 1),
    ("fire Q at 60 % for 600 ms", "E131", 1, 6),
    ("fire A for 600 ms", "E132", 1, 1),
    ("fire A at 60 %", "E133", 1, 1),
    ("fire A at 60 % for 1 s overlap 2 s", "E134", 1, 24),
    ("fire A at 60 % for 1 s ramp 2 s", "E134", 1, 24),
    ("together:\n    " + FIRE + "\n    fire front at 5 % for 1 s", "E135", 3, 5),
    ("fire A front at 60 % for 1 s", "E136", 1, 8),
    ("wait", "E140", 1, 1),
    ("wait until A.temperature > 60 C else abort", "E141", 1, 1),
    ("wait until A.temperature > 60 C timeout 4 s", "E142", 1, 1),
    ("wait until A.temperature > 60 C timeout 4 s else stop", "E172", 1, 50),
    ("together:\n    wait until A.temperature > 60 C timeout 4 s else abort", "E143", 2, 5),
    ("guard A.temp > 60 C", "E144", 1, 9),
    ("guard A.temperature >= 60 C", "E145", 1, 7),
    ("guard front.temperature > 60 C", "E146", 1, 7),
    ("guard some front.temperature > 60 C", "E146", 1, 7),
    ("repeat:\n    " + FIRE, "E150", 1, 1),
    ("repeat 2.5:\n    " + FIRE, "E151", 1, 8),
    ("repeat 0:\n    " + FIRE, "E151", 1, 8),
    ("repeat 9:\n    fire A at 60 % for 1 s overlap 1 s", "E152", 1, 1),
    ("fire A at $duty for 600 ms", "E160", 1, 11),
    ("param a = 1 s\nparam a = 2 s", "E161", 2, 7),
    ("def f():\n    wait 1 s\ndef f():\n    wait 1 s", "E161", 3, 5),
    ("def f(a, a):\n    wait 1 s", "E161", 1, 10),
    ("push(A)", "E162", 1, 1),
    ("def f(c):\n    fire $c at 5 % for 1 s\nf()", "E163", 3, 1),
    ("def f():\n    f()\nf()", "E164", 2, 5),
    ("def f(c):\n    wait $c\nf(A)", "E165", 2, 10),
    ("def f(c):\n    fire $c at 5 % for 1 s\nf(3 s)", "E165", 2, 10),
    ('include "absent.gait"', "E115", 1, 1),
    ("param d = 95 % [5 % .. 90 %]", "E180", 1, 1),
)  # fmt: skip


@pytest.mark.parametrize(("body", "code", "line", "column"), PLANTED)
def test_a_planted_mistake_is_found_at_its_line_and_column(body, code, line, column):
    assert (code, line, column) in mistakes(body)


@pytest.mark.parametrize(("body", "code", "line", "column"), PLANTED)
def test_a_planted_mistake_brings_no_others_with_it(body, code, line, column):
    assert [found[0] for found in mistakes(body)] == [code]


def test_a_script_without_its_head_is_told_both_lines():
    assert mistakes("wait 1 s", head="") == [("E102", 1, 1), ("E110", 1, 1)]


def test_a_script_in_a_later_language_is_refused():
    assert mistakes("wait 1 s", head="gait 2\nrobot round\n") == [("E103", -1, 1)]


def test_an_indented_first_statement_is_found():
    assert mistakes("", head="  gait 1\n") == [("E105", 0, 3)]


def test_a_script_for_another_robot_is_a_refusal_not_a_mistake():
    (found,) = diagnostics("wait 1 s", head="gait 1\nrobot sphere-b\n")

    assert (found.code, found.exit_code, found.place.line) == ("E300", 4, 2)


def test_all_mistakes_of_all_kinds_are_told_at_once():
    body = "repeat 3\n    fire Q at 60 for 600 ms\nwait\nfire A at 5 % fro 1 s\npush(B)\nfire B at 5 % for 3 parsec"

    assert [found[:2] for found in mistakes(body)] == [
        ("E104", 1), ("E131", 2), ("E120", 2), ("E140", 3), ("E101", 4), ("E162", 5), ("E121", 6),
    ]  # fmt: skip


def test_what_a_broken_line_declares_is_not_called_unknown():
    body = "param duty 60 %\ndeff push(c):\n    wait 1 s\nfire A at $duty for 1 s\npush(A)"

    assert mistakes(body) == [("E101", 1, 12), ("E107", 2, 1)]


def test_a_block_that_is_indented_for_no_reason_is_still_read():
    block = "    fire Q at 5 % fro 1 s\n    repeat 2:\n        wait\n        fire S at 5 % ;\n"
    body = f"{FIRE}\n{block}fire R at 5 % for 1 s"

    assert mistakes(body) == [("E105", 2, 5), ("E101", 2, 19), ("E140", 4, 9), ("E108", 5, 23), ("E131", 6, 6)]


def test_mistakes_in_a_def_that_nobody_calls_are_found():
    assert mistakes("def f(c):\n    fire $c at 60 ms for 1 s") == [("E122", 2, 16)]


def test_a_mistake_in_a_def_is_told_once_however_often_it_is_called():
    body = "def f(c):\n    fire $c at 60 for 1 s\nrepeat 3:\n    f(A)\n    f(B)"

    assert mistakes(body) == [("E120", 2, 16)]


@pytest.mark.parametrize(
    ("body", "help"),
    [
        ("fier A at 60 % for 600 ms", "did you mean `fire`?"),
        ("fire A at 60 % fro 600 ms", "did you mean `for`?"),
        ("fire fromt at 60 % for 600 ms", "did you mean `front`?"),
        ("param speed = 3 s\nwait $sped", "did you mean `speed`?"),
        ("def push():\n    wait 1 s\npusch()", "did you mean `push`?"),
        ("guard A.temperature <= 60 C", "write `<`"),
        ("guard A.temperature != 60 C", "write `>`"),
        ("guard A.temprature > 60 C", "did you mean `temperature`?"),
        ("wait 3 seconds", "did you mean `s`?"),
        ("fire A at 60 percent for 1 s", "did you mean `%`?"),
        ("wait until A.temperature > 60 C timeout 4 s else abbort", "did you mean `abort`?"),
        ("fire Q at 60 % for 1 s", "it has: A B C D E F G H all front even"),
    ],
)
def test_the_nearest_known_word_is_offered(body, help):
    assert diagnostics(body)[-1].help == help


def test_a_bare_number_is_asked_for_its_unit_with_the_units_that_fit():
    duty, time = diagnostics("fire A at 60 for 600")

    assert duty.message == "60 what? write `60 %`"
    assert time.message == "600 what? write `600 ms` or `600 s`"


def test_a_diagnostic_reads_as_file_line_column_code_and_a_caret_under_the_place():
    (found,) = diagnostics("repeat 2:\n    fire A at 60 for 600 ms   # half")

    assert str(found).split("\n") == [
        "script.gait:4:15: error E120: 60 what? write `60 %`",
        "    fire A at 60 for 600 ms   # half",
        "              ^^",
    ]


def test_a_diagnostic_gives_its_fields_for_json():
    (found,) = diagnostics("wait")

    assert found.as_dict() == {
        "file": "script.gait", "line": 3, "column": 1, "end_column": 5, "severity": "error", "code": "E140",
        "message": "wait for how long?", "help": "write `wait 500 ms` or `wait until ...`",
    }  # fmt: skip


def test_every_code_has_a_cause_and_a_remedy_and_is_explained_in_any_case():
    for row in errors.ROWS:
        assert row.cause.endswith(".")
        assert row.todo.endswith(".")
        assert errors.explain(row.code.lower()) is row
    assert len(errors.BY_CODE) == len(errors.ROWS)
    assert errors.explain("E999") is None


def test_every_mistake_of_the_text_exits_with_2_and_every_limit_with_4():
    assert {row.exit_code for row in errors.ROWS if row.code.startswith("E1") and row.code != "E182"} == {2}
    assert {row.exit_code for row in errors.ROWS if row.code.startswith("E3") or row.code == "E182"} == {4}


def test_many_broken_lines_are_told_up_to_twenty():
    assert len(diagnostics("fier A\n" * 30)) == 20


def test_a_robot_can_be_asked_for_before_it_is_known():
    assert loads(HEAD + "fier").robot_name() == "round"
    assert loads("gait 1\nrobot sphere-b\n").robot_name() == "sphere-b"


def test_a_script_as_windows_writes_it_is_read():
    assert compiled("wait 1 s\r\nfire A at 5 % for 1 s\r", head=HEAD.replace("\n", "\r\n"), profile=round_robot()).code


def test_a_file_that_never_ends_is_refused_and_not_read_to_its_end(tmp_path):
    (tmp_path / "endless").touch()
    os.truncate(tmp_path / "endless", 1 << 40)
    (tmp_path / "a.gait").write_text(f'{HEAD}include "endless"\n')

    (found,) = load(tmp_path / "a.gait").found

    assert (found.code, found.place.line) == ("E115", 3)
    assert "it is larger than" in found.message


def test_an_include_that_is_not_there_says_where_it_is_looked_for(tmp_path):
    (tmp_path / "a.gait").write_text(f'{HEAD}include "absent.gait"\n')

    (found,) = load(tmp_path / "a.gait").found

    assert found.help == "its path begins at the folder of the script that includes it"
