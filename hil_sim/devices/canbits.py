"""The bits of a CAN frame on the wire, classic or FD, and how long they take at one or two bit rates.

A CAN-FD frame is stuffed as a classic one up to the end of its data; its checksum field then begins with the count of
those stuffed bits and has a stuffed bit of its own before each four bits. Fields and their lengths as in Linux,
include/linux/can/length.h; the count's Gray code and parity, the checksums' first register (ISO) and what they run
over as in CTU's CAN FD core, its reference model BitFrame.cpp; polynomials and check values as CRC catalogues print
them for CRC-17/CAN-FD and CRC-21/CAN-FD.

    bits_of(Frame(0x123, bytes(64), fd=True, brs=True)).duration_ns(count, bit_ns=2000, data_bit_ns=500)

The rate changes within two bits, at their sample points: BRS is counted as slow and the checksum's delimiter as fast,
whose sum is exact where both sample points lie at the same place of a bit.
"""

from dataclasses import dataclass
from functools import lru_cache

from hil_sim.devices.canframe import Frame, bits, head, remainder, stuffed

CRC_17, CRC_21 = (17, 0x1685B), (21, 0x102899)
SHORT_MAX = 16  # data bytes that the shorter checksum protects
_KEPT = 512


@dataclass(frozen=True)
class Bits:
    """Bits up to the end of the checksum, stuffed; `fast` are the places of those at the data bit rate.

    `format_bit` is the place of the one that says that this is CAN FD, 0 in a classic frame.
    """

    sent: tuple[int, ...]
    fast: range = range(0)
    format_bit: int = 0

    def duration_ns(self, count: int, bit_ns: int, data_bit_ns: int) -> int:
        """Return how long the first `count` bits take, those after the checksum included."""
        fast = max(0, min(count, self.fast.stop) - self.fast.start)
        return (count - fast) * bit_ns + fast * data_bit_ns


@lru_cache(_KEPT)
def bits_of(frame: Frame) -> Bits:
    """Return the bits of a frame."""
    return _flexible(frame) if frame.fd else Bits(tuple(stuffed(head(frame))))


def _flexible(frame: Frame) -> Bits:
    begin = [0, *frame.arbitration, 1]
    switch = [*begin, 0, int(frame.brs)]
    data = bits(int.from_bytes(frame.data), 8 * len(frame.data))
    unstuffed = [*switch, int(frame.esi), *bits(frame.length, 4), *data]
    sent = stuffed(unstuffed)
    if len(set(sent[-6:-1])) == 1:  # five equal bits end the data: the fixed one that follows is enough
        sent.pop()
    count = _counted(len(sent) - len(unstuffed))
    width, polynomial = CRC_17 if len(frame.data) <= SHORT_MAX else CRC_21
    crc = remainder([*sent, *count], width, polynomial, 1 << width - 1)
    for place, bit in enumerate([*count, *bits(crc, width)]):
        if place % 4 == 0:
            sent.append(1 - sent[-1])
        sent.append(bit)
    fast = range(len(stuffed(switch)), len(sent) + 1) if frame.brs else range(0)
    return Bits(tuple(sent), fast, len(stuffed(begin)) - 1)


def _counted(stuffed_bits: int) -> list[int]:
    """Return the count of stuffed bits, modulo 8, in Gray code with even parity."""
    low = stuffed_bits % 8
    gray = low ^ low >> 1
    return [*bits(gray, 3), gray.bit_count() % 2]
