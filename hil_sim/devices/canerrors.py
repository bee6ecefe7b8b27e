"""Fault confinement of one CAN controller: its two error counters and what they forbid it.

Bosch, CAN Specification 2.0, 1991, section 8 (part A, page 24; part B, page 61), the rules that a whole-frame wire can
tell apart: a failed transmission counts 8, a damaged reception 1 (9 for who damages it with its own error flag), a
success takes 1 back; beyond 127 a controller is error-passive, beyond 255 bus-off. An error-passive sender whom nobody
acknowledges counts no further: a lone controller repeats for ever and never goes bus-off.
"""

PASSIVE_ABOVE, OFF_ABOVE, WARNING = 127, 255, 96
_COUNT_MAX = 255


class Errors:
    """Counts, from 0. `unanswered`: the last frame of its own failed because nobody acknowledged it."""

    def __init__(self) -> None:
        self.transmit = self.receive = 0
        self.unanswered = False

    def reset(self) -> None:
        """Begin anew, as configuration mode and the end of bus-off do."""
        self.transmit = self.receive = 0

    @property
    def passive(self) -> bool:
        """Whether it may no longer destroy a frame that it finds damaged."""
        return self.transmit > PASSIVE_ABOVE or self.receive > PASSIVE_ABOVE

    @property
    def bus_off(self) -> bool:
        """Whether it has to keep off the wire."""
        return self.transmit > OFF_ABOVE

    def sent(self) -> None:
        """A frame of its own was acknowledged."""
        self.transmit = max(0, self.transmit - 1)

    def heard(self) -> None:
        """A frame arrived whole."""
        self.receive = min(PASSIVE_ABOVE, max(0, self.receive - 1))

    def failed(self, unanswered: bool) -> None:
        """A frame of its own failed, because nobody acknowledged it or for another reason."""
        self.unanswered = unanswered
        if not (unanswered and self.passive):
            self.transmit += 8

    def garbled(self, destroyed: bool) -> None:
        """A frame arrived damaged, or it destroyed a frame that it could not read."""
        self.receive = min(_COUNT_MAX, self.receive + (9 if destroyed else 1))
