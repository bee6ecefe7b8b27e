"""The published vectors hold for our own codec, read back from the file as a stranger would read them."""

import json
from pathlib import Path

import pytest

from docs import vectors
from protocol import canbus, frames, messages, secret

FILE = json.loads((Path(__file__).parents[1] / "docs" / "vectors.json").read_text(encoding="utf-8"))
BY_NAME = {message.name: message for message in messages.MESSAGES}


def octets(message, values):
    """Return values with what is left of the payload as bytes."""
    rest = [field.name for field in message.fields if field.letter == "s"]
    return {name: bytes.fromhex(value) if name in rest else value for name, value in values.items()}


def decoded(wire):
    """Return the frames that a receiver of the vectors' session finds, and what it dropped."""
    decoder = frames.Decoder(FILE["dictionary_crc"], FILE["session"])
    return decoder.feed(bytes.fromhex(wire)), decoder.dropped


@pytest.mark.parametrize("vector", FILE["messages"], ids=lambda vector: vector["message"])
def test_a_payload_is_packed_and_unpacked_as_it_is_published(vector):
    message = BY_NAME[vector["message"]]
    payload, values = bytes.fromhex(vector["payload"]), octets(message, vector["values"])

    assert message.number == vector["kind"]
    assert message.pack(**values) == payload
    assert message.unpack(payload) == tuple(values.values())


def test_every_message_has_vectors():
    assert {vector["message"] for vector in FILE["messages"]} == set(BY_NAME)


@pytest.mark.parametrize("vector", FILE["frames"], ids=lambda vector: vector["message"])
def test_a_frame_is_found_as_it_is_published(vector):
    (frame,), dropped = decoded(vector["wire"])

    assert (frame.flags, frame.kind, frame.seq, frame.ack, frame.node) == tuple(
        vector[name] for name in ("flags", "kind", "seq", "ack", "node")
    )
    assert frame.payload.hex() == vector["payload"]
    assert dropped == 0
    if vector["key"]:
        made = secret.tag(
            secret.prepared(bytes.fromhex(vector["key"])), vector["from_robot"], vector["number"], frame.body[:-8]
        )
        assert made == frame.body[-8:]


def test_the_frames_have_every_flag_and_every_seed_and_the_greatest_length():
    flags = {vector["flags"] for vector in FILE["frames"]}

    assert flags >= {0, frames.RELIABLE, frames.NODE, frames.RELIABLE | frames.SEALED, 7}
    assert len({vector["seed"] for vector in FILE["frames"]}) == 3
    assert max(len(vector["wire"]) // 2 for vector in FILE["frames"]) == frames.FRAME_MAX


@pytest.mark.parametrize("vector", FILE["refused"], ids=lambda vector: vector["why"])
def test_what_must_be_refused_is_dropped_and_counted(vector):
    assert decoded(vector["wire"]) == ([], 1)


@pytest.mark.parametrize("vector", FILE["streams"], ids=lambda vector: vector["why"])
@pytest.mark.parametrize("piece", [1, 7, 10_000])
def test_a_stream_holds_just_these_frames_and_stops(vector, piece):
    wire = bytes.fromhex(vector["wire"])
    decoder, finder = frames.Decoder(FILE["dictionary_crc"], FILE["session"]), frames.StopFinder()
    found, stops = [], 0
    for at in range(0, len(wire), piece):
        found += decoder.feed(wire[at : at + piece])
        stops += finder.feed(wire[at : at + piece])

    assert [frame.kind for frame in found] == [BY_NAME[name].number for name in vector["kinds"]]
    assert stops == vector["stops"] or (piece == 10_000 and bool(stops) == bool(vector["stops"]))


def test_the_key_of_a_session_its_proof_and_a_tag_are_as_published():
    (told,) = FILE["keys"]
    hello = messages.HELLO.unpack(bytes.fromhex(told["hello"]))
    pads = secret.prepared(bytes.fromhex(told["pairing_key"]))
    key = secret.session_key(pads, hello, told["nonce_a"], told["nonce_b"], told["dictionary_crc"])

    assert key == secret.prepared(bytes.fromhex(told["session_key"]))
    assert list(secret.proof(key)) == told["proof"]
    assert secret.tag(key, told["from_robot"], told["number"], bytes.fromhex(told["body"])).hex() == told["tag"]


@pytest.mark.parametrize("vector", FILE["can"], ids=lambda vector: f"{vector['message']} {vector['fd']}")
def test_can_frames_are_cut_and_put_together_as_they_are_published(vector):
    body, from_robot, fd = bytes.fromhex(vector["body"]), vector["from_robot"], vector["fd"]
    cutter = canbus.Segmenter(vector["robot"], vector["host"], from_robot, canbus.FD if fd else canbus.CLASSIC)
    joiner = canbus.Assembler(from_robot)

    cut = cutter.feed(frames.encode(body))
    *before, taken = [joiner.feed(frame.identifier, True, frame.data, 0, fd) for frame in cut]

    assert [frame.data.hex() for frame in cut] == vector["data"]
    assert {frame.identifier for frame in cut} == {vector["identifier"]}
    assert set(before) <= {None}
    assert (taken.robot, taken.host, taken.line) == (vector["robot"], vector["host"], frames.encode(body))


def test_the_vectors_are_the_same_each_time():
    assert vectors.text() == vectors.text()
