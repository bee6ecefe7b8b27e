"""The same 42 bytes in our frames and in those of others: a time, 18 words, two bytes; field values to bytes and back.

All give the values in the order of the fields, and get them back with their names.

MAVLink's RC_CHANNELS has just these fields. MAVLink and Cyphal are the packages pymavlink and pycyphal, at the lowest
layer that makes a whole frame. The Klipper-style block is written here from Klipper's document alone (message blocks,
variable length quantities: docs/Protocol.md, https://www.klipper3d.org/Protocol.html), with a table for the CRC.
"""

import struct
from collections import namedtuple
from functools import partial

from pycyphal.transport import MessageDataSpecifier, Priority, Timestamp
from pycyphal.transport.commons.high_overhead_transport import TransferCRC
from pycyphal.transport.serial._frame import SerialFrame
from pycyphal.transport.serial._stream_parser import StreamParser
from pymavlink.dialects.v20 import common as mavlink

from protocol import frames
from protocol.messages import Field, Message

WORDS = 18
LAYOUT = "<I18HBB"
NAMES = ("time_ms", *[f"word_{i}" for i in range(WORDS)], "count", "rssi")
Values = tuple[int, ...]  # in this order
Record = namedtuple("Record", NAMES)


def values(time_ms: int) -> Values:
    """Return what a record of that time holds."""
    return (time_ms, *[1000 + (time_ms * 7 + 13 * i) % 1000 for i in range(WORDS)], WORDS, 99)


class Softrig:
    """Our frames, sent as telemetry is."""

    name, pure = "softrig", True
    seed = 0x12345678
    message = Message(
        0x50, "same", *[Field(name, letter) for name, letter in zip(NAMES, "I" + WORDS * "H" + "BB", strict=True)],
    )  # fmt: skip

    def __init__(self) -> None:
        self._decoder = frames.Decoder(self.seed)

    def prepared(self, record: Values) -> Values:
        """Return a record in the order of the codec's arguments."""
        return record

    def encode(self, prepared: Values) -> bytes:
        """Return the frame."""
        message = self.message
        return frames.encode(frames.seal(message.number, 1, 2, message.packed(*prepared), self.seed, 0))

    def feed(self, data: bytes) -> list:
        """Return the records that these bytes complete."""
        return [self.message.unpack(frame.payload) for frame in self._decoder.feed(data)]

    def told(self, record) -> Values:
        """Return the values of a record that was received."""
        return tuple(record)


class Sink:
    """A file for pymavlink to write to."""

    def write(self, data: bytes) -> None:
        """Forget the data."""


class Mavlink:
    """The package pymavlink, with its CRC in C or in Python."""

    def __init__(self, pure: bool) -> None:
        self.name = "pymavlink without fastcrc" if pure else "pymavlink with fastcrc"
        self.pure = pure
        self._crc = mavlink._x25crc_slow if pure else mavlink._x25crc_fast
        self._mav = mavlink.MAVLink(Sink())
        self._mav.robust_parsing = True

    def prepared(self, record: Values) -> Values:
        """Return a record in the order of the message's arguments."""
        return (record[0], record[19], *record[1:19], record[20])

    def encode(self, prepared: Values) -> bytes:
        """Return the packet."""
        mavlink.x25crc = self._crc
        return self._mav.rc_channels_encode(*prepared).pack(self._mav)

    def feed(self, data: bytes) -> list:
        """Return the records that these bytes complete."""
        mavlink.x25crc = self._crc
        return [told for told in self._mav.parse_buffer(data) or () if told.get_type() == "RC_CHANNELS"]

    def told(self, record) -> Values:
        """Return the values of a record that was received."""
        words = [getattr(record, f"chan{i + 1}_raw") for i in range(WORDS)]
        return (record.time_boot_ms, *words, record.chancount, record.rssi)


class Cyphal:
    """The package pycyphal: a transfer of one frame on a serial line, with its CRC-32C and its header's CRC-16."""

    name, pure = "pycyphal", True

    def __init__(self) -> None:
        self._stamp = Timestamp.now()
        self._frames: list[SerialFrame] = []
        self._buffer = bytearray(256)
        self._specifier = MessageDataSpecifier(1234)
        self._parser = StreamParser(self._take, 256)

    def prepared(self, record: Values) -> Values:
        """Return a record as it is."""
        return record

    def encode(self, prepared: Values) -> bytes:
        """Return the frame."""
        payload = struct.pack(LAYOUT, *prepared)
        payload += TransferCRC.new(payload).value_as_bytes
        frame = SerialFrame(
            priority=Priority.NOMINAL, transfer_id=prepared[0], index=0, end_of_transfer=True,
            payload=memoryview(payload), source_node_id=1, destination_node_id=None, data_specifier=self._specifier,
            user_data=0,
        )  # fmt: skip
        return bytes(frame.compile_into(self._buffer))

    def feed(self, data: bytes) -> list:
        """Return the records that these bytes complete."""
        self._frames.clear()
        self._parser.process_next_chunk(data, self._stamp)
        whole = [frame.payload for frame in self._frames if TransferCRC.new(frame.payload).check_residue()]
        return [Record(*struct.unpack(LAYOUT, payload[:-4])) for payload in whole]

    def told(self, record: Values) -> Values:
        """Return the values of a record that was received."""
        return record

    def _take(self, stamp: Timestamp, raw: memoryview, frame: SerialFrame | None) -> None:
        if frame is not None:
            self._frames.append(frame)


def _crc_row(byte: int) -> int:
    for _ in range(8):
        byte = (byte >> 1) ^ (0x8408 if byte & 1 else 0)
    return byte


class KlipperStyle:
    """Length, sequence, fields as variable length quantities, CRC-16 CCITT, sync byte: after Klipper's document."""

    name, pure = "Klipper-style", True
    header, trailer, longest, sync, reserved = 2, 3, 64, 0x7E, 0x10
    number = 20
    table = tuple(_crc_row(byte) for byte in range(256))

    def __init__(self) -> None:
        self._received = b""

    def prepared(self, record: Values) -> Values:
        """Return a record as it is."""
        return record

    def encode(self, prepared: Values) -> bytes:
        """Return the message block."""
        return self.block((self.number, *prepared))

    def block(self, numbers: Values, sequence: int = 1) -> bytes:
        """Return the message block of a command's number and fields."""
        content = bytearray()
        for number in numbers:
            for shift, low, high in ((28, -(1 << 26), 3 << 26), (21, -(1 << 19), 3 << 19), (14, -(1 << 12), 3 << 12)):
                if not low <= number < high:
                    content.append(number >> shift & 0x7F | 0x80)
            if not -32 <= number < 96:
                content.append(number >> 7 & 0x7F | 0x80)
            content.append(number & 0x7F)
        block = bytes((len(content) + self.header + self.trailer, self.reserved | sequence & 15)) + content
        return block + self._crc(block).to_bytes(2, "big") + bytes((self.sync,))

    def feed(self, data: bytes) -> list:
        """Return the records that these bytes complete; after damage it goes on behind the next sync byte."""
        received = self._received + data
        records, at = [], 0
        while len(received) - at >= self.header + self.trailer:
            length = received[at]
            if not 5 <= length <= self.longest or received[at + 1] & 0xF0 != self.reserved:
                at = self._behind_sync(received, at)
            elif len(received) - at < length:
                break
            elif self._whole(received[at : at + length]):
                records.append(Record(*self._numbers(received[at + self.header : at + length - self.trailer])[1:]))
                at += length
            else:
                at = self._behind_sync(received, at)
        self._received = received[at:]
        return records

    def told(self, record: Values) -> Values:
        """Return the values of a record that was received."""
        return tuple(record)

    def _behind_sync(self, received: bytes, at: int) -> int:
        found = received.find(self.sync, at)
        return found + 1 if found >= 0 else len(received)

    def _whole(self, block: bytes) -> bool:
        return block[-1] == self.sync and self._crc(block[:-3]) == int.from_bytes(block[-3:-1], "big")

    def _numbers(self, content: bytes) -> list[int]:
        numbers, number, begun = [], 0, False
        for byte in content:
            if begun:
                number = number << 7 | byte & 0x7F
            else:
                number = byte & 0x7F if byte & 0x60 != 0x60 else byte & 0x7F | -0x80
            begun = byte & 0x80 != 0
            if not begun:
                numbers.append(number)
        return numbers

    def _crc(self, data: bytes) -> int:
        crc = 0xFFFF
        for byte in data:
            crc = crc >> 8 ^ self.table[(crc ^ byte) & 0xFF]
        return crc


CODECS = (Softrig, partial(Mavlink, pure=True), partial(Mavlink, pure=False), Cyphal, KlipperStyle)  # ours first
