"""The record of everything that crossed the edge of a chip or came from outside, with its virtual time.

Two runs are the same if and only if their hashes are: every pin edge, bus transfer, conversion and UART byte goes in,
and so does each outside input (bytes from the host, faults). Kept entries can be read back; the hash needs none.

    journal = Journal(keep=True)
    journal.note(now_us, PIN, 3, b"\\x01")
    journal.trace_sha256()
"""

import hashlib
import marshal
from itertools import repeat

PIN, I2C_WRITE, I2C_READ, ADC, UART_SENT, UART_HEARD, FAULT, RESET, FLASH, SPI, PWM, CAN_SENT, CAN_HEARD = range(13)
KINDS = (
    "pin", "i2c write", "i2c read", "adc", "uart sent", "uart heard", "fault", "reset", "flash", "spi", "pwm",
    "can sent", "can heard",
)  # fmt: skip

Entry = tuple[int, int, int, bytes]
_BATCH = 4096


class Journal:
    """Entries (time_us, kind, which pin, chip or channel, data) in the order they happened."""

    def __init__(self, keep: bool = False) -> None:
        self.entries: list[Entry] = []
        self._keep = keep
        self._waiting: list[Entry] = []
        self._hash = hashlib.sha256()

    def note(self, time_us: int, kind: int, which: int, data: bytes) -> None:
        """Add one entry."""
        waiting = self._waiting
        waiting.append((time_us, kind, which, data))
        if len(waiting) >= _BATCH:
            self._settle()

    def trace_sha256(self) -> str:
        """Return the hash over all entries so far, in hexadecimal."""
        copy = self._hash.copy()
        copy.update(_encoded(self._waiting))
        return copy.hexdigest()

    def kept(self) -> list[Entry]:
        """Return all entries of a journal that was made to keep them."""
        self._settle()
        return self.entries

    def _settle(self) -> None:
        self._hash.update(_encoded(self._waiting))
        if self._keep:
            self.entries.extend(self._waiting)
        self._waiting = []


def _encoded(entries: list[Entry]) -> bytes:
    return b"".join(map(marshal.dumps, entries, repeat(2)))  # version 2 has no back references: equal entries, bytes
