"""The interrupt and error flags of an MCP2515, and the pin that tells of them.

Microchip DS20001801J, sections 6 and 7, tables 7-1 and register 6-3. ASSUMED: ERRIF cannot be cleared while its cause
is in EFLG (7.0 says so of every interrupt).
"""

from collections.abc import Callable

from hil_sim.devices.canerrors import PASSIVE_ABOVE, WARNING, Errors
from hil_sim.devices.mcp2515registers import CANINTE, CANINTF, EFLG

MERRF, WAKIF, ERRIF, TX0IF, RX1IF, RX0IF = 0x80, 0x40, 0x20, 0x04, 0x02, 0x01
RX1OVR, RX0OVR, TXBO, TXEP, RXEP, TXWAR, RXWAR, EWARN = 0x80, 0x40, 0x20, 0x10, 0x08, 0x04, 0x02, 0x01
CODES = (ERRIF, WAKIF, TX0IF, TX0IF << 1, TX0IF << 2, RX0IF, RX1IF)  # of interrupts, 1 to 7, table 7-1


class Flags:
    """CANINTF and EFLG in `registers`; `interrupted` is called when the level of INT has changed."""

    def __init__(self, registers: bytearray, errors: Errors, interrupted: Callable[[], None]) -> None:
        self._registers = registers
        self._errors = errors
        self._interrupted = interrupted
        self._level = 1

    def set(self, flags: int) -> None:
        """Set interrupt flags."""
        self._registers[CANINTF] |= flags
        self.tell()

    def clear(self, flags: int) -> None:
        """Clear interrupt flags."""
        self._registers[CANINTF] &= ~flags
        self.tell()

    def level(self) -> int:
        """Return the level of the INT pin: 0 while an interrupt that is enabled is pending."""
        return int(not self._registers[CANINTE] & self._registers[CANINTF])

    def code(self) -> int:
        """Return the code of the highest interrupt that is pending and enabled, 0 for none."""
        pending = self._registers[CANINTE] & self._registers[CANINTF]
        return next((code for code, flag in enumerate(CODES, 1) if pending & flag), 0)

    def note_errors(self) -> None:
        """Bring EFLG up to the error counters."""
        transmit, receive = self._errors.transmit, self._errors.receive
        rows = (
            (TXBO, self._errors.bus_off),
            (TXEP, transmit > PASSIVE_ABOVE),
            (RXEP, receive > PASSIVE_ABOVE),
            (TXWAR, transmit >= WARNING),
            (RXWAR, receive >= WARNING),
            (EWARN, max(transmit, receive) >= WARNING),
        )
        flags = sum(flag for flag, holds in rows if holds)
        self._registers[EFLG] = self._registers[EFLG] & (RX0OVR | RX1OVR) | flags
        self.tell()

    def tell(self) -> None:
        """Take up a change of the registers."""
        if self._registers[EFLG] & ~EWARN:
            self._registers[CANINTF] |= ERRIF
        if self._level != self.level():
            self._level = self.level()
            self._interrupted()
