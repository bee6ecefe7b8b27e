"""The dictionary that robots carry: every message, enum and variable, with ranges and words."""

from types import SimpleNamespace

import pytest

from docs import definitions, dictionary
from protocol import causes, messages
from protocol.variables import VARIABLES

WORDS = {"m": "A message.", "m.f": "A field."}
LINES = dictionary.definition_text().splitlines()


def place(words, letter="H", names=("STATES",)):
    """Return a field that has this comment."""
    field = SimpleNamespace(name="f", letter=letter)
    return definitions._place("m.f", field, 0, {"m.f": words}, dict.fromkeys(names))


def test_every_message_has_a_line_in_the_order_of_the_numbers():
    numbers = [int(line.split()[0]) for line in LINES if line[:1].isdigit()]

    assert numbers == sorted(message.number for message in messages.MESSAGES)


def test_every_variable_has_a_line_under_its_number():
    found = [line.split()[1:] for line in LINES if line.startswith("var ")]

    assert [int(number) for number, _ in found] == list(range(len(VARIABLES)))
    assert [text.split("[")[0] for _, text in found] == [f"{row.name}:{row.letter}" for row in VARIABLES]


def test_the_definitions_end_in_the_only_blank_line_so_that_a_profile_may_follow():
    text = dictionary.definition_text()

    assert text.endswith("\n\n")
    assert text.count("\n\n") == 1


def test_a_range_stands_behind_its_field():
    found = place("Share of the time. [0..1000]")

    assert found.definition == "f:H[0..1000]"
    assert (found.words, found.low, found.high) == ("Share of the time.", 0, 1000)


def test_an_enum_stands_behind_its_field():
    assert place("What it does. [STATES]", "B").definition == "f:B[STATES]"


def test_what_the_rest_holds_again_and_again_is_named_with_its_types():
    found = place("Of each coil. [* mohm:H used:B]", "s")

    assert found.definition == "f:s[mohm:H,used:B]"
    assert [(part.name, part.offset, part.size) for part in found.parts] == [("mohm", 0, 2), ("used", 2, 1)]


def test_brackets_that_are_no_range_are_words():
    assert place("Temperature [0.1 C; 255: none]").definition == "f:H"


def test_a_range_that_its_type_cannot_hold_is_refused():
    with pytest.raises(ValueError, match=r"m\.f: 0\.\.256 does not fit a u8"):
        place("A field. [0..256]", "B")


def test_an_enum_that_there_is_not_is_refused():
    with pytest.raises(ValueError, match=r"m\.f: there is no enum COLOURS"):
        place("A field. [COLOURS]")


@pytest.mark.parametrize(
    ("letter", "low", "high"),
    [("B", 0, 255), ("b", -128, 127), ("h", -32768, 32767), ("I", 0, 0xFFFFFFFF), ("i", -0x80000000, 0x7FFFFFFF)],
)
def test_a_field_without_a_range_has_that_of_its_type(letter, low, high):
    assert (place("A field.", letter).low, place("A field.", letter).high) == (low, high)


@pytest.mark.parametrize(
    ("name", "unit", "scale"),
    [
        ("now_ms", "ms", 1),
        ("board_decidegc", "degC", 0.1),
        ("seq", "", 1),
        ("duty_permille", "permille", 1),
        ("target_mn", "mN", 1),
        ("cell_pa", "Pa", 1),
        ("joint_centi", "deg or mm", 0.01),
    ],
)
def test_a_unit_is_the_end_of_the_name(name, unit, scale):
    found = definitions.Place(name, "H", 0, "", None)

    assert (found.unit, found.scale) == (unit, scale)


def test_the_names_of_an_enum_count_from_0_and_gaps_are_told():
    assert dictionary.enum_line("EVENTS", {1: "started", 2: "step", 9: "lost"}) == "EVENTS =1 started step =9 lost"


def test_every_name_and_code_has_its_words_in_the_help():
    named = [line.split(" ", 1) for line in dictionary.help_text().splitlines()]
    rows = [
        [message.name, *(f"{message.name}.{field.name}" for field in message.fields)] for message in messages.MESSAGES
    ]
    expected = {name for row in rows for name in row} | {f"var.{row.name}" for row in VARIABLES}

    assert {name for name, _ in named} == expected | {row.name for row in causes.CODES}
    assert all(words for _, words in named)


@pytest.mark.parametrize("row", definitions.rows(), ids=lambda row: row.name)
def test_each_message_goes_one_way_and_alive_goes_both(row):
    from_robot = {"identity", "dictionary_page", "stopped", "nak"} | {
        row.name for row in definitions.rows() if row.number >= 0x40
    }

    assert row.ways == ("both" if row.name == "alive" else "from" if row.name in from_robot else "to")
