"""The CAN port on a table top, under CPython and MicroPython: prints what its controller was told.

With `lock` every look at the bus runs while memory is locked, as it may within a control step.
"""

import sys

from firmware.canport import CanPort
from protocol import frames
from protocol.canbus import HOST, Segmenter

LOCKED = "lock" in sys.argv
NODE = 3


class Level:
    """The interrupt pin: low while the controller has a frame."""

    def __init__(self, chip):
        self.chip = chip

    def value(self):
        return 0 if self.chip.place < len(self.chip.arriving) else 1


class Chip:
    """A controller that always has room, and hands out what has arrived."""

    def __init__(self):
        self.arriving = []
        self.place = 0
        self.identifier = self.length = self.sent = self.sum = 0
        self.extended = True
        self.remote = False
        self.data = bytearray(8)

    def accept(self, buffer, mask, identifiers, extended):
        print("accept", buffer, mask, identifiers, extended)

    def begin(self, bitrate_hz):
        print("begin", bitrate_hz)

    def give_up(self):
        print("give up")

    def persist(self):
        print("persist")

    def configured(self):
        return True

    def overflowed(self):
        return False

    def state(self):
        return 1

    def has_sent(self):
        return True

    def receive(self):
        if self.place == len(self.arriving):
            return False
        frame = self.arriving[self.place]
        self.identifier, self.extended, self.length = frame.identifier, frame.extended, len(frame.data)
        for i in range(self.length):
            self.data[i] = frame.data[i]
        self.place += 1
        return True

    def send(self, identifier, data, length, extended=False, urgent=False, at=0):
        for i in range(length):
            self.sum = (self.sum * 31 + data[at + i] + identifier) & 0xFFFFFF
        self.sent += 1
        return True


def look(port):
    if LOCKED:
        import micropython  # noqa: PLC0415

        micropython.heap_lock()
    for _ in range(20):
        port.look()
    if LOCKED:
        micropython.heap_unlock()


chip = Chip()
port = CanPort(chip, Level(chip), NODE)
bodies = [frames.seal(kind, 1, 2, bytes(range(length)), 0, 0) for kind, length in ((0x20, 8), (0x14, 0), (0x21, 60))]
segments = Segmenter(NODE, HOST, False).feed(frames.STOP + b"".join([frames.encode(body) for body in bodies]))
chip.arriving = segments[:1]  # the rest comes while memory is locked
for now_ms in range(0, 3000, 5):
    for taken in port.take(now_ms):
        print(now_ms, taken.robot, taken.host, taken.kind, len(taken.line))
        if taken.kind:
            port.put(taken.line, taken.host)
            port.put(frames.encode(frames.seal(0x50, 0, 0, bytes(90), 0, 0)), taken.host)
    port.tell(0x1B000000, bytes(range(8)))
    if now_ms == 1000:
        chip.arriving = segments
    look(port)
    if now_ms % 500 == 0:
        print(now_ms, port.awake, port.waiting(), port.room(), chip.sent, chip.sum)
