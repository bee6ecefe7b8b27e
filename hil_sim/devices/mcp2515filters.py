"""Which receive buffer of an MCP2515 takes a frame: acceptance filters, masks, rollover, overflow.

Microchip DS20001801J, section 4.5 and the flow chart of figure 4-3; the modes RXM = 01 and 10 are those of revisions
up to G (register 4-1), which the newest calls reserved. ASSUMED: with the filters off (RXM = 11) FILHIT names the
buffer's first filter.
"""

from dataclasses import dataclass

from hil_sim.devices.canframe import Frame
from hil_sim.devices.mcp2515registers import EXIDE, FILTERS, MASKS, RX, identifier_bytes

BUKT = 0x04
ANY, EXTENDED_ONLY, STANDARD_ONLY = 3, 2, 1
FILTERS_OF = ((0, 1), (2, 3, 4, 5))


@dataclass(frozen=True)
class Verdict:
    """The buffer that is concerned, the filter that let the frame pass, and whether the buffer was full."""

    buffer: int
    filter: int
    overflow: bool = False


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
