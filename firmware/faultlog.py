"""The last faults, kept over resets and power cuts.

They are written down only while no coil can be on, and not more often than the flash likes. A start of the firmware
is numbered by the starts that had something to write down, so that no start costs the flash anything by itself.

    faults = FaultLog(Store(board.open, "faults", VERSION), cause)
    faults.add(now_ms, codes.OVER_TEMPERATURE, 3, 1201, messages.TRIPPED)
"""

import struct

from protocol import messages

VERSION = 1
FAULTS_MAX = 16
_STARTS = 1 << 30  # numbers of starts; a board's small integers end there
KEEP_EVERY_MS = 2000  # at most, so that a fault that comes and goes does not wear out the flash


class FaultLog:
    """A ring of FAULTS_MAX faults in RAM and in a store; `cause` says what began this start, see CAUSES."""

    def __init__(self, store, cause: int) -> None:
        self._store = store
        self._cause = cause
        self._faults = []  # packed, oldest first
        kept = store.read() or b""
        self.start = 1
        if len(kept) % messages.FAULT_BYTES == 4:
            self.start = (struct.unpack("<I", kept[:4])[0] + 1) % _STARTS
            for at in range(4, len(kept), messages.FAULT_BYTES):
                self._faults.append(kept[at : at + messages.FAULT_BYTES])
            self._faults = self._faults[-FAULTS_MAX:]
        self.unkept = False  # whether there is something to write down
        self._kept_ms = -KEEP_EVERY_MS

    def add(self, now_ms: int, code: int, channel: int, value: int, state: int) -> None:
        """Take a fault; the oldest makes room."""
        if len(self._faults) == FAULTS_MAX:
            self._faults.pop(0)
        fault = (self.start, now_ms, code, channel, value, state, self._cause)
        self._faults.append(struct.pack(messages.FAULT, *fault))
        self.unkept = True

    def count(self) -> int:
        """Return how many there are."""
        return len(self._faults)

    def page(self, skip: int, most: int) -> bytes:
        """Return up to `most` faults, newest first, without the `skip` newest."""
        end = len(self._faults) - skip
        return b"".join([self._faults[i] for i in range(end - 1, max(-1, end - 1 - most), -1)])

    def clear(self) -> bool:
        """Forget them all; False when the flash did not take it."""
        self._faults = []
        return self._keep()

    def keep(self, now_ms: int) -> None:
        """Write down what is new, if it is time; only to be called while no coil can be on."""
        if self.unkept and now_ms - self._kept_ms >= KEEP_EVERY_MS:
            self._kept_ms = now_ms
            self._keep()  # a flash that does not take it is not asked again before the next fault

    def _keep(self) -> bool:
        self.unkept = False
        return self._store.write(struct.pack("<I", self.start) + b"".join(self._faults))
