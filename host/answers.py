"""Orders that wait for the robot's answer, and the answers, decoded.

answers = Answers()
answers.expect(seq, Asked("status_request", now_ms, {}, keeper.told_ms))
taken = answers.take(kind, payload, parts, now_ms)
answers.said[seq]
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from host.coils import CoilState, coils_of
from host.errors import Refused
from host.kept import FaultPage, Settings, faults_of, settings_of
from host.profile import Parts
from host.records import Status, channel_name, status_of
from protocol import messages

Answer = Status | FaultPage | Settings | dict[str, CoilState]

DECODERS: dict[int, Callable[[bytes, Parts], Answer]] = {
    messages.FAULTS.number: lambda payload, parts: faults_of(payload, parts.channels),
    messages.SETTINGS.number: lambda payload, parts: settings_of(payload, parts.coils),
    messages.COILS.number: lambda payload, parts: coils_of(payload, parts.coils),
}


class Asked(NamedTuple):
    """An order that waits for its answer."""

    name: str
    at_ms: int
    values: dict[str, Any]
    told_ms: int | None  # the latest that the robot's clock had told then


class Taken(NamedTuple):
    """An answer that has come, and the order that it answers, if anybody gave it."""

    seq: int
    asked: Asked | None
    answer: Refused | Answer | None  # None: ok


class Answers:
    """What was asked and what was said, by the number of the order's frame."""

    def __init__(self) -> None:
        self.said: dict[int, Refused | Answer | None] = {}
        self._asked: dict[int, Asked] = {}

    def expect(self, seq: int, asked: Asked) -> None:
        """Wait for the answer to an order; an older one of that number is no longer waited for."""
        self.said.pop(seq, None)
        self._asked[seq] = asked

    def oldest(self) -> Asked | None:
        """Return the order that has waited longest, or None."""
        return next(iter(self._asked.values()), None)

    def take(self, kind: int, payload: bytes, parts: Parts, now_ms: int) -> Taken | None:
        """Take a frame, and return what it answers; None when it is no answer. ValueError: its payload is damaged."""
        if kind == messages.OK.number:
            return self._taken(messages.OK.unpack(payload).request, None)
        if kind == messages.STATUS.number:
            return self._taken(messages.STATUS.unpack(payload).request, status_of(payload, parts.channels, now_ms))
        if kind == messages.REFUSED.number:
            return self._refused(messages.REFUSED.unpack(payload), parts)
        if kind in DECODERS:
            answer = DECODERS[kind](payload, parts)
            return self._taken(payload[0], answer)
        return None

    def _refused(self, row: Any, parts: Parts) -> Taken:
        asked = self._asked.get(row.request)
        name, label = asked.name if asked else "an order", channel_name(row.channel, parts.channels)
        told = Refused(name, row.code, row.value, row.limit, label, parts.kind(label), parts.unit)
        return self._taken(row.request, told)

    def _taken(self, seq: int, answer: Refused | Answer | None) -> Taken:
        asked = self._asked.pop(seq, None)
        if asked:
            self.said[seq] = answer
        return Taken(seq, asked, answer)
