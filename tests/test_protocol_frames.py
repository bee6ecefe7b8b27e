"""Bytes on the wire, frozen: made by hand from the rules on the protocol page, not by the codec they test."""

import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol import frames, messages

SEED = 0x12345678
SESSION = 0xDEADBEEF

# (name, flags, kind, seq, ack, fields, wire)
VECTORS = [
    (
        "hello", 0, 0x01, 0, 0,
        {"version": 2, "session": SESSION, "attach": 0, "nonce_a": 1, "nonce_b": 2},
        "032001010602efbeadde0101010201010102020101052634da2f00",
    ),
    (
        "alive", 0, 0x10, 0, 5,
        {"have": 5, "slots": 16, "bytes": 448},
        "03201003050501010810c001146aa7a700",
    ),
    (
        "arm", 1, 0x11, 0, 0,
        {"session": SESSION, "lease_ms": 500, "without": 5},
        "0321110108efbeaddef4010501010594f010be00",
    ),
    (
        "fire", 1, 0x14, 3, 7,
        {"coils": 1, "duty_permille": 600, "hold_ms": 500},
        "0621140307010101095802f4019a29cf7000",
    ),
    (
        "start", 1, 0x22, 4, 7,
        {"at_ms": 42, "paused": 0},
        "06212204072a010101053a47c8a400",
    ),
    (
        "ok", 1, 0x40, 2, 4,
        {"request": 3},
        "0a2140020403f4f6e69d00",
    ),
    (
        "refused", 1, 0x41, 9, 4,
        {"request": 3, "code": 4, "channel": 0, "value": 900, "limit": 800},
        "0721410904030401038403010320030105c01391b000",
    ),
    (
        "stopped", 0, 0x05, 0, 0,
        {"state": 4, "code": 101, "coils": 3, "now_ms": 10_000},
        "03200501030465020301010310270105bbef36bf00",
    ),
    (
        "event", 1, 0x4F, 255, 1,
        {"event": 3, "code": 0, "step": 2, "channel": 255, "value": 0, "now_ms": 1_000_000},
        "06214fff010301020202ff0101010440420f05f26d538400",
    ),
    (
        "telemetry", 0, 0x50, 7, 0,
        {"slot": 1, "form": 6, "count": 250, "now_ms": 70_000, "values": b"TUW"},
        "04205007070106fa70110108545557f633a64200",
    ),
    (
        "clock", 0, 0x5E, 1, 0,
        {"host_us": 1_000_000, "received_ms": 70_000, "sent_ms": 70_004},
        "04205e010440420f04701101047411010560bf1d6a00",
    ),
    (
        "subscribe", 1, 0x16, 5, 3,
        {"slot": 2, "period_ms": 10, "on_change": 1, "variables": b"\x01\x07"},
        "0721160503020a08010107041a607800",
    ),
    (
        "faults_request", 1, 0x17, 2, 1,
        {"skip": 8},
        "0a211702010822ec992100",
    ),
    (
        "clear_faults", 1, 0x1B, 3, 1,
        {},
        "09211b03013f2f733200",
    ),
    (
        "settings_request", 1, 0x19, 4, 1,
        {},
        "0921190401966db67e00",
    ),
    (
        "set", 1, 0x1A, 5, 2,
        {"setting": 2, "channel": 3, "value": 9400},
        "09211a05020203b824010549c60c5400",
    ),
    (
        "calibrate", 1, 0x1C, 6, 4,
        {"session": SESSION, "without": 4},
        "0a211c0604efbeadde04010105a38f77e500",
    ),
    (
        "faults", 1, 0x43, 6, 3,
        {"request": 2, "start": 5, "count": 1, "records": bytes.fromhex("0400000039650c00690003b30400000301")},
        "07214306030205010103010401010439650c02690403b3040107030131df277800",
    ),
]  # fmt: skip


def seed_of(kind):
    return SEED if 0x50 <= kind < 0x60 else frames.session_seed(SEED, SESSION)


def line(kind=0x14, payload=b"x", seq=0, flags=0, node=0):
    return frames.encode(frames.seal(kind, seq, 0, payload, seed_of(kind), flags, node))


def decoder_of(seed=SEED, session=SESSION):
    return frames.Decoder(seed, session)


@pytest.mark.parametrize(("name", "flags", "kind", "seq", "ack", "fields", "wire"), VECTORS, ids=lambda v: str(v)[:12])
def test_the_bytes_of_a_message_are_frozen(name, flags, kind, seq, ack, fields, wire):
    message = messages.by_number(kind)
    expected = bytes.fromhex(wire)

    body = frames.seal(kind, seq, ack, message.pack(**fields), seed_of(kind), flags)
    (frame,) = decoder_of().feed(expected)

    assert message.name == name
    assert frames.encode(body).hex(" ") == expected.hex(" ")
    assert (frame.flags, frame.kind, frame.seq, frame.ack) == (flags, kind, seq, ack)
    assert message.unpack(frame.payload) == tuple(fields.values())


@given(st.binary(max_size=frames.PAYLOAD_MAX), st.integers(0x10, 255))
def test_any_payload_comes_back(payload, kind):
    (frame,) = decoder_of().feed(line(kind, payload))

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
    decoder = decoder_of(SEED + 1)

    assert decoder.feed(line()) == []
    assert decoder.dropped == 1


def test_a_frame_of_another_session_is_not_taken_but_its_telemetry_is():
    """Whoever has the dictionary may read what is open; nobody can make an order for a session that is not his."""
    decoder = decoder_of(session=SESSION + 1)

    assert decoder.feed(line(kind=0x14)) == []
    assert len(decoder.feed(line(kind=0x50))) == 1


def test_a_session_that_is_offered_is_taken_and_marked():
    decoder = decoder_of(session=SESSION + 1)
    decoder.offer(SESSION)

    (frame,) = decoder.feed(line())

    assert frame.offered


def test_a_frame_for_a_node_carries_its_number_behind_the_head():
    wire = bytes.fromhex("072314030709010101095802f401f30cd0d600")
    payload = messages.FIRE.pack(coils=1, duty_permille=600, hold_ms=500)

    body = frames.seal(0x14, 3, 7, payload, seed_of(0x14), frames.RELIABLE, node=9)
    (frame,) = decoder_of().feed(wire)

    assert frames.encode(body).hex(" ") == wire.hex(" ")
    assert (frame.node, frame.payload) == (9, payload)


@pytest.mark.parametrize("flags", [frames.NODE, frames.SEALED, frames.NODE | frames.SEALED])
def test_a_frame_too_short_for_what_its_flags_promise_is_dropped(flags):
    body = bytes((2 << 4 | flags, 0x14, 0, 0))
    decoder = decoder_of()

    assert decoder.feed(frames.encode(frames.close(body, seed_of(0x14)))) == []
    assert decoder.dropped == 1


def test_a_frame_with_the_reserved_flag_is_dropped():
    assert decoder_of().feed(line(flags=frames.RESERVED)) == []


def test_hello_is_taken_whatever_the_dictionary():
    assert len(decoder_of(SEED + 1).feed(line(kind=0x01))) == 1


@pytest.mark.parametrize(("kind", "taken"), [(0x01, True), (0x14, False)])
def test_of_another_version_only_greetings_are_taken(kind, taken):
    """A hello of any version must be answered; an order of another version must never be understood."""
    body = bytes((0x30, kind, 0, 0))

    assert (decoder_of().feed(frames.encode(frames.close(body, seed_of(kind)))) != []) == taken


def test_a_payload_that_is_too_long_is_refused_with_its_limit():
    with pytest.raises(ValueError, match="237 bytes, at most 236"):
        frames.seal(0x14, 0, 0, bytes(237), SEED, 0)


@given(st.binary(max_size=600), st.integers(1, 50))
def test_noise_never_raises_and_costs_at_most_the_frame_behind_it(noise, piece):
    decoder = decoder_of()
    stream = noise + line(payload=b"first") + line(payload=b"second")

    got = [frame for at in range(0, len(stream), piece) for frame in decoder.feed(stream[at : at + piece])]

    assert got[-1].payload == b"second"


@given(st.integers(0, 2**32))
def test_one_flipped_bit_never_yields_a_frame_that_was_not_sent(seed):
    chance = random.Random(seed)
    wire = bytearray(line(payload=bytes(chance.randbytes(40))))
    wire[chance.randrange(len(wire))] ^= 1 << chance.randrange(8)

    assert decoder_of().feed(bytes(wire) + b"\x00") == []


def test_an_endless_run_without_a_delimiter_keeps_memory_bounded():
    decoder = decoder_of()

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
