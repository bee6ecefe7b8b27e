"""What the language server knows, asked without a process: offers, what is pointed at, names, and nonsense."""

import random
from pathlib import Path

import pytest
from lsprotocol import types
from pygls.exceptions import JsonRpcInvalidParams
from pygls.workspace import PositionCodec

from host.gait.reading.syntax import CLAUSES, FORMS
from host.gait.script import read_text
from host.gait.working import sources
from host.lsp import words
from host.lsp.answers import Answers
from host.lsp.hover import hover
from host.lsp.outline import declaration, outline
from host.lsp.verdicts import judge, read_script
from tests.gait_scripts import ball_robot, round_robot
from tests.lsp_samples import FIRST_FREE, HEAD, ROOT, URI, desk_with

NONSENSE = ["\t", "\r", "\r\n", "\x00", "😀", "$", '"', "..", "(", "[", ":", "\u2028", "\ud800", "\n", "    ", "else "]
NONSENSE += ["wait until ", "for ", "sym ", "1e9", "hold ", "on fault:", "label ", "def f(", "\ufeff", "#"]


def shown(line, column, text=HEAD, profile=None):
    desk, path = desk_with(text + line, profile)
    return hover(desk.view(path), text.count("\n") + 1, column)


@pytest.mark.parametrize(
    ("line", "column", "said"),
    [
        ("fire A at 60 % for 600 ms", 5, "coil `A`: channel 0, in `front`, `even`\n\nduty 0.1 .. 90 %"),
        ("fire front at 60 % for 600 ms", 7, "group `front`: A B"),
        ("fire A at 60 % for 600 ms", 10, ""),
        ("fire A at 60 % for 600 ms", 7, "duty 0.1 .. 90 %"),
        ("fire A at 60 % for 600 ms", 16, "one order at most 4 s"),
        ("fire A at 60 % for 600 ms until 95 C", 27, "below the robot's own trip at 120 C"),
        ("fire A at $duty for 600 ms", 12, "param duty = 60 % [5 % .. 90 %]\n```\n\nhow much"),
        ("both(A, B)", 2, "def both(a, b):\n```\n\nBoth at once."),
        ("robot round", 8, "coils: A B C D E F G H"),
        ("wait 500 ms", 10, "`ms`: time"),
        ("guard any.temperature > 95 C", 12, "estimated temperature"),
        ("fire A at 60 for 600 ms", 11, "**E120** A number has no unit."),
        ("repeat 3:", 2, "at most 8 deep"),
        ("hold A at 80 C with 40 % for 5 s", 7, "The temperature that is kept.\n\nbelow the robot's own trip at 120 C"),
    ],
)
def test_hover_says_what_a_word_stands_for_and_how_far_it_goes(line, column, said):
    assert said in shown(line, column)


def test_the_outline_holds_what_a_text_declares():
    desk, path = desk_with(HEAD + "label late\n")

    entries = outline(desk.view(path))

    assert [(each.kind, each.name) for each in entries] == [
        ("param", "duty"), ("circle", "ring"), ("def", "both"), ("label", "late"),
    ]  # fmt: skip
    assert entries[2].last_line == FIRST_FREE - 1


@pytest.mark.parametrize(
    ("line", "column", "file", "at"),
    [("both(A, B)", 1, "new.gait", 7), ("lift(2 mm)", 1, "lift.gait", 18), ("wait $duty", 7, "new.gait", 3)],
)
def test_a_name_leads_to_its_declaration(line, column, file, at):
    desk, path = desk_with(HEAD + line)

    place = declaration(desk.view(path), FIRST_FREE, column)

    assert (Path(place.file).name, place.line) == (file, at)


def test_a_library_knows_the_names_of_the_open_script_that_includes_it():
    desk, main = desk_with('gait 1\nrobot round\nparam boost = 600 ms\ninclude "lib/heat.gait"\n')
    library = ROOT / "gaits" / "lib" / "heat.gait"
    lines = library.read_text(encoding="utf-8").splitlines()
    number = next(number for number, line in enumerate(lines, 1) if "for $boost" in line)

    path = desk.texts.put(library.as_uri(), "\n".join(lines), 1)
    place = declaration(desk.view(path), number, lines[number - 1].index("$boost") + 2)

    assert (place.file, place.line) == (main, 3)


def test_a_cursor_behind_wide_characters_is_where_the_editor_has_it():
    line = 'note "\U0001f600\U0001f600 $duty"'
    desk, _ = desk_with(HEAD + line)
    at = types.Position(FIRST_FREE - 1, len(line) + 2 - 1)  # two characters are two units each

    found = Answers(desk, PositionCodec()).definition(types.DefinitionParams(types.TextDocumentIdentifier(URI), at))

    assert found.range.start == types.Position(2, 6)


def test_an_include_leads_to_its_file():
    desk, path = desk_with(HEAD)

    assert declaration(desk.view(path), 4, 12).file == str(ROOT / "gaits" / "lib" / "lift.gait")


@pytest.mark.parametrize(
    ("name", "said"), [("both", None), ("ring", "declared already"), ("fire", "word of the language"), ("2", "no name")]
)
def test_a_new_name_must_be_free_and_a_name(name, said):
    desk, _ = desk_with(HEAD)
    asked = types.RenameParams(types.TextDocumentIdentifier(URI), types.Position(2, 7), name)

    if said is None:
        assert Answers(desk, PositionCodec()).renamed(asked).changes
    else:
        with pytest.raises(JsonRpcInvalidParams, match=said):
            Answers(desk, PositionCodec()).renamed(asked)


def test_every_word_and_quantity_of_the_language_has_its_sentence():
    quantities = {**sources.COIL, **sources.JOINT, **sources.CELL, **sources.SUPPLY, **sources.WHOLE}

    assert set(words.STATEMENTS) == set(FORMS)
    assert set(words.CLAUSES) == set(CLAUSES)
    assert set(words.QUANTITIES) == {*quantities, "down"}


@pytest.mark.parametrize("script", sorted(ROOT.glob("gaits/*.gait"))[::3], ids=lambda path: path.stem)
def test_where_its_robot_cannot_be_asked_nothing_is_wrong_with_a_good_script(script):
    verdict = judge(read_script(str(script), read_text), "no such port")

    assert verdict.found == ()
    assert verdict.unasked.reason == "limits are not checked: no such port"


@pytest.mark.parametrize(
    ("line", "word", "fixed"),
    [
        ("fier A at 60 % for 1 s", "fier", "fire"),
        ("fire A at $dutty for 1 s", "dutty", "duty"),
        ("wait 5 sec", "sec", "s"),
        ("bothe(A, B)", "bothe", "both"),
        ("fire frnt at 60 % for 1 s", "frnt", "front"),
    ],
)
def test_a_word_that_was_meant_otherwise_is_put_right_at_a_click(line, word, fixed):
    desk, _ = desk_with(HEAD + line)
    at = types.Position(FIRST_FREE - 1, line.index(word))
    context = types.CodeActionContext([])

    (fix,) = Answers(desk, PositionCodec()).fixes(
        types.CodeActionParams(types.TextDocumentIdentifier(URI), types.Range(at, at), context)
    )

    (edit,) = fix.edit.changes[URI]
    assert (edit.range.start, edit.new_text) == (at, fixed)
    assert edit.range.end.character - at.character == len(word)


@pytest.mark.parametrize("seed", range(12))
def test_no_text_and_no_cursor_brings_the_server_down(seed):
    draw = random.Random(seed)
    text = list(draw.choice(sorted(ROOT.glob("gaits/**/*.gait"))).read_text(encoding="utf-8"))
    for _ in range(8):
        at = draw.randrange(len(text))
        text[at : at + draw.randrange(20)] = draw.choice(NONSENSE)
    desk, path = desk_with(HEAD, draw.choice([round_robot(), ball_robot()]))
    desk.view(path)
    desk.texts.put(URI, "".join(text), 2)
    desk.judge(path, desk.robots.profile)

    answers = Answers(desk, PositionCodec(draw.choice(["utf-8", "utf-16", "utf-32"])))
    asked = {"text_document": types.TextDocumentIdentifier(URI)}
    for _ in range(10):
        asked["position"] = types.Position(draw.randrange(40), draw.randrange(60))
        answers.completed(types.CompletionParams(**asked), ["round"])
        answers.hover(types.HoverParams(**asked))
        answers.definition(types.DefinitionParams(**asked))
    assert isinstance(answers.outline(URI), list)
    answers.formatted(URI)
