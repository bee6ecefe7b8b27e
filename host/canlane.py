"""The way of frames to one robot on CAN: one after another, no quicker than it fetches them.

lane = Lane()
lane.add(frame)
lane.pop(now_s) if lane.waiting and lane.due_s <= now_s else None
"""

from __future__ import annotations

from collections import deque

from protocol import frames
from protocol.canbus import GAP_MS, SLEEP_MS, WAKE_MS, CanFrame

GAP_S, WAKE_S, SLEEP_S = GAP_MS / 1000, WAKE_MS / 1000, SLEEP_MS / 1000
GAP_MAX_S = 0.016
WIDER = 4  # times the distance, at each frame that has to be sent again
EASED_AFTER = 50  # segments that were not missed, before their distance is halved again
RECENT = 32  # frames among which one that is sent again is recognised
WAITING_MAX = 2048


class Lane:
    """The frames that wait to be sent to one robot, and when the next may go."""

    def __init__(self) -> None:
        self.waiting: deque[CanFrame] = deque()
        self.due_s = 0.0
        self._gap_s = GAP_S
        self._sent_s = -SLEEP_S
        self._passed = 0
        self._recent: deque[tuple[int, int]] = deque(maxlen=RECENT)

    def add(self, frame: CanFrame) -> None:
        """Queue a frame; what is too much is lost, as on any line."""
        if len(self.waiting) < WAITING_MAX:
            self.waiting.append(frame)

    def notice(self, stuffed: bytes) -> None:
        """Keep more distance when a reliable frame is sent again: the robot has missed a segment, or is far behind."""
        body = frames.decode(stuffed)
        if not body or len(body) < frames.BODY_MIN or not body[0] & frames.RELIABLE:
            return
        mark = (body[1], body[2])
        if mark in self._recent:
            self._gap_s, self._passed = min(WIDER * self._gap_s, GAP_MAX_S), 0
        self._recent.append(mark)

    def pop(self, now_s: float) -> CanFrame:
        """Take the frame that is due, and reckon when the next one is."""
        slept = now_s - self._sent_s >= SLEEP_S
        self.due_s = now_s + (max(WAKE_S, self._gap_s) if slept else self._gap_s)
        self._sent_s = now_s
        self._passed += 1
        if self._passed >= EASED_AFTER:
            self._gap_s, self._passed = max(self._gap_s / 2, GAP_S), 0
        return self.waiting.popleft()
