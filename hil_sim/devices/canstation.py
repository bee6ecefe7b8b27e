"""A plain CAN controller without registers: what a host, or a stranger on the bus, is.

station = CanStation(wire, 500_000)
station.send(Frame(0x123, b"hello"))
station.received
"""

from dataclasses import replace

from hil_sim.devices.canerrors import Errors
from hil_sim.devices.canframe import Frame
from hil_sim.devices.canwire import CanWire


class CanStation:
    """Sends what it is given, in that order, again and again until each is acknowledged; keeps what it hears.

    With a `data_bitrate_hz` it knows CAN FD.
    """

    def __init__(self, wire: CanWire, bitrate_hz: int, silent: bool = False, data_bitrate_hz: int = 0) -> None:
        self.bit_ns = 1_000_000_000 // bitrate_hz
        self.data_bit_ns = 1_000_000_000 // data_bitrate_hz if data_bitrate_hz else 0
        self.silent = silent
        self.errors = Errors()
        self.waiting: list[Frame] = []
        self.received: list[Frame] = []
        self.losses = self.failures = self.damaged = 0
        self._wire = wire
        wire.join(self)

    def send(self, frame: Frame) -> None:
        """Queue a frame; ValueError for one of CAN FD from a classic controller."""
        if frame.fd and not self.data_bit_ns:
            raise ValueError("this controller has no bit rate for the data of CAN FD")
        self.waiting.append(frame)
        self._wire.request()

    def offered(self) -> Frame | None:
        """Return the frame at the front of the queue; one of CAN FD says whether its sender is error-passive."""
        if not self.waiting:
            return None
        frame = self.waiting[0]
        return replace(frame, esi=True) if frame.fd and self.errors.passive else frame

    def edge(self) -> None:
        """Nothing sleeps here."""

    def began(self) -> None:
        """Nothing to do before its end."""

    def lost(self) -> None:
        """Count it; the frame stays at the front."""
        self.losses += 1

    def sent(self) -> None:
        """Take the frame off the queue."""
        self.waiting.pop(0)

    def failed(self) -> None:
        """Count it; the frame stays at the front."""
        self.failures += 1

    def heard(self, frame: Frame) -> None:
        """Keep it."""
        self.received.append(frame)

    def garbled(self) -> None:
        """Count it."""
        self.damaged += 1

    def recovered(self) -> None:
        """Go on with the queue."""
