"""Key files: made for one user alone, never made twice, and read with care."""

import json
import os
from binascii import crc32

import pytest

from host import keys
from host.errors import BadRequest


def test_a_new_key_is_for_its_user_alone_and_can_be_read(softrig, tmp_path):
    path = tmp_path / "robot.key"

    made = softrig("key", "new", str(path), "--json")

    raw = path.read_bytes()
    assert made.status == 0
    assert json.loads(made.out) == {"file": str(path)}
    assert path.stat().st_mode & 0o777 == 0o600
    assert keys.read(path) == raw[:32]
    assert int.from_bytes(raw[32:], "little") == crc32(raw[:32])


def test_no_umask_opens_a_new_key(tmp_path):
    before = os.umask(0)
    try:
        keys.make(tmp_path / "robot.key")
    finally:
        os.umask(before)

    assert (tmp_path / "robot.key").stat().st_mode & 0o777 == 0o600


def test_no_two_keys_are_the_same(tmp_path):
    for name in "ab":
        keys.make(tmp_path / name)

    assert keys.read(tmp_path / "a") != keys.read(tmp_path / "b")


def test_a_file_that_is_there_is_never_overwritten(softrig, tmp_path):
    path = tmp_path / "robot.key"
    path.write_bytes(b"another")

    made = softrig("key", "new", str(path))

    assert (made.status, path.read_bytes()) == (2, b"another")
    assert "is there already and stays as it is" in made.err


def test_a_place_that_cannot_be_written_is_told(tmp_path):
    with pytest.raises(BadRequest, match="No such file or directory"):
        keys.make(tmp_path / "none" / "robot.key")


@pytest.mark.parametrize("mode", [0o640, 0o604, 0o620, 0o666, 0o601])
def test_a_key_that_others_may_touch_is_refused(tmp_path, mode):
    path = tmp_path / "robot.key"
    keys.make(path)
    path.chmod(mode)

    with pytest.raises(BadRequest, match=rf"open to others \(mode {mode:o}\): chmod 600"):
        keys.read(path)


def test_a_key_that_is_not_there_is_told_with_what_makes_one(tmp_path):
    with pytest.raises(BadRequest, match="No such file or directory; `softrig key new FILE` makes one"):
        keys.read(tmp_path / "robot.key")


WHOLE = keys.packed(bytes(range(32)))


@pytest.mark.parametrize(
    "raw", [b"", WHOLE[:-1], WHOLE + b"\n", WHOLE[:5] + b"\xff" + WHOLE[6:], bytes(36), b"-----BEGIN OPENSSH"]
)
def test_what_is_no_key_is_refused(tmp_path, raw):
    path = tmp_path / "robot.key"
    path.write_bytes(raw)
    path.chmod(0o600)

    with pytest.raises(BadRequest, match="is no key file, or damaged"):
        keys.read(path)


def test_a_folder_is_no_key(tmp_path):
    with pytest.raises(BadRequest, match="Is a directory"):
        keys.read(tmp_path)
