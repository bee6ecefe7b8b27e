"""A record that outlives resets and power cuts: kept twice on the flash, the newer one counts.

A record is written over the older of its two files and read back, so that a cut in any instant leaves the one before
it whole. What is torn, damaged or of another version is never taken for a record. Nothing here may be called while a
coil is on: writing stops the processor for tens of milliseconds.

    store = Store(board.open, "settings", 1)
    store.write(b"...")
    store.read()
"""

import struct
from binascii import crc32

_HEAD = "<2sBxIH"  # mark, version, sequence, length
_HEAD_BYTES = struct.calcsize(_HEAD)
_MARK = b"sr"
_SEQUENCES = 1 << 30  # a flash is worn out long before, and a board's small integers end there


class Store:
    """One record by name; `open_file` is the board's `open`."""

    def __init__(self, open_file, name: str, version: int) -> None:
        self._open = open_file
        self._paths = (f"/{name}.0", f"/{name}.1")
        self._version = version

    def read(self) -> bytes | None:
        """Return the newest record of this version, or None."""
        records = self._records()
        newest = self._newest(records)
        return None if newest < 0 else records[newest][2]

    def damaged(self) -> bool:
        """Return whether something was written once of which nothing can be read."""
        return self.read() is None and any(self._raw(path) is not None for path in self._paths)

    def lost(self) -> bool:
        """Return whether there was a whole record once, of which nothing can be read: a torn first one was never whole.

        The second file is written only when the first is whole.
        """
        return self.read() is None and self._raw(self._paths[1]) is not None

    def write(self, payload: bytes) -> bool:
        """Make `payload` the record; False when the flash did not take it, and the record before it stands."""
        records = self._records()
        sequences = [record[1] if record else 0 for record in records]
        newest = self._newest(records)
        place = 1 - newest if newest >= 0 else 1 if sequences[1] < sequences[0] else 0
        sequence = 1 + max(sequences)
        body = struct.pack(_HEAD, _MARK, self._version, sequence, len(payload)) + payload
        try:
            with self._open(self._paths[place], "wb") as file:
                file.write(body + struct.pack("<I", crc32(body)))
        except OSError:
            return False
        return self._records()[place] == (self._version, sequence, payload)

    def _records(self) -> list:
        return [_record(self._raw(path)) for path in self._paths]

    def _newest(self, records: list) -> int:
        """Return which record of this version is the newest, -1: there is none."""
        newest = -1
        for place in range(2):
            record = records[place]
            if record and record[0] == self._version and (newest < 0 or record[1] > records[newest][1]):
                newest = place
        return newest

    def _raw(self, path: str) -> bytes | None:
        try:
            with self._open(path, "rb") as file:
                return file.read()
        except OSError:
            return None


def _record(raw: bytes | None) -> tuple | None:
    """Return (version, sequence, payload) of a file that holds a whole record, else None."""
    if raw is None or len(raw) < _HEAD_BYTES + 4:
        return None
    mark, version, sequence, length = struct.unpack(_HEAD, raw[:_HEAD_BYTES])
    end = _HEAD_BYTES + length
    if mark != _MARK or sequence >= _SEQUENCES or len(raw) != end + 4:
        return None
    if struct.unpack("<I", raw[end:])[0] != crc32(raw[:end]):
        return None
    return version, sequence, raw[_HEAD_BYTES:end]
