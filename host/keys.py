"""Pairing keys, each in a file of its own: 32 bytes and their CRC-32, as they also stand on the robot's flash.

Whoever can read the file can drive the robot, so it must be its owner's alone, and no command prints a key.

    make("circular.key")
    key = read("circular.key")
"""

from __future__ import annotations

import os
import stat
from binascii import crc32
from contextlib import suppress
from pathlib import Path

from host.errors import BadRequest
from protocol.secret import KEY_BYTES

FILE_BYTES = KEY_BYTES + 4
OTHERS = stat.S_IRWXG | stat.S_IRWXO


def make(path: str | Path) -> None:
    """Draw a key and write it where no file is yet, for this user alone; BadRequest when it cannot be."""
    key = os.urandom(KEY_BYTES)
    try:
        number = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    except FileExistsError:
        raise BadRequest(f"{path} is there already and stays as it is: name a file that is not") from None
    except OSError as error:
        raise BadRequest(f"key file {path}: {error.strerror}") from error
    try:
        with open(number, "wb") as file:
            file.write(packed(key))
    except OSError as error:
        with suppress(OSError):
            os.unlink(path)
        raise BadRequest(f"key file {path}: {error.strerror}") from error


def read(path: str | Path) -> bytes:
    """Return the key in a file; BadRequest when there is none, it is no key, or others may read it."""
    try:
        with open(path, "rb") as file:
            mode = os.fstat(file.fileno()).st_mode
            raw = file.read(FILE_BYTES + 1)
    except OSError as error:
        raise BadRequest(f"key file {path}: {error.strerror}; `softrig key new FILE` makes one") from error
    if os.name == "posix" and mode & OTHERS:
        raise BadRequest(f"key file {path} is open to others (mode {mode & 0o777:03o}): chmod 600 {path}")
    if len(raw) != FILE_BYTES or packed(raw[:KEY_BYTES]) != raw:
        raise BadRequest(f"{path} is no key file, or damaged: `softrig key new FILE` makes one")
    return raw[:KEY_BYTES]


def packed(key: bytes) -> bytes:
    """Return a key as files hold it."""
    return key + crc32(key).to_bytes(4, "little")
