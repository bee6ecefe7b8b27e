"""The ASCII protocol of LAWICEL's CAN232 and its many descendants, as python-can's slcan interface speaks it.

After the commands and answers of LAWICEL's CAN232 manual, version 3, as public firmware quotes them; where python-can
reads them otherwise (S7 is 750 kbit/s, S9 83.3 kbit/s), it is followed. Received frames come by themselves, which
LAWICEL calls auto poll, without time-stamps; error frames do not exist, the flags of F tell of errors. What is not
understood is answered with BELL and changes nothing.

    adapter = Slcan(desk)
    adapter.take(b"S6\\rO\\rt1232AABB\\r")      # b"\\r\\rz\\r"
    adapter.told()                             # b"t7FF0\\r", and so on
"""

from collections.abc import Callable

from hil_sim.can.desk import CanDesk
from hil_sim.can.host import CanHost, Heard
from hil_sim.devices.canerrors import WARNING
from hil_sim.devices.canframe import DATA_MAX, Frame

OK, BELL = b"\r", b"\a"
RATES_HZ = (10_000, 20_000, 50_000, 100_000, 125_000, 250_000, 500_000, 750_000, 1_000_000, 83_300)
SJA1000_HZ = 8_000_000  # its clock, of which the s command counts
LINE_MAX = 1 + 8 + 1 + 2 * DATA_MAX
FULL, LOUD, OVERRUN, PASSIVE, ARBITRATION_LOST, BUS_ERROR = 0x02, 0x04, 0x08, 0x20, 0x40, 0x80  # flags of F
VERSION, SERIAL_NUMBER = b"V1013\r", b"NSR01\r"
DIGITS = frozenset(b"0123456789ABCDEFabcdef")
_IDENTIFIER = {"t": 3, "r": 3, "T": 8, "R": 8}  # how many digits it has


class Slcan:
    """One adapter on the bus of `desk`: closed until it is opened, at `bitrate_hz` unless told another rate."""

    def __init__(self, desk: CanDesk, bitrate_hz: int = 500_000) -> None:
        self.openings = 0
        self._desk = desk
        self._bitrate_hz = bitrate_hz
        self._host: CanHost | None = None
        self._line = bytearray()
        self._seen = [0, 0, 0]  # errors, losses and overruns that F has told of
        self._refused = False
        self._commands: dict[str, Callable[[str], bytes]] = {
            "S": self._rate, "s": self._registers, "O": self._open, "L": self._open, "C": self._close,
            "V": lambda text: VERSION, "v": lambda text: VERSION.lower(), "N": lambda text: SERIAL_NUMBER,
            "F": self._flags, "Z": self._only_off, "X": self._only_on,
            **dict.fromkeys(_IDENTIFIER, self._send),
        }  # fmt: skip

    def take(self, data: bytes) -> bytes:
        """Take bytes of the host; return the answers."""
        answers = []
        for byte in data:
            if byte != ord("\r"):
                if byte != ord("\n") and len(self._line) <= LINE_MAX:
                    self._line.append(byte)
                continue
            line = bytes(self._line)
            self._line.clear()
            answers.append(self._answer(line))
        return b"".join(answers)

    def told(self) -> bytes:
        """Return what has been received since the last time."""
        lines = []
        while self._host is not None and (happened := self._host.take()) is not None:
            if isinstance(happened, Heard) and not happened.own:
                lines.append(_line_of(happened.frame))
        return b"".join(lines)

    def close(self) -> None:
        """Leave the bus."""
        if self._host is not None:
            self._desk.leave(self._host)
            self._host = None

    def _answer(self, line: bytes) -> bytes:
        if not line:
            return OK
        command = self._commands.get(chr(line[0]))
        if command is None or len(line) > LINE_MAX or not set(line[1:]) <= DIGITS:
            return BELL
        return command(line.decode())

    def _rate(self, text: str) -> bytes:
        if self._host is not None or len(text) != 2 or not text[1].isdigit():
            return BELL
        self._bitrate_hz = RATES_HZ[int(text[1])]
        return OK

    def _registers(self, text: str) -> bytes:
        """Take bit timing as the registers BTR0 and BTR1 of an SJA1000."""
        if self._host is not None or len(text) != 5:
            return BELL
        btr0, btr1 = bytes.fromhex(text[1:])
        quanta = 1 + (btr1 & 0x0F) + 1 + (btr1 >> 4 & 7) + 1
        self._bitrate_hz = SJA1000_HZ // (((btr0 & 0x3F) + 1) * quanta)
        return OK

    def _open(self, text: str) -> bytes:
        if self._host is not None or len(text) != 1:
            return BELL
        self._host = self._desk.host(self._bitrate_hz, silent=text == "L")
        self.openings += 1
        self._seen, self._refused = [0, 0, 0], False
        return OK

    def _close(self, text: str) -> bytes:
        if self._host is None or len(text) != 1:
            return BELL
        self.close()
        return OK

    def _send(self, text: str) -> bytes:
        frame = _frame_of(text)
        if frame is None or self._host is None or self._host.silent:
            return BELL
        if not self._host.room:
            self._refused = True
            return BELL
        self._host.send(frame)
        return b"Z\r" if frame.extended else b"z\r"

    def _flags(self, text: str) -> bytes:
        """Return the status flags; those of single events only once."""
        host = self._host
        if host is None or len(text) != 1:
            return BELL
        now = [host.failures + host.damaged, host.losses, host.overruns]
        errors, losses, overruns = (count - seen for count, seen in zip(now, self._seen, strict=True))
        rows = (
            (FULL, self._refused),
            (LOUD, max(host.errors.transmit, host.errors.receive) >= WARNING),
            (OVERRUN, overruns > 0),
            (PASSIVE, host.errors.passive),
            (ARBITRATION_LOST, losses > 0),
            (BUS_ERROR, errors > 0),
        )
        self._seen, self._refused = now, False
        return b"F%02X\r" % sum(flag for flag, holds in rows if holds)

    def _only_off(self, text: str) -> bytes:
        return OK if text[1:] == "0" else BELL

    def _only_on(self, text: str) -> bytes:
        return OK if text[1:] == "1" else BELL


def _frame_of(text: str) -> Frame | None:
    """Return the frame of a command to send one, None when it is not well formed."""
    remote, extended = text[0] in "rR", text[0] in "TR"
    length_at = 1 + _IDENTIFIER[text[0]]
    if len(text) <= length_at or not text[length_at].isdigit():
        return None
    length = int(text[length_at])
    if length > DATA_MAX or len(text) != length_at + 1 + (0 if remote else 2 * length):
        return None
    try:
        number = int(text[1:length_at], 16)
        return Frame(number, bytes.fromhex(text[length_at + 1 :]), extended, remote, length if remote else -1)
    except ValueError:
        return None


def _line_of(frame: Frame) -> bytes:
    letter = ("R" if frame.extended else "r") if frame.remote else ("T" if frame.extended else "t")
    length = min(DATA_MAX, frame.length)
    return f"{letter}{frame.id:0{_IDENTIFIER[letter]}X}{length}{frame.data.hex().upper()}\r".encode()
