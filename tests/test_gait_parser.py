"""Reading a script: what the language takes, and the tree that comes of it."""

from fractions import Fraction

import pytest

from host.gait import tree
from host.gait.diagnostics import GaitError
from host.gait.reading.parser import parse_file, parse_value
from host.gait.units import decimal
from tests.gait_scripts import compiled, diagnostics, mistakes


def statements(text):
    file, found = parse_file(text, "x.gait")
    assert found == []
    return file.statements


def one(text):
    (statement,) = statements(text)
    return statement


def test_every_statement_of_the_language_is_read_into_its_own_node():
    text = (
        "gait 1\nrobot sphere-a\nparam duty = 60 % [5 % .. 90 %]\ninclude \"lib/push.gait\"\n"
        "guard any.temperature > 110 C\ndef push(c):\n    wait 1 s\nfire A B at 60 % for 1 s\nrepeat 3:\n    wait 1 s\n"
        "move R L to -8 deg over 2 s\norient 5 deg for 3 s\n"
        "together:\n    wait 1 s\nwait 1 s\nwait until A.temperature < 45 C timeout 4 s else abort\npush(A)\n"
    )  # fmt: skip

    kinds = [type(item).__name__ for item in statements(text)]

    assert kinds == [
        "Gait", "Robot", "Param", "Include", "Guard", "Define", "Fire",
        "Repeat", "Move", "Orient", "Together", "Wait", "WaitUntil", "Call",
    ]  # fmt: skip


def test_a_fire_keeps_its_clauses_in_the_order_written():
    fire = one("fire A $c even ramp 50 ms at 60 % until 95 C for 600 ms overlap 20 ms")

    assert [clause.word for clause in fire.clauses] == ["ramp", "at", "until", "for", "overlap"]
    assert fire.coils[0].text == "A"
    assert fire.coils[1] == tree.Reference("c", fire.coils[1].place)


def test_a_place_says_file_line_and_columns():
    fire = statements("\n\nfire A at 60 % for 600 ms  # half")[0]

    assert fire.place == tree.Place("x.gait", 3, 1, 26)
    assert fire.clause("at").value.place == tree.Place("x.gait", 3, 11, 15)


def test_comments_are_kept_with_their_places_and_not_taken_from_texts():
    file, _ = parse_file('# head\ninclude "a#b.gait" # tail\nwait 1 s\n', "x.gait")

    assert [(item.text, item.place.line, item.place.column) for item in file.comments] == [
        ("# head", 1, 1),
        ("# tail", 2, 20),
    ]
    assert file.statements[0].path == "a#b.gait"


def test_blank_lines_and_comments_may_stand_anywhere_in_a_block():
    repeat = one("repeat 2:\n\n# out\n    wait 1 s\n        # deep\n\n    wait 2 s  # end\n\n# out again\n")

    assert len(repeat.body) == 2


def test_blocks_nest_as_in_python():
    text = "repeat 2:\n  repeat 3:\n    together:\n      wait 1 s\n  wait 2 s\nwait 3 s"

    outer, last = statements(text)

    assert [type(item).__name__ for item in outer.body] == ["Repeat", "Wait"]
    assert last.time.value == 3


def test_a_sign_needs_no_blanks_around_it():
    assert one("param a=60%[5%..90%]").high.unit == "%"
    assert one("wait 95ms").time == tree.Number(Fraction(95), "ms", tree.Place("x.gait", 1, 6, 10))


def test_a_group_with_a_quantifier_reads_as_words():
    condition = one("guard all front.temperature < 45 C").condition

    assert (condition.quantifier.text, condition.subjects[0].text, condition.quantity.text) == (
        "all",
        "front",
        "temperature",
    )


def test_multiplication_binds_tighter_than_addition_and_both_from_the_left():
    value = parse_value("1 - 2 - 3 * 4", "v")

    assert (value.operator, value.left.operator, value.right.operator) == ("-", "-", "*")


def test_a_value_that_is_not_one_says_so():
    with pytest.raises(GaitError) as caught:
        parse_value("50 % of it", "-p duty")

    assert str(caught.value).startswith("-p duty:1:6: error E101")


def test_numbers_are_exact():
    assert parse_value("0.1", "v").value == Fraction(1, 10)
    assert decimal(Fraction(1, 3)) == "0.333"
    assert decimal(Fraction(-1, 100000)) == "0"


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("wait " + "(" * 200 + "1 s" + ")" * 200, "E114"),
        ("wait " + "-" * 900 + "1 s", "E114"),
        ("wait 1 s #" + "x" * 2000, "E114"),
        ("wait 1 s\n" * 20_001, "E114"),
        ("".join(" " * depth + "repeat 2:\n" for depth in range(60)) + " " * 60 + "wait 1 s", "E114"),
    ],
)
def test_what_is_too_large_to_be_read_is_refused_with_its_reason(text, code):
    _, found = parse_file(text, "x.gait")

    assert [item.code for item in found] == [code]


def test_ten_doublings_of_a_def_are_read_but_sixty_are_refused():
    def doublings(count):
        defs = "".join(f"def f{i}():\n    f{i + 1}()\n    f{i + 1}()\n" for i in range(count))
        return f"{defs}def f{count}():\n    wait 1 ms\nf0()"

    assert len(compiled(doublings(6)).plan) == 64
    with pytest.raises(GaitError, match="E114"):
        compiled(doublings(60))


def test_a_text_of_twenty_thousand_lines_may_end_its_last_line():
    _, found = parse_file("\n" * 20_000, "x.gait")

    assert found == []


def test_calls_and_includes_that_are_nested_too_deeply_are_said_where_they_are():
    calls = "".join(f"def f{i}():\n    f{i + 1}()\n" for i in range(2000)) + "def f2000():\n    wait 1 s\nf0()"
    files = {f"f{i}.gait": f'gait 1\ninclude "f{i + 1}.gait"\n' for i in range(2000)}

    assert mistakes(calls) == [("E114", 200, 5)]
    assert [item.code for item in diagnostics('include "f0.gait"', files=files)] == ["E114"]
