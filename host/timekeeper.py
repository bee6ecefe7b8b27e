"""Keeps the robot's clock in view: asks for it now and then, and notices one that has begun anew.

Questions leave at uneven times, so that they meet the robot's control step in every phase; the clearest answers count.
Only a time before one that the robot had told already proves a restart. One that is merely behind what was reckoned
proves nothing, for a clock may stand still: it makes the keeper `doubt`, until the robot has said who it is.

    keeper = Timekeeper()
    question = keeper.question(now_us)   # the payload of a `clock_request`, or None: not due
    keeper.answered(messages.CLOCK.unpack(payload), now_us)
    keeper.told(robot_ms, keeper.made_after(sent_ms, SLACK_MS), now_us, len(payload))   # True: the robot has restarted
"""

from __future__ import annotations

from typing import Any, NamedTuple

from host.robotclock import RobotClock, since
from protocol import frames, messages

SOON_MS, SOON = 50, 5  # so far apart are so many questions, to begin with
APART_MS, UNEVEN_MS, STRIDE_MS = 400, 200, 127
UNANSWERED_MS = 2000  # after a question that was not answered
OPEN_MAX = 4  # questions that may wait for an answer; who asks more often has lost those before
LATE_MS = 500  # between the making of a frame and its arrival on a line that is read
SLACK_MS = 50  # by which the answer to a question may seem too early, should the clocks be read unluckily
FRAME_BYTES = frames.BODY_MIN + frames.STUFFING  # beside its payload
QUESTION_BYTES, ANSWER_BYTES = 4 + FRAME_BYTES, 12 + FRAME_BYTES


class Origin(NamedTuple):
    """When a frame was made at the earliest."""

    host_ms: float
    told_ms: int | None  # the latest that the robot's clock had told then
    slack_ms: int  # by which its time may be before that all the same


class Timekeeper:
    """The robot's clock as this session knows it."""

    def __init__(self) -> None:
        self.clock = RobotClock()
        self.told_ms: int | None = None  # the latest of the robot's times so far
        self.doubts = False  # whether the robot is the one it was
        self.byte_ns = 0  # of a byte on the line, 0: not known
        self._due_us: int | None = None
        self._asked_us: dict[int, int] = {}  # by their last 32 bits
        self._count = 0
        self._event_ms: int | None = None  # the robot's clock in its last event

    def question(self, now_us: int) -> bytes | None:
        """Return the payload of a question for the clock if one is due."""
        if self._due_us is not None and now_us < self._due_us:
            return None
        self._count += 1
        apart_ms = SOON_MS if self._count < SOON else APART_MS + self._count * STRIDE_MS % UNEVEN_MS
        self._due_us = now_us + 1000 * (UNANSWERED_MS if self._asked_us else apart_ms)
        self._asked_us[now_us & 0xFFFFFFFF] = now_us
        while len(self._asked_us) > OPEN_MAX:
            del self._asked_us[next(iter(self._asked_us))]
        payload: bytes = messages.CLOCK_REQUEST.pack(host_us=now_us & 0xFFFFFFFF)
        return payload

    def due_us(self, now_us: int) -> int:
        """Return when the next question is due."""
        return now_us if self._due_us is None else self._due_us

    def answered(self, clock: Any, now_us: int) -> None:
        """Take the answer to a question; one that nobody asked says nothing."""
        asked_us = self._asked_us.pop(clock.host_us, None)
        if asked_us is not None:
            self._asked_us.clear()  # older ones are lost
            self.clock.answered(asked_us / 1000, clock.received_ms, self._line_ms(QUESTION_BYTES))
            self._read(clock.sent_ms, now_us / 1000, ANSWER_BYTES)

    def made_after(self, host_ms: float, slack_ms: int) -> Origin:
        """Return the origin of a frame that is made after the host's `host_ms`, and after all that was told so far."""
        return Origin(host_ms, self.told_ms, slack_ms)

    def told(self, robot_ms: int, origin: Origin, now_us: int, payload_bytes: int) -> bool:
        """Take a robot time; return whether the clock has begun anew, because it is before what it had told."""
        if _is_before(robot_ms, origin.told_ms, origin.slack_ms):
            return True
        self.doubts = self.doubts or _is_before(robot_ms, self.clock.earliest(origin.host_ms), origin.slack_ms)
        self._read(robot_ms, now_us / 1000, payload_bytes + FRAME_BYTES)
        return False

    def happened(self, robot_ms: int, now_us: int, payload_bytes: int) -> bool:
        """Take the time of an event: it may have been sent many times, but never arrives before one that is older."""
        before_ms, self._event_ms = self._event_ms, robot_ms
        if _is_before(robot_ms, before_ms, 0):
            return True
        self._read(robot_ms, now_us / 1000, payload_bytes + FRAME_BYTES)
        return False

    def introduced(self, asked_ms: float, robot_ms: int, now_us: int, payload_bytes: int) -> None:
        """Take the time in an `identity` that was asked for then: the robot is the one it was, or the first."""
        self.clock.answered(asked_ms, robot_ms)
        self._read(robot_ms, now_us / 1000, payload_bytes + FRAME_BYTES)
        self.doubts = False

    def _read(self, robot_ms: int, now_ms: float, octets: int) -> None:
        if self.told_ms is None or since(robot_ms, self.told_ms) > 0:
            self.told_ms = robot_ms
        self.clock.read(robot_ms, now_ms, self._line_ms(octets))

    def _line_ms(self, octets: int) -> float:
        return octets * self.byte_ns / 1e6


def _is_before(robot_ms: int, earlier_ms: int | None, slack_ms: int) -> bool:
    return earlier_ms is not None and since(robot_ms, earlier_ms) < -slack_ms
