"""A CAN frame, and the bits that a classic one is on the wire; those of CAN FD are in canbits.py.

Fields, stuffing and checksum are standard results (ISO 11898-1; Bosch, CAN Specification 2.0, 1991, part B). Held
against the 44 bits of a remote frame that figure 2-5 of Microchip's DS20001801J counts, and against the check value
that catalogues print for CRC-15/CAN.

    frame = Frame(0x123, b"\\x01\\x02")
    len(stuffed(head(frame))) + TAIL_BITS  # how long it is
"""

from dataclasses import dataclass

DATA_MAX = 8
FD_LENGTHS = (0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64)  # by their code
STANDARD_MAX, EXTENDED_MAX = 0x7FF, 0x1FFF_FFFF
TAIL_BITS = 10  # after the checksum, never stuffed: its delimiter, the acknowledge slot and delimiter, end of frame
END_BITS = 7
INTERMISSION_BITS = 3
POLYNOMIAL = 0x4599
_RUN = 5  # equal bits after which one of the other kind is stuffed in


@dataclass(frozen=True)
class Frame:
    """A frame; `length` is the code of a remote frame, or one beyond 8 that some controllers let pass.

    One of CAN FD (`fd`) has up to 64 bytes, `brs` if they go at the faster rate, `esi` from an error-passive node.
    """

    id: int
    data: bytes = b""
    extended: bool = False
    remote: bool = False
    length: int = -1  # as long as the data
    fd: bool = False
    brs: bool = False
    esi: bool = False

    def __post_init__(self) -> None:
        limit = EXTENDED_MAX if self.extended else STANDARD_MAX
        if not 0 <= self.id <= limit:
            raise ValueError(f"identifier {self.id:#x}, at most {limit:#x}")
        if self.remote if self.fd else self.brs or self.esi:
            raise ValueError("brs and esi are of CAN FD, which has no remote frames")
        if self.fd and len(self.data) not in FD_LENGTHS:
            raise ValueError(f"{len(self.data)} data bytes, CAN FD has {', '.join(map(str, FD_LENGTHS))}")
        if not self.fd and len(self.data) > (0 if self.remote else DATA_MAX):
            raise ValueError(f"{len(self.data)} data bytes, at most {0 if self.remote else DATA_MAX}")
        if self.length < 0:
            object.__setattr__(self, "length", FD_LENGTHS.index(len(self.data)))

    @property
    def arbitration(self) -> list[int]:
        """The bits it fights for the wire with; 0 is dominant, so the least list wins."""
        if not self.extended:
            return [*bits(self.id, 11), int(self.remote), 0]
        return [*bits(self.id >> 18, 11), 1, 1, *bits(self.id, 18), int(self.remote)]


def head(frame: Frame) -> list[int]:
    """Return the bits from start of frame to the end of the checksum, without stuffing."""
    reserved = [0, 0] if frame.extended else [0]
    begin = [0, *frame.arbitration, *reserved, *bits(frame.length, 4)]
    for byte in frame.data:
        begin += bits(byte, 8)
    return begin + bits(checksum(begin), 15)


def checksum(unstuffed: list[int]) -> int:
    """Return the 15-bit CRC over unstuffed bits."""
    return remainder(unstuffed, 15, POLYNOMIAL)


def remainder(dividend: list[int], width: int, polynomial: int, start: int = 0) -> int:
    """Return the CRC of that width over bits."""
    crc = start
    for bit in dividend:
        taken = bit ^ crc >> width - 1 & 1
        crc = crc << 1 & (1 << width) - 1
        if taken:
            crc ^= polynomial
    return crc


def stuffed(unstuffed: list[int]) -> list[int]:
    """Return the bits with one of the other kind after every five equal ones, stuffed ones included."""
    sent: list[int] = []
    run = 0
    for bit in unstuffed:
        run = run + 1 if sent and bit == sent[-1] else 1
        sent.append(bit)
        if run == _RUN:
            sent.append(1 - bit)
            run = 1
    return sent


def length_bits(frame: Frame) -> int:
    """Return how many bit times a classic frame takes, end of frame included, the intermission not."""
    return len(stuffed(head(frame))) + TAIL_BITS


def bits(value: int, count: int) -> list[int]:
    """Return the lowest bits of a number, the highest of them first."""
    return [value >> place & 1 for place in range(count - 1, -1, -1)]
