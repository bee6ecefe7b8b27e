"""The line from a MicroPython process to the bench that owns its hardware and its time.

A request is eight bytes (operation, object, ticks read since the last one, length, argument), then its data. The
answer is four words, the time since reset, status and value, then its data. No virtual time passes between two
requests, so reading the clock needs none: it is counted, and told with the next. What needs no answer (a pin that is
set, the watchdog that is fed, a sleep) waits for the next request that does; the time that it takes is known here.
hil_sim/worlds/desk.py is the other end.

Memory is allocated for nothing that a control step does.
"""

import json
import sys
from array import array
from binascii import hexlify, unhexlify

PIN_SET, PIN_GET, I2C_WRITE, I2C_READ, UART_READ, UART_WRITE, ADC, FEED, SLEEP, TIME, CALL = range(11)
CRASH, READ, SPI, PULSE = range(11, 15)
OS_ERROR, INTERRUPTED = 1, 3  # how a request may end, besides well (0) and with another error (2), told in words
MACHINE, FILES, DESK = 0, 1, 2  # objects that are there from the start; the desk is the bench's end of this line
HEAD = 8
_FILLED = {"readinto": 0, "readfrom_into": 1, "readfrom_mem_into": 2, "write_readinto": 1}  # which argument is filled
_POSTED_MAX = 256
_TICKS_MAX = 1000
_TEXTS = {"ValueError": ValueError, "TypeError": TypeError, "AttributeError": AttributeError}


class Line:
    """One process's end of the line."""

    def __init__(self, fd: int) -> None:
        self.ticks = 0  # read since the last request, each costs its time
        self._ahead_us = 0  # what the requests cost that wait to be sent, and the ticks before them
        self._sleeps = False  # one of them is a sleep
        self._file = open(fd, "r+b")
        self._out = bytearray(_POSTED_MAX + 2 * HEAD)
        self._end = 0  # of what waits to be sent
        self._answer = array("I", [0, 0, 0, 0])  # time since reset in us, 30 bits and the rest; status; value
        self._errors = {5: OSError(5), 110: OSError(110)}  # raised without allocating

    def now_us(self) -> int:
        """Return the time since reset, after a look at the clock that costs one tick."""
        self.ticks += 1
        if self.ticks >= _TICKS_MAX:
            self.flush()
        return self._answer[0] + (self._answer[1] << 30) + self._ahead_us + self.ticks

    def post(self, op: int, which: int, argument: int, cost_us: int) -> None:
        """Make a request that has no answer; it goes out with the next one, or with the next sleep."""
        if self._end > _POSTED_MAX or (op == SLEEP and self._sleeps):
            self.flush()
        self._sleeps |= op == SLEEP
        self._ahead_us += self.ticks + cost_us
        self._put(op, which, 0, argument)

    def flush(self) -> None:
        """Have all that waits done."""
        self.ask(TIME, 0, 0)

    def ask(self, op: int, which: int, argument: int, data=None, count: int = 0) -> int:
        """Make a request with data, or for `count` bytes; return its value or raise what it raised."""
        self._put(op, which, len(data) if data else count, argument)
        if data:
            self._append(data)
        if self._end:
            self._file.write(self._out, self._end)
            self._end = 0
        if self._file.readinto(self._answer) != 16:
            raise SystemExit  # the bench is gone
        self._ahead_us = 0
        self._sleeps = False
        if self._answer[2]:
            self._fail(self._answer[2], self._answer[3])
        return self._answer[3]

    def take(self, buffer) -> None:
        """Fill a buffer with the data that follow the answer."""
        self._file.readinto(buffer)

    def read(self, count: int) -> bytes:
        """Return the data that follow the answer."""
        return self._file.read(count) if count else b""

    def call(self, which: int, name: str, args=(), options=None):
        """Call a method of an object of the bench and return its result."""
        asked = [which, name, [_plain(value) for value in args], _plain(options or {})]
        return _lively(json.loads(self.read(self.ask(CALL, 0, 0, json.dumps(asked).encode()))))

    def _append(self, data) -> None:
        out, end = self._out, self._end
        length = len(data)
        if end + length > len(out):
            self._file.write(out, end)
            self._file.write(data)
            self._end = 0
            return
        for i in range(length):
            out[end + i] = data[i]
        self._end = end + length

    def _put(self, op: int, which: int, length: int, argument: int) -> None:
        out, at, ticks = self._out, self._end, self.ticks
        out[at] = op
        out[at + 1] = which
        out[at + 2] = ticks & 0xFF
        out[at + 3] = ticks >> 8
        out[at + 4] = length & 0xFF
        out[at + 5] = length >> 8
        out[at + 6] = argument & 0xFF
        out[at + 7] = argument >> 8
        self._end = at + HEAD
        self.ticks = 0

    def _fail(self, status: int, value: int) -> None:
        if status == OS_ERROR:
            raise self._errors.get(value) or OSError(value)
        if status == INTERRUPTED:
            raise KeyboardInterrupt
        kind, text = json.loads(self.read(value))
        raise _TEXTS.get(kind, RuntimeError)(text)


class Remote:
    """An object of the bench."""

    kind = ""
    which = 0

    def __init__(self, *args, **options) -> None:
        self.which = line.call(MACHINE, self.kind, args, options).which

    def __enter__(self):
        return self

    def __exit__(self, *raised) -> None:
        self.close()

    def __getattr__(self, name):
        def method(*args, **options):
            result = line.call(self.which, name, args, options)
            if name in _FILLED:
                args[_FILLED[name]][:] = result
                return None
            return result

        return method


class Held(Remote):
    """An object that the bench made in answer to a call."""

    def __init__(self, which: int) -> None:
        self.which = which
        self._is_open = True

    def close(self) -> None:
        """Close it, once."""
        if self._is_open:
            self._is_open = False
            line.call(self.which, "close")


def _plain(value):
    """Return a value as JSON can carry it."""
    if isinstance(value, (bytes, bytearray, memoryview)):
        return {"bytes": hexlify(value).decode()}
    if isinstance(value, Remote):
        return {"object": value.which}
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    return value


def _lively(value):
    """Return what JSON carried as it was."""
    if isinstance(value, dict) and "bytes" in value:
        return unhexlify(value["bytes"])
    if isinstance(value, dict) and "object" in value:
        return Held(value["object"])
    return value


line = Line(int(sys.argv[1]))
