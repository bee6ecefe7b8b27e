"""MCP2515, CAN controller on SPI (Microchip DS20001801J). Nothing here allocates memory once it has begun.

Frames leave in the order in which they were handed over: of equal priority the chip sends the highest buffer first, so
two are filled downwards and begun anew when both are empty. The third, the highest, is left to urgent frames, which
overtake them. Frames are received in the order of their arrival as long as `receive` is called until it says no.

With `accept` the chip lets few frames pass: each of its two receive buffers has a mask and filters of its own, so that
frames of one kind cannot take the place of another.

    can = Mcp2515(spi, Pin(17, Pin.OUT, value=1), 8_000_000)
    can.begin(500_000)
    can.send(0x123, data, 8)
    while can.receive():
        can.identifier, can.data, can.length
"""

RESET, WRITE, READ, BIT_MODIFY, READ_STATUS = 0xC0, 0x02, 0x03, 0x05, 0xA0
LOAD_TX, RTS, READ_RX = 0x40, 0x80, 0x90
CANSTAT, CANCTRL, TEC, CNF3, CANINTF, EFLG, RXB0CTRL, RXB1CTRL = 0x0E, 0x0F, 0x1C, 0x28, 0x2C, 0x2D, 0x60, 0x70
MASKS, FILTERS = (0x20, 0x24), ((0x00, 0x04), (0x08, 0x10, 0x14, 0x18))  # of both receive buffers
CONFIGURATION, NORMAL, OPMOD = 0x80, 0x00, 0xE0
ABORT, ONE_SHOT = 0x10, 0x08  # in CANCTRL
RECEIVED = 0x03  # CANINTE, CANINTF, READ STATUS: a frame in either buffer
PENDING = 0x14  # READ STATUS: frames that wait to be sent in the lower two buffers
URGENT_PENDING = 0x40  # and in the highest
SENT = 0xA8  # and frames that have been
SENT_FLAGS = 0x1C  # the same in CANINTF
ANY_MESSAGE, FILTERED, ROLL_OVER = 0x60, 0x00, 0x04
OVERFLOWS = 0xC0  # EFLG
EXTENDED, REMOTE_STANDARD, REMOTE_EXTENDED = 0x08, 0x10, 0x40
# A bit of 8 quanta: 1, propagation 2, first segment 3, second 2; sampled at 75 %. CNF2 is BTLMODE and the middle two.
QUANTA, SEGMENTS, SECOND = 8, 0x91, 0x01
LOOKS = 20
HEADER = 6  # bytes of a transfer before the data: instruction, identifier, length
URGENT = 2  # the buffer that goes first

STOPPED, ACTIVE, WARNING, PASSIVE, BUS_OFF = 0, 1, 2, 3, 4


class Mcp2515:
    """One chip. `begin` raises OSError when it does not answer as it should; a chip that is gone reads as silent."""

    def __init__(self, spi, select, crystal_hz: int) -> None:
        self.identifier = 0  # of the frame received last, and what follows
        self.extended = False
        self.remote = False
        self.length = 0
        self.data = bytearray(8)
        self.transmit_errors = 0
        self.receive_errors = 0
        self._spi = spi
        self._select = select
        self._crystal_hz = crystal_hz
        self._settings = bytearray(4)  # CNF3, CNF2, CNF1, CANINTE
        self._order = bytearray(1)
        self._status = bytearray(2)
        self._three = bytearray(3)
        self._four = bytearray(4)
        self._six = bytearray(6)
        self._frame = bytearray(HEADER + 8)
        self._rows = []  # where a mask or a filter goes, its identifier, and whether that is an extended one
        self._next = URGENT - 1  # the buffer to fill next, -1 until both are empty
        self._second_is_older = False

    def accept(self, buffer: int, mask: int, identifiers, extended: bool) -> None:
        """Have a receive buffer take these identifiers alone, compared under a mask; counts from `begin` on."""
        self._rows.append((MASKS[buffer], mask, extended))
        for i in range(len(FILTERS[buffer])):
            self._rows.append((FILTERS[buffer][i], identifiers[min(i, len(identifiers) - 1)], extended))

    def begin(self, bitrate_hz: int) -> None:
        """Reset the chip and go onto the bus. ValueError: not a rate of this crystal."""
        scale = self._crystal_hz // (2 * QUANTA * bitrate_hz)
        if not 1 <= scale <= 64 or scale * 2 * QUANTA * bitrate_hz != self._crystal_hz:
            raise ValueError(f"bit rate {bitrate_hz} Hz, with a crystal of {self._crystal_hz} Hz")
        self._settings[0], self._settings[1], self._settings[2] = SECOND, SEGMENTS, scale - 1
        self._settings[3] = RECEIVED
        self.restart()

    def restart(self) -> None:
        """Begin anew, as after bus-off: what was waiting to be sent is lost."""
        self._tell(RESET)
        self._wait(CONFIGURATION, 19, "ENODEV")
        for i in range(4):
            self._write(CNF3 + i, self._settings[i])
        for register, identifier, extended in self._rows:
            self._identify(self._six, 2, identifier, extended)
            self._six[0], self._six[1] = WRITE, register
            self._exchange(self._six)
        self._write(RXB0CTRL, FILTERED if self._rows else ANY_MESSAGE | ROLL_OVER)
        self._write(RXB1CTRL, FILTERED if self._rows else ANY_MESSAGE)
        self._write(CANCTRL, NORMAL)
        self._wait(NORMAL, 5, "EIO")
        if not self.configured():
            raise OSError(5, "EIO")
        self._next = URGENT - 1
        self._second_is_older = False

    def give_up(self) -> None:
        """Take back what waits to be sent, and try each frame once only from now on, heard or not."""
        self._write(CANCTRL, NORMAL | ONE_SHOT | ABORT)
        self._write(CANCTRL, NORMAL | ONE_SHOT)

    def persist(self) -> None:
        """Try each frame again and again, as after `begin`."""
        self._write(CANCTRL, NORMAL)

    def configured(self) -> bool:
        """Return whether the chip is on the bus with what `begin` set."""
        six, settings = self._six, self._settings
        self._read_from(CNF3, six)
        for i in range(4):
            if six[2 + i] != settings[i]:
                return False
        return self._read(CANSTAT) & OPMOD == NORMAL

    def state(self) -> int:
        """Return STOPPED, ACTIVE, WARNING, PASSIVE or BUS_OFF."""
        if self._read(CANSTAT) & OPMOD != NORMAL:
            return STOPPED
        flags = self._read(EFLG)
        return BUS_OFF if flags & 0x20 else PASSIVE if flags & 0x18 else WARNING if flags & 0x06 else ACTIVE

    def count_errors(self) -> None:
        """Bring both error counters into `transmit_errors` and `receive_errors`."""
        self._read_from(TEC, self._four)
        self.transmit_errors, self.receive_errors = self._four[2], self._four[3]

    def overflowed(self) -> bool:
        """Return whether frames were lost because nobody fetched them, since this was asked last."""
        if not self._read(EFLG) & OVERFLOWS:
            return False
        four = self._four
        four[0], four[1], four[2], four[3] = BIT_MODIFY, EFLG, OVERFLOWS, 0
        self._exchange(four)
        return True

    def has_sent(self) -> bool:
        """Return whether a frame was acknowledged since this was asked last."""
        if not self._look() & SENT:
            return False
        four = self._four
        four[0], four[1], four[2], four[3] = BIT_MODIFY, CANINTF, SENT_FLAGS, 0
        self._exchange(four)
        return True

    def send(
        self, identifier: int, data, length: int, extended: bool = False, urgent: bool = False, at: int = 0
    ) -> bool:
        """Hand over a frame of `length` bytes of `data`, from `at` on; return whether there was room for it."""
        status = self._look()
        if urgent:
            if status & URGENT_PENDING:
                return False
            buffer = URGENT
        else:
            if not status & PENDING:
                self._next = URGENT - 1
            elif self._next < 0:
                return False
            buffer = self._next
            self._next -= 1
        frame = self._frame
        frame[0] = LOAD_TX | buffer << 1
        self._identify(frame, 1, identifier, extended)
        frame[5] = length
        for i in range(length):
            frame[HEADER + i] = data[at + i]
        self._exchange(frame)
        self._tell(RTS | 1 << buffer)
        return True

    def receive(self) -> bool:
        """Fetch the oldest frame that has arrived; return whether there was one."""
        full = self._look() & RECEIVED
        if not full:
            self._second_is_older = False
            return False
        second = full == 2 or (full == 3 and self._second_is_older)
        self._second_is_older = not second
        frame = self._frame
        frame[0] = READ_RX | 4 if second else READ_RX
        self._exchange(frame)
        self._unpack(frame)
        return True

    def _unpack(self, frame) -> None:
        base, low = frame[1] << 3 | frame[2] >> 5, frame[2]
        self.extended = bool(low & EXTENDED)
        self.identifier = base << 18 | (low & 3) << 16 | frame[3] << 8 | frame[4] if self.extended else base
        self.remote = bool(frame[5] & REMOTE_EXTENDED if self.extended else low & REMOTE_STANDARD)
        self.length = min(8, frame[5] & 0x0F)
        for i in range(8):
            self.data[i] = frame[HEADER + i]

    def _identify(self, buffer, at: int, identifier: int, extended: bool) -> None:
        """Put an identifier into four bytes of a buffer, as the chip has it."""
        base = identifier >> 18 if extended else identifier
        low = identifier & 0x3FFFF if extended else 0
        buffer[at] = base >> 3
        buffer[at + 1] = (base << 5) & 0xE0 | (EXTENDED if extended else 0) | low >> 16
        buffer[at + 2] = (low >> 8) & 0xFF
        buffer[at + 3] = low & 0xFF

    def _look(self) -> int:
        self._status[0] = READ_STATUS
        self._exchange(self._status)
        return self._status[1]

    def _wait(self, mode: int, error: int, name: str) -> None:
        looks = 0
        while self._read(CANSTAT) & OPMOD != mode or self._read(CANCTRL) & OPMOD != mode:
            looks += 1
            if looks > LOOKS:
                raise OSError(error, name)

    def _tell(self, instruction: int) -> None:
        self._order[0] = instruction
        self._exchange(self._order)

    def _write(self, register: int, value: int) -> None:
        three = self._three
        three[0], three[1], three[2] = WRITE, register, value
        self._exchange(three)

    def _read(self, register: int) -> int:
        self._read_from(register, self._three)
        return self._three[2]

    def _read_from(self, register: int, buffer) -> None:
        """Read registers from one on into a buffer, behind the two bytes of the instruction."""
        buffer[0], buffer[1] = READ, register
        self._exchange(buffer)

    def _exchange(self, buffer) -> None:
        """Send a buffer and fill it with what comes back, the chip selected."""
        self._select.value(0)
        self._spi.write_readinto(buffer, buffer)
        self._select.value(1)
