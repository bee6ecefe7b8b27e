"""What a host has subscribed to: up to four records of telemetry, each with its variables, its period or on change.

A record is made only when the line has room for it and a whole frame besides: telemetry waits for answers and events,
never the other way round. A record that is late goes as soon as there is room; those whose time has passed meanwhile
are counted as if they had been sent, so that the host sees by `count` how many it did not get, whatever the reason.

    subscriptions.subscribe(0, 10, False, bytes(variables.USUAL), order.seq, now_ms)
    payload = subscriptions.record(now_ms, room)
"""

import struct

from firmware.channels import Refused
from firmware.readings import Readings
from protocol import codes, variables
from protocol.frames import BODY_MIN, FRAME_MAX, PAYLOAD_MAX, STUFFING

SLOTS = 4  # of a session; one more is for those who only watch
WATCH_MS = 2000  # after it was asked for, they get no more
WATCH_PERIOD_MS = 50  # at the least: the line is the session's
STEP_MS = 5  # nothing changes within a control step
STILL_MS = 1000  # what has not changed is told again this often: the record that told it may be lost
HEAD = "<BBBI"  # slot, form, count, now_ms
HEAD_BYTES = struct.calcsize(HEAD)
VALUES_MAX = PAYLOAD_MAX - HEAD_BYTES
BESIDE = HEAD_BYTES + BODY_MIN + STUFFING + 1 + FRAME_MAX  # room that a record needs beside its values
USUAL_FORM = 0  # of records that every listener can read


class Subscription:
    """One slot. Its `count` goes on from one subscription to the next, as long as the session lasts."""

    def __init__(self, place: int) -> None:
        self.place = place
        self.period_ms = 0  # 0: nothing is sent
        self.on_change = False
        self.form = USUAL_FORM
        self.readers = ()  # none: the usual variables
        self.layout = "<"
        self.room = 0
        self.due_ms = 0
        self.count = 0
        self.last = b""
        self.told_ms = 0
        self.blocked = False  # a change waits for room since `due_ms`


class Subscriptions:
    """The slots of one core; `active` are those that have something to send."""

    def __init__(self, core) -> None:
        self._readings = Readings(core)
        self._counts = _counts(core)
        self.forget()

    def forget(self) -> None:
        """End all: nobody is left who asked for it."""
        self.active = ()
        self._slots = [Subscription(place) for place in range(SLOTS + 1)]
        self._watched_ms = 0
        self._turn = 0

    def subscribe(self, slot: int, period_ms: int, on_change: bool, numbers: bytes, request: int, now_ms: int) -> None:
        """Send these variables from now on, or nothing when the period is 0; or raise Refused, and nothing changes."""
        if slot >= SLOTS:
            raise Refused(codes.SLOT_LIMIT, 255, slot, SLOTS - 1)
        mine = self._slots[slot]
        if period_ms:
            self._check(period_ms, numbers)
            usual = tuple(numbers) == variables.USUAL
            mine.form = USUAL_FORM if usual else 1 + request % 255
            mine.readers = () if usual else [self._readings.readers[number] for number in numbers]
            mine.layout = variables.layout(numbers, self._counts)
            mine.room = struct.calcsize(mine.layout) + BESIDE
            mine.on_change, mine.due_ms = on_change, now_ms
            mine.last, mine.blocked = b"", False
        mine.period_ms = period_ms
        self.active = [each for each in self._slots if each.period_ms]

    def watch(self, period_ms: int, now_ms: int) -> None:
        """Send the usual variables for a while to whoever asks, whichever session there is."""
        mine = self._slots[SLOTS]
        if not mine.period_ms:
            mine.layout = variables.layout(variables.USUAL, self._counts)
            mine.room = struct.calcsize(mine.layout) + BESIDE
            mine.due_ms = now_ms
        mine.period_ms = max(period_ms, WATCH_PERIOD_MS)
        self._watched_ms = now_ms
        self.active = [each for each in self._slots if each.period_ms]

    def record(self, now_ms: int, room: int) -> bytes:
        """Return the payload of a record that is due and for which there is room, or b""; the slots take turns."""
        for _ in self.active:
            self._turn = (self._turn + 1) % len(self.active)
            mine = self.active[self._turn]
            if mine.place == SLOTS and now_ms - self._watched_ms > WATCH_MS:
                mine.period_ms = 0
                self.active = [each for each in self._slots if each.period_ms]
                return b""
            if now_ms - mine.due_ms >= 0:
                values = self._values(mine, now_ms, room)
                if values:
                    head = struct.pack(HEAD, mine.place, mine.form, mine.count, now_ms & 0xFFFFFFFF)
                    mine.count = (mine.count + 1) & 255
                    return head + variables.veiled(values)
        return b""

    def _check(self, period_ms: int, numbers: bytes) -> None:
        if period_ms < STEP_MS:
            raise Refused(codes.PERIOD_LIMIT, 255, period_ms, STEP_MS)
        for number in numbers:
            if number >= len(variables.VARIABLES):
                raise Refused(codes.UNKNOWN_VARIABLE, 255, number, len(variables.VARIABLES) - 1)
        octets = variables.size(numbers, self._counts)
        if not 0 < octets <= VALUES_MAX:
            raise Refused(codes.RECORD_LIMIT, 255, octets, VALUES_MAX if octets else 1)

    def _values(self, mine: Subscription, now_ms: int, room: int) -> bytes:
        """Return the values to send now, or b""; count those that found no room since they were due."""
        if room < mine.room and not mine.on_change:
            return b""
        values = self._read(mine) if mine.readers else self._readings.usual()
        if mine.on_change and not self._is_news(mine, values, now_ms, room):
            return b""
        skipped = (now_ms - mine.due_ms) // mine.period_ms
        mine.count = (mine.count + skipped) & 255
        mine.due_ms += (skipped + 1) * mine.period_ms
        return values

    def _read(self, mine: Subscription) -> bytes:
        flat = []
        for reader in mine.readers:
            reader(flat)
        return struct.pack(mine.layout, *flat)

    def _is_news(self, mine: Subscription, values: bytes, now_ms: int, room: int) -> bool:
        """Return whether to send values on change now; the time of a change that finds no room becomes its due time."""
        if values == mine.last and not mine.blocked and now_ms - mine.told_ms < STILL_MS:
            return False
        if not mine.blocked:
            mine.due_ms = now_ms
        mine.blocked = room < mine.room
        if mine.blocked:
            return False
        mine.last, mine.told_ms = values, now_ms
        return True


def _counts(core) -> variables.Counts:
    """Return how many of what a record may tell the robot has."""
    profile = core.profile
    cameras, loads = 1 if profile.camera else 0, 1 if profile.load else 0
    return variables.Counts(len(profile.coils), len(profile.joints), cameras, loads, len(profile.cells))
