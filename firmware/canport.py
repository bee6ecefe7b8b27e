"""A robot's end of the CAN bus: frames in and out through the controller, bodies towards the core.

The controller has room for one frame to this robot, so `look` is called before every access to the I2C bus and again
and again while the loop rests: it allocates nothing. A stop has a receive buffer for itself. What is urgent goes
through a transmit buffer of its own and overtakes telemetry.

There may be nobody on the bus. A robot that has heard nothing for a while, and whom nobody acknowledges, sleeps: it
looks at the interrupt pin once in a control step, and tries a beacon now and then, once.

    port = CanPort(Mcp2515(...), Pin(20, Pin.IN), node)
    for taken in port.take(now_ms): ...
    port.put(line, taken.host)
"""

from array import array

from firmware.drivers.mcp2515 import ACTIVE, BUS_OFF
from protocol.canbus import ALL, ANSWERS, FROM_ROBOT, STOP_DATA, STOP_IDENTIFIER, Assembler, CanFrame, Segmenter

BITRATE_HZ = 500_000
AWAKE_MS = 2000  # after the last frame that was received, or acknowledged
STUCK_MS = 500  # for which frames wait in vain before they are given up
CHECK_MS = 100
RECEIVED_MAX, URGENT_MAX, BULK_MAX = 16, 160, 96  # frames
_NOTHING = ()
_BYTES_A_FRAME = 5  # at least, of a stuffed body
_TO_ROBOT = FROM_ROBOT | ALL << 10  # direction and node of a robot, in an identifier


class Ring:
    """Frames in the order of their arrival, in memory that is there from the beginning."""

    def __init__(self, size: int) -> None:
        self.count = 0
        self._size = size
        self._identifiers = array("I", [0] * size)
        self._lengths = bytearray(size)
        self._data = bytearray(8 * size)
        self._first = 0

    def add(self, identifier: int, data, length: int) -> bool:
        """Append a frame; return whether there was room."""
        if self.count == self._size:
            return False
        place = (self._first + self.count) % self._size
        self._identifiers[place] = identifier
        self._lengths[place] = length
        for i in range(length):
            self._data[8 * place + i] = data[i]
        self.count += 1
        return True

    def send(self, chip, urgent: bool) -> bool:
        """Hand the first frame to the controller; return whether it took it."""
        first = self._first
        if not chip.send(self._identifiers[first], self._data, self._lengths[first], True, urgent, 8 * first):
            return False
        self._forget()
        return True

    def pop(self) -> CanFrame:
        """Take the first frame."""
        first = self._first
        data = bytes(self._data[8 * first : 8 * first + self._lengths[first]])
        self._forget()
        return CanFrame(self._identifiers[first], True, data)

    def room(self) -> int:
        """Return how many more frames it takes."""
        return self._size - self.count

    def clear(self) -> None:
        """Forget all frames."""
        self.count = 0

    def _forget(self) -> None:
        self._first = (self._first + 1) % self._size
        self.count -= 1


class CanPort:
    """The CAN bus as the robot with number `node` sees it. OSError when there is no controller."""

    def __init__(self, chip, interrupt, node: int) -> None:
        self.node = node
        self.overflows = 0  # times that a frame was lost because nobody fetched it
        self.bus_offs = 0  # looks at the controller that found it so
        self.refused = 0  # bodies for which there was no room
        self.state = ACTIVE  # of the controller, see its driver
        self.awake = False
        self.stopped = False  # a stop has come that `take` has not told yet
        self._chip = chip
        self._interrupt = interrupt
        self._assembler = Assembler(False)
        self._segmenter = Segmenter(node, ALL, True)
        self._received = Ring(RECEIVED_MAX)
        self._urgent, self._bulk = Ring(URGENT_MAX), Ring(BULK_MAX)
        self._heard = self._probing = False
        self._lively_ms = self._moved_ms = self._checked_ms = 0
        chip.accept(0, 0x7FF, (0,), False)
        chip.accept(1, _TO_ROBOT, (node << 10, ALL << 10), True)
        chip.begin(BITRATE_HZ)
        chip.give_up()

    def look(self) -> None:
        """Fetch what has arrived and hand over what waits, without allocating."""
        if not self.awake:
            return
        if not self._interrupt.value():
            self._fetch()
        if self._urgent.count:
            self._urgent.send(self._chip, True)
        while self._bulk.count and self._bulk.send(self._chip, False):
            pass

    def take(self, now_ms: int):
        """Return what was completed since the last call, see canbus.py; called once in each control step."""
        if not self.awake:
            if not self._interrupt.value():
                self._wake(now_ms)
            elif not self._probing:
                return _NOTHING
        self.look()
        self._keep_up(now_ms)
        taken = []
        if self.stopped:
            self.stopped = False
            taken.append(self._assembler.feed(STOP_IDENTIFIER, False, STOP_DATA, now_ms))
        while self._received.count:
            frame = self._received.pop()
            body = self._assembler.feed(frame.identifier, True, frame.data, now_ms)
            if body is not None:
                taken.append(body)
        return taken

    def room(self) -> int:
        """Return how many bytes of stuffed bodies `put` takes now."""
        return _BYTES_A_FRAME * min(self._urgent.room(), self._bulk.room()) if self.awake else 0

    def waiting(self) -> int:
        """Return how many frames wait to be sent."""
        return self._urgent.count + self._bulk.count

    def put(self, line: bytes, host: int) -> None:
        """Queue a stuffed body for a host; it is lost when there is no room, or nobody on the bus."""
        if not self.awake:
            return
        self._segmenter.host = host
        cut = self._segmenter.feed(line)
        ring = self._lane(cut[0].identifier) if cut else self._bulk
        if ring.room() < len(cut):
            self.refused += 1
            return
        for frame in cut:
            ring.add(frame.identifier, frame.data, len(frame.data))

    def tell(self, identifier: int, data: bytes) -> None:
        """Send a frame that is no segment, if there is room; a robot that sleeps tries it once, to hear of others."""
        if self.awake:
            self._bulk.add(identifier, data, len(data))
        else:
            self._probing = self._is_ready() and self._chip.send(identifier, data, len(data), True)

    def _lane(self, identifier: int) -> Ring:
        return self._urgent if identifier >> 26 <= ANSWERS else self._bulk

    def _fetch(self) -> None:
        chip = self._chip
        while chip.receive():
            self._heard = True
            if chip.remote:
                continue  # it carries nothing: what stands in the buffer is of the frame before it
            if chip.extended:
                if not self._received.add(chip.identifier, chip.data, chip.length):
                    self.overflows += 1
            elif chip.length == len(STOP_DATA):
                self.stopped = self.stopped or self._is_stop(chip.data)

    def _is_stop(self, data) -> bool:
        for i in range(len(STOP_DATA)):
            if data[i] != STOP_DATA[i]:
                return False
        return True

    def _keep_up(self, now_ms: int) -> None:
        """Follow what the bus does: whether anybody is there, whether frames leave, whether the chip is well."""
        if (self.awake or self._probing) and (self._chip.has_sent() or self._heard):
            self._wake(now_ms)
        self._heard = self._probing = False
        if not self.awake:
            return
        if not self.waiting():
            self._moved_ms = now_ms
        if now_ms - self._lively_ms >= AWAKE_MS or now_ms - self._moved_ms >= STUCK_MS:
            self._sleep()
        elif now_ms - self._checked_ms >= CHECK_MS:
            self._checked_ms = now_ms
            self._check()

    def _wake(self, now_ms: int) -> None:
        self._lively_ms = self._moved_ms = now_ms
        if not self.awake:
            self.awake = True
            self._chip.persist()

    def _sleep(self) -> None:
        self.awake = False
        self._urgent.clear()
        self._bulk.clear()
        self._chip.give_up()

    def _check(self) -> None:
        """Take up the state of the controller; count overflows and looks that found it bus-off."""
        self._is_ready()
        if self._chip.overflowed():
            self.overflows += 1
        self.state = self._chip.state()
        self.bus_offs += self.state == BUS_OFF

    def _is_ready(self) -> bool:
        """Return whether the chip works; one that has lost its settings begins anew."""
        try:
            if not self._chip.configured():
                self._chip.restart()
            return True
        except OSError:
            return False
