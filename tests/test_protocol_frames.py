"""Bytes on the wire, frozen: made by hand from the rules on the protocol page, not by the codec they test."""

import random
from binascii import crc32

import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol import frames, messages

SEED = 0x12345678

# (name, flags, kind, seq, ack, fields, wire)
VECTORS = [
    ("hello", 0, 0x01, 0, 0, {"version": 1, "session": 0xDEADBEEF}, "031001010a01efbeaddef2c01d8000"),
    ("alive", 0, 0x10, 0, 5, {}, "0310100605b287389300"),
    (
        "arm", 1, 0x11, 0, 0, {"session": 0xDEADBEEF, "lease_ms": 500, "without": 5},
        "0311110108efbeaddef4010501010517ab3dda00",
    ),
    ("fire", 1, 0x14, 3, 7, {"coils": 1, "duty_permille": 600, "hold_ms": 500}, "0611140307010101095802f401354932ea00"),
    ("ok", 1, 0x40, 2, 4, {"request": 3}, "0a11400204032d97058200"),
    (
        "refused", 1, 0x41, 9, 4, {"request": 3, "code": 4, "channel": 0, "value": 900, "limit": 800},
        "07114109040304010384030103200301051934865c00",
    ),
    (
        "stopped", 0, 0x05, 0, 0, {"state": 4, "code": 101, "coils": 3, "now_ms": 10_000},
        "03100501030465020301010310270105 6a4e917300",
    ),
    (
        "event", 1, 0x51, 255, 1,
        {"event": 3, "code": 0, "step": 2, "channel": 255, "value": 0, "now_ms": 1_000_000},
        "061151ff010301020202ff0101010440420f05332bd62700",
    ),
    ("faults_request", 1, 0x17, 2, 1, {"skip": 8}, "0a1117020108fb8d7a3e00"),
    ("clear_faults", 1, 0x1B, 3, 1, {}, "09111b0301ec98910b00"),
    ("settings_request", 1, 0x19, 4, 1, {}, "091119040145da544700"),
    ("set", 1, 0x1A, 5, 2, {"setting": 2, "channel": 3, "value": 9400}, "09111a05020203b8240105602b8d3500"),
    ("calibrate", 1, 0x1C, 6, 4, {"session": 0xDEADBEEF, "without": 4}, "0a111c0604efbeadde040101050cef8a7f00"),
    (
        "faults", 1, 0x43, 6, 3,
        {"request": 2, "start": 5, "count": 1, "records": bytes.fromhex("0400000039650c00690003b30400000301")},
        "07114306030205010103010401010439650c02690403b30401070301300e6abd00",
    ),
    (
        "settings", 1, 0x44, 7, 5,
        {"request": 4, "source": 1, "node": 9, "board_offset_decidegc": -15, "resistances": b"\x00\x00\xb8\x24"},
        "0a11440705040109f1ff0107b824cb8ba01200",
    ),
]  # fmt: skip


def line(kind=0x14, payload=b"x", seq=0):
    return frames.encode(frames.seal(kind, seq, 0, payload, SEED, 0))


@pytest.mark.parametrize(("name", "flags", "kind", "seq", "ack", "fields", "wire"), VECTORS, ids=lambda v: str(v)[:12])
def test_the_bytes_of_a_message_are_frozen(name, flags, kind, seq, ack, fields, wire):
    message = messages.by_number(kind)
    expected = bytes.fromhex(wire)

    body = frames.seal(kind, seq, ack, message.pack(**fields), SEED, flags)
    (frame,) = frames.Decoder(SEED).feed(expected)

    assert message.name == name
    assert frames.encode(body).hex(" ") == expected.hex(" ")
    assert (frame.flags, frame.kind, frame.seq, frame.ack) == (flags, kind, seq, ack)
    assert message.unpack(frame.payload) == tuple(fields.values())


@given(st.binary(max_size=frames.PAYLOAD_MAX), st.integers(0x10, 255))
def test_any_payload_comes_back(payload, kind):
    (frame,) = frames.Decoder(SEED).feed(line(kind, payload))

    assert (frame.kind, frame.payload) == (kind, payload)


@given(st.binary(max_size=frames.PAYLOAD_MAX))
def test_the_only_zero_of_a_frame_is_its_last_byte_and_it_costs_one_byte(payload):
    body = frames.seal(0x14, 0, 0, payload, SEED, 0)

    wire = frames.encode(body)

    assert wire.index(0) == len(wire) - 1
    assert len(wire) == len(body) + 2


@given(st.binary(max_size=frames.PAYLOAD_MAX), st.binary(max_size=frames.PAYLOAD_MAX))
def test_no_stream_of_valid_frames_holds_the_stop_pattern(first, second):
    assert frames.STOP not in b"\x00" + line(payload=first) + line(payload=second)


def test_the_stop_pattern_is_shorter_than_the_shortest_frame():
    assert len(frames.STOP) - 2 < len(line(payload=b"")) - 1


def test_a_frame_sealed_with_another_dictionary_is_not_taken():
    decoder = frames.Decoder(SEED + 1)

    assert decoder.feed(line()) == []
    assert decoder.dropped == 1


def test_hello_is_taken_whatever_the_dictionary():
    assert len(frames.Decoder(SEED + 1).feed(line(kind=0x01))) == 1


@pytest.mark.parametrize(("kind", "taken"), [(0x01, True), (0x14, False)])
def test_of_another_version_only_unseeded_frames_are_taken(kind, taken):
    """A hello of any version must be answered; an order of another version must never be understood."""
    body = bytearray(frames.seal(kind, 0, 0, b"", SEED, 0))[:-4]
    body[0] = 0x20
    sealed = bytes(body) + crc32(bytes(body), 0 if kind < 0x10 else SEED).to_bytes(4, "little")

    assert (frames.unseal(sealed, SEED) is not None) == taken


def test_a_payload_that_is_too_long_is_refused_with_its_limit():
    with pytest.raises(ValueError, match="246 bytes, at most 245"):
        frames.seal(0x14, 0, 0, bytes(246), SEED, 0)


@given(st.binary(max_size=600), st.integers(1, 50))
def test_noise_never_raises_and_costs_at_most_the_frame_behind_it(noise, piece):
    decoder = frames.Decoder(SEED)
    stream = noise + line(payload=b"first") + line(payload=b"second")

    got = [frame for at in range(0, len(stream), piece) for frame in decoder.feed(stream[at : at + piece])]

    assert got[-1].payload == b"second"


@given(st.integers(0, 2**32))
def test_one_flipped_bit_never_yields_a_frame_that_was_not_sent(seed):
    chance = random.Random(seed)
    wire = bytearray(line(payload=bytes(chance.randbytes(40))))
    wire[chance.randrange(len(wire))] ^= 1 << chance.randrange(8)

    assert frames.Decoder(SEED).feed(bytes(wire) + b"\x00") == []


def test_an_endless_run_without_a_delimiter_keeps_memory_bounded():
    decoder = frames.Decoder(SEED)

    for _ in range(1000):
        decoder.feed(b"\x01" * 100)

    assert len(decoder._tail) <= frames.BODY_MAX + 1
    decoder.feed(b"\x00")
    assert len(decoder.feed(line())) == 1


@given(st.integers(0, 5))
def test_the_stop_pattern_is_found_also_in_pieces_and_in_the_middle_of_a_frame(cut):
    finder = frames.StopFinder()
    finder.feed(line()[:5])

    found = [finder.feed(frames.STOP[:cut]), finder.feed(frames.STOP[cut:])]

    assert any(found)
    assert not finder.feed(line())
