"""The robot's pairing key, if it was given one: the file `/key`, 32 bytes and their CRC-32, which no order can read.

A robot with a key takes orders only in sessions whose frames carry tags made with it; one whose key is damaged takes
none at all, rather than being open to everybody. No two sessions have the same key, also not of two robots that share
one: the robot's part is made of the board's serial number, of the number of this start, which is written down before it
is first used, and of how many sessions it has begun.

    pairing = Pairing(board.open, board.serial)
    key = pairing.offer(hello, dictionary_crc)
"""

import struct
from binascii import crc32

from firmware.store import Store
from protocol import messages, secret

VERSION = 1
PATH = "/key"
FILE_BYTES = secret.KEY_BYTES + 4
STARTS = 1 << 30  # a flash is worn out long before, and a board's small integers end there


class Pairing:
    """The key of one robot; `secured` is what its `identity` says of it, see SECURED.

    Made once in a start, which it numbers then; without a number orders cannot be taken safely.
    """

    def __init__(self, open_file, serial: bytes) -> None:
        raw = _raw(open_file)
        key = b"" if raw is None else _key(raw)
        self.secured = messages.UNPAIRED if raw is None else messages.PAIRED if key else messages.KEY_DAMAGED
        self.nonce = self.proof = (0, 0)  # of the session that was offered last
        self._pads = secret.prepared(key)
        self._store = Store(open_file, "starts", VERSION)
        self._serial = serial
        self._start = 0
        self._begun = 0
        if self.secured == messages.PAIRED and not self._numbered():
            self.secured = messages.KEY_DAMAGED

    def offer(self, hello, dictionary_crc: int) -> bytes:
        """Return the key of the session that this hello asks for, b"" without a key; keep its nonce and proof."""
        if self.secured != messages.PAIRED:
            return b""
        self.nonce = secret.nonce(self._pads, self._serial, self._start, self._begun, hello)
        key = secret.session_key(self._pads, hello, self.nonce[0], self.nonce[1], dictionary_crc)
        self.proof = secret.proof(key)
        return key

    def session_begun(self) -> None:
        """Never make a key again that was made before: a session has begun."""
        self._begun += 1

    def _numbered(self) -> bool:
        """Write down the number of this start; False when the flash does not take it, or has lost the last one."""
        kept = self._store.read()
        if kept is None:
            kept = bytes(4)
            if self._store.lost() or not self._store.write(kept):  # so that no number that is used was the first record
                return False
        if len(kept) != 4:
            return False
        self._start = struct.unpack("<I", kept)[0] + 1
        return self._start < STARTS and self._store.write(struct.pack("<I", self._start))


def _raw(open_file) -> bytes | None:
    """Return what is in the file and a byte more than it may hold at most, or None when there is none."""
    try:
        with open_file(PATH, "rb") as file:
            return file.read(FILE_BYTES + 1)
    except OSError as error:
        return None if error.args[0] == 2 else b""  # 2: ENOENT; a file that cannot be read is a key all the same


def _key(raw: bytes) -> bytes:
    """Return the key in a file, b"" when it is damaged."""
    if len(raw) != FILE_BYTES or struct.unpack("<I", raw[secret.KEY_BYTES :])[0] != crc32(raw[: secret.KEY_BYTES]):
        return b""
    return raw[: secret.KEY_BYTES]
