"""What the language server offers at a cursor."""

import re
from dataclasses import replace

import pytest

from host.gait.reading.lines import code_part
from host.lsp.completion import complete
from tests.gait_scripts import profile_of
from tests.lsp_samples import FIRST_FREE, HEAD, ROOT, URI, desk_with


def offers(line, text=HEAD, profile=None):
    desk, path = desk_with(text + line, profile)
    view = replace(desk.view(path), robots=("round",))
    return [item.text for item in complete(view, text.count("\n") + 1, len(line))]


@pytest.mark.parametrize(
    ("line", "some"),
    [
        ("", ["fire", "wait", "repeat", "both", "lift"]),
        ("fire ", ["A", "front", "at", "for", "until", "$duty"]),
        ("fire A at ", ["$duty", "$clear"]),
        ("fire A at 60 ", ["%", "for"]),
        ("fire A at 60 % f", ["for", "until"]),
        ("    fire $", ["$a", "$b", "$duty"]),
        ("wait until A.", ["temperature", "heat", "resistance"]),
        ("wait until A.temperature > 95 ", ["C", "timeout", "else"]),
        ("wait 5", ["ms", "s"]),
        ("guard ", ["any", "all", "supply", "board", "A"]),
        ("guard supply.", ["current", "voltage"]),
        ("robot ", ["round"]),
        ("let next = ", ["ring"]),
        ("let next = ring[", ["down"]),
        ("both(", ["A", "front", "$duty"]),
        ("for c in ", ["A", "even"]),
        ("on ", ["fault"]),
        ('include "lib/', ["lib/lift.gait", "lib/push.gait"]),
        ('note "at $d', ["$duty"]),
    ],
)
def test_what_may_come_next_is_offered(line, some):
    assert set(some) <= set(offers(line))


@pytest.mark.parametrize(
    "line", ["# fire ", "param ", "label ", "fire A at at ", 'note "fire ', "fire A at 60 % for 2 s # "]
)
def test_where_nothing_of_the_script_can_stand_nothing_is_offered(line):
    assert offers(line) == []


def test_labels_are_offered_only_further_down():
    text = HEAD + "label early\nwait until A.temperature > 95 C timeout 4 s else \nlabel late\n"
    desk, path = desk_with(text)

    found = complete(desk.view(path), FIRST_FREE + 1, 49)

    assert [item.text for item in found] == ["continue", "abort", "late"]


def test_arguments_are_offered_only_in_their_own_def():
    assert not {"$a", "$b"} & set(offers("fire $"))


def test_names_are_still_offered_while_the_text_cannot_be_read():
    desk, path = desk_with(HEAD)
    desk.view(path)
    desk.texts.put(URI, HEAD + "\tfire $", 2)

    assert "$duty" in [item.text for item in complete(desk.view(path), FIRST_FREE, 7)]


@pytest.mark.parametrize("script", sorted(ROOT.glob("gaits/*.gait"))[::4], ids=lambda path: path.stem)
def test_every_word_of_a_gait_is_offered_where_it_stands(script):
    text = script.read_text(encoding="utf-8")
    desk, path = desk_with(text, profile_of(re.search(r"^robot (.*)", text, re.M)[1]), script.as_uri())
    view = desk.view(path)

    missing = [
        (number, word)
        for number, line in enumerate(view.lines, 1)
        for word, column in used(code_part(line))
        if word not in [item.text for item in complete(view, number, column)]
    ]

    assert missing == []


def used(line):
    """Yield the words of a line, with their columns, but texts, robots and names that it declares."""
    if not re.match("robot|def|label", line):
        for word in re.finditer(r'"[^"]*"|\$?[A-Za-z_]\w*|%', line):
            if word[0][0] != '"' and not re.fullmatch(r"\s*(param|circle|let|for) ", line[: word.start()]):
                yield word[0], word.start()
