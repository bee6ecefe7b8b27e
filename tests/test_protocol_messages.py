"""The table of messages: what it packs and what it refuses."""

import pytest

from protocol import causes, codes, messages


def test_every_number_and_name_stands_once():
    numbers = [message.number for message in messages.MESSAGES]
    names = [message.name for message in messages.MESSAGES]

    assert len(set(numbers)) == len(numbers)
    assert len(set(names)) == len(names)


def test_a_value_outside_its_field_is_refused_before_it_is_packed():
    with pytest.raises(ValueError, match="duty_permille 65536, must be 0 to 65535"):
        messages.FIRE.pack(coils=1, duty_permille=65536, hold_ms=1)


def test_a_forgotten_field_is_named():
    with pytest.raises(ValueError, match="fire needs hold_ms"):
        messages.FIRE.pack(coils=1, duty_permille=1, hold=1)


@pytest.mark.parametrize("payload", [b"", bytes(7), bytes(9)])
def test_a_payload_of_the_wrong_length_is_refused(payload):
    with pytest.raises(ValueError, match=r"fire: .* expected 8"):
        messages.FIRE.unpack(payload)


def test_a_last_field_of_text_takes_the_rest():
    page = messages.DICTIONARY_PAGE.unpack(messages.DICTIONARY_PAGE.pack(part=0, offset=7, text=b"abc"))

    assert (page.part, page.offset, page.text) == (0, 7, b"abc")


def test_every_code_says_cause_deed_and_remedy_under_a_number_of_its_own():
    assert len({row.number for row in causes.CODES}) == len({row.name for row in causes.CODES}) == len(causes.CODES)
    assert all(row.cause and row.did and row.todo for row in causes.CODES)
    assert causes.named("f05").number == codes.OVER_TEMPERATURE
    assert causes.row(codes.STOP).name == "F01"


def test_values_may_be_given_in_the_order_of_the_fields():
    assert messages.FIRE.packed(5, 600, 500) == messages.FIRE.pack(coils=5, duty_permille=600, hold_ms=500)
    assert messages.DICTIONARY_PAGE.packed(0, 7, b"abc") == b"\x00\x07\x00abc"


@pytest.mark.parametrize(
    ("values", "complaint"),
    [((1, 600), "fire takes coils"), ((1, 65536, 500), "duty_permille 65536"), ((1, 0.5, 500), "not a whole number")],
)
def test_values_in_order_are_refused_like_named_ones(values, complaint):
    with pytest.raises(ValueError, match=complaint):
        messages.FIRE.packed(*values)
