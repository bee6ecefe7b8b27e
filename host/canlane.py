"""The ways of frames to robots on CAN: to each one after another, no quicker than it fetches them.

What goes to all keeps its distance from all else. No more is handed over than the bus takes with room to spare, so that
a stop finds an empty queue in the adapter and robots find time to answer.

    lanes = Lanes(500_000)
    lanes.lane(node).add(frame)
    frame = lanes.pop(now_s) if lanes.due_s() <= now_s else None
"""

from __future__ import annotations

from collections import deque

from protocol import frames
from protocol.canbus import ALL, GAP_MS, SLEEP_MS, WAKE_MS, CanFrame

GAP_S, WAKE_S, SLEEP_S = GAP_MS / 1000, WAKE_MS / 1000, SLEEP_MS / 1000
GAP_MAX_S = 0.016
WIDER = 4  # times the distance, at each frame that has to be sent again
EASED_AFTER = 50  # segments that were not missed, before their distance is halved again
RECENT = 32  # frames among which one that is sent again is recognised
WAITING_MAX = 2048
SPARE = 1.5  # times that a frame takes, until the next one
NEVER_S = float("inf")


class Lane:
    """The frames that wait to be sent to one robot, and when the next may go."""

    def __init__(self) -> None:
        self.waiting: deque[CanFrame] = deque()
        self.due_s = 0.0
        self._gap_s = GAP_S
        self._sent_s = -SLEEP_S
        self._passed = 0
        self._added = 0
        self._recent: deque[tuple[tuple[int, int], int]] = deque(maxlen=RECENT)  # and how many were added before

    def add(self, frame: CanFrame) -> None:
        """Queue a frame; what is too much is lost, as on any line."""
        if len(self.waiting) < WAITING_MAX:
            self.waiting.append(frame)
            self._added += 1

    def notice(self, stuffed: bytes) -> None:
        """Keep more distance when a reliable frame is sent again that had left: the robot has missed a segment."""
        body = frames.decode(stuffed)
        if not body or len(body) < frames.BODY_MIN or not body[0] & frames.RELIABLE:
            return
        mark = (body[1], body[2])
        left = self._added - len(self.waiting)
        if any(mark == seen and left > before for seen, before in self._recent):
            self._gap_s, self._passed = min(WIDER * self._gap_s, GAP_MAX_S), 0
        self._recent.append((mark, self._added))

    def pop(self, now_s: float) -> CanFrame:
        """Take the frame that is due, and reckon when the next one is."""
        slept = now_s - self._sent_s >= SLEEP_S
        self.due_s = now_s + (max(WAKE_S, self._gap_s) if slept else self._gap_s)
        self._sent_s = now_s
        self._passed += 1
        if self._passed >= EASED_AFTER:
            self._gap_s, self._passed = max(self._gap_s / 2, GAP_S), 0
        return self.waiting.popleft()


class Lanes:
    """The lanes of all robots on a bus, by their nodes, and the one to ALL, which goes before the others."""

    def __init__(self, bitrate_hz: int) -> None:
        self._bitrate_hz = bitrate_hz
        self._lanes = {ALL: Lane()}
        self._free_s = 0.0  # when the bus has taken what was handed over
        self._spoke_s = self._called_s = -SLEEP_S  # when anything was sent last, and when it went to all

    def lane(self, node: int) -> Lane:
        """Return the lane of a robot."""
        return self._lanes.setdefault(node, Lane())

    def due_s(self) -> float:
        """Return when the next frame may go, NEVER_S when none waits."""
        if self._lanes[ALL].waiting:
            return max(self._spoke_s + WAKE_S, self._free_s)
        due_s = min((lane.due_s for lane in self._lanes.values() if lane.waiting), default=NEVER_S)
        return max(due_s, self._called_s + WAKE_S, self._free_s)

    def pop(self, now_s: float) -> CanFrame:
        """Take the frame that is due."""
        lane = self._lanes[ALL]
        self._spoke_s = now_s
        if lane.waiting:
            self._called_s = now_s
        else:
            lane = min((lane for lane in self._lanes.values() if lane.waiting), key=lambda lane: lane.due_s)
        frame = lane.pop(now_s)
        self._free_s = now_s + SPARE * _bits(frame) / self._bitrate_hz
        return frame


def _bits(frame: CanFrame) -> int:
    """Return how long an extended frame is at most, with all that is stuffed."""
    return 80 + 10 * len(frame.data)
