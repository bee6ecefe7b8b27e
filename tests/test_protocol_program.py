"""Programs: frozen op-codes, and the verification that no device may skip."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol import program, verify
from protocol.program import Condition

CONDITION = Condition(program.TEMPERATURE, program.ALL, program.BELOW, 450, 0b11)
AIM = program.aim(0, 1, [0, 1, 2])
OPS = [
    (program.fire(0x01, 600, 700, 950), "01 01000000 5802 bc02 b603"),
    (program.ramp(0x03, 300, 800, 0, 100), "02 03000000 2c01 2003 0000 6400"),
    (program.delay(70_000), "03 70110100"),
    (program.repeat(3), "04 0300"),
    (program.next_(), "05"),
    (program.wait(CONDITION, 20_000, program.ABORT), "06 01 01 c201 03000000 204e0000 00"),
    (program.guard(Condition(program.CURRENT, 0, program.ABOVE, -2, 0)), "07 02 10 feff 00000000"),
    (program.step(12), "08 0c00"),
    (program.off(0x80), "09 80000000"),
    (program.aim(2, 1, [11, 12, 0]), "0a 02 01 0b0c00ffffffffff"),
    (program.aimed(2, 1000, 550, 950), "0b 02 e803 2602 b603 0000"),
    (program.move(0b10, -250, 1000), "0c 02000000 06ff e803"),
    (program.orient(-30, 5000), "0d e2ff 8813"),
    (program.press(5000, 1000, 70_000), "0e 8813 e803 70110100"),
    (program.label(3), "0f 03"),
    (program.label(program.ON_FAULT), "0f ff"),
    (program.note(7), "10 0700"),
    (program.guard(Condition(program.TIME, 0, program.ABOVE, 0, 60_000)), "07 10 10 0000 60ea0000"),
    (program.fire(0x01, 400, 5000, program.KEEP | 800), "01 01000000 9001 8813 2083"),
    (program.halt(), "00"),
]


@pytest.mark.parametrize(("op", "wire"), OPS, ids=[program.NAMES[op[0]] for op, _ in OPS])
def test_the_bytes_of_an_op_are_frozen_and_as_long_as_the_table_says(op, wire):
    assert op == bytes.fromhex(wire)
    assert len(op) == program.SIZES[op[0]]


def test_the_header_is_frozen_and_reads_back():
    header = program.header(b"\x00", 0xAABBCCDD, program.OUTLIVES_HOST)

    assert header == bytes.fromhex("5347 02 01 ddccbbaa 01000000 8def02d2")
    assert program.read_header(header) == (program.OUTLIVES_HOST, 0xAABBCCDD, 1, 0xD202EF8D)


def test_a_condition_reads_back_with_its_sign():
    wait = program.wait(Condition(1, 0, 0, -400, 1), 1, 1)

    assert program.read_condition(wait, 1).value == -400


def test_a_condition_on_down_is_frozen():
    assert program.guard(Condition(program.DOWN, program.CHOSEN, program.IS, 0, 2)) == bytes.fromhex(
        "07 08 12 0000 02000000"
    )


def test_places_behind_are_counted_round_the_circle():
    assert program.aim(0, -1, [4, 5, 6]) == program.aim(0, 2, [4, 5, 6])


@pytest.mark.parametrize(
    ("code", "needed"),
    [
        (program.guard(CONDITION), False),
        (program.guard(Condition(program.PITCH, 0, program.ABOVE, -450, 0)), True),
        (program.guard(Condition(program.DOWN, 0, program.IS, 0, 1)), True),
        (AIM, True),
    ],
)
def test_the_verification_finds_out_whether_a_program_asks_where_down_is(code, needed):
    check = verify.Check(code + program.halt(), 8, 100)

    while not check.go_on(1):
        pass

    assert check.needs_attitude == needed


@pytest.mark.parametrize(
    ("code", "camera", "loop"),
    [
        (program.move(1 << 8, 0, 1), False, False),
        (program.guard(Condition(program.POSITION, 0, program.ABOVE, 0, 1 << 8)), False, False),
        (program.guard(Condition(program.ORIENTATION, 0, program.ABOVE, 0, 0)), True, False),
        (program.orient(0, 1), True, True),
    ],
)
def test_the_verification_finds_out_whether_a_program_needs_a_camera_and_the_loop(code, camera, loop):
    check = verify.Check(code + program.halt(), 8, 100, joints=2)

    while not check.go_on(1):
        pass

    assert (check.needs_camera, check.needs_loop) == (camera, loop)


@pytest.mark.parametrize(
    "code",
    [
        program.move(0, 0, 1), program.move(1, 0, 1), program.move(1 << 10, 0, 1), program.move(0x101, 0, 1),
        program.fire(1 << 8, 1, 1), program.off(1 << 9),
        program.guard(Condition(program.POSITION, 0, program.ABOVE, 0, 1)),
        program.guard(Condition(program.JOINT_CURRENT, program.CHOSEN, program.ABOVE, 0, 1 << 8)),
        program.guard(Condition(program.HEAT, 0, program.ABOVE, 0, 1 << 8)),
    ],
)  # fmt: skip
def test_an_order_or_condition_for_channels_of_the_other_kind_is_refused(code):
    with pytest.raises(program.BadProgram):
        verify.check_code(code + program.halt(), coils=8, bytes_max=100, joints=2)


@pytest.mark.parametrize(
    ("code", "load", "press"),
    [
        (program.move(1, 0, 1), False, False),
        (program.guard(Condition(program.PRESSURE, 0, program.ABOVE, 0, 1 << 5)), False, False),
        (program.guard(Condition(program.FORCE, 0, program.ABOVE, 0, 0)), True, False),
        (program.press(0, 1, 1), True, True),
    ],
)
def test_the_verification_finds_out_whether_a_program_needs_the_load_cell_and_the_press(code, load, press):
    check = verify.Check(code + program.halt(), 0, 100, joints=1, cells=6)

    while not check.go_on(1):
        pass

    assert (check.needs_load, check.needs_press) == (load, press)


def test_a_condition_on_a_cell_that_the_robot_has_not_is_refused():
    code = program.guard(Condition(program.PRESSURE, program.ANY, program.ABOVE, 0, 1 << 6)) + program.halt()

    with pytest.raises(program.BadProgram, match="channels 0x40, this robot has 0x3f"):
        verify.check_code(code, coils=0, bytes_max=100, joints=1, cells=6)


def test_a_force_that_is_reached_after_its_time_is_refused():
    with pytest.raises(program.BadProgram, match="after the end of its order"):
        verify.check_code(program.press(500, 1001, 1000) + program.halt(), coils=0, bytes_max=100, joints=1)


BAD = {
    "nothing": (b"", "0 bytes of code"),
    "no halt": (program.delay(1), "needs a halt"),
    "cut short": (program.fire(1, 1, 1)[:-1], "cut short"),
    "unknown op": (b"\x0a\x00", "op 10 unknown"),
    "open loop": (program.repeat(2) + program.halt(), "closed loops"),
    "next without repeat": (program.next_() + program.halt(), "nested -1"),
    "nine loops deep": (program.repeat(1) * 9 + program.next_() * 9 + program.halt(), "nested 9"),
    "kept at nothing": (program.fire(1, 500, 100, program.KEEP) + program.halt(), "kept at no temperature"),
    "no turns": (program.repeat(0) + program.next_() + program.halt(), "no turns"),
    "no coil": (program.fire(0, 1, 1) + program.halt(), "channels 0x0"),
    "unknown coil": (program.fire(1 << 8, 1, 1) + program.halt(), "channels 0x100"),
    "an object without joints": (program.orient(500, 1000) + program.halt(), "this robot has none"),
    "a force without joints": (program.press(500, 0, 1000) + program.halt(), "this robot has none"),
    "duty above all": (program.fire(1, 1001, 1) + program.halt(), "duty 1001"),
    "nine guards": (program.guard(CONDITION) * 9 + program.halt(), "9 guards, at most 8"),
    "unknown source": (program.guard(Condition(17, 0, 0, 0, 1)) + program.halt(), "does not know"),
    "unknown quantifier": (program.guard(Condition(1, 3, 0, 0, 1)) + program.halt(), "does not know"),
    "chosen current": (AIM + program.guard(Condition(2, 2, 0, 0, 0)) + program.halt(), "does not know"),
    "a coil used before it is aimed": (program.aimed(0, 1, 1) + AIM + program.halt(), "holds no coil"),
    "a condition on a coil not aimed": (AIM + program.guard(Condition(8, 2, 1, 0, 1)) + program.halt(), "no coil"),
    "a fifth place": (program.aim(4, 0, [0, 1]) + program.halt(), "cannot be aimed"),
    "a circle of one": (program.aim(0, 0, [1]) + program.halt(), "cannot be aimed"),
    "a circle with a hole": (AIM[:5] + b"\xff\x02" + AIM[7:] + program.halt(), "cannot be aimed"),
    "a circle beyond the robot": (program.aim(0, 0, [0, 8]) + program.halt(), "cannot be aimed"),
    "further than once around": (AIM[:2] + b"\x03" + AIM[3:] + program.halt(), "cannot be aimed"),
    "an aimed duty above all": (AIM + program.aimed(0, 1001, 1) + program.halt(), "duty 1001"),
    "a label that never comes": (program.wait(CONDITION, 1, 2) + program.halt(), "every label"),
    "a ninth label": (program.wait(CONDITION, 1, 10) + program.halt(), "label 8 is none"),
    "a jump back": (program.label(0) + program.wait(CONDITION, 1, 2) + program.halt(), "label 0 is none"),
    "a label twice": (program.label(0) * 2 + program.halt(), "label 0 twice"),
    "a label in a loop": (program.repeat(2) + program.label(0) + program.delay(1) + program.next_(), "in a loop"),
    "a loop that takes no time": (program.repeat(2) + program.note(1) + program.next_() + program.halt(), "no time"),
    "an abort in the midst": (program.delay(1) + program.label(255) + program.halt(), "by itself at the end"),
    "two ways to abort": ((program.halt() + program.label(255)) * 2 + program.halt(), "by itself at the end"),
    "a jump into the abort": (
        program.wait(CONDITION, 1, 2) + program.halt() + program.label(255) + program.label(0) + program.halt(),
        "by itself at the end",
    ),
    "a coil not aimed on every way": (
        program.wait(CONDITION, 1, 2) + AIM + program.label(0) + program.aimed(0, 1, 1) + program.halt(),
        "no coil",
    ),
    "a delay beyond the clock": (program.delay(1 << 30) + program.halt(), "a time beyond"),
    "a time-out beyond the clock": (program.wait(CONDITION, 1 << 30, 1) + program.halt(), "a time beyond"),
    "a time beyond the clock": (program.guard(Condition(16, 0, 1, 0, 1 << 30)) + program.halt(), "a time of"),
    "too long": (program.delay(1) * 30 + program.halt(), "at most 100"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_code_is_refused_and_says_why(name):
    code, why = BAD[name]

    with pytest.raises(program.BadProgram, match=why):
        verify.check_code(code, coils=8, bytes_max=100)


@given(st.binary(max_size=100))
def test_random_bytes_are_refused_or_can_be_taken_apart(code):
    try:
        verify.check_code(code, coils=8, bytes_max=100)
    except program.BadProgram:
        return
    assert program.disassemble(code)[-1][1] == "halt"


@pytest.mark.parametrize("data", [b"", bytes(16), b"SG\x01" + bytes(13)])
def test_a_foreign_header_is_refused(data):
    with pytest.raises(program.BadProgram):
        program.read_header(data)


def test_the_labels_and_the_way_after_an_abort_are_found():
    wait = program.wait(CONDITION, 1, program.JUMP + 5)
    code = program.repeat(2) + wait + program.next_() + program.label(5) + program.halt() + program.label(255)
    check = verify.Check(code + program.halt(), coils=8, bytes_max=100)

    assert check.go_on(len(code))
    assert check.labels[5] == len(program.repeat(2) + wait + program.next_())
    assert check.fault_at == len(code) - len(program.label(255))


def test_a_coil_that_is_aimed_on_every_way_to_a_label_may_be_used():
    wait = program.wait(CONDITION, 1, program.JUMP)

    verify.check_code(AIM + wait + AIM + program.label(0) + program.aimed(0, 1, 1) + program.halt(), 8, 100)


def test_a_streamed_code_is_verified_as_far_as_it_has_come():
    buffer = bytearray(64)
    check = verify.Check(buffer, coils=8, bytes_max=64, streamed=True)
    assert check.go_on(32)
    for piece in (program.fire(1, 500, 700) + program.delay(700), program.halt()):
        buffer[check.end : check.end + len(piece)] = piece
        check.end += len(piece)
        assert check.go_on(32)
        assert check.at == check.end


def test_a_streamed_code_has_no_loops():
    buffer = bytearray(program.repeat(2) + program.delay(1))
    check = verify.Check(buffer, coils=8, bytes_max=64, streamed=True)
    check.end = len(buffer)

    with pytest.raises(program.BadProgram, match="streamed 0"):
        check.go_on(32)
