"""The line to one robot on a CAN bus, which may carry the lines of many.

A stop goes out before all that waits, and to every robot on the bus. A line without a number greets all, and becomes
that of the only robot that answers.

    link = open_can("can:slcan:/dev/ttyACM0@3")
"""

from __future__ import annotations

from contextlib import suppress
from typing import Any

from host.canbus import TICK_S, CanBus
from host.errors import BadRequest, NoRobot, Silent
from host.link import Link
from host.records import Stopped, stopped_of
from protocol import frames
from protocol.canbus import ALL, CLASSIC, FD, STOP_DATA, STOP_IDENTIFIER, CanFrame, Segmenter, kind_of
from protocol.messages import STOPPED, SYNC

SETTLE_S = 0.05  # in which others may answer a greeting that went to all
SILENT_S = 2.5  # after which a number that nobody has is told
GATHER_S = 0.2  # in which every robot that heard a stop has said so
INBOX_MAX = 1 << 18


class CanLink:
    """The line to one robot on a bus; one to ALL becomes that of the only robot that answers it."""

    def __init__(self, bus: CanBus, node: int) -> None:
        self.bus = bus
        self.node = node
        self.stopped: dict[int, bytes] = {}  # what robots said last of a stop, by their nodes
        self.repeatable = bus.repeatable
        self._text = bus.address.text
        self._segmenter = Segmenter(node, bus.address.host, False, FD if bus.address.fd else CLASSIC)
        self._inbox: list[bytes] = []
        self._waiting_bytes = 0
        self._offers: dict[int, list[bytes]] = {}  # answers to a line to ALL, by the nodes that gave them
        self._settled_s = 0.0
        self._asked_s: float | None = None
        bus.join(self)

    @property
    def observer(self) -> Any:
        """Return what watches the robot from outside, or None."""
        return self.bus.observers.get(self.node)

    def now_s(self) -> float:
        """Return the clock of the bus: virtual on a bench, else monotonic."""
        return self.bus.now_s()

    def write(self, data: bytes) -> None:
        """Send stuffed frames; stops first, each once, the rest as the robot can take it, and the word to start twice.

        Nobody acknowledges that word. The second follows at once, and who has started passes it over.
        """
        if self._asked_s is None:
            self._asked_s = self.now_s()
        cut = self._segmenter.feed(data)
        if any(not frame.extended for frame in cut):
            self.bus.send(CanFrame(STOP_IDENTIFIER, False, STOP_DATA), self.node)
        for stuffed in data.split(b"\x00"):
            self.bus.notice(stuffed, self.node)
        for frame in cut:
            if frame.extended:
                self.bus.send(frame, self.node)
                if kind_of(frame.identifier) == SYNC.number:
                    self.bus.send(frame, self.node)

    def read(self, until_s: float) -> bytes:
        """Return all that a robot has said by now, or b"" at `until_s`; LinkLost when the bus is gone.

        All, because a host that was held up would else take what it reads next for newer than it is.
        """
        while True:
            self.bus.catch_up()
            if self._offers and self.now_s() + TICK_S > self._settled_s:
                self._settle()
            if self._inbox:
                data, self._inbox, self._waiting_bytes = b"".join(self._inbox), [], 0
                return data
            now_s = self.now_s()
            if now_s + TICK_S > until_s:
                self._check(now_s)
                return b""
            self.bus.turn(min(until_s, self._settled_s) if self._offers else until_s)

    def take(self, robot: int, kind: int, line: bytes) -> None:
        """Take a body that a robot has sent, if it is for this line."""
        if kind == STOPPED.number:
            self.stopped[robot] = line
            if self.node in (robot, ALL):
                self._keep(line)
        elif robot == self.node:
            self._keep(line)
        elif self.node == ALL:
            if not self._offers:
                self._settled_s = self.now_s() + SETTLE_S
            self._offers.setdefault(robot, []).append(line)

    def gather(self, time_s: float) -> None:
        """Hear for that long what robots say; nothing of it is read here."""
        until_s = self.now_s() + time_s
        while self.now_s() + TICK_S <= until_s:
            self.bus.turn(until_s)

    def close(self) -> None:
        """Send what still waits, and let go of the bus."""
        self.bus.leave(self)

    def reopen(self) -> CanLink:
        """Return the same line on a bus that was opened again."""
        self.close()
        if self.repeatable:
            raise NoRobot(f"{self._text}: a bench that was left is gone")
        return CanLink(CanBus.open(self._text), self.node)

    def pause(self, until_s: float) -> None:
        """Let time pass without the bus."""
        self.bus.pause(until_s)

    def _settle(self) -> None:
        """Be the line of the only robot that has answered; BadRequest when there are several."""
        nodes, self._offers = sorted(self._offers), dict(self._offers)
        if len(nodes) > 1:
            raise BadRequest(
                f"{self._text}: robots {_listed(nodes)} answer: name one, as {_with(self._text, nodes[0])}"
            )
        self.node = self._segmenter.robot = nodes[0]
        for line in self._offers.pop(self.node):
            self._keep(line)

    def _keep(self, line: bytes) -> None:
        if self._waiting_bytes + len(line) <= INBOX_MAX:
            self._inbox.append(line)
            self._waiting_bytes += len(line)

    def _check(self, now_s: float) -> None:
        """Raise Silent when the robot that is asked for is not there."""
        others = sorted(self.bus.heard)
        if self._asked_s is None or now_s - self._asked_s < SILENT_S or self.node in others:
            return
        if self.node != ALL and others:
            raise Silent(f"{self._text}: robot {self.node} does not answer; on this bus: {', '.join(map(str, others))}")
        if self.bus.damaged and not others:
            raise Silent(
                f"{self._text}: nobody answers, and {self.bus.damaged} frames were damaged: is the bit rate right?"
            )


def roll(link: Link) -> dict[int, Stopped]:
    """Return what each robot on a bus has said of a stop, once all had the time to; of any other line nothing."""
    if not isinstance(link, CanLink):
        return {}
    link.gather(GATHER_S)
    told = {}
    for node, line in sorted(link.stopped.items()):
        for frame in frames.Decoder().feed(line):
            with suppress(ValueError):
                told[node] = stopped_of(frame.payload, (), round(link.now_s() * 1000))
    return told


def open_can(address: str) -> CanLink:
    """Open `can:INTERFACE:CHANNEL[@NODE]`."""
    bus = CanBus.open(address)
    return CanLink(bus, bus.address.node)


def _listed(nodes: list[int]) -> str:
    return ", ".join(map(str, nodes))


def _with(text: str, node: int) -> str:
    """Return an address with a robot's number."""
    head, mark, query = text.partition("?")
    return f"{head.removesuffix('@all')}@{node}{mark}{query}"
