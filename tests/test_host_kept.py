"""What the host makes of the records that a robot sends, and of what are none."""

import struct

import pytest

from host.kept import Fault, Settings, faults_of, settings_of
from protocol import messages

LABELS = ("A", "B")


def page(records: bytes) -> bytes:
    return messages.FAULTS.pack(request=3, start=7, count=9, records=records)


def settings(resistances: bytes, source: int = 1) -> bytes:
    return messages.SETTINGS.pack(request=3, source=source, node=4, board_offset_decidegc=-5, resistances=resistances)


def test_faults_are_read_in_the_order_in_which_they_come():
    rows = [(4, 812_345, 105, 1, 1203, 3, 1), (3, 99, 101, 255, -1, 2, 3)]

    read = faults_of(page(b"".join(struct.pack("<IIHBiBB", *row) for row in rows)), LABELS)

    assert (read.start, read.count) == (7, 9)
    assert read.faults == (
        Fault(4, 812_345, 105, "B", 1203, "running", "power-on"),
        Fault(3, 99, 101, None, -1, "armed", "reset"),
    )


def test_numbers_that_this_version_cannot_name_are_shown_as_they_are():
    (fault,) = faults_of(page(struct.pack("<IIHBiBB", 1, 2, 999, 0, 0, 77, 2)), LABELS).faults

    assert (fault.code, fault.state, fault.cause) == (999, "state 77", "2")
    assert settings_of(settings(bytes(4), source=9), LABELS).source == "9"


def test_settings_name_the_coils():
    read = settings_of(settings(b"\x00\x00\xb8\x24"), LABELS)

    assert read == Settings("stored", 4, -5, {"A": 0, "B": 9400})


@pytest.mark.parametrize("records", [bytes(1), bytes(16), bytes(18)])
def test_a_page_of_another_length_is_none(records):
    with pytest.raises(ValueError, match="must be a multiple of 17"):
        faults_of(page(records), LABELS)


@pytest.mark.parametrize("resistances", [b"", bytes(3), bytes(6)])
def test_settings_of_another_number_of_coils_are_none(resistances):
    with pytest.raises(ValueError, match="for 2 coils"):
        settings_of(settings(resistances), LABELS)
