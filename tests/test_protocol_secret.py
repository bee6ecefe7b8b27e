"""HMAC-SHA256 of both ends, against the vectors of RFC 4231 and the standard library; tags and keys of sessions."""

import hmac
import random
import struct
import subprocess
from collections import namedtuple
from hashlib import sha256
from pathlib import Path

import pytest

from hil_sim.worlds.micropython import interpreter
from protocol import secret

Hello = namedtuple("Hello", ("session", "attach", "nonce_a", "nonce_b"))

# RFC 4231, section 4: key, data, HMAC-SHA-256 (cases 1 to 5; the others need keys that are longer than a block)
VECTORS = (
    (b"\x0b" * 20, b"Hi There", "b0344c61d8db38535ca8afceaf0bf12b881dc200c9833da726e9376c2e32cff7"),
    (b"Jefe", b"what do ya want for nothing?", "5bdcc146bf60754e6a042426089575c75a003f089d2739839dec58b964ec3843"),
    (b"\xaa" * 20, b"\xdd" * 50, "773ea91e36800e46854db8ebd09181a72959098b3ef8c122d9635514ced565fe"),
    (bytes(range(1, 26)), b"\xcd" * 50, "82558a389a443c0ea4cc819899f2083a85f0faa3e578f8077a2e3ff46729665b"),
    (b"\x0c" * 20, b"Test With Truncation", "a3b6167473100ee06e0c796c2955552b"),
)
ON_MICROPYTHON = """
import sys
sys.path.insert(0, {root!r})
from collections import namedtuple
from binascii import hexlify, unhexlify
from protocol import secret
for line in {lines!r}.split():
    key, message = [unhexlify(part) for part in line.split("-")]
    print(hexlify(secret.hmac(secret.prepared(key), message)).decode())
Hello = namedtuple("Hello", ("session", "attach", "nonce_a", "nonce_b"))
pads = secret.prepared(bytes(range(32)))
session = secret.session_key(pads, Hello(7, 1, 0xFFFFFFFF, 0x80000000), 4, 5, 0xDEADBEEF)
print(hexlify(secret.tag(session, True, 0xFFFFFFFF, b"body")).decode(), secret.proof(session))
"""


@pytest.mark.parametrize(("key", "data", "digest"), VECTORS)
def test_the_vectors_of_rfc_4231_come_out(key, data, digest):
    assert secret.hmac(secret.prepared(key), data).hex().startswith(digest)


def test_any_key_up_to_a_block_agrees_with_the_standard_library():
    generator = random.Random(1)

    for length in range(65):
        key, message = generator.randbytes(length), generator.randbytes(generator.randrange(300))

        assert secret.hmac(secret.prepared(key), message[:9], message[9:]) == hmac.digest(key, message, sha256)


def test_a_key_that_is_longer_than_a_block_is_a_mistake():
    with pytest.raises(ValueError, match="key 65 bytes, at most 64"):
        secret.prepared(bytes(65))


def test_a_tag_tells_direction_number_and_every_bit_of_the_body_apart():
    key = secret.session_key(secret.prepared(bytes(32)), Hello(1, 2, 3, 4), 5, 6, 7)
    frames = [(False, 7, b"\x01\x02"), (True, 7, b"\x01\x02"), (False, 263, b"\x01\x02")]
    frames += [(False, 7, (0x0201 ^ 1 << bit).to_bytes(2, "little")) for bit in range(16)]

    tags = {secret.tag(key, *frame) for frame in frames}

    assert len(tags) == len(frames)
    assert {len(tag) for tag in tags} == {secret.TAG_BYTES}


def test_every_word_of_both_greetings_makes_another_session_key():
    pads = secret.prepared(bytes(32))
    words = [1, 2, 3, 4, 5, 6, 7]
    said = [words] + [[word + (i == place) for i, word in enumerate(words)] for place in range(7)]

    keys = {secret.session_key(pads, Hello(*row[:4]), *row[4:]) for row in said}

    assert len(keys) == 8


def test_a_stranger_makes_the_same_of_what_the_document_says():
    """With the standard library alone: hello 2, 7, 0, 8, 9; the robot's numbers 4, 5; its dictionary 0xDEADBEEF."""
    key, hello = bytes(range(32)), Hello(7, 0, 8, 9)
    said = struct.pack("<BIIII", 2, 7, 0, 8, 9) + struct.pack("<III", 4, 5, 0xDEADBEEF)
    session = hmac.digest(key, b"softrig session" + said, sha256)

    made = secret.session_key(secret.prepared(key), hello, 4, 5, 0xDEADBEEF)

    assert made == secret.prepared(session)
    assert secret.proof(made) == struct.unpack("<II", hmac.digest(session, b"softrig proof", sha256)[:8])
    assert secret.tag(made, False, 258, b"body") == hmac.digest(session, b"\0\x02\x01\0\0body", sha256)[:8]


def test_a_tag_is_the_same_only_if_all_of_it_is():
    assert secret.same(b"12345678", b"12345678")
    assert not any(
        secret.same(b"12345678", other) for other in (b"12345679", b"02345678", b"1234567", b"", b"123456789")
    )


def test_a_nonce_is_another_on_each_board_in_each_start_after_each_session_and_for_each_hello():
    pads = secret.prepared(bytes(32))
    hellos = [Hello(session, attach, a, b) for session in (1, 2) for attach in (0, 1) for a in (0, 1) for b in (0, 1)]

    boards = [(serial, start, begun) for serial in (b"a", b"b") for start in (1, 2) for begun in (0, 1)]
    made = {secret.nonce(pads, *board, hello) for board in boards for hello in hellos}

    assert len(made) == 128
    assert secret.nonce(pads, *boards[0], hellos[0]) == secret.nonce(pads, *boards[0], hellos[0])


def test_micropython_makes_the_same_of_them(tmp_path):
    lines = " ".join(f"{key.hex()}-{data.hex()}" for key, data, _ in VECTORS)
    script = tmp_path / "secret.py"
    script.write_text(ON_MICROPYTHON.format(root=str(Path(__file__).parents[1]), lines=lines))

    said = subprocess.run([interpreter(), str(script)], capture_output=True, text=True, check=True).stdout.splitlines()

    hello = Hello(7, 1, 0xFFFFFFFF, 0x80000000)
    session = secret.session_key(secret.prepared(bytes(range(32))), hello, 4, 5, 0xDEADBEEF)
    ours = [secret.hmac(secret.prepared(key), data).hex() for key, data, _ in VECTORS]
    assert said == [*ours, f"{secret.tag(session, True, 0xFFFFFFFF, b'body').hex()} {secret.proof(session)}"]
