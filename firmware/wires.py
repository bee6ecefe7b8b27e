"""The wires between robot and hosts: the serial line, and the CAN bus where there is a controller for it.

Both are listened to at once. What came in by one is given to the core by itself, a turn for each; a stop is taken from
any of them without waiting for its turn, and so is the word to start together. Answers to a greeting go where the
greeting came from, `stopped` goes everywhere, all else goes where the session's last valid frame came from.

    wires = Wires(board, core, board.can(node))
    wires.step(now_ms)
"""

from firmware.beacons import Beacons
from firmware.rates import Rates
from protocol.canbus import ALL, BYTE_NS, SYNC_LINE
from protocol.frames import GREETINGS_BELOW, STOP, StopFinder
from protocol.messages import STOPPED, SYNC

SERIAL = 0  # the source that is the serial line; any other is the node of a host on CAN
WAITING_MAX = 32  # bodies that came by CAN
SERIAL_MAX = 1024  # bytes that came by the serial line


class Wires:
    """The serial line of `board` and the CAN bus behind `port`, or None, with one core at their end."""

    def __init__(self, board, core, port) -> None:
        self.port = core.can = port
        self._board = board
        self._core = core
        self._beacons = Beacons(core, port) if port else None
        self._rates = Rates(board)
        self._asker = self._host = SERIAL  # who spoke last, and who holds the session
        self._finder = StopFinder()
        self._serial = b""
        self._taken = []

    def step(self, now_ms: int) -> None:
        """Let the core take one step with what has arrived, and send what it hands back."""
        core = self._core
        data = self.read(now_ms)
        core.link.byte_ns = self.byte_ns()
        self.write(core.step(now_ms, data, self.room()), core.link.heard_ms == now_ms)
        if (self._board.noise or self._rates.trying) and not self._serial:
            self._rates.look(now_ms, core.intact_ms == now_ms and self._asker == SERIAL, core.at_rest())
        if self._beacons:
            self._beacons.tell(now_ms)

    def read(self, now_ms: int) -> bytes:
        """Return what one source has sent; a stop first, whoever it came from."""
        data = self._board.read()
        if self.port is None:
            return data
        taken = self.port.take(now_ms)
        if not (data or taken or self._taken or self._serial):
            return data
        urgent = self._finder.feed(data)  # also where its halves come in two reads, and a body by CAN between them
        self._serial = (self._serial + data)[-SERIAL_MAX:]
        stop, word = STOP if urgent else b"", b""
        for body in taken:
            if body.host == ALL and body.line == STOP:
                stop = STOP
            elif body.kind == SYNC.number:
                word = b"\x00" + SYNC_LINE  # whatever half of a frame came before it
            elif body.host != SERIAL and len(self._taken) < WAITING_MAX:
                self._taken.append(body)
        return stop + word + self._turn(urgent)

    def room(self) -> int:
        """Return how many bytes `write` takes now."""
        room = self._room(self._asker)
        return max(room, self._room(self._host)) if self._core.session else room

    def byte_ns(self) -> int:
        """Return the time of a byte on its way from the host that spoke last."""
        return self._board.byte_ns if self._asker == SERIAL else BYTE_NS

    def write(self, data: bytes, heard: bool) -> None:
        """Send stuffed frames, each where it belongs; `heard`: what was read last held a valid frame of the session."""
        if heard:
            self._host = self._asker
        if self.port is None or not data:
            self._board.write(data)
            return
        serial = b""
        for stuffed in data.split(b"\x00"):
            if stuffed:
                serial += self._sent(_kind(stuffed), stuffed + b"\x00")
        if len(serial) <= self._board.room():
            self._board.write(serial)

    def _turn(self, urgent: bool) -> bytes:
        """Return what came from the next source, everything that waits of it."""
        if self._serial and (urgent or self._asker != SERIAL or not self._taken):
            self._asker = SERIAL
            data, self._serial = self._serial, b""
            return data
        if not self._taken:
            return b""
        lines = [b"\x00"] if self._asker == SERIAL else []  # ends what has come of a frame there
        self._asker = self._taken[0].host
        while self._taken and self._taken[0].host == self._asker:
            lines.append(self._taken.pop(0).line)
        return b"".join(lines)

    def _sent(self, kind: int, line: bytes) -> bytes:
        """Send a stuffed frame by CAN if it goes there; return what of it goes by the serial line."""
        if kind == STOPPED.number:
            self.port.put(line, ALL)
            return line
        goes_to = self._asker if kind < GREETINGS_BELOW else self._host
        if goes_to == SERIAL:
            return line
        self.port.put(line, goes_to)
        return b""

    def _room(self, source: int) -> int:
        return self._board.room() if source == SERIAL else self.port.room()


def _kind(stuffed: bytes) -> int:
    """Return the kind of a stuffed body: its second byte, which the stuffing may have taken away as a zero."""
    return stuffed[2] if len(stuffed) > 2 and stuffed[0] > 2 else 0
