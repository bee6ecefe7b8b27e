"""MCP2515: CAN controller behind SPI instructions, as Microchip's data sheet DS20001801J describes it.

This file is the SPI side: table 12-1 and section 12; the registers behind it are in mcp2515can.py. Kept faithfully,
because drivers trip over them: BIT MODIFY of a register that does not have it is a plain write; RXnIF goes with the
rise of CS after READ RX BUFFER; an instruction is over with CS, whatever is missing of it.

    chip = Mcp2515(clock, CanWire(clock))
    chip.select(True)
    chip.exchange(RESET)
    chip.select(False)

SPI is deaf for 128 clocks of the crystal after a reset (8.1, page 55, as Zephyr's mcp2515 driver and others quote it).
ASSUMED: MISO rests low, by the pull-down of the processor's pad, while nothing is clocked out; addresses wrap at 7Fh.
"""

from collections.abc import Callable

from hil_sim.clock import Clock
from hil_sim.devices.canwire import CanWire
from hil_sim.devices.mcp2515can import Mcp2515Can, Passed
from hil_sim.devices.mcp2515filters import rx_status
from hil_sim.devices.mcp2515flags import RX0IF, RX1IF
from hil_sim.devices.mcp2515registers import BIT_MODIFIABLE, D0, RX, SIDH, TX, plain

RESET, WRITE, READ, BIT_MODIFY, READ_STATUS, RX_STATUS = 0xC0, 0x02, 0x03, 0x05, 0xA0, 0xB0
READ_RX, LOAD_TX, RTS = 0x90, 0x40, 0x80
START_CLOCKS = 128
FLOATING = 0x00


class Mcp2515:
    """One chip on `wire`, its crystal of `crystal_hz`.

    `interrupted` is called when the level of INT has changed, `passed` with each frame that it has sent or heard.
    """

    rate_max_hz: int = 10_000_000
    modes: tuple[int, ...] = (0, 3)

    def __init__(
        self,
        clock: Clock,
        wire: CanWire,
        crystal_hz: int = 8_000_000,
        interrupted: Callable[[], None] = lambda: None,
        passed: Passed = lambda frame, outward: None,
    ) -> None:
        self._alive = True
        self.can = Mcp2515Can(clock, wire, crystal_hz, interrupted, passed)
        self._clock = clock
        self._start_us = -(-START_CLOCKS * 1_000_000 // crystal_hz)
        self._selected = False
        self._heard: list[int] = []  # the bytes of the present instruction
        self._deaf_until_us = clock.now_us + self._start_us

    @property
    def alive(self) -> bool:
        """Whether it works; one that does not is off the bus and answers nothing."""
        return self._alive

    @alive.setter
    def alive(self, alive: bool) -> None:
        """Let it die, or be replaced by a new one."""
        self._alive = alive
        self.reset()

    def reset(self) -> None:
        """Begin anew, as a power cycle does."""
        self.can.reset()
        self._deaf_until_us = self._clock.now_us + self._start_us

    def select(self, selected: bool) -> None:
        """Follow the CS pin, True for low; its rise ends an instruction."""
        if self._selected and not selected and self._heard and self._heard[0] & 0xF9 == READ_RX:
            self.can.flags.clear(RX1IF if self._heard[0] & 4 else RX0IF)
        self._selected = selected
        self._heard = []

    def exchange(self, byte: int) -> int:
        """Take one byte while selected and return the one that is clocked out meanwhile."""
        if not (self._selected and self._alive) or self._clock.now_us < self._deaf_until_us:
            return FLOATING
        self._heard.append(byte)
        said = self._say(self._heard[0], len(self._heard) - 1)
        self._take(self._heard[0], len(self._heard) - 1, byte)
        return said

    def int_level(self) -> int:
        """Return the level of the INT pin."""
        return self.can.flags.level() if self._alive else 1

    def _say(self, instruction: int, place: int) -> int:
        """Return what is clocked out under the byte at `place`, 0 being the instruction."""
        if instruction == READ and place >= 2:
            return self.can.load(self._heard[1] + place - 2)
        if instruction & 0xF9 == READ_RX and place >= 1:
            return self.can.load(RX[instruction >> 2 & 1] + (D0 if instruction & 2 else SIDH) + place - 1)
        if instruction == READ_STATUS and place >= 1:
            return self.can.status()
        return rx_status(self.can.registers) if instruction == RX_STATUS and place >= 1 else FLOATING

    def _take(self, instruction: int, place: int, byte: int) -> None:
        """Act on the byte at `place`."""
        if instruction == RESET:
            self.reset()
        elif instruction == WRITE and place >= 2:
            self.can.store(self._heard[1] + place - 2, byte)
        elif instruction == BIT_MODIFY and place == 3:
            self._modify(self._heard[1], self._heard[2], byte)
        elif LOAD_TX <= instruction < LOAD_TX + 6 and place >= 1:
            self.can.store(TX[instruction >> 1 & 3] + (D0 if instruction & 1 else SIDH) + place - 1, byte)
        elif instruction & 0xF8 == RTS and place == 0:
            for buffer in range(3):
                if instruction & 1 << buffer:
                    self.can.ask(buffer)

    def _modify(self, address: int, mask: int, byte: int) -> None:
        if plain(address) not in BIT_MODIFIABLE:
            mask = 0xFF
        self.can.store(address, self.can.load(address) & ~mask | byte & mask)
