"""The words of the reference page stand beside what they explain, and none is missing."""

import pytest

from docs import meanings
from protocol import messages
from protocol.variables import VARIABLES


def test_every_message_every_field_and_every_variable_has_its_words():
    rows = [
        (message.name, *(f"{message.name}.{field.name}" for field in message.fields)) for message in messages.MESSAGES
    ]

    expected = {name for row in rows for name in row} | {f"var.{row.name}" for row in VARIABLES}
    assert set(meanings.read()) == expected


def test_a_field_without_words_is_named():
    with pytest.raises(ValueError, match=r"messages.py:3: fire.coils has no comment"):
        meanings.read('FIRE = Message(\n    0x14, "fire",  # Heat.\n    Field("coils", "I"),\n)\n')


def test_words_may_go_on_in_lines_of_their_own():
    text = 'FIRE = Message(\n    0x14, "fire",  # Heat\n    # coils.\n    Field("coils", "I"),  # Mask.\n)\n'

    assert meanings.read(text) == {"fire": "Heat coils.", "fire.coils": "Mask."}
