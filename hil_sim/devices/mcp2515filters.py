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
    mask = registers[MASKS[buffer] : MASKS[buffer] + 4]
    for number in FILTERS_OF[buffer]:
        wanted = registers[FILTERS[number] : FILTERS[number] + 4]
        if bool(wanted[1] & EXIDE) == frame.extended and _meets(frame, wanted, mask, mode):
            return number
    return None


def _meets(frame: Frame, wanted: bytearray, mask: bytearray, mode: int) -> bool:
    """Compare under the mask; of a standard frame the extended part is held against its first two data bytes."""
    high, low, third, fourth = identifier_bytes(frame)
    if frame.extended:
        compared = (high, low, third, fourth)
    elif mode == STANDARD_ONLY:
        compared = (high, low, wanted[2], wanted[3])
    else:
        compared = (high, low, *(frame.data + bytes(wanted[2:4])[len(frame.data) :])[:2])
    bits = (mask[0], mask[1] & (0xE3 if frame.extended else 0xE0), mask[2], mask[3])
    return all((have ^ want) & care == 0 for have, want, care in zip(compared, wanted, bits, strict=True))
