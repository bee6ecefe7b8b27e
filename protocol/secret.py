"""What a pairing key is used for: the key of a session, the tags of its frames, and numbers that nobody can foretell.

The key itself never crosses the wire. Both ends prove that they have it by the tags they make: HMAC-SHA256 (RFC 2104)
over direction, extended sequence number and frame, cut to its first eight bytes. Each use of a key begins with words
of its own, so that no value made for one purpose serves another.

    pads = prepared(key)
    session = session_key(pads, hello, identity.nonce_a, identity.nonce_b, identity.dictionary_crc)
    tag(session, False, 7, body)
"""

import struct
from hashlib import sha256

from protocol.frames import TAG_BYTES, VERSION

KEY_BYTES = 32
_BLOCK = 64
_INNER = int.from_bytes(b"\x36" * _BLOCK, "little")
_OUTER = int.from_bytes(b"\x5c" * _BLOCK, "little")


def prepared(key: bytes) -> bytes:
    """Return both pads of a key, one after the other, so that they are made only once; ValueError above 64 bytes."""
    if len(key) > _BLOCK:
        raise ValueError(f"key {len(key)} bytes, at most {_BLOCK}")
    number = int.from_bytes(key, "little")
    return (number ^ _INNER).to_bytes(_BLOCK, "little") + (number ^ _OUTER).to_bytes(_BLOCK, "little")


def hmac(pads: bytes, head: bytes, message: bytes = b"") -> bytes:
    """Return the 32 bytes of HMAC-SHA256 over `head` and `message`, by the pads of a key."""
    inner = sha256(pads[:_BLOCK])
    inner.update(head)
    inner.update(message)
    outer = sha256(pads[_BLOCK:])
    outer.update(inner.digest())
    return outer.digest()


def session_key(pads: bytes, hello, robot_a: int, robot_b: int, dictionary_crc: int) -> bytes:
    """Return the prepared key of the session that `hello` asked for; it is made of all that hello says."""
    said = struct.pack("<III", robot_a, robot_b, dictionary_crc)
    return prepared(hmac(pads, b"softrig session", _said(hello) + said))


def proof(session: bytes) -> tuple:
    """Return the two numbers by which the robot shows in its `identity` that it made the same key of the session."""
    return struct.unpack("<II", hmac(session, b"softrig proof")[:8])


def nonce(pads: bytes, serial: bytes, start: int, begun: int, hello) -> tuple:
    """Return two numbers that nobody without the key foretells, the same for the same hello said again.

    They are others on another board, in another start, and after another session of that start has begun.
    """
    told = struct.pack("<II", start, begun) + _said(hello) + serial
    return struct.unpack("<II", hmac(pads, b"softrig nonce", told)[:8])


def tag(session: bytes, device: bool, number: int, body: bytes) -> bytes:
    """Return the tag of a frame from the robot, or from its host; `body` is all of it that goes before the tag."""
    return hmac(session, struct.pack("<BI", device, number), body)[:TAG_BYTES]


def same(tag: bytes, other: bytes) -> bool:
    """Return whether two tags are the same; how long that takes tells nothing of where they differ."""
    differing = len(tag) ^ len(other)
    for i in range(min(len(tag), len(other))):
        differing |= tag[i] ^ other[i]
    return differing == 0


def _said(hello) -> bytes:
    return struct.pack("<BIIII", VERSION, hello.session, hello.attach, hello.nonce_a, hello.nonce_b)
