"""One frame on a CAN wire: who sends it, who hears it, who cannot, and how it ends.

Who signals an error, and when, is in Bosch's CAN Specification 2.0, 1991, part B, section 7.2. ASSUMED: bit rates
within 1.7 % of each other understand each other (Microchip DS20001801J, 5.4, the variation that it allows between
oscillators); another rate is found out after 12 bits, and who finds it out destroys the frame. So does a classic
controller that hears CAN FD, ASSUMED 12 bits after the bit that says so, which it takes for a reserved one.
"""

from collections.abc import Iterable
from typing import Protocol

from hil_sim.devices.canbits import bits_of
from hil_sim.devices.canerrors import Errors
from hil_sim.devices.canframe import TAIL_BITS, Frame

TOLERANCE = 0.017
ERROR_FLAG_BITS, DELIMITER_BITS = 6, 8
ALIEN_BITS = 12


class Node(Protocol):
    """What the wire needs of a controller; `bit_ns` is 0 while it is not on the bus, `silent` one only listens.

    `data_bit_ns` is 0 for a controller that knows no CAN FD.
    """

    bit_ns: int
    data_bit_ns: int
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


class Passage:
    """One frame on the wire: who sends it, who hears it, who cannot, and how it will end if nothing intervenes."""

    def __init__(self, senders: dict[Node, Frame], others: list[Node]) -> None:
        self.senders = senders
        self.others = others
        self.frame = next(iter(senders.values()))
        self.bits = bits_of(self.frame)
        self.bit_ns = max(node.bit_ns for node in senders)
        self._data_bit_ns = max(node.data_bit_ns for node in senders)
        lost = {node: self._lost_after(node) for node in (*senders, *others)}
        self.aliens = {node: after_bits for node, after_bits in lost.items() if after_bits}
        self.length_ns = self._duration_ns(len(self.bits.sent) + TAIL_BITS)
        self.whole = True
        self.unanswered = False
        broken = [after_bits for node, after_bits in self.aliens.items() if _breaks(node)]
        if broken:
            self.fail(min(broken))
        elif len(set(senders.values())) > 1:
            self.fail(_common(bits_of(frame).sent for frame in senders.values()) + 1)
        elif all(node.silent or node in self.aliens for node in others):
            self.fail(len(self.bits.sent) + 2)
            self.unanswered = True

    def fail(self, after_bits: int) -> None:
        """Let an error frame follow after so many bits; a second flag comes from those who only then see the first."""
        flags = 2 if any(_breaks(node) for node in self.others) else 1
        self.length_ns = self._duration_ns(after_bits) + (flags * ERROR_FLAG_BITS + DELIMITER_BITS) * self.bit_ns
        self.whole = False

    def _lost_after(self, node: Node) -> int:
        """Return after how many bits a node finds that it cannot read this frame, 0: it can."""
        if not _alike(node.bit_ns, self.bit_ns):
            return ALIEN_BITS
        if self.frame.fd and not node.data_bit_ns:
            return self.bits.format_bit + ALIEN_BITS
        if self.frame.brs and not _alike(node.data_bit_ns, self._data_bit_ns):
            return self.bits.fast.start + ALIEN_BITS
        return 0

    def _duration_ns(self, count: int) -> int:
        return self.bits.duration_ns(count, self.bit_ns, self._data_bit_ns)


def _breaks(node: Node) -> bool:
    return not node.silent and not node.errors.passive


def hear(node: Node, frame: Frame | None, alien: bool) -> None:
    """Tell a node of a frame, or None for a damaged one, at which it may have been an alien."""
    if not node.silent:
        node.errors.heard() if frame is not None else node.errors.garbled(alien and _breaks(node))
    node.heard(frame) if frame is not None else node.garbled()


def _alike(one_ns: int, other_ns: int) -> bool:
    return abs(one_ns - other_ns) <= TOLERANCE * max(one_ns, other_ns)


def _common(frames: Iterable[tuple[int, ...]]) -> int:
    """Return how many bits at their beginning all frames have in common."""
    count = 0
    for column in zip(*frames, strict=False):
        if len(set(column)) > 1:
            return count
        count += 1
    return count
