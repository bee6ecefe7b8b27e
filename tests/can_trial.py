"""The CAN driver on a table top: runs under CPython and MicroPython, prints what the chip was told.

With `lock` every order after the beginning runs while memory is locked.
"""

import sys

from firmware.drivers.mcp2515 import Mcp2515

LOCKED = "lock" in sys.argv


class Select:
    """A pin that nobody looks at."""

    def value(self, level):
        pass


class Spi:
    """A bus with a chip that is always ready and has one frame in its second buffer."""

    def __init__(self):
        self.told = []

    def write_readinto(self, out, into):
        if not LOCKED:
            self.told.append(bytes(out))
        instruction = out[0]
        if instruction == 0x03:
            into[2] = self.register(out[1])
            if len(into) == 6:
                into[2], into[3], into[4], into[5] = 0x01, 0x91, 0x00, 0x03
        elif instruction == 0xA0:
            into[1] = 0x02
        elif instruction == 0x94:
            for i in range(1, 14):
                into[i] = 0xFF

    def register(self, address):
        self.reads = getattr(self, "reads", 0) + 1
        return (0x80 if self.reads <= 2 else 0x00) if address in (0x0E, 0x0F) else 0


spi = Spi()
can = Mcp2515(spi, Select(), 8_000_000)
can.accept(0, 0x7FF, (0,), False)
can.accept(1, 0x1FFFFFFF, (0x155, 0x1ABCDEF5), True)
can.begin(500_000)
data = bytearray(range(8))
if LOCKED:
    import micropython

    micropython.heap_lock()
can.send(0x1FFFFFFF, data, 8, True)
can.send(0x123, data, 3, at=2)
can.send(0x124, data, 3, False, True)
can.has_sent()
can.give_up()
can.persist()
can.receive()
can.state()
can.count_errors()
can.overflowed()
can.configured()
if LOCKED:
    micropython.heap_unlock()
for row in spi.told:
    print(" ".join([str(byte) for byte in row]))
print("received", can.identifier, can.extended, can.remote, can.length, list(can.data))
