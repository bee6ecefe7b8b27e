"""A CAN bus on the virtual clock: arbitration, bit times, acknowledgement, error frames, recovery from bus-off.

A frame occupies the wire for as many bit times as it has, stuffed bits counted; what comes of it is told to every node
at its end. Interframe space and the wait of an error-passive sender are those of Bosch's CAN Specification 2.0, 1991,
part B, page 54.

    wire = CanWire(clock)
    wire.join(controller)
    wire.request()  # by a node that has something to send, or that has come onto the bus

How a frame ends is worked out in canpassage.py. ASSUMED: a sender that asks within a frame waits for its end.
DEVIATION: no overload frames; propagation takes no time.
"""

from collections import Counter
from functools import partial

from hil_sim.clock import Clock, Event
from hil_sim.devices.canframe import END_BITS, INTERMISSION_BITS, Frame
from hil_sim.devices.canpassage import Node, Passage, hear

SUSPEND_BITS = 8  # that an error-passive sender waits besides
QUIET_BITS, QUIET_TIMES = 11, 128  # recessive bits, and how often, before a node that is bus-off may come back


class CanWire:
    """Two wires and the nodes on them."""

    def __init__(self, clock: Clock) -> None:
        self.nodes: list[Node] = []
        self._clock = clock
        self._busy = False
        self._free_us = 0  # when the intermission ends
        self._begin_at: Event | None = None
        self._spoiled: Counter[Node | None] = Counter()  # frames to damage, by their sender, None: of any
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

    def spoil(self, count: int, sender: Node | None = None) -> None:
        """Damage the next frames, of one sender or of any."""
        self._spoiled[sender] += count

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
        blamed = [node for node in (*senders, None) if self._spoiled[node]]
        if passage.whole and blamed:
            self._spoiled[blamed[0]] -= 1
            passage.fail(len(passage.bits.sent) // 2)
        self._clock.at(self._clock.now_us + _us(passage.length_ns), lambda: self._finish(passage))

    def _finish(self, passage: Passage) -> None:
        present = self._present()
        whole = passage.whole and all(node in present for node in passage.senders)
        self._busy = False
        self._free_us = self._clock.now_us + _us(INTERMISSION_BITS * passage.bit_ns)
        self._quiet_ns = self._clock.now_us * 1000 - (END_BITS + 1) * passage.bit_ns
        for node in passage.others:
            if node in present:
                hear(node, passage.frame if whole and node not in passage.aliens else None, node in passage.aliens)
        for node in passage.senders:
            if node in present:
                self._send_ends(node, whole, passage)
        self._begin_quiet()
        self.request()

    def _send_ends(self, node: Node, whole: bool, passage: Passage) -> None:
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


def _us(ns: int) -> int:
    return -(-ns // 1000)
