"""Stop: no valid frame holds the pattern, and wherever it comes, in whatever state, it stops within a control step.

The proof: an encoded frame has one zero, its last byte. So between two delimiters of any stream of valid frames stands
the stuffed body of one frame, which is a byte longer than the body: at least 9 bytes. The pattern wants four.
"""

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from firmware.core import Core
from firmware.profile import Profile
from firmware.wires import Wires
from protocol import codes, frames, messages, program
from protocol.canbus import CLASSIC, FD, STOP_IDENTIFIER, Assembler, Segmenter, Taken, identifier
from protocol.link import QUEUE_MAX, Link
from tests.firmware_bench import PROFILE, SESSION, Rig, Table

STOP = frames.STOP
BYTE_S = 10 / 115_200
STEP_S = 0.0075  # a control step, and what the step that switches off spends on its buses before

parts = [STOP, b"STOP", b"\x00", b"\x05", b"S", b"TOP\x00", b"\xff" * 253, b"x"]
cunning = st.lists(st.sampled_from(parts), max_size=20)
payloads = st.one_of(st.binary(max_size=236), cunning.map(lambda parts: b"".join(parts)[:236]))
valid = st.builds(
    lambda kind, seq, ack, payload, seed, flags, node: frames.encode(
        frames.seal(kind, seq, ack, payload, seed, flags, node)
    ),
    st.integers(0, 255), st.integers(0, 255), st.integers(0, 255), payloads, st.integers(0, 2**32 - 1),
    st.sampled_from([0, frames.RELIABLE, frames.SEALED, frames.RELIABLE | frames.SEALED]), st.integers(0, 255),
)  # fmt: skip
noises = st.one_of(st.binary(max_size=300), cunning.map(b"".join))


def test_a_body_of_any_length_is_stuffed_longer_than_the_pattern_wherever_that_stands_in_it():
    """All lengths, all places."""
    for length in range(frames.BODY_MIN, frames.BODY_MAX + 1):
        for place in range(length - len(STOP) + 1):
            line = frames.encode(b"\x01" * place + STOP + b"\x02" * (length - place - len(STOP)))

            assert line.find(0) == len(line) - 1 == length + 1 > len(STOP)


@given(st.lists(valid, min_size=1, max_size=6))
def test_no_stream_of_valid_frames_holds_the_pattern(lines):
    stream = b"\x00" + b"".join(lines)

    assert STOP not in stream
    assert all(len(piece) >= frames.BODY_MIN + 1 for piece in stream.split(b"\x00")[1:-1])


@given(noises, noises, st.lists(st.integers(0, 600), max_size=8), valid, st.integers(1, 250))
def test_the_pattern_is_found_in_any_surroundings_however_the_bytes_are_cut(before, after, cuts, line, broken_off):
    stream = before + line[:broken_off] + STOP + after
    places = sorted({0, *(cut for cut in cuts if cut < len(stream)), len(stream)})
    finder, found, read = frames.StopFinder(), [], b""

    for begin, end in pairwise(places):
        read += stream[begin:end]
        found.append(finder.feed(stream[begin:end]))
        assert found[-1] == (STOP in read[max(0, begin - 5) : end])

    assert any(found)


@given(noises, st.integers(1, 40))
def test_nothing_but_the_pattern_is_found(noise, step):
    finder = frames.StopFinder()

    found = [finder.feed(noise[at : at + step]) for at in range(0, len(noise), step)]

    assert any(found) == (STOP in noise)


def idle(rig):
    """Nothing has happened yet."""


def self_test(rig):
    rig.host.send(messages.ARM.number, messages.ARM.pack(session=SESSION, lease_ms=0, without=0), rig.now_ms)
    while not rig.core.control.selftest.running:
        rig.run(5)


def calibrating(rig):
    rig.host.send(messages.CALIBRATE.number, messages.CALIBRATE.pack(session=SESSION, without=0), rig.now_ms)
    while not rig.core.control.selftest.running:
        rig.run(5)


def armed(rig):
    rig.arm()


def firing(rig):
    rig.arm()
    rig.fire(0b11)
    assert any(rig.board.chip.duty_permille)


def uploading(rig):
    rig.arm()
    code = program.fire(1, 500, 1000) * 20 + program.halt()
    rig.upload(code[:60], program.header(code, rig.profile.crc))


def loaded(rig, code):
    rig.arm()
    rig.upload(code, program.header(code, rig.profile.crc))


def verifying(rig):
    loaded(rig, program.fire(1, 0, 0) * 200 + program.halt())
    rig.host.send(messages.START.number, messages.START.pack(paused=0, at_ms=0), rig.now_ms)
    rig.run(5)
    assert rig.core.commands.upload.request >= 0


def waits_for_sync(rig):
    loaded(rig, program.fire(1, 500, 1000) + program.delay(1000) + program.halt())
    rig.say(messages.START, paused=0, at_ms=messages.AT_SYNC)


def waits_for_its_time(rig):
    loaded(rig, program.fire(1, 500, 1000) + program.delay(1000) + program.halt())
    rig.say(messages.START, paused=0, at_ms=rig.now_ms + 60)


def running(rig):
    loaded(rig, program.fire(1, 500, 1000) + program.delay(1000) + program.halt())
    rig.say(messages.START, paused=0, at_ms=0)
    rig.run(20)
    assert any(rig.board.chip.duty_permille)


def tripped(rig):
    rig.core.trip(codes.CHIP)


STATES = [
    idle, self_test, calibrating, armed, firing, uploading, verifying, waits_for_sync, waits_for_its_time, running,
    tripped,
]  # fmt: skip


def stopped_in_one_step(rig, line):
    """Assert that every coil is off, supply too, after the step that reads these bytes, and that it says so."""
    answer = rig.core.step(rig.now_ms, line, 1024)
    rig.now_ms += 5

    assert not any(rig.board.chip.duty_permille)
    assert not rig.board.powered
    assert rig.core.state == messages.TRIPPED
    kinds = [frame.kind for frame in frames.Decoder(rig.core.link.decoder.dictionary_crc, SESSION).feed(answer)]
    assert kinds[0] == messages.STOPPED.number


def fill(rig):
    """Leave no room in either direction; return the bytes that wait for the robot, the last frame broken off."""
    while rig.core.link.room():
        rig.core.link.send(messages.EVENT.number, bytes(17), rig.now_ms)
    for _ in range(QUEUE_MAX):
        rig.core.link.post(messages.CLOCK.number, bytes(12))
    fire = messages.FIRE.pack(coils=4, duty_permille=900, hold_ms=2000)
    while rig.host.room():
        rig.host.send(messages.FIRE.number, fire, rig.now_ms)
    return rig.host.poll(rig.now_ms)[:-3]


@pytest.mark.parametrize("full", [False, True], ids=["quiet", "full"])
@pytest.mark.parametrize("state", STATES, ids=lambda state: state.__name__)
def test_a_stop_stops_in_one_step_in_every_state_also_with_full_queues(state, full):
    rig = Rig()
    state(rig)
    before = fill(rig) if full else b"\x07\x21"

    stopped_in_one_step(rig, before + STOP + b"\x09\x21")


def test_a_stop_in_the_first_step_of_all_stops():
    core = Core(Table(), Profile(PROFILE.read_bytes()), boot=1)

    core.step(0, STOP, 1024)

    assert core.state == messages.TRIPPED
    assert core.code == codes.STOP


@pytest.mark.parametrize("state", STATES, ids=lambda state: state.__name__)
def test_a_stop_is_latched_until_clear(state):
    rig = Rig()
    state(rig)
    stopped_in_one_step(rig, STOP)
    rig.run(100)  # what was being verified is, in vain

    code = program.fire(1, 500, 1000) + program.halt()
    for message, fields in (
        (messages.ARM, {"session": SESSION, "lease_ms": 0, "without": 0}),
        (messages.FIRE, {"coils": 1, "duty_permille": 500, "hold_ms": 1000}),
        (messages.PROGRAM, {"header": program.header(code, rig.profile.crc)}),
        (messages.CODE, {"offset": 0, "code": code}),
        (messages.START, {"at_ms": 0, "paused": 0}),
        (messages.SYNC, {}),
        (messages.CALIBRATE, {"session": SESSION, "without": 0}),
        (messages.DISARM, {}),
    ):
        answers = rig.say(message, **fields)
        if message in (messages.ARM, messages.FIRE, messages.START, messages.CALIBRATE):
            assert [body.code for name, body in answers if name == "refused"][-1] == codes.TRIPPED
        assert not any(rig.board.chip.duty_permille)
        assert rig.core.state == messages.TRIPPED

    assert ("ok" in [name for name, _ in rig.say(messages.CLEAR)]) == (rig.core.state == messages.IDLE)
    assert rig.core.state == messages.IDLE


def test_on_the_bench_a_stop_behind_a_full_line_switches_off_within_a_step_of_its_arrival(rig):
    rig.fire("A", "C", duty_percent=50, hold_s=3)
    line = rig.link
    traffic = frames.encode(frames.seal(messages.CODE.number, 200, 0, bytes(230), 0, frames.RELIABLE))
    begun_s = line.now_s()

    line.write(traffic + traffic[:100] + STOP + traffic[:50])
    arrived_s = begun_s + BYTE_S * (len(traffic) + 100 + len(STOP))
    rig.run_alone(0.1)

    for label in "AC":
        assert arrived_s - BYTE_S <= rig.coil(label).off_at_s <= arrived_s + STEP_S


@given(st.integers(0, 2**11 - 1), st.binary(max_size=8))
def test_on_can_only_one_frame_is_a_stop(number, data):
    taken = Assembler(from_robot=False).feed(number, False, data, 0)

    assert (taken is not None) == (number == STOP_IDENTIFIER and data == b"STOP")


can_frames = st.tuples(st.integers(0, 2**29 - 1), st.binary(max_size=64))


@given(st.lists(can_frames, max_size=30), st.booleans(), st.booleans())
def test_no_extended_frames_of_can_make_the_pattern(heard, from_robot, fd):
    assembler = Assembler(from_robot)

    lines = [taken.line for each in heard if (taken := assembler.feed(each[0], True, each[1], 0, fd))]

    assert STOP not in b"\x00" + b"".join(lines)


@given(st.lists(valid, max_size=4), st.integers(0, 300), st.lists(st.integers(1, 60), max_size=20), st.booleans())
def test_on_can_a_stop_goes_out_mid_frame_and_comes_in_as_the_pattern(lines, broken_off, pieces, fd):
    """Whoever writes the stream: as a standard frame of identifier 0, which wins every arbitration."""
    mtu = FD if fd else CLASSIC
    segmenter, assembler = Segmenter(3, 1, False, mtu), Assembler(False)
    stream, at, out = b"".join(lines)[:broken_off] + STOP + b"".join(lines), 0, []

    for length in (*pieces, len(stream)):
        out += segmenter.feed(stream[at : at + length])
        at += length

    taken = [assembler.feed(*frame, 0, fd) for frame in out]
    stops = [each for each in taken if each is not None and each.line == STOP]
    assert len(stops) == 1
    assert all(frame.identifier for frame in out if frame.extended)


def test_every_identifier_of_a_body_loses_the_arbitration_against_a_stop():
    """A standard identifier wins against an extended one whose first 11 bits are not less."""
    for kind in range(256):
        for from_robot in (False, True):
            assert identifier(kind, 0, 0, from_robot) >> 18 > STOP_IDENTIFIER


class TwoWires:
    """A board's serial line and its CAN bus, as a test says what they bring in each step."""

    noise = 0
    byte_ns = 86_805
    can = None

    def __init__(self) -> None:
        self.serial, self.bodies = b"", []
        self.node = 3

    def read(self) -> bytes:
        data, self.serial = self.serial, b""
        return data

    def take(self, now_ms: int) -> list:
        bodies, self.bodies = self.bodies, []
        return bodies

    def room(self) -> int:
        return 512


class Ears:
    """The core of those wires, as far as it hears."""

    def __init__(self) -> None:
        self.link = Link(device=True)


def test_a_stop_whose_halves_a_body_by_can_has_parted_is_found():
    board = TwoWires()
    wires = Wires(board, Ears(), board)
    finder = frames.StopFinder()
    line = frames.encode(frames.seal(messages.CLEAR.number, 0, 0, b"", 1, frames.RELIABLE))
    found = []

    for serial, bodies in ((b"\x00ST", []), (b"", [Taken(3, 1, messages.CLEAR.number, line)]), (b"OP\x00", [])):
        board.serial, board.bodies = serial, bodies
        found.append(finder.feed(wires.read(0)))

    assert found == [False, False, True]
