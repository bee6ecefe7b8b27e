"""Bodies on CAN: what is cut up comes together again, or not at all; what is lost costs no more than its body."""

import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol import frames
from protocol.canbus import (
    ALL,
    CLASSIC,
    FD,
    FIRST,
    LAST,
    LATE_MS,
    UNDER_WAY_MAX,
    Assembler,
    CanFrame,
    Segmenter,
    identifier,
    priority,
)
from protocol.messages import ALIVE, EVENT, FIRE, HELLO, IDENTITY, SYNC, TELEMETRY

KINDS = [kind for kind in range(256) if kind not in (0x58, 0x59, SYNC.number)]
LEGAL_FD = {*range(9), 12, 16, 20, 24, 32, 48, 64}
bodies = st.builds(
    lambda kind, rest: bytes((0x20, kind)) + rest, st.sampled_from(KINDS), st.binary(min_size=6, max_size=251)
)
mtus = st.sampled_from([CLASSIC, FD])


def cut(parts, mtu=CLASSIC, robot=3, host=1, from_robot=False) -> list[CanFrame]:
    """Return the CAN frames of bodies."""
    return Segmenter(robot, host, from_robot, mtu).feed(b"".join(frames.encode(body) for body in parts))


def joined(can_frames, mtu=CLASSIC, from_robot=False, assembler=None, now_ms=0) -> list[bytes]:
    """Return the bodies that CAN frames make."""
    assembler = assembler or Assembler(from_robot)
    taken = [assembler.feed(*frame, now_ms, fd=mtu == FD) for frame in can_frames]
    return [frames.decode(each.line[:-1]) for each in taken if each]


@given(st.lists(bodies, max_size=6), mtus, st.booleans())
def test_every_body_comes_together_again(parts, mtu, from_robot):
    assert joined(cut(parts, mtu, from_robot=from_robot), mtu, from_robot) == parts


@given(st.lists(bodies, max_size=4), mtus, st.lists(st.integers(1, 99), max_size=20), st.booleans())
def test_it_does_not_matter_in_which_pieces_the_stream_is_written(parts, mtu, pieces, stopped):
    stream = b"".join(frames.encode(body) for body in parts) + (frames.STOP if stopped else b"")
    whole = Segmenter(3, 1, False, mtu).feed(stream)
    segmenter, at, out = Segmenter(3, 1, False, mtu), 0, []

    for length in (*pieces, len(stream)):
        out += segmenter.feed(stream[at : at + length])
        at += length

    assert out == whole


@given(bodies, mtus)
def test_a_frame_has_a_length_that_its_bus_can_carry(body, mtu):
    lengths = [len(frame.data) for frame in cut([body], mtu)]

    assert set(lengths) <= (LEGAL_FD if mtu == FD else set(range(1, 9)))
    assert all(length == mtu for length in lengths[:-1])


@pytest.mark.parametrize(("mtu", "length", "count"), [(8, 16, 3), (8, 8, 2), (8, 253, 37), (64, 62, 1), (64, 253, 5)])
def test_a_body_takes_as_many_frames_as_the_document_says(mtu, length, count):
    assert len(cut([bytes((0x20, 0x20)) + bytes(length - 2)], mtu)) == count


def test_the_bytes_of_a_transfer_are_those_of_the_document():
    body = bytes((0x21, 0x20, 5, 9)) + bytes(range(1, 9)) + b"\xaa\xbb\xcc\xdd"

    first, second, third = cut([body], robot=3, host=1)

    assert first == CanFrame(0x08800C08, True, b"\x80\x21\x20\x05\x09\x01\x02\x03")
    assert second == CanFrame(0x08800C08, True, b"\x01\x04\x05\x06\x07\x08\xaa\xbb")
    assert third == CanFrame(0x08800C08, True, b"\x42\xcc\xdd")


def test_on_can_fd_the_length_stands_after_the_first_segment_byte():
    body = bytes((0x21, 0x20)) + bytes(range(2, 15))

    (frame,) = cut([body], FD)

    assert frame.data == b"\xc0\x0f" + body + bytes(3)


@given(st.lists(bodies, min_size=1, max_size=6), mtus, st.randoms(use_true_random=False))
def test_a_segment_that_is_lost_costs_its_body_and_no_other(parts, mtu, chance):
    can_frames = cut(parts, mtu)
    lost = {chance.randrange(len(can_frames)) for _ in range(3)}
    owner = [index for index, body in enumerate(parts) for _ in cut([body], mtu)]

    got = joined([frame for at, frame in enumerate(can_frames) if at not in lost], mtu)

    hit = {owner[at] for at in lost}
    assert got == [body for index, body in enumerate(parts) if index not in hit]


@given(st.lists(bodies, min_size=1, max_size=6), mtus, st.randoms(use_true_random=False))
def test_a_segment_that_comes_twice_costs_nothing(parts, mtu, chance):
    twice = [frame for frame in cut(parts, mtu) for _ in range(chance.choice((1, 1, 2)))]

    got = joined(twice, mtu)

    assert [body for at, body in enumerate(got) if at == 0 or body != got[at - 1]] == [
        body for at, body in enumerate(parts) if at == 0 or body != parts[at - 1]
    ]


@given(st.lists(bodies, min_size=1, max_size=6), mtus, st.randoms(use_true_random=False))
def test_segments_out_of_order_make_no_body_that_was_not_sent(parts, mtu, chance):
    can_frames = cut(parts, mtu)
    for _ in range(4):
        at = chance.randrange(len(can_frames))
        can_frames.insert(chance.randrange(len(can_frames)), can_frames.pop(at))

    assert all(body in parts for body in joined(can_frames, mtu))


@given(st.binary(min_size=13, max_size=13), st.binary(min_size=13, max_size=13))
def test_the_head_of_one_body_and_the_tail_of_the_next_never_meet(one, other):
    first, _, _, _, _, last = cut([b"\x20\x20" + one, b"\x20\x20" + other])

    assert joined([first, last]) == []


def test_a_segment_that_comes_too_late_is_no_part_of_its_body():
    first, second = cut([b"\x20\x20" + bytes(8)])

    in_time, late = Assembler(False), Assembler(False)
    for assembler, after_ms in ((in_time, LATE_MS), (late, LATE_MS + 1)):
        assembler.feed(*first, 0)
        assert bool(assembler.feed(*second, after_ms)) == (assembler is in_time)

    assert (in_time.dropped, late.dropped) == (0, 1)


@given(st.lists(st.tuples(bodies, st.integers(1, 4)), min_size=1, max_size=4), mtus, st.randoms(use_true_random=False))
def test_four_senders_may_talk_at_once(said, mtu, chance):
    """Each host its own transfer: the segments of several arrive in any mixture."""
    queues = [cut([body for body, host in said if host == number], mtu, host=number) for number in range(1, 5)]
    mixed = []
    while any(queues):
        mixed.append(chance.choice([queue for queue in queues if queue]).pop(0))

    assembler = Assembler(False)
    taken = [each for each in (assembler.feed(*frame, 0, fd=mtu == FD) for frame in mixed) if each]

    for number in range(1, 5):
        got = [frames.decode(each.line[:-1]) for each in taken if each.host == number]
        assert got == [body for body, host in said if host == number]


@given(st.lists(st.tuples(st.integers(0, 2**29 - 1), st.binary(max_size=64), st.booleans()), max_size=200))
def test_whatever_arrives_memory_stays_bounded_and_nothing_raises(noise):
    assembler = Assembler(False)

    for at, (number, data, fd) in enumerate(noise):
        taken = assembler.feed(number & ~(1 << 17 | 7), True, data, at, fd)

        assert taken is None or 8 < len(taken.line) <= frames.FRAME_MAX
    assert len(assembler._under_way) <= UNDER_WAY_MAX
    assert all(sum(map(len, each.pieces)) <= frames.BODY_MAX + FD for each in assembler._under_way)


def test_a_body_that_never_ends_is_dropped():
    assembler = Assembler(False)
    number = identifier(0x20, 3, 1, False)

    for at in range(1000):
        assert assembler.feed(number, True, bytes((at & 63 | (FIRST if at == 0 else 0), 0x20)) + bytes(6), 0) is None
        assert sum(len(each.pieces) for each in assembler._under_way) < 64

    assert assembler.dropped == 1


def test_a_fifth_body_takes_the_place_of_the_one_that_has_waited_longest():
    assembler = Assembler(False)
    pairs = [cut([b"\x20\x20" + bytes(8)], host=host) for host in range(1, 6)]

    for now_ms, (first, _) in enumerate(pairs):
        assembler.feed(*first, now_ms)

    assert [bool(assembler.feed(*last, 9)) for _, last in pairs] == [False, True, True, True, True]


@pytest.mark.parametrize("place", range(4))
def test_the_stop_pattern_is_a_frame_of_its_own_wherever_it_stands(place):
    body = b"\x20\x20" + bytes(range(1, 9))
    stream = frames.encode(body)
    halves = [stream, stream[:5], b"", stream + stream]

    out = Segmenter(3, 1, False).feed(halves[place] + frames.STOP + stream)

    stops = [frame for frame in out if not frame.extended]
    assert stops == [CanFrame(0, False, b"STOP")]
    assert joined(out)[-1] == body


def test_a_stop_is_for_all_and_turns_into_the_pattern():
    taken = Assembler(True).feed(0, False, b"STOP", 0)

    assert (taken.robot, taken.host, taken.line) == (ALL, ALL, frames.STOP)


@pytest.mark.parametrize(("number", "data"), [(0, b"STO"), (0, b"STOP!"), (1, b"STOP"), (0x7FF, b"")])
def test_no_other_standard_frame_is_taken(number, data):
    assert Assembler(False).feed(number, False, data, 0) is None


def test_no_body_stops_a_robot():
    """Whatever a body holds, its frames are extended ones."""
    assert all(frame.extended for frame in cut([b"\x20\x20" + frames.STOP * 9]))


@pytest.mark.parametrize("number", [identifier(0x20, 3, 1, True), identifier(0x20, 3, 1, False) | 1])
def test_frames_of_the_other_direction_and_of_other_networks_are_passed_over(number):
    assert Assembler(False).feed(number, True, bytes((FIRST | LAST,)) + bytes(7), 0) is None


def test_a_body_of_another_kind_than_its_identifier_is_dropped():
    assembler = Assembler(True)
    body = bytes((FIRST, 0x20, 0x21, 0, 0, 0, 0, 0)), bytes((LAST | 1, 0, 0, 0))

    assert [assembler.feed(identifier(0x20, 3, 1, True), True, data, 0) for data in body] == [None, None]
    assert assembler.dropped == 1


def test_the_word_to_start_together_is_one_frame_for_all():
    (frame,) = cut([frames.seal(SYNC.number, 0, 0, b"", 0, 0)], robot=ALL)
    taken = Assembler(False).feed(*frame, 0)

    assert frame == CanFrame(identifier(SYNC.number, ALL, 1, False), True, b"SYNC")
    assert (taken.robot, taken.host, taken.kind) == (ALL, 1, SYNC.number)
    assert [each.kind for each in frames.Decoder().feed(taken.line)] == [SYNC.number]


@pytest.mark.parametrize("data", [b"", b"SYN", b"STOP", b"SYNC\0", b"\xc0\x20\x07\0\0\0\0\0"])
def test_no_other_data_is_that_word(data):
    assembler = Assembler(False)

    assert assembler.feed(identifier(SYNC.number, ALL, 1, False), True, data, 0) is None


def test_beacons_are_not_segments():
    frame = bytes((FIRST | LAST, 0x58)) + bytes(6)

    assert Assembler(True).feed(identifier(0x58, 3, ALL, True), True, frame, 0) is None


def test_the_more_urgent_has_the_lower_identifier():
    rows = [(SYNC, False), (FIRE, False), (EVENT, True), (HELLO, False), (TELEMETRY, True)]
    numbers = [identifier(message.number, 5, 1, from_robot) for message, from_robot in rows]

    assert numbers == sorted(numbers)
    assert priority(ALIVE.number, False) == priority(FIRE.number, False)
    assert priority(IDENTITY.number, True) == priority(HELLO.number, False)


@given(st.integers(0, 255), st.integers(0, 127), st.integers(0, 127), st.booleans())
def test_an_identifier_has_29_bits_and_all_that_it_is_made_of(kind, robot, host, from_robot):
    number = identifier(kind, robot, host, from_robot)

    assert number < 1 << 29
    assert (number >> 18 & 255, number >> 17 & 1, number >> 10 & 127, number >> 3 & 127, number & 7) == (
        kind, from_robot, robot, host, 0,
    )  # fmt: skip


def test_a_stream_without_end_is_not_kept():
    segmenter, chance = Segmenter(3, 1, False), random.Random(1)

    for _ in range(200):
        segmenter.feed(bytes(chance.randrange(1, 256) for _ in range(100)))

        assert len(segmenter._tail) <= frames.FRAME_MAX
    assert segmenter.feed(b"\x00" + frames.encode(b"\x20\x20" + bytes(6)))
