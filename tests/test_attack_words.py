"""A robot that means ill can say what it likes: none of it reaches the user's terminal as anything but text."""

import json

import pytest

from host.cli.output import printable
from tests.fake_robot import PROFILE, FakeRobot
from tests.test_cli_commands import line, peer  # noqa: F401  (fixtures)

ESCAPE = "\x1b]0;mine\x07\x9b2J\r\u202e\ud800"
HARMLESS = r"\x1b]0;mine\x07\x9b2J\r\u202e\ud800"


def profile_with(**changes) -> bytes:
    """Return the profile of the circular robot with other words in it."""
    return json.dumps(json.loads(PROFILE) | changes).encode()


def is_harmless(text: str) -> bool:
    return all(character.isprintable() or character == "\n" for character in text)


def test_what_cannot_be_printed_is_told_by_its_number():
    assert printable(f"coil {ESCAPE} is hot\n") == f"coil {HARMLESS} is hot\n"
    assert printable("5 °C, 3 µm – „gut“") == "5 °C, 3 µm – „gut“"


@pytest.mark.parametrize("options", [(), ("--json",)], ids=["lines", "json"])
@pytest.mark.parametrize("changes", [{"robot": ESCAPE}, {"groups": [[ESCAPE, "A B"]]}], ids=["name", "group"])
def test_the_words_of_a_profile_leave_the_terminal_alone(softrig, line, peer, changes, options):  # noqa: F811
    peer.__init__(profile=profile_with(**changes))

    told = softrig("info", *options)

    assert is_harmless(told.out + told.err)
    assert told.status in (0, 5)


def test_the_rows_of_a_strange_dictionary_leave_the_terminal_alone(softrig, line, peer):  # noqa: F811
    rows = FakeRobot().dictionary.split(b"\n")
    rows[1] += ESCAPE.encode("utf-8", "replace")
    peer.__init__(dictionary=b"\n".join(rows))

    told = softrig("info")

    assert told.status == 5
    assert "mine" in told.err
    assert is_harmless(told.err)
