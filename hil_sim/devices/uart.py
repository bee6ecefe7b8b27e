"""The device's end of a serial line: buffers that end, a cable that can be pulled, a host that can die.

uart = Uart(host_baud=115_200)
uart.open(115_200, now_us=0)
uart.host_write(b"hello", now_us=0)
uart.read(5, now_us=500)
"""

from collections.abc import Callable

from hil_sim.devices.wire import Wire

BUFFER_BYTES = 256


class Uart:
    """The device's end of a line: a receive and a transmit buffer of 256 bytes, both lazily served.

    `sent`, where set, is told of each device write and when it will have arrived at the host as a whole.
    """

    def __init__(self, host_baud: int) -> None:
        self.inward = Wire(host_baud)
        self.outward = Wire(host_baud)
        self.overruns = 0
        self.misread = 0
        self.is_open = False
        self.connected = True
        self.deserted = False  # the host's process has died: it neither writes nor reads
        self.trap: Callable[[str], None] | None = None  # is told of each "read" and "write" of the device
        self.sent: Callable[[int], None] | None = None
        self._received = bytearray()
        self._landed = b""
        self._room = BUFFER_BYTES
        self._send_room = BUFFER_BYTES

    def open(self, baud: int, now_us: int, rx_bytes: int = BUFFER_BYTES, tx_bytes: int = BUFFER_BYTES) -> None:
        """Start the device's end at `baud`; what arrived before is lost."""
        self.close(now_us)
        self.outward = self.outward.at(baud)
        self._room = rx_bytes
        self._send_room = tx_bytes
        self.is_open = True

    def close(self, now_us: int) -> None:
        """Stop the device's end, as a reset does: bytes on the way out are cut off."""
        self.inward.take(now_us)
        self._received.clear()
        self._land(now_us)
        self.outward.clear(now_us)
        self.is_open = False

    def any(self, now_us: int) -> int:
        """Return how many received bytes wait."""
        self._fill(now_us)
        return len(self._received)

    def read(self, count: int, now_us: int) -> bytes:
        """Return up to `count` received bytes."""
        if self.trap is not None:
            self.trap("read")
        self._fill(now_us)
        data = bytes(self._received[:count])
        del self._received[:count]
        return data

    def write(self, data: bytes, now_us: int) -> int:
        """Send as much of `data` as the transmit buffer takes; return how much that is."""
        if self.trap is not None:
            self.trap("write")
        data = data[: max(0, self._send_room - self.outward.waiting(now_us))]
        arrives_us = self.outward.send(self._as_heard(data), now_us)
        if self.sent is not None and self._reaches_host:
            self.sent(arrives_us)
        return len(data)

    def host_write(self, data: bytes, now_us: int) -> None:
        """Put the host's bytes on the line."""
        if self._reaches_host:
            self.inward.send(data, now_us)

    def host_read(self, now_us: int) -> bytes:
        """Return the bytes that have reached the host."""
        self._land(now_us)
        data, self._landed = self._landed, b""
        return data

    def host_wake_us(self) -> int | None:
        """Return when the next device write will have reached the host as a whole, or None."""
        return self.outward.next_us() if self._reaches_host else None

    def cut(self, now_us: int) -> None:
        """Pull the cable out: what is on it is lost."""
        self.settle(now_us)
        self.inward.clear(now_us)
        self.connected = False

    def join(self, now_us: int) -> None:
        """Plug the cable in again."""
        self._land(now_us)
        self.connected = True

    def desert(self, deserted: bool, now_us: int) -> None:
        """Let the host's process die, or a new one come: what it had written still goes out."""
        self._land(now_us)
        self.deserted = deserted

    def retune(self, host_baud: int, now_us: int) -> None:
        """Have the host's end run at another rate: what is on the way to the device is lost."""
        self.settle(now_us)
        self.inward = self.inward.at(host_baud)

    def settle(self, now_us: int) -> None:
        """Hand over all that has arrived by now; to be called before the line changes."""
        self._fill(now_us)
        self._land(now_us)

    @property
    def _reaches_host(self) -> bool:
        return self.connected and not self.deserted

    def _land(self, now_us: int) -> None:
        arrived = self.outward.take(now_us)
        if self._reaches_host:
            self._landed += arrived

    def _fill(self, now_us: int) -> None:
        arrived = self.inward.take(now_us)
        if not arrived or not self.is_open:
            return
        room = self._room - len(self._received)
        self._received += self._as_heard(arrived[:room])
        self.overruns += max(0, len(arrived) - room)

    def _as_heard(self, data: bytes) -> bytes:
        """Return `data` as the other end reads it: noise when the two rates differ by more than 3 %."""
        if abs(self.outward.baud - self.inward.baud) * 100 <= 3 * self.inward.baud:
            return data
        self.misread += len(data)
        return bytes(byte ^ 0xA5 for byte in data)
