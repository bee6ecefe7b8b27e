"""The registers of the MCP2515: where they are, what may be written, what they hold after a reset.

Tables 11-1 and 11-2 of Microchip's data sheet DS20001801J with the registers' own tables (3-1 to 10-2), addresses and
bits also held against the Linux driver mcp251x.c. ASSUMED: those that the data sheet calls unknown after a reset hold
5Ah, so that nobody relies on them.
"""

from hil_sim.devices.canframe import DATA_MAX, Frame

BFPCTRL, TXRTSCTRL, CANSTAT, CANCTRL, TEC, REC = 0x0C, 0x0D, 0x0E, 0x0F, 0x1C, 0x1D
CNF3, CNF2, CNF1, CANINTE, CANINTF, EFLG = 0x28, 0x29, 0x2A, 0x2B, 0x2C, 0x2D
FILTERS, MASKS = (0x00, 0x04, 0x08, 0x10, 0x14, 0x18), (0x20, 0x24)
TX, RX = (0x30, 0x40, 0x50), (0x60, 0x70)  # TXBnCTRL and RXBnCTRL, each with its buffer behind it
SIDH, SIDL, EID8, EID0, DLC, D0 = range(1, 7)  # places in a buffer; those of a filter are one less
EXIDE, SRR, RTR = 0x08, 0x10, 0x40  # the first and second in SIDL, the third in DLC
UNKNOWN = 0x5A

READ_ONLY = {CANSTAT, TEC, REC, *(at + place for at in RX for place in range(SIDH, D0 + DATA_MAX))}
CONFIGURATION_ONLY = {*range(0x0C), *range(0x10, 0x1C), *range(0x20, 0x28), CNF1, CNF2, CNF3, TXRTSCTRL}
BIT_MODIFIABLE = {
    BFPCTRL, TXRTSCTRL, CANCTRL, CNF3, CNF2, CNF1, CANINTE, CANINTF, EFLG, *TX, *RX,
}  # fmt: skip
WRITABLE = {  # bits; all eight where nothing is said
    BFPCTRL: 0x3F,
    TXRTSCTRL: 0x07,
    CNF3: 0xC7,
    EFLG: 0xC0,
    RX[0]: 0x64,
    RX[1]: 0x60,
    **dict.fromkeys((at + SIDL - 1 for at in FILTERS), 0xEB),
    **dict.fromkeys((at + SIDL - 1 for at in MASKS), 0xE3),
    **dict.fromkeys((at + SIDL for at in TX), 0xEB),
    **dict.fromkeys((at + DLC for at in TX), 0x4F),
}


def after_reset() -> bytearray:
    """Return all registers as a reset leaves them."""
    registers = bytearray(0x80)
    registers[CANCTRL] = 0x87
    for at in FILTERS:
        registers[at : at + 4] = bytes(UNKNOWN & WRITABLE.get(at + place, 0xFF) for place in range(4))
    for at in (*TX, *RX):
        registers[at + SIDH : at + D0 + DATA_MAX] = bytes((UNKNOWN,)) * (DATA_MAX + DLC)
    for at in TX:
        registers[at + SIDL] &= WRITABLE[at + SIDL]
        registers[at + DLC] &= WRITABLE[at + DLC]
    return registers


def plain(address: int) -> int:
    """Return the register at an address: CANSTAT and CANCTRL show in every row."""
    address &= 0x7F
    return address & 0x0F if address & 0x0E == 0x0E else address


def frame_of(registers: bytearray, at: int) -> Frame:
    """Return the frame in the transmit buffer at `at`; a length beyond 8 goes out as it is, with 8 bytes."""
    high, low, eid8, eid0, dlc = registers[at + SIDH : at + D0]
    extended, remote, length = bool(low & EXIDE), bool(dlc & RTR), dlc & 0x0F
    base = high << 3 | low >> 5
    data = bytes(registers[at + D0 : at + D0 + min(DATA_MAX, length)])
    number = base << 18 | (low & 3) << 16 | eid8 << 8 | eid0 if extended else base
    return Frame(number, b"" if remote else data, extended, remote, length)


def identifier_bytes(frame: Frame) -> tuple[int, int, int, int]:
    """Return the identifier as SIDH, SIDL (without flags), EID8 and EID0; of a standard one the last two are 0."""
    base = frame.id >> 18 if frame.extended else frame.id
    low = frame.id & 0x3FFFF if frame.extended else 0
    return base >> 3, base << 5 & 0xE0 | low >> 16, low >> 8 & 0xFF, low & 0xFF


def store_frame(registers: bytearray, at: int, frame: Frame) -> None:
    """Put a frame into the receive buffer at `at`; data bytes that did not come keep what was there."""
    high, low, eid8, eid0 = identifier_bytes(frame)
    flag = EXIDE if frame.extended else SRR if frame.remote else 0
    dlc = frame.length | (RTR if frame.extended and frame.remote else 0)
    registers[at + SIDH : at + D0] = bytes((high, low | flag, eid8, eid0, dlc))
    registers[at + D0 : at + D0 + len(frame.data)] = frame.data
