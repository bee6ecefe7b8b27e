"""The table of variables: how a record of them is laid out, and how it is veiled on the line."""

import struct

import pytest

from host.errors import BadRequest
from host.selections import numbers_of
from protocol import frames, variables


def numbers(*names: str) -> tuple[int, ...]:
    return tuple(variables.number(name) for name in names)


def test_the_numbers_of_variables_stand_for_ever():
    assert [variable.name for variable in variables.VARIABLES][:10] == [
        "state", "code", "step", "coils_on", "without", "lease_left_ms", "supply_mv", "current_ma", "board_decidegc",
        "roll_decideg",
    ]  # fmt: skip
    assert numbers("duty_permille", "coil_decidegc", "heat_permille", "most_decidegc") == (15, 16, 17, 21)


def test_a_record_holds_its_variables_in_the_order_they_were_asked_for():
    asked = numbers("duty_permille", "state", "board_decidegc")
    values = struct.pack("<3HBh", 0, 600, 1000, 3, -125)

    assert variables.size(asked, variables.counts(3)) == len(values) == 9
    assert variables.unpack(asked, values, variables.counts(3)) == [(0, 600, 1000), 3, -125]


def test_the_usual_record_of_22_coils_is_102_bytes():
    assert variables.layout(variables.USUAL, variables.counts(22)) == "<BHHHhhhB22H22h"
    assert variables.size(variables.USUAL, variables.counts(22)) == 102


@pytest.mark.parametrize("values", [b"", b"\x01\x02", b"\x01\x02\x03\x04"])
def test_values_of_another_length_are_refused(values):
    with pytest.raises(ValueError, match="bytes of values, expected 3"):
        variables.unpack(numbers("state", "step"), values, variables.counts(8))


def test_veiled_values_hold_no_zero_where_coils_are_off():
    values = struct.pack("<22H", *[0] * 22)

    veiled = variables.veiled(values)

    assert veiled == b"\x55" * 44
    assert variables.veiled(veiled) == values
    assert variables.veiled(b"") == b""


def test_any_record_fits_a_frame_if_its_values_fit_229_bytes():
    assert frames.PAYLOAD_MAX - 7 == 229


def test_a_name_that_there_is_not_is_answered_with_the_nearest():
    with pytest.raises(BadRequest, match=r"no variable 'suply_mv'; did you mean 'supply_mv'\?"):
        numbers_of(["state", "suply_mv"])
    with pytest.raises(BadRequest, match="softrig watch --list"):
        numbers_of(["xyz"])
    with pytest.raises(BadRequest, match="no variable was named"):
        numbers_of([])
