"""A robot of the tests' own, made of protocol.link alone, and a line to it on a virtual clock.

It answers as the wire's table says and does what its test tells it to, so that the host can be tried against answers
that the real firmware never gives.
"""

from __future__ import annotations

import json
import random
import struct
from pathlib import Path
from types import SimpleNamespace

import pytest

from host.definitions import dictionary_of
from host.errors import LinkLost
from host.profile import Parts
from protocol import frames, messages, variables
from protocol.link import Link

PROFILE = (Path(__file__).parents[1] / "firmware/robots/circular.json").read_bytes()
LABELS = [channel["label"] for channel in json.loads(PROFILE)["channels"]]
STEP_MS = 5
PAGE = 200


def telemetry_of(form: int, values: bytes) -> bytes:
    """Return a record of telemetry as it stands on the line."""
    return messages.TELEMETRY.pack(slot=0, form=form, count=0, now_ms=70, values=variables.veiled(values))


class FakeRobot:
    """Answers every request with ok, runs a program of `program_ms`, and does what its attributes say."""

    def __init__(self, profile: bytes = PROFILE, dictionary: bytes | None = None) -> None:
        self.parts = _parts_of(profile)
        self.dictionary = dictionary or dictionary_of(profile)
        self.seed = frames.crc32(self.dictionary)
        self.link = Link(self.seed, device=True)
        self.link.may_adopt = True
        self.boot = 1
        self.now_ms = 0  # of the line
        self.started_ms = 0  # the line's time at which the robot's clock began
        self.help_text = b"fire Heat coils for a limited time.\nfire.hold_ms Off again after this long.\n"
        self.role = messages.HOLDER
        self.holder = 0
        self.state = messages.IDLE
        self.session = 0
        self.refuse: dict[str, tuple[int, int, int, int]] = {}  # message -> code, channel, value, limit
        self.deaf = False
        self.program_ms = 500
        self.ending = (messages.FINISHED, 0, 255, 0)
        self.orders: list[tuple] = []  # (time, name, payload's fields)
        self.code = bytearray()
        self.stops = 0
        self.paused = False
        self.duty = [0] * len(self.parts.coils)
        self.joints = [FakeJoint() for _ in self.parts.joints]
        self.object_centideg = 0
        self.load_mn = 0
        self.cell_pa = [0] * len(self.parts.cells)
        self.period_ms = 0
        self.count = 0  # of telemetry
        self.supply_mv = 2000
        self.attitude = {"roll_decideg": 0, "pitch_decideg": 0, "down": 255}
        self._until: dict[int, int] = {}
        self._ends_ms: int | None = None
        self._due_ms = 0
        self._finder = frames.StopFinder()

    @property
    def last_order(self) -> tuple:
        """Return the fields of the order that came last."""
        return self.orders[-1][2]

    def taken(self, *names: str) -> list[tuple]:
        """Return the orders of these names, each with its fields."""
        return [(name, *order) for _, name, order in self.orders if name in names]

    def step(self, now_ms: int, data: bytes) -> bytes:
        """Take the bytes that arrived, go on to `now_ms`, return the bytes to send."""
        self.now_ms = now_ms
        if self.deaf:
            return b""
        if self._finder.feed(data):
            self._stopped(now_ms)
        delivered = self.link.receive(data, now_ms)
        if self.link.session != self.session:
            self.session, self.period_ms, self.count = self.link.session, 0, 0
        for received in delivered:
            self._serve(received, now_ms)
        self._go_on(now_ms)
        return self.link.poll(now_ms)

    def tell(self, event: int, code: int, channel: int, value: int, now_ms: int) -> None:
        """Send an event."""
        payload = messages.EVENT.pack(event=event, code=code, step=3, channel=channel, value=value, now_ms=now_ms)
        self.link.send(messages.EVENT.number, payload, now_ms)

    @property
    def uptime_ms(self) -> int:
        """Return the robot's clock."""
        return (self.now_ms - self.started_ms) & 0xFFFFFFFF

    def restart(self, boot: int | None = None) -> None:
        """Forget everything, as after a reset; the next number of a start may be the same."""
        self.boot = self.boot + 1 if boot is None else boot
        self.started_ms = self.now_ms
        self.session, self.state, self.period_ms = 0, messages.IDLE, 0
        self.link.begin(self.seed, 0)

    def _serve(self, received, now_ms: int) -> None:
        message = messages.by_number(received.kind)
        order = message.unpack(received.payload)
        if message is messages.CLOCK_REQUEST:
            self._post(messages.CLOCK, host_us=order.host_us, received_ms=self.uptime_ms, sent_ms=self.uptime_ms)
            return
        self.orders.append((now_ms, message.name, order))
        if message is messages.HELLO:
            self._hello(order)
        elif message is messages.DICTIONARY:
            text = self.help_text if order.part == messages.HELP else self.dictionary
            page = text[order.offset : order.offset + min(order.count, PAGE)]
            self._post(messages.DICTIONARY_PAGE, part=order.part, offset=order.offset, text=page)
        elif message is messages.WATCH:
            self.telemetry(slot=4)
        elif message.name in self.refuse:
            code, channel, value, limit = self.refuse[message.name]
            self._send(
                messages.REFUSED, now_ms, request=received.seq, code=code, channel=channel, value=value, limit=limit
            )
        elif message is messages.STATUS_REQUEST:
            self._status(received.seq, now_ms)
        elif message is messages.SETTINGS_REQUEST:
            resistances = bytes(2 * len(self.duty))
            self._send(
                messages.SETTINGS, now_ms, request=received.seq, source=0, node=0, board_offset_decidegc=0,
                resistances=resistances,
            )  # fmt: skip
        else:
            self._obey(message, order, now_ms)
            self._send(messages.OK, now_ms, request=received.seq)

    def _obey(self, message, order, now_ms: int) -> None:
        if message is messages.ARM:
            self.state = messages.ARMED
        elif message is messages.DISARM:
            self.state = messages.IDLE
            self._let_go()
            self.tell(messages.DISARMED, 0, 255, 0, now_ms)
        elif message is messages.SUBSCRIBE:
            self.period_ms = order.period_ms
        elif message is messages.FIRE:
            for i in range(len(self.duty)):
                if order.coils >> i & 1:
                    self.duty[i], self._until[i] = order.duty_permille, now_ms + order.hold_ms
        elif message in (messages.MOVE, messages.ORIENT, messages.PRESS):
            self._turn(message, order, now_ms)
        elif message is messages.CODE:
            self.code += order.code
        elif message is messages.START:
            self.state, self._ends_ms = messages.RUNNING, now_ms + self.program_ms
            self.tell(messages.STARTED, 0, 255, 0, now_ms)

    def _turn(self, message, order, now_ms: int) -> None:
        if message is messages.ORIENT:
            self.object_centideg = order.target_centideg
        if message is messages.PRESS:
            self._press(order.target_mn)
        for i, joint in enumerate(self.joints):
            if message is messages.ORIENT:
                joint.move(joint.commanded_centi - order.target_centideg, now_ms + order.time_ms, order.hold_ms)
            elif message is messages.PRESS:
                joint.move(order.target_mn // 10, now_ms + order.time_ms, order.hold_ms)
            elif order.joints >> len(self.duty) + i & 1:
                joint.move(order.target_centi, now_ms + order.over_ms, order.hold_ms)

    def _press(self, target_mn: int) -> None:
        """Feel that force at once, 1 kPa in each force cell for each newton, and give way 1 mm for each."""
        self.load_mn, self.cell_pa = target_mn, [target_mn] * len(self.cell_pa)

    def _go_on(self, now_ms: int) -> None:
        for i, until_ms in list(self._until.items()):
            if now_ms >= until_ms:
                self.duty[i] = 0
                del self._until[i]
        for joint in self.joints:
            joint.step(now_ms)
        if self._ends_ms is not None and now_ms >= self._ends_ms:
            self._ends_ms = None
            event = self.ending[0]
            self.state = messages.TRIPPED if event == messages.TRIP else messages.ARMED
            self.tell(*self.ending, now_ms)
        if self.period_ms and now_ms >= self._due_ms:
            self._due_ms = now_ms + self.period_ms
            self.telemetry()

    def telemetry(self, late_ms: int = 0, slot: int = 0) -> None:
        """Send telemetry, or what is that late."""
        degrees = [250 + duty for duty in self.duty]
        parts = self.parts
        counts = variables.Counts(len(self.duty), len(self.joints), parts.cameras, parts.loads, len(parts.cells))
        values = variables.veiled(struct.pack(
            variables.layout(variables.USUAL, counts),
            self.state, 0, self.supply_mv, 0, 231, *self.attitude.values(), *self.duty, *degrees,
            *[joint.centi for joint in self.joints], *[joint.commanded_centi for joint in self.joints],
            *[joint.ma for joint in self.joints], *[self.object_centideg] * parts.cameras,
            *[self.load_mn] * parts.loads, *self.cell_pa,
        ))  # fmt: skip
        now_ms = (self.uptime_ms - late_ms) & 0xFFFFFFFF
        self._post(messages.TELEMETRY, slot=slot, form=0, count=self.count, now_ms=now_ms, values=values)
        self.count = (self.count + 1) & 255

    def _hello(self, order) -> None:
        self.link.offer(order.session)
        self._post(
            messages.IDENTITY, session=order.session, boot=self.boot, uptime_ms=self.uptime_ms,
            dictionary_crc=self.seed, dictionary_bytes=len(self.dictionary), version=frames.VERSION,
            state=self.state, role=self.role, node=0, secured=0, slots=32, bytes=960, byte_ns=0,
            holder=self.holder, step=0,
            nonce_a=0, nonce_b=0, proof_a=0, proof_b=0, firmware=b"softrig 0.1.0",
        )  # fmt: skip

    def _status(self, seq: int, now_ms: int) -> None:
        self._send(
            messages.STATUS, now_ms, request=seq, state=self.state, code=0, uptime_ms=self.uptime_ms, lease_ms=0,
            step=0, paused=int(self.paused), coils=self._driven(), supply_mv=self.supply_mv, current_ma=12,
            board_decidegc=231, dropped=0, forged=0, repeated=0, overruns=0, **self.attitude,
        )  # fmt: skip

    def _stopped(self, now_ms: int) -> None:
        driven = self._driven()
        self.stops += 1
        self.state, self._ends_ms = messages.TRIPPED, None
        self._let_go()
        self._post(messages.STOPPED, state=self.state, code=101, coils=driven, now_ms=self.uptime_ms)

    def _driven(self) -> int:
        """Return the mask of the channels that are driven."""
        driven = [duty > 0 for duty in self.duty] + [joint.driven for joint in self.joints]
        return sum(1 << i for i, each in enumerate(driven) if each)

    def _let_go(self) -> None:
        """Switch every coil off and let every joint go limp."""
        self.duty = [0] * len(self.duty)
        for joint in self.joints:
            joint.commanded_centi = variables.UNKNOWN_CENTI

    def _send(self, message, now_ms: int, **values) -> None:
        self.link.send(message.number, message.pack(**values), now_ms)

    def _post(self, message, **values) -> None:
        self.link.post(message.number, message.pack(**values))


def _parts_of(profile: bytes) -> Parts:
    """Return the parts that a profile names, also one that is not good enough for a host."""
    data = json.loads(profile)
    labels = [tuple(row["label"] for row in data["channels"] if row["kind"] == kind) for kind in ("sma", "servo")]
    return Parts(
        labels[0] + labels[1],
        *labels,
        cameras=int("camera" in data),
        loads=int("load" in data),
        cells=tuple(row["label"] for row in data.get("cells", ())),
        unit=data.get("servo", {}).get("unit", "deg"),
    )


class FakeJoint:
    """A joint that stands where it was told to go as soon as its time is over."""

    def __init__(self) -> None:
        self.centi = 0
        self.commanded_centi = variables.UNKNOWN_CENTI
        self.ma = 120  # while it is driven it takes ten times as much
        self._arrives_ms = self._ends_ms = 0

    @property
    def driven(self) -> bool:
        """Return whether it has pulses."""
        return self.commanded_centi != variables.UNKNOWN_CENTI

    def move(self, target_centi: int, arrives_ms: int, hold_ms: int) -> None:
        """Go there, and go limp that long after."""
        self.commanded_centi, self.ma = target_centi, 1200
        self._arrives_ms, self._ends_ms = arrives_ms, arrives_ms + hold_ms

    def step(self, now_ms: int) -> None:
        """Arrive, or go limp, when it is time."""
        if self.driven and now_ms >= self._arrives_ms:
            self.centi = self.commanded_centi
        if self.driven and now_ms >= self._ends_ms:
            self.commanded_centi, self.ma = variables.UNKNOWN_CENTI, 120


def plug_in(line: object, monkeypatch: pytest.MonkeyPatch) -> None:
    """Have every command of this test find `line` at the address fake:, which is the robot that it talks to."""
    point = SimpleNamespace(name="fake", load=lambda: lambda address: line)
    monkeypatch.setattr("host.link.entry_points", lambda group: [point])
    monkeypatch.setenv("SOFTRIG_ROBOT", "fake:")


class FakeLine:
    """A line to a fake robot: virtual time, steps of 5 ms, seeded loss of whole writes, and a cable to cut."""

    observer = None
    repeatable = True

    def __init__(self, robot, loss: float = 0.0, seed: int = 1) -> None:
        self.robot = robot
        self.now_ms = 1000
        self.cut = False
        self.closed = False
        self.at: dict[int, object] = {}  # time -> what happens then
        self.written = b""
        self._loss = loss
        self._random = random.Random(seed)
        self._outward = self._inward = b""

    def now_s(self) -> float:
        return self.now_ms / 1000

    def write(self, data: bytes) -> None:
        self._check()
        self.written += data
        self._outward += self._damaged(data)

    def read(self, until_s: float) -> bytes:
        while not self._inward and self.now_ms < until_s * 1000 - 1e-6:
            self._check()
            self._pass()
        data, self._inward = self._inward, b""
        return data

    def unread(self, time_ms: int) -> None:
        """Let time pass while nobody reads, as when the host's process is held up."""
        until_ms = self.now_ms + time_ms
        while self.now_ms < until_ms:
            self._pass()

    def close(self) -> None:
        self.closed = True

    def _pass(self) -> None:
        self.now_ms += STEP_MS
        for due in [due for due in self.at if due <= self.now_ms]:
            self.at.pop(due)()
        data, self._outward = self._outward, b""
        self._inward += self._damaged(self.robot.step(self.now_ms, data))

    def _check(self) -> None:
        if self.cut:
            raise LinkLost("fake: the line broke")

    def _damaged(self, data: bytes) -> bytes:
        """Lose whole frames and flip bytes of others, as the seed will have it."""
        pieces = data.split(b"\x00")
        kept = [piece for piece in pieces[:-1] if self._random.random() >= self._loss]
        flipped = [piece[:-1] + b"\x5a" if self._random.random() < self._loss / 4 else piece for piece in kept]
        return b"".join(piece + b"\x00" for piece in flipped) + pieces[-1]
