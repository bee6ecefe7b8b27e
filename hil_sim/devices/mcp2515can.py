"""The CAN side of an MCP2515: its registers, modes, buffers, error flags and interrupts.

After Microchip's data sheet DS20001801J: buffers, requests, priorities, abort (section 3), reception (section 4; which
buffer takes a frame is in mcp2515filters.py), bit timing (5), error states (6), interrupts (7), modes (10). Kept
faithfully, because drivers trip over them: what may only be written in configuration mode is silently left alone
otherwise; normal and loopback mode are left only when nothing is pending; waking up leads to listen-only.

Of buffers of equal priority the highest number goes first (3.2, page 15, as public drivers quote it). RECALLED, no copy
of these pages at hand: ABTF is set by ABAT only (3.6); waking needs WAKIE (10.2.1). ASSUMED: a buffer that is pending
cannot be written; a chip asleep ignores REQOP; ERRIF cannot be cleared while its cause is in EFLG (7.0 says so of every
interrupt); TEC shows at most 255; TXnRTS pins have their pull-ups. DEVIATION: waking takes no time, but the frame that
wakes is not received. Not connected: TXnRTS, RXnBF, CLKOUT and SOF; their registers keep what is written.
"""

from collections.abc import Callable

from hil_sim.clock import Clock, Event
from hil_sim.devices import mcp2515registers as regs
from hil_sim.devices.canerrors import Errors
from hil_sim.devices.canframe import Frame, length_bits
from hil_sim.devices.canwire import CanWire
from hil_sim.devices.mcp2515filters import BUKT, receive
from hil_sim.devices.mcp2515flags import MERRF, RX0IF, RX1IF, TX0IF, WAKIF, Flags

NORMAL, SLEEP, LOOPBACK, LISTEN_ONLY, CONFIGURATION = (mode << 5 for mode in range(5))
REQOP, ABAT, ONE_SHOT = 0xE0, 0x10, 0x08  # in CANCTRL
ABTF, MLOA, TXERR, TXREQ, PRIORITY = 0x40, 0x20, 0x10, 0x08, 0x03  # in TXBnCTRL
BUKT1 = 0x02  # in RXB0CTRL
BUFFERS = range(3)
_COUNT_MAX = 255
Passed = Callable[[Frame, bool], None]  # a frame that has crossed the pins, outward or inward


class Mcp2515Can:
    """One chip on `wire`, with its interrupt `flags`; `interrupted` and `passed` are those of Mcp2515."""

    def __init__(
        self, clock: Clock, wire: CanWire, crystal_hz: int, interrupted: Callable[[], None], passed: Passed
    ) -> None:
        self.errors = Errors()
        self.silent = False
        self.bit_ns = 0
        self.data_bit_ns = 0  # a classic controller: it destroys frames of CAN FD as long as it may
        self._clock = clock
        self.wire = wire
        self._passed = passed
        self._crystal_hz = crystal_hz
        self.registers = regs.after_reset()
        self.flags = Flags(self.registers, self.errors, interrupted)
        self._loop_at: Event | None = None
        self.reset()
        wire.join(self)

    def reset(self) -> None:
        """Return to configuration mode and the registers of the data sheet."""
        if self._loop_at is not None:
            self._loop_at.cancel()
            self._loop_at = None
        self.registers[:] = regs.after_reset()
        self._sending: int | None = None  # the buffer whose frame is on the wire
        self._withdrawn = False  # its request was taken back meanwhile
        self._enter(CONFIGURATION)

    def load(self, address: int) -> int:
        """Return the register at an address."""
        register = regs.plain(address)
        if register == regs.CANSTAT:
            return self.mode | self.flags.code() << 1
        if register in (regs.TEC, regs.REC):
            return min(_COUNT_MAX, self.errors.transmit if register == regs.TEC else self.errors.receive)
        if register == regs.TXRTSCTRL:
            return self.registers[register] | (~self.registers[register] & 7) << 3
        return self.registers[register]

    def store(self, address: int, value: int) -> None:
        """Write the register at an address, as far as it may be written now."""
        register = regs.plain(address)
        if register in regs.READ_ONLY or (register in regs.CONFIGURATION_ONLY and self.mode != CONFIGURATION):
            return
        buffer, place = (register >> 4) - (regs.TX[0] >> 4), register & 0x0F
        if register == regs.CANCTRL:
            self._control(value)
        elif buffer in BUFFERS and place == 0:
            self._store_request(buffer, value)
        elif buffer not in BUFFERS or not self._pending(buffer):
            writable = regs.WRITABLE.get(register, 0xFF)
            self.registers[register] = self.registers[register] & ~writable | value & writable
            if register == regs.RX[0]:
                self.registers[register] = self.registers[register] & ~BUKT1 | (value & BUKT) >> 1
            self._wake_if_told()
            self.flags.tell()

    def ask(self, buffer: int) -> None:
        """Request that a buffer be sent."""
        if buffer == self._sending:
            self._withdrawn = False
        if not self._pending(buffer):
            at = regs.TX[buffer]
            self.registers[at] = self.registers[at] & PRIORITY | TXREQ
            self.wire.request()
            self._loop()

    def status(self) -> int:
        """Return what READ STATUS answers, figure 12-8."""
        flags = self.registers[regs.CANINTF]
        status = flags & (RX0IF | RX1IF)
        for buffer in BUFFERS:
            status |= self._pending(buffer) << 2 + 2 * buffer | bool(flags & TX0IF << buffer) << 3 + 2 * buffer
        return status

    def offered(self) -> Frame | None:
        """Return the frame to send next: of the highest priority, of equal ones the highest buffer."""
        buffer = self._next()
        blocked = self.mode != NORMAL or self.registers[regs.CANCTRL] & ABAT
        return None if buffer is None or blocked else regs.frame_of(self.registers, regs.TX[buffer])

    def edge(self) -> None:
        """Wake up from sleep, if that is enabled; the frame that does it is not received."""
        if self.mode == SLEEP:
            self.flags.set(WAKIF)
            self._wake_if_told()

    def began(self) -> None:
        """Remember which buffer is on the wire."""
        self._sending, self._withdrawn = self._next(), False

    def lost(self) -> None:
        """Say so in the buffer; it tries again unless it has one shot."""
        buffer = self._next()
        if buffer is not None:
            self._flag(buffer, MLOA)
            if self.registers[regs.CANCTRL] & ONE_SHOT:
                self._done(buffer)

    def sent(self) -> None:
        """Take the request back and interrupt."""
        if self._sending is not None:
            self._passed(regs.frame_of(self.registers, regs.TX[self._sending]), True)
        self._settle()

    def _settle(self) -> None:
        buffer, self._sending = self._sending, None
        if buffer is not None:
            self.flags.note_errors()
            self._done(buffer)
            self.flags.set(TX0IF << buffer)

    def failed(self) -> None:
        """Say so in the buffer; it tries again unless it has one shot or was aborted meanwhile."""
        buffer, self._sending = self._sending, None
        self.flags.note_errors()
        self.flags.set(MERRF)
        if buffer is not None:
            control = self.registers[regs.CANCTRL]
            self._flag(buffer, TXERR | (ABTF if control & ABAT else 0))
            if control & (ABAT | ONE_SHOT) or self._withdrawn:
                self._done(buffer)

    def heard(self, frame: Frame) -> None:
        """Put a frame into the buffer whose filters let it pass, or note that this one is full."""
        self._passed(frame, False)
        self._receive(frame)

    def _receive(self, frame: Frame) -> None:
        self.flags.note_errors()
        self.flags.set(receive(self.registers, frame))

    def garbled(self) -> None:
        """Note a damaged frame."""
        self.flags.note_errors()
        self.flags.set(MERRF)

    def recovered(self) -> None:
        """Be error-active again."""
        self.flags.note_errors()

    def _store_request(self, buffer: int, value: int) -> None:
        """Take TXBnCTRL: the priority, and a request or its withdrawal, which leaves a frame on the wire alone."""
        at = regs.TX[buffer]
        self.registers[at] = self.registers[at] & ~PRIORITY | value & PRIORITY
        if value & TXREQ:
            self.ask(buffer)
        elif buffer == self._sending:
            self._withdrawn = True
        elif self._pending(buffer):
            self._done(buffer)

    def _control(self, value: int) -> None:
        """Take CANCTRL: mode, aborts, one-shot."""
        self.registers[regs.CANCTRL] = value
        for buffer in BUFFERS:
            if value & ABAT and self._pending(buffer) and buffer != self._sending:
                self._flag(buffer, ABTF)
                self._done(buffer)
        self._change_mode()
        self.wire.request()

    def _change_mode(self) -> None:
        asked = self.registers[regs.CANCTRL] & REQOP
        busy = self.mode in (NORMAL, LOOPBACK) and self._next() is not None
        if asked != self.mode and asked <= CONFIGURATION and self.mode != SLEEP and not busy:
            self._enter(asked)

    def _enter(self, mode: int) -> None:
        self.mode = mode
        self.silent = mode == LISTEN_ONLY
        self.bit_ns = self._bit_time_ns() if mode in (NORMAL, LISTEN_ONLY) else 0
        if mode in (CONFIGURATION, LISTEN_ONLY):
            self.errors.reset()
        self.flags.note_errors()
        self.wire.request()
        self._loop()

    def _bit_time_ns(self) -> int:
        cnf1, cnf2, cnf3 = (self.registers[register] for register in (regs.CNF1, regs.CNF2, regs.CNF3))
        propagation, first = (cnf2 & 7) + 1, (cnf2 >> 3 & 7) + 1
        second = (cnf3 & 7) + 1 if cnf2 & 0x80 else max(2, first)
        quanta = 1 + propagation + first + second
        return quanta * 2 * ((cnf1 & 0x3F) + 1) * 1_000_000_000 // self._crystal_hz

    def _loop(self) -> None:
        """In loopback, hand the next frame to the chip's own receiver after the time it would take."""
        buffer = self._next()
        if self.mode == LOOPBACK and buffer is not None and self._loop_at is None:
            self.began()
            frame = regs.frame_of(self.registers, regs.TX[buffer])
            length_us = -(-length_bits(frame) * self._bit_time_ns() // 1000)
            self._loop_at = self._clock.at(self._clock.now_us + length_us, lambda: self._looped(frame))

    def _looped(self, frame: Frame) -> None:
        self._loop_at = None
        self._receive(frame)
        self._settle()
        self._loop()

    def _wake_if_told(self) -> None:
        if self.mode == SLEEP and self.registers[regs.CANINTF] & self.registers[regs.CANINTE] & WAKIF:
            self.registers[regs.CANCTRL] = self.registers[regs.CANCTRL] & ~REQOP | LISTEN_ONLY
            self._enter(LISTEN_ONLY)

    def _pending(self, buffer: int) -> bool:
        return bool(self.registers[regs.TX[buffer]] & TXREQ)

    def _next(self) -> int | None:
        best, rank = None, -1
        for buffer in BUFFERS:
            control = self.registers[regs.TX[buffer]]
            if control & TXREQ and control & PRIORITY >= rank:
                best, rank = buffer, control & PRIORITY
        return best

    def _flag(self, buffer: int, flags: int) -> None:
        self.registers[regs.TX[buffer]] |= flags

    def _done(self, buffer: int) -> None:
        """Take a request back; with the last one a mode may be reached that waits for it."""
        self.registers[regs.TX[buffer]] &= ~TXREQ
        self._change_mode()
