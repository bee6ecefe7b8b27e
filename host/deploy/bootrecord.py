"""The boot record, which firmware/start.py reads to choose a slot: kept twice, the newest whole copy counts.

record = BootRecord.newest([board.read("/boot.0"), board.read("/boot.1")])
board.write(record.path, record.packed())
"""

from __future__ import annotations

import struct
from binascii import crc32
from collections.abc import Iterable
from dataclasses import dataclass, replace

COPIES = ("/boot.0", "/boot.1")
SLOTS = "ab"
CONFIRMED = NOWHERE = 255
TRIES = 3
_RECORD = struct.Struct("<2sBxIH4B")
_MARK, _VERSION, _FIELDS = b"sr", 1, 4
_SEQUENCES = 1 << 30  # as the board has it


@dataclass(frozen=True)
class BootRecord:
    """Which slot runs, how many tries it has left, where to fall back to, whether service was asked for."""

    sequence: int
    slot: int
    tries: int = CONFIRMED
    fallback: int = NOWHERE
    service: int = 0

    @classmethod
    def newest(cls, copies: Iterable[bytes | None]) -> BootRecord | None:
        """Return the newest whole record among the copies, or None."""
        return max(filter(None, map(_unpacked, copies)), key=lambda record: record.sequence, default=None)

    @property
    def path(self) -> str:
        """Return the file that this record is written to: over the older copy."""
        return COPIES[self.sequence & 1]

    @property
    def confirmed(self) -> bool:
        """Return whether the slot's program has been healthy once."""
        return self.tries == CONFIRMED

    def packed(self) -> bytes:
        """Return the bytes of the file."""
        values = (self.sequence, _FIELDS, self.slot, self.tries, self.fallback, self.service)
        body = _RECORD.pack(_MARK, _VERSION, *values)
        return body + struct.pack("<I", crc32(body))

    def trying(self, slot: int, fallback: int) -> BootRecord:
        """Return the record after this one that puts a slot on trial."""
        return replace(self, sequence=self.sequence + 1, slot=slot, tries=TRIES, fallback=fallback, service=0)


def _unpacked(raw: bytes | None) -> BootRecord | None:
    if raw is None or len(raw) != _RECORD.size + 4:
        return None
    body = raw[: _RECORD.size]
    mark, version, sequence, length, *fields = _RECORD.unpack(body)
    if (mark, version, length) != (_MARK, _VERSION, _FIELDS) or raw[_RECORD.size :] != struct.pack("<I", crc32(body)):
        return None
    return BootRecord(sequence, *fields) if sequence < _SEQUENCES and fields[0] < len(SLOTS) else None
