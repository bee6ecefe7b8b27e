"""CAN frames: length, stuffing and checksum."""

import pytest

from hil_sim.devices.canframe import Frame, checksum, head, length_bits, stuffed


def unstuffed_length(frame):
    return len(head(frame)) + 10


def test_a_frame_without_stuffing_has_44_bits_and_8_for_each_byte():
    assert unstuffed_length(Frame(0x123)) == 44
    assert unstuffed_length(Frame(0x123, bytes(8))) == 108
    assert unstuffed_length(Frame(0x123, bytes(8), extended=True)) == 128


def test_five_equal_bits_are_followed_by_one_of_the_other_kind():
    assert stuffed([0] * 5) == [0, 0, 0, 0, 0, 1]
    assert stuffed([1, 1, 1, 1, 1, 0]) == [1, 1, 1, 1, 1, 0, 0]
    assert stuffed([0, 1] * 10) == [0, 1] * 10


def test_a_stuffed_bit_begins_the_next_run():
    assert stuffed([0, 0, 0, 0, 0, 1, 1, 1, 1]) == [0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 0]


def test_the_worst_frame_has_a_stuffed_bit_for_every_four():
    worst = max(length_bits(Frame(0, bytes([byte] * 8))) for byte in (0x00, 0x0F, 0x1E, 0x3C, 0x78, 0xFF))

    assert worst <= 108 + (34 + 64 - 1) // 4


def test_the_checksum_of_a_frame_with_its_checksum_is_zero():
    assert checksum(head(Frame(0x5A5, b"\x12\x34"))) == 0
    assert checksum(head(Frame(0x1234567, b"softrig", extended=True))) == 0


def test_the_checksum_divides_by_the_polynomial_of_the_specification():
    assert checksum([1]) == 0x4599  # x15 + x14 + x10 + x8 + x7 + x4 + x3 + 1
    said = [int(bit) for byte in b"123456789" for bit in f"{byte:08b}"]

    assert checksum(said) == 0x059E  # the check value of CRC-15/CAN
    assert checksum([1, 0]) == (0x4599 << 1 ^ 0x4599) & 0x7FFF


@pytest.mark.parametrize(
    ("wins", "loses"),
    [
        (Frame(0x100), Frame(0x101)),
        (Frame(0x100), Frame(0x100, remote=True)),
        (Frame(0x100, remote=True), Frame(0x100 << 18, extended=True)),
        (Frame(0x100 << 18, extended=True), Frame(0x101)),
    ],
)
def test_the_lower_identifier_wins_and_data_before_remote_before_extended(wins, loses):
    assert wins.arbitration < loses.arbitration


@pytest.mark.parametrize(
    "fields", [{"id": 0x800}, {"id": 1 << 29, "extended": True}, {"id": 1, "data": bytes(9)}, {"id": -1}]
)
def test_what_is_no_frame_is_refused(fields):
    with pytest.raises(ValueError, match="at most"):
        Frame(**fields)


def bits(text: str) -> list[int]:
    return [int(bit) for bit in text.replace(" ", "")]


def test_a_standard_frame_has_its_fields_in_order():
    start_id_rtr_ide_r0 = "0 00100100011 0 0 0"

    assert head(Frame(0x123, b"\xa5"))[:-15] == bits(start_id_rtr_ide_r0 + "0001 10100101")
    assert head(Frame(0x123, remote=True, length=2))[:-15] == bits("0 00100100011 1 0 0 0010")


def test_an_extended_frame_has_its_fields_in_order():
    start_base_srr_ide = "0 10010001101 1 1"
    rest_rtr_r1_r0_length = "000101011001111000 0 0 0 0000"

    assert head(Frame(0x12345678 & 0x1FFFFFFF, extended=True))[:-15] == bits(start_base_srr_ide + rest_rtr_r1_r0_length)


def test_ten_bits_follow_that_are_never_stuffed():
    frame = Frame(0x123, bytes(8))

    assert length_bits(frame) == len(stuffed(head(frame))) + 10


def test_the_length_is_that_of_the_data_unless_another_is_given():
    assert Frame(1, b"abc").length == 3
    assert Frame(1).length == 0
    assert Frame(1, remote=True, length=4).length == 4
    assert Frame(1, bytes(8), length=0).length == 0
