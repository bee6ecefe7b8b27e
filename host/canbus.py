"""A CAN bus and the lines of the robots on it: each frame goes to the line of the robot that sent it.

    bus = CanBus.open("can:softrig:circular,sphere-b")
    one, two = CanLink(bus, 1), CanLink(bus, 2)

Waiting is that of python-can's `recv`; a bus that has a clock of its own, as a bench, says so by `now_s`.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING, Any
from typing import Protocol as Interface

from host.canaddress import CanAddress, first_line, open_bus, parse
from host.canlane import NEVER_S, Lanes
from host.errors import LinkLost, SoftrigError
from host.link import monotonic_s, pause_until
from protocol.canbus import ALL, FROM_ROBOT, Assembler, CanFrame, kind_of
from protocol.messages import TELEMETRY

if TYPE_CHECKING:
    from can import BusABC, Message

FLUSH_S = 0.5
SEND_S = 2.0
CAUGHT_MAX = 4096  # frames
TICK_S = 5e-7  # half the tick of a clock of microseconds: a wait that is shorter is over
OFF_S = 1.0  # that an adapter may be bus-off; most come back by themselves
BUS_OFF = 0x40  # class of an error frame, as Linux numbers them


class Line(Interface):
    """What hears the robots of a bus."""

    def take(self, robot: int, kind: int, line: bytes) -> None:
        """Take a stuffed body that a robot has sent to this host, or to all."""


class CanBus:
    """A bus of python-can and the lines of the robots on it."""

    def __init__(self, bus: BusABC, address: CanAddress) -> None:
        from can import CanError, Message  # noqa: PLC0415

        self.address = address
        self.heard: set[int] = set()  # nodes of robots that have sent anything
        self.damaged = 0  # error frames
        self.repeatable = bool(getattr(bus, "repeatable", False))
        self.now_s: Callable[[], float] = getattr(bus, "now_s", monotonic_s)
        self.observers: dict[int, Any] = getattr(bus, "benches", {})  # of the robots, where somebody watches them
        self._bus = bus
        self._message = Message
        self._lost = (CanError, OSError, ValueError, TypeError)
        self._lines: list[Line] = []
        self._lanes = Lanes(address.bitrate_hz)
        self._assemblers: dict[int, Assembler] = {}
        self._off_s: float | None = None  # since when the adapter is bus-off

    @classmethod
    def open(cls, address: str) -> CanBus:
        """Open the bus of an address; NoRobot and its kin when it cannot be had."""
        told = parse(address)
        return cls(open_bus(told), told)

    def join(self, line: Line) -> None:
        """Have a line told what robots say."""
        self._lines.append(line)

    def send(self, frame: CanFrame, lane: int) -> None:
        """Queue a frame for a robot; a stop goes at once."""
        if frame.extended:
            self._lanes.lane(lane).add(frame)
        else:
            self._put(frame)

    def notice(self, stuffed: bytes, lane: int) -> None:
        """Look whether a frame is one that was sent before."""
        self._lanes.lane(lane).notice(stuffed)

    def turn(self, until_s: float) -> bool:
        """Send what is due and wait for one frame, at most until then; return whether one has come."""
        next_s = self._flush()
        now_s = self.now_s()
        if self._off_s is not None and now_s - self._off_s >= OFF_S:
            raise self._broken("the adapter is bus-off: are wires, terminators and bit rate right?")
        try:
            message = self._bus.recv(max(0.0, min(until_s, next_s) - now_s))
        except self._lost as error:
            raise self._broken(first_line(error)) from error
        if message is not None:
            self._take(message)
        return message is not None

    def catch_up(self) -> None:
        """Take all that has come by now, unless it comes faster than it is taken."""
        for _ in range(CAUGHT_MAX):
            if not self.turn(self.now_s()):
                return

    def leave(self, line: Line) -> None:
        """Forget a line; with the last one the bus is closed, once all has been sent."""
        if line not in self._lines:
            return
        with suppress(SoftrigError):
            until_s = self.now_s() + FLUSH_S
            while self._lanes.due_s() < NEVER_S and self.now_s() + TICK_S <= until_s:
                self.turn(until_s)
        self._lines.remove(line)
        if not self._lines:
            with suppress(*self._lost):
                self._bus.shutdown()

    def pause(self, until_s: float) -> None:
        """Let time pass, whatever has become of the bus."""
        if self.now_s is monotonic_s:
            pause_until(until_s)
        while self.now_s() + TICK_S <= until_s:
            self.turn(until_s)

    def _flush(self) -> float:
        """Send what is due; return when something is next."""
        now_s = self.now_s()
        while (due_s := self._lanes.due_s()) < now_s + TICK_S:
            self._put(self._lanes.pop(now_s))
        return due_s

    def _put(self, frame: CanFrame) -> None:
        long = self.address.fd and frame.extended
        message = self._message(
            arbitration_id=frame.identifier, is_extended_id=frame.extended, data=frame.data, is_fd=long,
            bitrate_switch=long,
        )  # fmt: skip
        try:
            self._bus.send(message, SEND_S)
        except self._lost as error:
            raise self._broken(first_line(error)) from error

    def _take(self, message: Message) -> None:
        if message.is_error_frame:
            self.damaged += 1
            if message.arbitration_id & BUS_OFF and self._off_s is None:
                self._off_s = self.now_s()
            return
        self._off_s = None
        number, host = message.arbitration_id, message.arbitration_id >> 3 & 127
        if message.is_remote_frame or not message.is_extended_id or not number & FROM_ROBOT:
            return
        robot = number >> 10 & 127
        self.heard.add(robot)
        if host not in (ALL, self.address.host) and kind_of(number) != TELEMETRY.number:  # which is for everybody
            return
        assembler = self._assemblers.setdefault(robot, Assembler(True))
        taken = assembler.feed(number, True, bytes(message.data), round(self.now_s() * 1000), message.is_fd)
        if taken is not None:
            for line in self._lines:
                line.take(robot, taken.kind, taken.line)

    def _broken(self, why: str) -> LinkLost:
        return LinkLost(
            f"{self.address.text}: the line broke ({why}); a robot that was armed switches everything off by itself"
        )
