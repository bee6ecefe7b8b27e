"""Test vectors for whoever writes a codec of his own: bytes and what they mean, made by ours.

    messages   payloads: the least, the greatest and some usual values of every field
    frames     whole frames: flags, node, session, pairing key, payload; the body and the bytes on the wire
    refused    bytes on the wire that a receiver of `dictionary_crc` and `session` must not take, and why
    streams    what arrives in one piece, and the kinds of the frames in it; whether it holds a stop
    keys       a pairing key, what was said, the key of the session, its proof and a tag
    can        bodies and the CAN frames that carry them, one after the other, as a sender's first

`values` has numbers; what is left of a payload is written in hexadecimal digits, like all bytes.
"""

import json
from collections.abc import Iterator
from typing import Any

from docs.definitions import Place, Row, rows
from protocol import canbus, frames, messages, secret

DICTIONARY_CRC = 0xC0FFEE42
SESSION = 0x12345678
PAIRING_KEY = bytes(range(32))
NONCES = (0x01020304, 0x05060708, 0xA1A2A3A4, 0xA5A6A7A8)  # host a, b; robot a, b
USUAL = 0x9ABCDEF0123
REST = bytes.fromhex("00 01 7f 80 ff 00 53 54 4f 50 00")  # with zeros, and with the stop pattern in it
Json = dict[str, Any]


def text() -> str:
    """Return the vectors as JSON, one vector a line."""
    parts = {
        "messages": list(payloads()),
        "frames": list(whole_frames()),
        "refused": list(refused()),
        "streams": list(streams()),
        "keys": [key()],
        "can": list(segments()),
    }
    head = {"version": frames.VERSION, "dictionary_crc": DICTIONARY_CRC, "session": SESSION, "stop": frames.STOP.hex()}
    lines = [f' "{name}": {json.dumps(value)},' for name, value in head.items()]
    for name, vectors in parts.items():
        body = ",\n".join("  " + json.dumps(vector) for vector in vectors)
        lines.append(f' "{name}": [\n{body}\n ]{"," if name != list(parts)[-1] else ""}')
    return "{\n" + "\n".join(lines) + "\n}\n"


def payloads() -> Iterator[Json]:
    """Yield the payloads of every message."""
    for row in rows():
        seen: list[dict[str, int | bytes]] = []
        for pick in (_least, _greatest, _usual):
            values = {place.name: pick(row, place) for place in row.fields}
            if values not in seen:
                seen.append(values)
                payload = message(row).pack(**values)
                yield {"message": row.name, "kind": row.number, "values": _plain(values), "payload": payload.hex()}


def message(row: Row) -> messages.Message:
    """Return the codec of a message."""
    return next(message for message in messages.MESSAGES if message.number == row.number)


def usual(name: str) -> bytes:
    """Return a payload of the message with that name."""
    row = next(row for row in rows() if row.name == name)
    return message(row).pack(**{place.name: _usual(row, place) for place in row.fields})


def frame(name: str, payload: bytes, flags: int, number: int, ack: int, node: int = 0, key: bytes = b"") -> Json:
    """Return a frame; `key` is that of the session, and `number` its seq counted on."""
    row = next(row for row in rows() if row.name == name)
    device = row.ways == "from"
    kind, seq = row.number, number & 255
    seed = _seed(kind)
    if key:
        covered = frames.head(kind, seq, ack, flags | frames.SEALED, node) + payload
        body = frames.close(covered + secret.tag(secret.prepared(key), device, number, covered), seed)
    else:
        body = frames.seal(kind, seq, ack, payload, seed, flags, node)
    return {
        "message": name, "kind": kind, "flags": body[0] & 15, "seq": seq, "ack": ack, "node": node, "seed": seed,
        "key": key.hex(), "from_robot": device, "number": number, "payload": payload.hex(), "body": body.hex(),
        "wire": frames.encode(body).hex(),
    }  # fmt: skip


def whole_frames() -> Iterator[Json]:
    """Yield frames of every sort: each kind of seed, each flag, the shortest, the longest, the worst for COBS."""
    yield frame("hello", usual("hello"), 0, 0, 0)
    yield frame("identity", usual("identity"), 0, 0, 0)
    yield frame("identity", usual("identity"), 0, 0, 0, node=9)
    yield frame("sync", b"", 0, 0, 0)
    yield frame("alive", usual("alive"), 0, 200, 7)
    yield frame("disarm", b"", frames.RELIABLE, 0, 0)
    yield frame("fire", usual("fire"), frames.RELIABLE, 3, 255)
    yield frame("fire", usual("fire"), frames.RELIABLE, 255, 0, node=126)
    yield frame("fire", usual("fire"), frames.RELIABLE, 3, 255, key=_session_key())
    yield frame("fire", usual("fire"), frames.RELIABLE, 259, 255, node=1, key=_session_key())
    yield frame("refused", usual("refused"), frames.RELIABLE, 70_000, 1, key=_session_key())
    yield frame("telemetry", usual("telemetry"), 0, 17, 0)
    for filling in (b"\x00", b"\x01", b"\xff"):
        yield frame("code", b"\x00\x00" + filling * (frames.PAYLOAD_MAX - 2), frames.RELIABLE, 1, 2)
    yield frame("code", b"\x00\x00" + b"\x01" * (frames.PAYLOAD_MAX - 2), frames.RELIABLE, 1, 2, 126, _session_key())


def refused() -> Iterator[Json]:
    """Yield what no receiver may take, with the reason."""
    whole = frame("fire", usual("fire"), frames.RELIABLE, 3, 255)
    body = bytes.fromhex(whole["body"])
    for at in range(len(body)):
        yield _refused(f"bit {at % 8} of byte {at} is flipped", _with(body, at, body[at] ^ 1 << at % 8))
    yield _refused("made for another session", _sealed(body[:-4], frames.session_seed(DICTIONARY_CRC, SESSION + 1)))
    yield _refused("made for another dictionary", _sealed(body[:-4], frames.session_seed(DICTIONARY_CRC + 1, SESSION)))
    yield _refused("sealed like a greeting", _sealed(body[:-4], 0))
    yield _refused("sealed like an open frame", _sealed(body[:-4], DICTIONARY_CRC))
    telemetry = bytes.fromhex(frame("telemetry", usual("telemetry"), 0, 17, 0)["body"])
    yield _refused("an open frame sealed like one of the session", _sealed(telemetry[:-4], _seed(whole["kind"])))
    yield _refused("of version 1", _sealed(_with(body, 0, 0x11)[:-4], _seed(whole["kind"])))
    yield _refused("with the reserved flag", _sealed(_with(body, 0, body[0] | frames.RESERVED)[:-4], _seed(body[1])))
    yield _refused("says that a node follows, and nothing does", _sealed(_head(frames.NODE), _seed(body[1])))
    yield _refused("says that a tag follows, and none does", _sealed(_head(frames.SEALED) + bytes(7), _seed(body[1])))
    yield _refused("one byte too short", body[:-1])
    yield _refused("no payload and half a CRC", body[:6])
    yield _refused("one byte too long", _sealed(body[:4] + b"\x01" * 246, _seed(body[1])))
    stuffed = frames.encode(body)
    for why, wire in (
        ("a run that ends beyond the frame", _with(stuffed, 0, 0xFE)),
        ("a last run that is cut", stuffed[:-2] + b"\x00"),
        ("nothing but a run of none", b"\x01\x00"),
        ("four bytes that are no stop", b"STOQ\x00"),
    ):
        yield {"why": why, "wire": wire.hex()}


def streams() -> Iterator[Json]:
    """Yield what a receiver may find on a line: frames after noise, frames around a stop, halves of frames."""
    fire = bytes.fromhex(frame("fire", usual("fire"), frames.RELIABLE, 3, 255)["wire"])
    hello = bytes.fromhex(frame("hello", usual("hello"), 0, 0, 0)["wire"])
    code = bytes.fromhex(frame("code", b"\x00\x00" + REST, frames.RELIABLE, 4, 255)["wire"])
    for why, wire, kinds, stops in (
        ("two frames", fire + hello, ["fire", "hello"], 0),
        ("zeros between frames mean nothing", b"\x00\x00" + fire + b"\x00" + hello, ["fire", "hello"], 0),
        ("noise costs the frame that it runs into", b"\xa5\x5a" + fire + hello, ["hello"], 0),
        ("half a frame costs no more than the next", fire[:9] + hello + hello, ["hello"], 0),
        ("a line that was open before the first frame", b"\xff" * 600 + b"\x00" + fire, ["fire"], 0),
        ("a stop", frames.STOP, [], 1),
        ("a stop in the middle of a frame", fire[:9] + frames.STOP + fire, ["fire"], 1),
        ("two stops that share a zero", frames.STOP + frames.STOP[1:], [], 2),
        ("a stop straight after a frame, whose zero it may use", fire + frames.STOP[1:] + hello, ["fire", "hello"], 1),
        ("the letters in a payload are no stop", code, ["code"], 0),
    ):
        yield {"why": why, "wire": wire.hex(), "kinds": kinds, "stops": stops}


def segments() -> Iterator[Json]:
    """Yield bodies in their CAN frames: classic and FD, both directions, the longest, and a padded one."""
    full = b"\x00\x00" + b"\x01" * (frames.PAYLOAD_MAX - 2)
    for name, payload, robot, host, mtu in (
        ("fire", usual("fire"), 3, canbus.HOST, canbus.CLASSIC),
        ("fire", usual("fire"), 126, 126, canbus.FD),
        ("code", full, 3, canbus.HOST, canbus.CLASSIC),
        ("code", full, 3, canbus.HOST, canbus.FD),
        ("telemetry", usual("telemetry"), 5, canbus.ALL, canbus.CLASSIC),
        ("identity", usual("identity"), 5, 7, canbus.FD),
        ("stopped", usual("stopped"), 5, canbus.ALL, canbus.CLASSIC),
        ("sync", b"", canbus.ALL, canbus.HOST, canbus.CLASSIC),
    ):
        sealed = frame(name, payload, 0, *((0, 0) if name == "sync" else (1, 2)))  # whose frame holds neither
        cutter = canbus.Segmenter(robot, host, sealed["from_robot"], mtu)
        cut = cutter.feed(bytes.fromhex(sealed["wire"]))
        yield {
            "message": name, "kind": sealed["kind"], "robot": robot, "host": host, "from_robot": sealed["from_robot"],
            "fd": mtu == canbus.FD, "body": sealed["body"], "identifier": cut[0].identifier,
            "data": [each.data.hex() for each in cut],
        }  # fmt: skip


def key() -> Json:
    """Return a session's key with all that it is made of, and what it makes."""
    session, (nonce_a, nonce_b) = _session_pads(), NONCES[2:]
    body = frames.head(0x14, 3, 255, frames.RELIABLE | frames.SEALED, 0) + usual("fire")
    return {
        "pairing_key": PAIRING_KEY.hex(), "hello": _hello().hex(), "nonce_a": nonce_a, "nonce_b": nonce_b,
        "dictionary_crc": DICTIONARY_CRC, "session_key": _session_key().hex(),
        "proof": list(secret.proof(session)), "body": body.hex(), "from_robot": False, "number": 259,
        "tag": secret.tag(session, False, 259, body).hex(),
    }  # fmt: skip


def _least(row: Row, place: Place) -> int | bytes:
    return b"" if place.letter == "s" else place.low


def _greatest(row: Row, place: Place) -> int | bytes:
    return b"\xff" * (frames.PAYLOAD_MAX - row.size) if place.letter == "s" else place.high


def _usual(row: Row, place: Place) -> int | bytes:
    return REST if place.letter == "s" else place.low + (USUAL >> place.offset % 5) % (place.high - place.low + 1)


def _plain(values: dict[str, int | bytes]) -> dict[str, int | str]:
    return {name: value.hex() if isinstance(value, bytes) else value for name, value in values.items()}


def _seed(kind: int) -> int:
    if kind < frames.GREETINGS_BELOW:
        return 0
    return DICTIONARY_CRC if frames.is_open(kind) else frames.session_seed(DICTIONARY_CRC, SESSION)


def _session_key() -> bytes:
    """Return the key of the session as 32 bytes, which `secret` hands out prepared only."""
    return bytes(byte ^ 0x36 for byte in _session_pads()[:32])


def _session_pads() -> bytes:
    hello = messages.HELLO.unpack(_hello())
    return secret.session_key(secret.prepared(PAIRING_KEY), hello, *NONCES[2:], DICTIONARY_CRC)


def _hello() -> bytes:
    host_a, host_b, *_ = NONCES
    return messages.HELLO.pack(version=frames.VERSION, session=SESSION, attach=0, nonce_a=host_a, nonce_b=host_b)


def _refused(why: str, body: bytes) -> Json:
    return {"why": why, "wire": frames.encode(body).hex()}


def _sealed(body: bytes, seed: int) -> bytes:
    return body + frames.crc32(body, seed).to_bytes(4, "little")


def _head(flags: int) -> bytes:
    return bytes((frames.VERSION << 4 | flags, 0x14, 3, 255))


def _with(body: bytes, at: int, byte: int) -> bytes:
    return body[:at] + bytes((byte,)) + body[at + 1 :]
