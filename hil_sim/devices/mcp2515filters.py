"""Which receive buffer of an MCP2515 takes a frame: acceptance filters, masks, rollover, overflow.

Microchip DS20001801J, section 4.5 and the flow chart of figure 4-3; the modes RXM = 01 and 10 are those of revisions
up to G (register 4-1), which the newest calls reserved. ASSUMED: with the filters off (RXM = 11) FILHIT names the
buffer's first filter; data bytes that a frame does not have are not compared.
"""

from dataclasses import dataclass

from hil_sim.devices.canframe import Frame
from hil_sim.devices.mcp2515flags import RX0IF, RX0OVR, RX1IF, RX1OVR
from hil_sim.devices.mcp2515registers import (
    CANINTF,
    DLC,
    EFLG,
    EXIDE,
    FILTERS,
    MASKS,
    RTR,
    RX,
    SIDL,
    SRR,
    identifier_bytes,
    store_frame,
)

BUKT, RXRTR = 0x04, 0x08
ROLLED_OVER = 6
ANY, EXTENDED_ONLY, STANDARD_ONLY = 3, 2, 1
FILTERS_OF = ((0, 1), (2, 3, 4, 5))


@dataclass(frozen=True)
class Verdict:
    """The buffer that is concerned, the filter that let the frame pass, and whether the buffer was full."""

    buffer: int
    filter: int
    overflow: bool = False


def receive(registers: bytearray, frame: Frame) -> int:
    """Put a frame into the buffer that takes it and return that one's interrupt flag, 0 when none does."""
    flags = registers[CANINTF]
    verdict = choose(registers, frame, (bool(flags & RX0IF), bool(flags & RX1IF)))
    if verdict is None:
        return 0
    if verdict.overflow:
        registers[EFLG] |= RX1OVR if verdict.buffer else RX0OVR
        return 0
    at = RX[verdict.buffer]
    hit_bits = 7 if verdict.buffer else 1
    remote = RXRTR if frame.remote else 0
    registers[at] = registers[at] & ~(hit_bits | RXRTR) | verdict.filter & hit_bits | remote
    store_frame(registers, at, frame)
    return RX1IF if verdict.buffer else RX0IF


def rx_status(registers: bytearray) -> int:
    """Return what RX STATUS answers, figure 12-9: the buffers that are full, and the first one's message."""
    full = registers[CANINTF] & (RX0IF | RX1IF)
    if not full:
        return 0
    at = RX[0 if full & RX0IF else 1]
    hit = registers[at] & (1 if full & RX0IF else 7)
    rolled_over = 0 if full & RX0IF or hit > 1 else ROLLED_OVER
    low, length = registers[at + SIDL], registers[at + DLC]
    extended = bool(low & EXIDE)
    remote = bool(length & RTR if extended else low & SRR)
    return full << 6 | extended << 4 | remote << 3 | hit + rolled_over


def choose(registers: bytearray, frame: Frame, full: tuple[bool, bool]) -> Verdict | None:
    """Return what becomes of a frame; None when no filter lets it pass."""
    hit = _hit(registers, frame, 0)
    if hit is not None:
        if not full[0]:
            return Verdict(0, hit)
        if not registers[RX[0]] & BUKT:
            return Verdict(0, hit, overflow=True)
        return Verdict(1, hit, overflow=full[1])
    hit = _hit(registers, frame, 1)
    return None if hit is None else Verdict(1, hit, overflow=full[1])


def _hit(registers: bytearray, frame: Frame, buffer: int) -> int | None:
    """Return the lowest filter of a buffer that lets the frame pass."""
    mode = registers[RX[buffer]] >> 5 & 3
    if mode == ANY:
        return FILTERS_OF[buffer][0]
    if mode == (STANDARD_ONLY if frame.extended else EXTENDED_ONLY):
        return None
    have, compared = _compared(frame, mode)
    care = compared & int.from_bytes(registers[MASKS[buffer] : MASKS[buffer] + 4])
    for number in FILTERS_OF[buffer]:
        at = FILTERS[number]
        wanted = int.from_bytes(registers[at : at + 4])
        if bool(registers[at + 1] & EXIDE) == frame.extended and not (have ^ wanted) & care:
            return number
    return None


def _compared(frame: Frame, mode: int) -> tuple[int, int]:
    """Return what is held against the four bytes of a filter, and which of its bits.

    Of a standard frame the extended part is held against its first two data bytes.
    """
    have = int.from_bytes(bytes(identifier_bytes(frame)))
    if frame.extended:
        return have, 0xFFE3_FFFF
    if mode == STANDARD_ONLY:
        return have, 0xFFE0_0000
    data = frame.data[:2]
    return have | int.from_bytes(data.ljust(2, b"\0")), 0xFFE0_0000 | 0xFFFF & ~(0xFFFF >> 8 * len(data))
