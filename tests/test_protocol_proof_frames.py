"""Frames and messages: everything comes back, everything damaged is dropped, and soon all is well again."""

import random
from itertools import count, groupby

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from protocol import frames, messages
from protocol.canbus import CLASSIC, FD, UNDER_WAY_MAX, Assembler, Segmenter
from protocol.link import PAST_MAX, QUEUE_MAX, WINDOW, Link
from tests.damage import damaged
from tests.million import fuzz

CRC, SESSION = 0x12345678, 0xDEADBEEF
RANGES = {letter: (-(1 << bits - 1), (1 << bits - 1) - 1) for letter, bits in (("b", 8), ("h", 16), ("i", 32))}
RANGES |= {letter: (0, (1 << bits) - 1) for letter, bits in (("B", 8), ("H", 16), ("I", 32))}
REST = [b"", bytes(100), b"\xff" * 100, frames.STOP]
seeds = st.integers(0, 2**32)


def values_of(field):
    """Return a strategy for a field: its extremes, and what lies between."""
    if field.letter == "s":
        return st.one_of(st.sampled_from(REST), st.binary(max_size=150))
    low, high = RANGES[field.letter]
    return st.one_of(st.sampled_from([low, high, 0, 1]), st.integers(low, high))


def seed_of(kind):
    return CRC if frames.is_open(kind) else frames.session_seed(CRC, SESSION)


def some_lines(chance, many):
    """Return that many valid frames, each different from all others."""
    numbers = count()
    sizes = (0, 1, 9, 60, 228)
    return [
        frames.encode(
            frames.seal(0x14, 0, 0, next(numbers).to_bytes(4, "little") + chance.randbytes(chance.choice(sizes)),
                        seed_of(0x14), frames.RELIABLE, chance.choice((0, 0, 7)))
        )
        for _ in range(many)
    ]  # fmt: skip


@pytest.mark.parametrize("message", messages.MESSAGES, ids=lambda message: message.name)
@settings(max_examples=40)
@given(data=st.data())
def test_every_message_comes_back_with_every_extreme(message, data):
    fields = {field.name: data.draw(values_of(field), field.name) for field in message.fields}
    payload = message.pack(**fields)
    line = frames.encode(frames.seal(message.number, 255, 255, payload, seed_of(message.number), 0))

    (frame,) = frames.Decoder(CRC, SESSION).feed(line)

    assert tuple(message.unpack(frame.payload)) == tuple(fields.values())


@pytest.mark.parametrize("message", messages.MESSAGES, ids=lambda message: message.name)
def test_all_fields_at_their_lowest_and_highest_come_back_and_one_beyond_is_refused(message):
    for place in (0, 1):
        fields = {
            field.name: b"\xff" if field.letter == "s" else RANGES[field.letter][place] for field in message.fields
        }
        assert tuple(message.unpack(message.pack(**fields))) == tuple(fields.values())
        for field in message.fields:
            if field.letter != "s":
                beyond = RANGES[field.letter][place] + (1 if place else -1)
                with pytest.raises(ValueError, match=f"{field.name} {beyond}, must be"):
                    message.pack(**{**fields, field.name: beyond})


@pytest.mark.parametrize("message", messages.MESSAGES, ids=lambda message: message.name)
@settings(max_examples=30)
@given(payload=st.binary(max_size=120))
def test_any_payload_is_refused_or_is_exactly_what_its_fields_make(message, payload):
    try:
        row = message.unpack(payload)
    except ValueError:
        return

    names = [field.name for field in message.fields]
    assert message.pack(**dict(zip(names, row, strict=True))) == payload


@given(seeds, st.integers(1, 3), st.integers(1, 200))
def test_damage_costs_at_most_one_frame_more_than_it_touches(seed, damages, piece):
    chance = random.Random(seed)
    lines = some_lines(chance, 20)
    stream, touched = damaged(chance, lines, damages)
    decoder = frames.Decoder(CRC, SESSION)

    got = [frame for at in range(0, len(stream), piece) for frame in decoder.feed(stream[at : at + piece])]

    numbers = [int.from_bytes(frame.payload[:4], "little") for frame in got]
    lost = set(range(20)) - set(numbers)
    assert numbers == sorted(set(numbers))
    assert all(
        frames.encode(frames.close(frame.body, seed_of(0x14))) == lines[n]
        for frame, n in zip(got, numbers, strict=True)
    )
    assert len(lost - touched) <= damages
    assert lost - touched <= {number + 1 for number in touched}


@given(st.lists(st.binary(max_size=400), max_size=12), st.lists(st.integers(1, 300), min_size=1, max_size=12))
def test_what_the_decoder_makes_of_a_stream_does_not_depend_on_how_it_is_cut(noises, cuts):
    chance = random.Random(1)
    stream = b"".join(noise + line for noise, line in zip(noises, some_lines(chance, len(noises)), strict=True))
    whole, pieces = frames.Decoder(CRC, SESSION), frames.Decoder(CRC, SESSION)
    expected, got, at = whole.feed(stream + b"\x00"), [], 0

    while at < len(stream):
        cut = cuts[len(got) % len(cuts)]
        got += pieces.feed(stream[at : at + cut])
        at += cut

    assert got + pieces.feed(b"\x00") == expected
    assert pieces.dropped == whole.dropped


@given(st.lists(st.binary(max_size=2000), max_size=20), st.sampled_from([b"", b"k" * 128]))
def test_no_object_grows_whatever_arrives(pieces, key):
    decoder, link, finder = frames.Decoder(CRC, SESSION), Link(device=True), frames.StopFinder()
    link.begin(CRC, SESSION, key)
    segmenter = Segmenter(3, 1, False)

    for piece in pieces:
        for frame_number, line in enumerate(some_lines(random.Random(len(piece)), 20)):
            link.receive(line[:frame_number] + piece, 0)
        decoder.feed(piece)
        finder.feed(piece)
        segmenter.feed(piece)

    assert len(decoder._tail) <= frames.BODY_MAX + 1
    assert len(segmenter._tail) <= frames.BODY_MAX + 1
    assert len(finder._tail) < len(frames.STOP)
    assert len(link._ahead) < WINDOW
    assert len(link._posts) <= QUEUE_MAX
    assert len(link._past) <= PAST_MAX


@given(
    st.lists(st.tuples(st.integers(0, 2**29 - 1), st.binary(max_size=64), st.integers(0, 120)), max_size=120),
    st.booleans(),
)
def test_the_assembler_keeps_four_bodies_and_no_more(can_frames, fd):
    assembler, now_ms = Assembler(False), 0

    for number, data, passed_ms in can_frames:
        now_ms += passed_ms
        taken = assembler.feed(number & ~(1 << 17 | 7), True, data, now_ms, fd)
        assert taken is None or frames.BODY_MIN <= len(frames.decode(taken.line[:-1])) <= frames.BODY_MAX

        assert len(assembler._under_way) <= UNDER_WAY_MAX
        assert all(sum(map(len, each.pieces)) <= frames.BODY_MAX + FD for each in assembler._under_way)


@given(seeds, st.sampled_from([CLASSIC, FD]))
def test_on_can_a_lost_doubled_or_swapped_segment_costs_its_body_and_no_other(seed, mtu):
    """A body that is one segment may come twice, which is up to the link."""
    chance = random.Random(seed)
    bodies = [frames.decode(line[:-1]) for line in some_lines(chance, 8)]
    segmenter, assembler = Segmenter(3, 1, False, mtu), Assembler(False)
    cut = [segmenter.feed(frames.encode(body)) for body in bodies]
    hit = chance.randrange(8)
    place, what = chance.randrange(len(cut[hit])), chance.choice(("lose", "double", "swap"))
    cut[hit][place : place + 2] = {
        "lose": cut[hit][place + 1 : place + 2],
        "double": cut[hit][place : place + 1] * 2 + cut[hit][place + 1 : place + 2],
        "swap": cut[hit][place : place + 2][::-1],
    }[what]

    taken = [assembler.feed(*frame, 0, mtu == FD) for transfer in cut for frame in transfer]

    got = [body for body, _ in groupby(frames.decode(each.line[:-1]) for each in taken if each)]
    whole = [body for number, body in enumerate(bodies) if number != hit]
    assert got in (whole, bodies)


def test_of_twenty_thousand_fuzzed_frames_none_is_taken_that_was_not_sent():
    """`make fuzz` takes a million."""
    dropped, whole = fuzz(20_000)

    assert dropped > 5000
    assert whole > 1000
