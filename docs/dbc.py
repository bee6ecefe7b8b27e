"""The DBC: what the frames of a CAN bus say, for cantools and every other tool that reads one.

A body travels in segments: the first shows its head, with the fields of the payload that fit whole into its last three
bytes; the others show bytes. Beacons, `sync` and the stop are whole. The identifiers are those of robot 1 and host 1;
the mask MASK leaves the two nodes out, so that the frames of every robot are found.

    cantools decode --frame-id-mask 0x1FFE0007 --no-strict docs/softrig.dbc
"""

from collections.abc import Iterator
from dataclasses import dataclass

from docs.definitions import Place, Row, enums, rows
from protocol import canbus, frames
from protocol.messages import SYNC

ROBOT, HOST = 1, canbus.HOST
MASK = 0x1FFFFFFF & ~(127 << 10 | 127 << 3)
EXTENDED = 1 << 31
HEAD_BITS = 8 + 8 * frames.HEAD_BYTES  # of a first segment, before the payload
BITS = 8 * canbus.CLASSIC


@dataclass(frozen=True)
class Signal:
    """One signal: `mark` says on which segments it stands (`M`: all, and it chooses)."""

    name: str
    start: int
    bits: int
    words: str
    mark: str = ""
    place: Place | None = None
    names: tuple[tuple[int, str], ...] = ()

    def line(self) -> str:
        """Return its row."""
        sign = "-" if self.place and self.place.signed else "+"
        scale, unit = (self.place.scale, self.place.unit) if self.place else (1, "")
        low, high = (self.place.low, self.place.high) if self.place else (0, (1 << self.bits) - 1)
        mark = f" {self.mark}" if self.mark else ""
        limits = f"[{low * scale:g}|{high * scale:g}]" if scale != 1 else f"[{low}|{high}]"
        return f' SG_ {self.name}{mark} : {self.start}|{self.bits}@1{sign} ({scale:g},0) {limits} "{unit}" Vector__XXX'


@dataclass(frozen=True)
class Message:
    """One CAN frame: `number` as a DBC has it, with the uppermost bit for an extended identifier."""

    number: int
    name: str
    size: int
    sender: str
    words: str
    signals: tuple[Signal, ...]


def text() -> str:
    """Return the DBC."""
    found = list(messages())
    lines = ['VERSION ""', "", "NS_ :", "", "BS_:", "", "BU_: host robot", ""]
    for message in found:
        lines += [f"BO_ {message.number} {message.name}: {message.size} {message.sender}"]
        lines += [signal.line() for signal in message.signals] + [""]
    for message in found:
        lines.append(f'CM_ BO_ {message.number} "{_quoted(message.words)}";')
        lines += [f'CM_ SG_ {message.number} {signal.name} "{_quoted(signal.words)}";' for signal in message.signals]
    lines.append("")
    for message in found:
        for signal in message.signals:
            names = " ".join(f'{number} "{name}"' for number, name in signal.names)
            lines += [f"VAL_ {message.number} {signal.name} {names} ;"] if names else []
    return "\n".join(lines) + "\n"


def messages() -> Iterator[Message]:
    """Yield every frame: the stop, then each message in each of its ways, by its number."""
    words = "Everything off, on every robot, at once. Whoever sends it, whoever hears it."
    yield Message(canbus.STOP_IDENTIFIER, "stop", len(canbus.STOP_DATA), "host", words, (_word(canbus.STOP_DATA),))
    for row in sorted(rows(), key=lambda row: row.number):
        for way in ("to", "from") if row.ways == "both" else (row.ways,):
            number = canbus.identifier(row.number, ROBOT, HOST, way == "from") | EXTENDED
            name = f"{row.name}_{way}_robot" if row.ways == "both" else row.name
            sender = "robot" if way == "from" else "host"
            yield Message(number, name, *_inside(row, sender))


def _inside(row: Row, sender: str) -> tuple[int, str, str, tuple[Signal, ...]]:
    """Return the size, the sender, the meaning and the signals of a message's frame."""
    if row.number == SYNC.number:
        return len(canbus.SYNC_DATA), sender, row.words, (_word(canbus.SYNC_DATA),)
    if row.number in canbus.BEACONS:
        return row.size, sender, row.words, tuple(_fields(row, 0, ""))
    return canbus.CLASSIC, sender, row.words, tuple(segment(row))


def _word(data: bytes) -> Signal:
    """Return the signal of a frame that is always the same."""
    word = data.decode()
    return Signal("word", 0, 32, f"Always the letters {word}.", names=((int.from_bytes(data, "little"), word),))


def segment(row: Row) -> Iterator[Signal]:
    """Yield the signals of a segment of a body."""
    yield Signal("counter", 0, 6, "Counts the segments that its sender sends.")
    yield Signal("last", 6, 1, "1: the body ends here.")
    yield Signal("first", 7, 1, "1: the body begins here.", "M")
    for at, name in enumerate(("reliable", "node", "sealed", "reserved")):
        yield Signal(f"flag_{name}", 8 + at, 1, f"The flag {1 << at} of the frame.", "m1")
    yield Signal("version", 12, 4, "Version of the protocol.", "m1")
    kind = Place("kind", "B", 0, "", None)
    yield Signal("kind", 16, 8, "The message's number.", "m1", kind, ((row.number, row.name),))
    yield Signal("seq", 24, 8, "Number of the frame.", "m1")
    yield Signal("ack", 32, 8, "The next reliable seq that the sender expects.", "m1")
    at = HEAD_BITS
    for signal in _fields(row, HEAD_BITS, "m1"):
        if signal.start + signal.bits > BITS:
            break
        yield signal
        at = signal.start + signal.bits
    for byte in range(at // 8, canbus.CLASSIC):
        yield Signal(f"head{byte}", 8 * byte, 8, "A byte of the payload, the tag or the CRC.", "m1")
    for byte in range(1, canbus.CLASSIC):
        yield Signal(f"byte{byte}", 8 * byte, 8, "A byte of the body.", "m0")


def _fields(row: Row, start: int, mark: str) -> Iterator[Signal]:
    """Yield the signals of the fields of a payload that begins at that bit, but for what is left of it."""
    taken = ("counter", "last", "first", "version", "kind", "seq", "ack") if mark else ()
    for place in row.fields:
        if place.size:
            name = f"{place.name}_told" if place.name in taken else place.name
            names = tuple(enums()[place.enum].items()) if place.enum else ()
            yield Signal(name, start + 8 * place.offset, 8 * place.size, place.words, mark, place, names)


def _quoted(words: str) -> str:
    return words.replace("`", "").replace('"', "'")
