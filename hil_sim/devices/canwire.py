"""A CAN bus on the virtual clock: arbitration, bit times, acknowledgement, error frames, recovery from bus-off.

A frame occupies the wire for as many bit times as it has, stuffed bits counted; what comes of it is told to every node
at its end. Frames of the Bosch CAN specification 2.0 (canframe.py), counters of its section 8 (canerrors.py).

    wire = CanWire(clock)
    wire.join(controller)
    wire.request()  # by a node that has something to send, or that has come onto the bus

ASSUMED: bit rates within 1.7 % of each other understand each other (Microchip DS20001801J, 5.4, the variation that it
allows between oscillators); another rate is found out after 12 bits, and who finds it out destroys the frame. A
sender that asks within a frame waits for its end. DEVIATION: no overload frames; propagation takes no time.
"""

from collections.abc import Iterable
from functools import partial
from typing import Protocol

from hil_sim.clock import Clock, Event
from hil_sim.devices.canerrors import Errors
from hil_sim.devices.canframe import END_BITS, INTERMISSION_BITS, TAIL_BITS, Frame, head, stuffed

TOLERANCE = 0.017
SUSPEND_BITS = 8  # that an error-passive sender waits besides
ERROR_FLAG_BITS, DELIMITER_BITS = 6, 8
ALIEN_BITS = 12
QUIET_BITS, QUIET_TIMES = 11, 128  # recessive bits, and how often, before a node that is bus-off may come back


class Node(Protocol):
    """What the wire needs of a controller; `bit_ns` is 0 while it is not on the bus, `silent` one only listens."""

    bit_ns: int
    silent: bool
    errors: Errors

    def offered(self) -> Frame | None:
        """Return the frame it would send next."""

    def edge(self) -> None:
        """Somebody else has begun a frame."""

    def began(self) -> None:
        """Its own frame is on the wire and has won."""

    def lost(self) -> None:
        """Its own frame has met a stronger one."""

    def sent(self) -> None:
        """Its own frame was acknowledged."""

    def failed(self) -> None:
        """Its own frame was not acknowledged, or destroyed."""

    def heard(self, frame: Frame) -> None:
        """A frame of another has arrived."""

    def garbled(self) -> None:
        """A frame of another has arrived damaged."""

    def recovered(self) -> None:
        """It was bus-off and no longer is."""


class CanWire:
    """Two wires and the nodes on them."""

    def __init__(self, clock: Clock) -> None:
        self.nodes: list[Node] = []
        self._clock = clock
        self._busy = False
        self._free_us = 0  # when the intermission ends
        self._begin_at: Event | None = None
        self._spoiled = 0
        self._held_us: dict[Node, int] = {}
        self._quiet_ns = 0  # since when the wire is recessive
        self._off: dict[Node, int] = {}  # quiet times that each still has to wait for
        self._return_at: list[Event] = []

    def join(self, node: Node) -> None:
        """Connect a node."""
        self.nodes.append(node)
        self.request()

    def leave(self, node: Node) -> None:
        """Disconnect a node; a frame that it is sending is lost to all others."""
        self.nodes.remove(node)
        for kept in (self._held_us, self._off):
            kept.pop(node, None)

    def spoil(self, count: int) -> None:
        """Damage the next frames."""
        self._spoiled += count

    def request(self) -> None:
        """See whether anybody has something to send, as soon as the wire is free."""
        if not self._busy and self._begin_at is None:
            self._begin_at = self._clock.at(max(self._free_us, self._clock.now_us), self._begin)

    def _begin(self) -> None:
        self._begin_at = None
        now_us = self._clock.now_us
        offers = [(node, frame) for node in self._present() if not node.silent and (frame := node.offered())]
        ready = [(node, frame) for node, frame in offers if self._held_us.get(node, 0) <= now_us]
        if not ready:
            if offers:
                held_us = min(self._held_us[node] for node, _ in offers)
                self._begin_at = self._clock.at(held_us, self._begin)
            return
        self._busy = True
        self._end_quiet()
        best = min(frame.arbitration for _, frame in ready)
        for node, frame in ready:
            if frame.arbitration != best:
                node.lost()
        self._occupy({node: frame for node, frame in ready if frame.arbitration == best})

    def _occupy(self, senders: dict[Node, Frame]) -> None:
        """Put the frame that has won on the wire, for as long as it will last."""
        passage = Passage(senders, [node for node in self._present() if node not in senders])
        for node in list(self.nodes):
            node.began() if node in senders else node.edge()
        if passage.whole and self._spoiled:
            self._spoiled -= 1
            passage.fail(len(passage.bits) // 2)
        length_us = _us(passage.length_bits * passage.bit_ns)
        self._clock.at(self._clock.now_us + length_us, lambda: self._finish(passage))

    def _finish(self, passage: "Passage") -> None:
        present = self._present()
        whole = passage.whole and all(node in present for node in passage.senders)
        self._busy = False
        self._free_us = self._clock.now_us + _us(INTERMISSION_BITS * passage.bit_ns)
        self._quiet_ns = self._clock.now_us * 1000 - (END_BITS + 1) * passage.bit_ns
        for node in passage.others:
            if node in present:
                _hear(node, passage.frame if whole and node not in passage.aliens else None, node in passage.aliens)
        for node in passage.senders:
            if node in present:
                self._send_ends(node, whole, passage)
        self._begin_quiet()
        self.request()

    def _send_ends(self, node: Node, whole: bool, passage: "Passage") -> None:
        if whole:
            node.errors.sent()
            node.sent()
        else:
            node.errors.failed(passage.unanswered)
            if node.errors.bus_off:
                self._off[node] = QUIET_TIMES
            node.failed()
        if node.errors.passive:
            self._held_us[node] = self._free_us + _us(SUSPEND_BITS * passage.bit_ns)
        else:
            self._held_us.pop(node, None)

    def _begin_quiet(self) -> None:
        """Let nodes that are bus-off come back when the wire has been quiet for long enough."""
        for node, times in self._off.items():
            due_ns = self._quiet_ns + times * QUIET_BITS * node.bit_ns
            self._return_at.append(self._clock.at(_us(due_ns), partial(self._recover, node)))

    def _end_quiet(self) -> None:
        for event in self._return_at:
            event.cancel()
        self._return_at.clear()
        quiet_ns = self._clock.now_us * 1000 - self._quiet_ns
        for node in [node for node in self._off if node.bit_ns]:
            self._off[node] -= quiet_ns // (QUIET_BITS * node.bit_ns)

    def _recover(self, node: Node) -> None:
        if self._off.pop(node, None) is not None and node.bit_ns and node.errors.bus_off:
            node.errors.reset()
            node.recovered()
            self.request()

    def _present(self) -> list[Node]:
        return [node for node in self.nodes if node.bit_ns and not node.errors.bus_off]


class Passage:
    """One frame on the wire: who sends it, who hears it, who cannot, and how it will end if nothing intervenes."""

    def __init__(self, senders: dict[Node, Frame], others: list[Node]) -> None:
        self.senders = senders
        self.others = others
        self.frame = next(iter(senders.values()))
        self.bits = stuffed(head(self.frame))
        self.bit_ns = max(node.bit_ns for node in senders)
        self.aliens = [node for node in (*senders, *others) if not _alike(node.bit_ns, self.bit_ns)]
        self.length_bits = len(self.bits) + TAIL_BITS
        self.whole = True
        self.unanswered = False
        if any(_breaks(node) for node in self.aliens):
            self.fail(ALIEN_BITS)
        elif len(set(senders.values())) > 1:
            self.fail(_common(stuffed(head(frame)) for frame in senders.values()) + 1)
        elif all(node.silent or node in self.aliens for node in others):
            self.fail(len(self.bits) + 2)
            self.unanswered = True

    def fail(self, after_bits: int) -> None:
        """Let an error frame follow after so many bits; a second flag comes from those who only then see the first."""
        flags = 2 if any(_breaks(node) for node in self.others) else 1
        self.length_bits = after_bits + flags * ERROR_FLAG_BITS + DELIMITER_BITS
        self.whole = False


def _breaks(node: Node) -> bool:
    return not node.silent and not node.errors.passive


def _hear(node: Node, frame: Frame | None, alien: bool) -> None:
    if not node.silent:
        node.errors.heard() if frame is not None else node.errors.garbled(alien and _breaks(node))
    node.heard(frame) if frame is not None else node.garbled()


def _alike(one_ns: int, other_ns: int) -> bool:
    return abs(one_ns - other_ns) <= TOLERANCE * max(one_ns, other_ns)


def _common(frames: Iterable[list[int]]) -> int:
    """Return how many bits at their beginning all frames have in common."""
    count = 0
    for column in zip(*frames, strict=False):
        if len(set(column)) > 1:
            return count
        count += 1
    return count


def _us(ns: int) -> int:
    return -(-ns // 1000)
