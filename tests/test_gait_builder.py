"""Scripts from Python: every statement, blocks, comments, and what is refused at once."""

import doctest
from fractions import Fraction

import pytest

from host.gait import builder
from host.gait.builder import Gait
from host.gait.reading.parser import parse_file
from tests.gait_scripts import HEAD, circular, compiled, round_robot

STATEMENTS = [
    (lambda gait: gait.param("hold", "15 %"), "param hold = 15 %"),
    (lambda gait: gait.include("lib/push.gait"), 'include "lib/push.gait"'),
    (lambda gait: gait.circle("roll", "A B", "$c"), "circle roll = A B $c"),
    (lambda gait: gait.let("next", "roll[down - 1]"), "let next = roll[down - 1]"),
    (lambda gait: gait.guard("any.temperature > 110 C"), "guard any.temperature > 110 C"),
    (lambda gait: gait.fire("A", duty=60, ms=600, until=95), "fire A at 60 % for 600 ms until 95 C"),
    (lambda gait: gait.fire("A", duty=0.1, s=Fraction(1, 4)), "fire A at 0.1 % for 0.25 s"),
    (
        lambda gait: gait.fire("$c", duty="$d", time="2 * $t", ramp="1 ms", overlap="0 s"),
        "fire $c at $d for 2 * $t ramp 1 ms overlap 0 s",
    ),
    (
        lambda gait: gait.hold("A", "C", at=80, duty=40, s=5, overlap="1 s"),
        "hold A C at 80 C with 40 % for 5 s overlap 1 s",
    ),
    (lambda gait: gait.move("R L", to="-28 deg", over="2 s"), "move R L to -28 deg over 2 s"),
    (lambda gait: gait.orient("$angle", time="$t"), "orient $angle for $t"),
    (lambda gait: gait.press(5, over="1 s", s=20, overlap="5 s"), "press to 5 N over 1 s for 20 s overlap 5 s"),
    (lambda gait: gait.wait("$rest"), "wait $rest"),
    (lambda gait: gait.wait_until("down is $c", "4 s", "recover"), "wait until down is $c timeout 4 s else recover"),
    (lambda gait: gait.note("it is warm # really"), 'note "it is warm # really"'),
    (lambda gait: gait.label("recover"), "label recover"),
    (lambda gait: gait.call("push", "A C", -2, 0.5, "$c"), "push(A C, -2, 0.5, $c)"),
]
BLOCKS = [
    (lambda gait: gait.repeat(3), "repeat 3:"),
    (lambda gait: gait.together(), "together:"),
    (lambda gait: gait.for_each("c", "A C", "B D"), "for c in A C, B D:"),
    (lambda gait: gait.for_each("k", range(1, 9)), "for k in 1 .. 8:"),
    (lambda gait: gait.sym("z 90 deg", "x $turn"), "sym z 90 deg, x $turn:"),
    (lambda gait: gait.define("push", "c", "hold"), "def push(c, hold):"),
    (lambda gait: gait.on_fault(), "on fault:"),
]
MISTAKES = [
    (lambda gait: gait.fire(duty=60, ms=600), "which coils or joints? name them first"),
    (lambda gait: gait.fire("A", duty=60), 'no time given: give one of ms=600, s=0.6, time="600 ms"'),
    (lambda gait: gait.fire("A", duty=60, ms=1, s=1), "ms and s given: give one of"),
    (lambda gait: gait.fire("A", duty="60 % for 3 s", ms=1), 'duty: "60 % for 3 s": `for` is not expected here'),
    (lambda gait: gait.fire("A", duty=True, ms=1), "duty: True is neither a number nor a text"),
    (lambda gait: gait.fire("A", duty=60, ms=float("nan")), "ms: nan cannot be written as a decimal"),
    (lambda gait: gait.fire("A", duty=60, ms=Fraction(1, 3)), "ms: 1/3 cannot be written as a decimal"),
    (lambda gait: gait.fire("A", duty=60, ms="5 s"), 'ms: "5 s" is no number; a text is given as time="600 ms"'),
    (lambda gait: gait.fire("at", duty=60, ms=1), '"at" is not a name'),
    (lambda gait: gait.fire("A", duty=60, ms=1, ramp=5), 'ramp: 5 has no unit; write it as a text: ramp="200 ms"'),
    (lambda gait: gait.guard("A.temperature"), 'condition: "guard A.temperature": '),
    (lambda gait: gait.guard("force > 5 N\nwait 1 s"), "is not one statement of its kind"),
    (lambda gait: gait.call("push", "A, B"), 'argument: "A, B" is not one argument'),
    (lambda gait: gait.note('say "no"'), "is not a text for one line without quotation marks"),
    (lambda gait: gait.param("a", "1", low="0"), "low and high are given both or not at all"),
    (lambda gait: gait.add("fire A sometimes 5 %"), "text:1:18: error E101"),
    (lambda gait: gait.for_each("k", range(0, 9, 2)).__enter__(), "is no span of whole numbers, one after another"),
    (lambda gait: Gait("no robot"), 'robot: "robot no robot": '),
]  # fmt: skip


@pytest.mark.parametrize(("build", "line"), STATEMENTS, ids=[line for _, line in STATEMENTS])
def test_a_statement_is_written_as_in_a_script(build, line):
    assert build(Gait("round")).text() == f"{HEAD}{line}\n"


@pytest.mark.parametrize(("build", "head"), BLOCKS, ids=[head for _, head in BLOCKS])
def test_a_block_takes_what_is_added_within(build, head):
    gait = Gait("round")

    with build(gait):
        gait.wait(s=1)

    assert gait.wait(s=2).text() == f"{HEAD}{head}\n    wait 1 s\nwait 2 s\n"


@pytest.mark.parametrize(("build", "told"), MISTAKES, ids=[told for _, told in MISTAKES])
def test_a_mistake_is_refused_at_once_in_plain_words(build, told):
    gait = Gait("round")

    with pytest.raises(ValueError) as caught:  # noqa: PT011  # the text is what is asked about
        build(gait)

    assert told in str(caught.value)
    assert gait.text() == HEAD


def test_the_examples_in_the_docs_of_the_builder_run():
    failed, tried = doctest.testmod(builder)

    assert (failed, tried >= 15) == (0, True)


def test_comments_and_blank_lines_stand_where_they_were_added():
    gait = Gait("round").blank().comment("Heat,\nthen rest.").fire("A", duty=60, ms=600).blank().blank()
    with gait.repeat(2):
        gait.blank().add("wait 1 s # beside").comment("done")

    assert gait.comment("end").text().removeprefix(HEAD) == (
        "\n# Heat,\n# then rest.\nfire A at 60 % for 600 ms\n\nrepeat 2:\n    wait 1 s  # beside\n    # done\n# end\n"
    )


def test_a_block_with_a_mistake_in_it_leaves_nothing_behind():
    gait = Gait("round")

    with pytest.raises(ValueError, match="which coils"), gait.repeat(3), gait.together():
        gait.wait(s=1).fire(duty=60, ms=1)
    with pytest.raises(ValueError, match="the block of this repeat is empty"), gait.repeat(3):
        pass

    assert gait.text() == HEAD


def test_a_script_is_not_whole_while_a_block_is_open():
    gait = Gait("round")

    with gait.repeat(3):
        gait.wait(s=1)
        with pytest.raises(ValueError, match="a block is open"):
            gait.text()
        assert repr(gait) == HEAD.rstrip()

    assert repr(gait) == gait.text()


def test_a_script_from_python_is_the_tree_and_the_program_of_its_text():
    gait = Gait("round").fire("A", duty=60, ms=600).wait(s=1)

    text = "fire A at 60 % for 600 ms\nwait 1 s"

    assert gait.tree() == parse_file(gait.text(), "script.gait")[0].statements
    assert gait.compile(round_robot()).code == compiled(text).code


def test_a_script_is_checked_against_a_profile_or_a_robot_at_an_address():
    gait = Gait("circular").param("duty", "60 %", "5 %", "90 %").fire("A", duty="$duty", ms=600)

    report = gait.check("sim:circular", ["duty=50%"])

    assert report.sound
    assert report.coils[0].on_ms == 600
    assert not Gait("round").fire("A", duty=95, ms=600).check(round_robot()).sound
    with pytest.raises(ValueError, match=r"script\.gait:3:6: error E1"):
        Gait("round").fire("Z", duty=60, ms=600).check(round_robot())


def test_a_notebook_shows_a_checked_script_as_a_picture_until_it_changes():
    gait = Gait("circular").fire("A", duty=60, ms=600)
    assert gait._repr_svg_() is None

    gait.check(circular())
    shown = gait._repr_svg_()

    assert shown.startswith("<svg")
    assert gait.wait(s=1)._repr_svg_() is None


def test_a_script_is_saved_with_what_it_includes_beside_it(tmp_path):
    (tmp_path / "push.gait").write_text("gait 1\ndef push(c):\n    fire $c at 60 % for 600 ms\n")
    gait = Gait("round").include("push.gait").call("push", "A")

    path = gait.save(tmp_path / "a.gait")

    assert path.read_text() == gait.text()
    assert gait.check(round_robot(), path=path).sound
