"""The one form of a script: what `softrig fmt` writes, what it keeps, and when it writes nothing."""

import json
from textwrap import dedent

import pytest
from click.testing import CliRunner
from hypothesis import given, settings
from hypothesis import strategies as st

from host.cli import main
from host.gait.diagnostics import GaitError
from host.gait.forms.formatting import formatted
from host.gait.forms.layout import layout, same
from host.gait.forms.writer import decimal, statement
from host.gait.reading.parser import parse_file
from tests.gait_scripts import HEAD, ROOT
from tests.gait_strategy import examples
from tests.test_gait_random import pieces

GAITS = sorted((ROOT / "gaits").rglob("*.gait"))
UGLY = "gait 1\nrobot round\nfire  A   at 60%  for 600ms#here\n\n\n# end"
FAIR = "gait 1\nrobot round\nfire A at 60 % for 600 ms  #here\n\n# end\n"
ONE_LINERS = """\
param a = 60 % [5 % .. 90 %]
include "lib/push.gait"
circle roll = A B $c
let next = roll[down]
let next = roll[down + 1]
let next = roll[down - $k * 2]
fire A B at 60 % for 600 ms until 95 C ramp 100 ms overlap 200 ms
hold A C at 80 C with 40 % for 5 s overlap 1 s
move R L to -28.5 deg over 2 s
orient -5 deg for 3 s
press to 5 N over 1 s for 20 s overlap 5 s
wait $rest
wait until any A B.temperature > 95 C timeout 4 s else recover
wait until roll > 30 deg timeout 4 s else continue
wait until down is $c timeout 4 s else abort
guard $c.resistance > 4.2 ohm
note "it is warm # really"
label recover
push(A C, 2 * ($a + 1 s), -3)
stop_it()
wait (1 s - (2 s - 3 s)) * 2 / (3 * 4) - -1 s""".splitlines()
HEADS = """\
repeat 3:
together:
for c in A B C:
for c in A C, B D:
for k in 1 .. 2 * $n:
sym z 90 deg, x 180 deg:
sym $k * 45 deg:
def push(c, time):
def rest():
on fault:""".splitlines()


def fmt(*arguments, text=None):
    return CliRunner().invoke(main, ["fmt", *map(str, arguments)], input=text)


def tidied(text):
    return formatted(dedent(text), "x.gait")


@pytest.mark.parametrize("line", ONE_LINERS)
def test_a_statement_in_its_form_stays_as_it_is(line):
    assert formatted(f"{line}\n", "x.gait") == f"{line}\n"


@pytest.mark.parametrize("head", HEADS)
def test_a_block_in_its_form_stays_as_it_is(head):
    assert formatted(f"{head}\n    wait 1 s\n", "x.gait") == f"{head}\n    wait 1 s\n"


@pytest.mark.parametrize("path", GAITS, ids=lambda path: path.stem)
def test_every_gait_is_in_its_form(path):
    text = path.read_text(encoding="utf-8")

    assert formatted(text, path.name) == text


def test_blanks_and_numbers_get_one_form():
    assert tidied("wait   007.50s") == "wait 7.5 s\n"
    assert tidied("repeat 2 :\n  wait 1s\n\n\n\n  wait 2 s\n\n\n") == "repeat 2:\n    wait 1 s\n\n    wait 2 s\n"
    assert tidied("\n\n\ngait 1\n\n") == "gait 1\n"
    assert tidied("") == ""


def test_brackets_stay_where_they_are_needed_and_go_where_not():
    assert tidied("wait ((1 s) + (2 s * 3))") == "wait 1 s + 2 s * 3\n"
    assert tidied("wait (1 s - (2 s - 3 s)) * -(2 * 3)") == "wait (1 s - (2 s - 3 s)) * -(2 * 3)\n"


def test_a_comment_goes_with_the_block_that_its_column_is_in():
    text = """\
    # head

    repeat 2:
       # first
       repeat 3:
           wait 1 s
           # of the inner

         # of the outer
    # before the wait
    wait 2 s

    # last
    """

    assert tidied(text) == dedent("""\
    # head

    repeat 2:
        # first
        repeat 3:
            wait 1 s
            # of the inner

        # of the outer
    # before the wait
    wait 2 s

    # last
    """)


def test_columns_of_neighbouring_params_are_aligned():
    assert tidied("param a = 100 % [5 % .. 100 %] # one\nparam long = 5 s # two\n\nparam b = 1 s") == (
        "param a    = 100 % [5 % .. 100 %]  # one\nparam long = 5 s                   # two\n\nparam b = 1 s\n"
    )


def test_comments_of_near_statements_are_aligned_and_of_others_not():
    near = tidied("wait 1 s # one\nwait 10 s\n\nwait 100 s # two\nnote 'x'\n".replace("'", '"'))
    far = tidied("wait 1 s # one\nwait 100 * (2 s + 3 s) # two\n")

    assert near == 'wait 1 s    # one\nwait 10 s\n\nwait 100 s  # two\nnote "x"\n'
    assert far == "wait 1 s  # one\nwait 100 * (2 s + 3 s)  # two\n"


def test_a_number_is_written_exactly_or_not_at_all():
    file, _ = parse_file("wait 0.1000000000000000000000000000001 s", "x.gait")

    assert statement(file.statements[0]) == "wait 0.1000000000000000000000000000001 s"
    with pytest.raises(ValueError, match="no end as a decimal"):
        decimal(file.statements[0].time.value / 3)


def test_trees_that_differ_anywhere_are_not_the_same():
    one, other = (layout(parse_file(f"repeat 2:\n    wait {n} s # {text}", "x")[0]) for n, text in ((1, "a"), (1, "b")))

    assert same(one, one)
    assert not same(one, other)
    assert not same(one.items[0].node, layout(parse_file("repeat 2:\n    wait 2 s", "x")[0]).items[0].node)


def test_a_script_that_cannot_be_read_is_told_about_and_stays(tmp_path):
    bad, good = tmp_path / "bad.gait", tmp_path / "good.gait"
    bad.write_text("gait 1\nfire A att 60 %\n")
    good.write_text(UGLY)

    done = fmt(bad, good)

    assert done.exit_code == 2
    assert "bad.gait:2:12: error E101" in done.output
    assert bad.read_text() == "gait 1\nfire A att 60 %\n"
    assert good.read_text() == FAIR


def test_check_and_diff_write_nothing(tmp_path):
    path = tmp_path / "a.gait"
    path.write_text(UGLY)

    checked, shown = fmt("--check", path), fmt("--diff", path)

    assert (checked.exit_code, checked.output) == (1, f"{path} would change\n")
    assert (shown.exit_code, "+fire A at 60 % for 600 ms  #here" in shown.output) == (0, True)
    assert path.read_text() == UGLY


def test_a_file_is_written_in_place_with_its_rights_and_once(tmp_path):
    path, link = tmp_path / "a.gait", tmp_path / "link.gait"
    path.write_bytes(b"\xef\xbb\xbf" + UGLY.replace("\n", "\r\n").encode())
    path.chmod(0o640)
    link.symlink_to(path)

    told = json.loads(fmt("--json", link).output)

    assert told == {"file": str(link), "changed": True}
    assert (path.read_bytes(), path.stat().st_mode & 0o777, link.is_symlink()) == (FAIR.encode(), 0o640, True)
    assert fmt("--check", tmp_path).exit_code == 0
    assert sorted(file.name for file in tmp_path.iterdir()) == ["a.gait", "link.gait"]


def test_a_script_goes_from_stdin_to_stdout():
    assert fmt("-", text=UGLY).output == FAIR


@pytest.mark.parametrize("name", ["nonsuch.gait", "/dev/null"])
def test_what_is_no_file_is_told_in_one_line(name):
    done = fmt(name)

    assert (done.exit_code, done.output.count("\n")) == (2, 1)
    assert "E115" in done.output


@settings(max_examples=examples(100))
@given(st.lists(pieces, max_size=40).map("".join))
def test_random_text_is_formatted_or_refused_and_nothing_else(text):
    try:
        once = formatted(text, "x.gait")
    except GaitError:
        return

    assert formatted(once, "x.gait") == once


def test_a_line_that_would_grow_too_long_is_refused():
    line = "wait " + "+".join(["123456789012345"] * 60)

    with pytest.raises(GaitError, match="as it would be written: a line of"):
        formatted(HEAD + line, "x.gait")
