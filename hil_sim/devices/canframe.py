"""A classic CAN frame and the bits it is on the wire.

Fields, stuffing and checksum are standard results (ISO 11898-1; Bosch, CAN Specification 2.0, 1991, part B). Held
against the 44 bits of a remote frame that figure 2-5 of Microchip's DS20001801J counts, and against the check value
that catalogues print for CRC-15/CAN.

    frame = Frame(0x123, b"\\x01\\x02")
    len(stuffed(head(frame))) + TAIL_BITS  # how long it is
"""

from dataclasses import dataclass

DATA_MAX = 8
STANDARD_MAX, EXTENDED_MAX = 0x7FF, 0x1FFF_FFFF
TAIL_BITS = 10  # after the checksum, never stuffed: its delimiter, the acknowledge slot and delimiter, end of frame
END_BITS = 7
INTERMISSION_BITS = 3
POLYNOMIAL = 0x4599
_RUN = 5  # equal bits after which one of the other kind is stuffed in


@dataclass(frozen=True)
class Frame:
    """A frame; `length` is the code of a remote frame, or one beyond 8 that some controllers let pass."""

    id: int
    data: bytes = b""
    extended: bool = False
    remote: bool = False
    length: int = -1  # as long as the data

    def __post_init__(self) -> None:
        limit = EXTENDED_MAX if self.extended else STANDARD_MAX
        if not 0 <= self.id <= limit:
            raise ValueError(f"identifier {self.id:#x}, at most {limit:#x}")
        if len(self.data) > DATA_MAX or (self.remote and self.data):
            raise ValueError(f"{len(self.data)} data bytes, at most {0 if self.remote else DATA_MAX}")
        if self.length < 0:
            object.__setattr__(self, "length", len(self.data))

    @property
    def arbitration(self) -> list[int]:
        """The bits it fights for the wire with; 0 is dominant, so the least list wins."""
        if not self.extended:
            return [*_bits(self.id, 11), int(self.remote), 0]
        return [*_bits(self.id >> 18, 11), 1, 1, *_bits(self.id, 18), int(self.remote)]


def head(frame: Frame) -> list[int]:
    """Return the bits from start of frame to the end of the checksum, without stuffing."""
    reserved = [0, 0] if frame.extended else [0]
    bits = [0, *frame.arbitration, *reserved, *_bits(frame.length, 4)]
    for byte in frame.data:
        bits += _bits(byte, 8)
    return bits + _bits(checksum(bits), 15)


def checksum(bits: list[int]) -> int:
    """Return the 15-bit CRC over unstuffed bits."""
    crc = 0
    for bit in bits:
        taken = bit ^ crc >> 14 & 1
        crc = crc << 1 & 0x7FFF
        if taken:
            crc ^= POLYNOMIAL
    return crc


def stuffed(bits: list[int]) -> list[int]:
    """Return the bits with one of the other kind after every five equal ones, stuffed ones included."""
    sent: list[int] = []
    run = 0
    for bit in bits:
        run = run + 1 if sent and bit == sent[-1] else 1
        sent.append(bit)
        if run == _RUN:
            sent.append(1 - bit)
            run = 1
    return sent


def length_bits(frame: Frame) -> int:
    """Return how many bit times it takes, end of frame included, the intermission not."""
    return len(stuffed(head(frame))) + TAIL_BITS


def _bits(value: int, count: int) -> list[int]:
    return [value >> place & 1 for place in range(count - 1, -1, -1)]
