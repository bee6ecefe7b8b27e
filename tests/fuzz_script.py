"""Bytes of a fuzzer, read as a script of what is to happen; what runs out reads as zeros."""

from protocol import frames

CRC, SESSION = 0x12345678, 77


class Script:
    """The rest of an input; it is false when nothing is left."""

    def __init__(self, data: bytes, crc: int = CRC, session: int = SESSION) -> None:
        self.crc, self.session = crc, session
        self._data = data
        self._at = 0

    def __bool__(self) -> bool:
        return self._at < len(self._data)

    def byte(self) -> int:
        """Return the next byte."""
        self._at += 1
        return self._data[self._at - 1] if self._at <= len(self._data) else 0

    def some(self, count: int = -1) -> bytes:
        """Return the next bytes, as many as the byte before them says, at most 236."""
        count = min(self.byte(), frames.PAYLOAD_MAX) if count < 0 else count
        self._at += count
        return self._data[self._at - count : self._at]

    def line(self) -> bytes:
        """Return a frame as the next bytes say: head, payload, and a valid CRC; in one of four cases with a node."""
        flags, kind, seq, ack = (self.byte() for _ in range(4))
        node = flags >> 4 if flags & frames.NODE else 0
        payload = self.some()
        return self.sealed(kind, payload, seq, ack, flags & (frames.RELIABLE | frames.SEALED), node)

    def sealed(self, kind: int, payload: bytes, seq: int = 0, ack: int = 0, flags: int = 0, node: int = 0) -> bytes:
        """Return a frame of the session, or an open one."""
        seed = self.crc if frames.is_open(kind) else frames.session_seed(self.crc, self.session)
        return frames.encode(frames.seal(kind, seq, ack, payload, seed, flags, node))
