"""MCP2515, CAN controller on SPI (Microchip DS20001801J). Nothing here allocates memory once it has begun.

Frames leave in the order in which they were handed over: of equal priority the chip sends the highest buffer first, so
the three are filled downwards and begun anew when all are empty. Frames are received in the order of their arrival as
long as `receive` is called until it says no.

    can = Mcp2515(spi, Pin(17, Pin.OUT, value=1), 8_000_000)
    can.begin(500_000)
    can.send(0x123, data, 8)
    while can.receive():
        can.identifier, can.data, can.length
"""

RESET, WRITE, READ, BIT_MODIFY, READ_STATUS = 0xC0, 0x02, 0x03, 0x05, 0xA0
LOAD_TX, RTS, READ_RX = 0x40, 0x80, 0x90
CANSTAT, CANCTRL, TEC, CNF3, EFLG, RXB0CTRL, RXB1CTRL = 0x0E, 0x0F, 0x1C, 0x28, 0x2D, 0x60, 0x70
CONFIGURATION, NORMAL, OPMOD = 0x80, 0x00, 0xE0
RECEIVED = 0x03  # CANINTE, CANINTF, READ STATUS: a frame in either buffer
REQUESTED = 0x54  # READ STATUS: frames that wait to be sent
ANY_MESSAGE, ROLL_OVER = 0x60, 0x04
OVERFLOWS = 0xC0  # EFLG
EXTENDED, REMOTE_STANDARD, REMOTE_EXTENDED = 0x08, 0x10, 0x40
# A bit of 8 quanta: 1, propagation 2, first segment 3, second 2; sampled at 75 %. CNF2 is BTLMODE and the middle two.
QUANTA, SEGMENTS, SECOND = 8, 0x91, 0x01
LOOKS = 20
HEADER = 6  # bytes of a transfer before the data: instruction, identifier, length
BUFFERS = 3

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
        self._next = BUFFERS - 1  # the buffer to fill next, -1 until all are empty
        self._second_is_older = False

    def begin(self, bitrate_hz: int) -> None:
        """Reset the chip and go onto the bus; any frame is received. ValueError: not a rate of this crystal."""
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
        self._write(RXB0CTRL, ANY_MESSAGE | ROLL_OVER)
        self._write(RXB1CTRL, ANY_MESSAGE)
        self._write(CANCTRL, NORMAL)
        self._wait(NORMAL, 5, "EIO")
        if not self.configured():
            raise OSError(5, "EIO")
        self._next = BUFFERS - 1
        self._second_is_older = False

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

    def send(self, identifier: int, data, length: int, extended: bool = False) -> bool:
        """Hand over a frame of `length` bytes; return whether there was room for it."""
        if not self._look() & REQUESTED:
            self._next = BUFFERS - 1
        elif self._next < 0:
            return False
        frame, buffer = self._frame, self._next
        base = identifier >> 18 if extended else identifier
        low = identifier & 0x3FFFF if extended else 0
        frame[0] = LOAD_TX | buffer << 1
        frame[1] = base >> 3
        frame[2] = (base << 5) & 0xE0 | (EXTENDED if extended else 0) | low >> 16
        frame[3] = (low >> 8) & 0xFF
        frame[4] = low & 0xFF
        frame[5] = length
        for i in range(length):
            frame[HEADER + i] = data[i]
        self._exchange(frame)
        self._tell(RTS | 1 << buffer)
        self._next = buffer - 1
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
