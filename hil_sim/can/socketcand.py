"""One client of socketcand's protocol, as python-can's socketcand interface speaks it.

After doc/protocol.md and src/state_raw.c of linux-can/socketcand: `< open can0 >`, `< rawmode >`, `< send ... >`,
`< sendrtr ... >`, `< echo >`, and back frames, remote frames and error frames with their class. There is one bus, under
any name; of broadcast-manager mode only sending is there, and neither statistics, ISO-TP nor CAN FD, which the robots
do not know. What is not understood is answered with an error and changes nothing.

    client = Socketcand(desk)
    client.greeting                          # b"< hi >"
    client.take(b"< open can0 >")            # b"< ok >"
    client.told()                            # b"< frame 123 0.250000 AABB >"

python-can holds each of its first answers against a whole segment of TCP: frames are kept back for a moment after
`< rawmode >` so that none is glued to that answer.
"""

import re
from collections.abc import Callable

from hil_sim.can.desk import CanDesk
from hil_sim.can.host import CanHost, Heard, Trouble
from hil_sim.devices.canframe import DATA_MAX, Frame

OK = b"< ok >"
UNKNOWN = b"< error unknown command >"
SYNTAX = b"< error syntax >"
FULL = b"< error queue is full >"
PENDING_MAX = 512  # bytes without an end
HOLD_US = 100_000
_COMMAND = re.compile(rb"<([^<>]*)>")
_IDENTIFIER = re.compile(r"[0-9A-Fa-f]{1,3}|[0-9A-Fa-f]{8}")
_BYTE = re.compile(r"[0-9A-Fa-f]{1,2}")


class Socketcand:
    """One client: a controller of its own on the bus of `desk`, from `open` on."""

    greeting = b"< hi >"

    def __init__(self, desk: CanDesk, bitrate_hz: int = 500_000) -> None:
        self._desk = desk
        self._bitrate_hz = bitrate_hz
        self._host: CanHost | None = None
        self._raw = False
        self._from_us = 0
        self._pending = b""
        self._commands: dict[str, Callable[[list[str]], bytes]] = {
            "open": self._open,
            "rawmode": lambda words: self._mode(True),
            "bcmmode": lambda words: self._mode(False),
            "echo": lambda words: b"< echo >",
            "send": lambda words: self._send(_frame_of(words)),
            "sendrtr": lambda words: self._send(_frame_of(words, remote=True)),
        }

    def take(self, data: bytes) -> bytes:
        """Take bytes of the client; return the answers."""
        self._pending += data
        answers, end = [], 0
        for match in _COMMAND.finditer(self._pending):
            answers.append(self._answer(match.group(1).decode("latin-1").split()))
            end = match.end()
        self._pending = self._pending[end:]
        if len(self._pending) > PENDING_MAX:
            self._pending = b""
            answers.append(UNKNOWN)
        return b"".join(answers)

    def told(self) -> bytes:
        """Return what has happened on the bus since the last time."""
        if self._host is None or self._desk.clock.now_us < self._from_us:
            return b""
        told = []
        while (happened := self._host.take()) is not None:
            if self._raw and not (isinstance(happened, Heard) and happened.own):
                told.append(_told(happened))
        return b"".join(told)

    def close(self) -> None:
        """Leave the bus."""
        if self._host is not None:
            self._desk.leave(self._host)
            self._host = None

    def _answer(self, words: list[str]) -> bytes:
        command = self._commands.get(words[0]) if words else None
        if command is None or (self._host is None) != (words[0] == "open"):
            return UNKNOWN
        return command(words[1:])

    def _open(self, words: list[str]) -> bytes:
        if len(words) != 1:
            return SYNTAX
        self._host = self._desk.host(self._bitrate_hz)
        return OK

    def _mode(self, raw: bool) -> bytes:
        self._raw = raw
        self._from_us = self._desk.clock.now_us + HOLD_US
        return OK

    def _send(self, frame: Frame | None) -> bytes:
        """Send a frame, which is not answered."""
        if frame is None or self._host is None:
            return SYNTAX
        if not self._host.room:
            return FULL
        self._host.send(frame)
        return b""


def _frame_of(words: list[str], remote: bool = False) -> Frame | None:
    """Return the frame of an order to send one, None when it is not well formed."""
    if len(words) < 2 or not _IDENTIFIER.fullmatch(words[0]) or not words[1].isdecimal() or int(words[1]) > DATA_MAX:
        return None
    length, data = int(words[1]), words[2:]
    if len(data) != (0 if remote else length) or not all(_BYTE.fullmatch(byte) for byte in data):
        return None
    try:
        extended = len(words[0]) == 8
        return Frame(
            int(words[0], 16), bytes(int(byte, 16) for byte in data), extended, remote, length if remote else -1
        )
    except ValueError:
        return None


def _told(happened: Heard | Trouble) -> bytes:
    stamp = f"{happened.time_us // 1_000_000}.{happened.time_us % 1_000_000:06}"
    if isinstance(happened, Trouble):
        return f"< error {happened.kind:03X} {stamp} >".encode()
    frame = happened.frame
    number = f"{frame.id:08X}" if frame.extended else f"{frame.id:03X}"
    if frame.remote:
        return f"< rtr {number} {stamp} {frame.length} >".encode()
    return f"< frame {number} {stamp} {frame.data.hex().upper()} >".encode()
