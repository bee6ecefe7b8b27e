"""Fuzz targets: cores on the table top. Whatever arrives, nothing is driven that nobody ordered, and no joint jumps.

A press does not push on for long at more than the force that trips.
"""

import io
import json
from binascii import crc32

from firmware.core import Core
from firmware.dictionary import Dictionary
from firmware.profile import Profile
from protocol import frames, messages, program
from protocol.link import QUEUE_MAX, WINDOW
from tests.firmware_bench import FINGERS, PROFILE, ROOT, Table
from tests.firmware_press import PRESS, Axis
from tests.fuzz_script import SESSION, Script
from tests.odd_robots import MIXED

ROOM = 512
KEY = bytes(range(32))
DRIVING = (messages.FIRE.number, messages.MOVE.number, messages.PRESS.number, messages.START.number)
FRAME_MS = 10  # of the camera: from one to the next the loop turns the joints at once
PUSHED_MAX = 20  # steps on end of a press at more than the force that trips
PUSHED_MARGIN_N = 0.25


class Kind:
    """A robot by its profile; its dictionary need not be read from disk for every input."""

    def __init__(self, text: bytes) -> None:
        self.profile = Profile(text)
        self._text = text
        self.dictionary = Dictionary(self._open, "")

    def _open(self, path: str, mode: str):
        return io.BytesIO(self._text) if path == "/robot.json" else (ROOT / path.lstrip("/")).open(mode)


ROUND, FINGER, BOTH = Kind(PROFILE.read_bytes()), Kind(FINGERS.read_bytes()), Kind(json.dumps(MIXED).encode())
PUSHER = Kind(PRESS.read_bytes())


class Robot:
    """A core; what it hears is kept, so that each step can be judged."""

    def __init__(self, kind: Kind, keyed: bool) -> None:
        self.board = Table()
        self.board.dictionary = lambda: kind.dictionary
        self.profile = kind.profile
        if keyed:
            self.board.flash.files["/key"] = KEY + crc32(KEY).to_bytes(4, "little")
        self.board.supply.mv = self.profile.supply.nominal_mv
        self.axis = Axis(self.board, 1.0) if self.profile.press else None
        if self.axis:
            self.board.converter = self.axis
        self.core = Core(self.board, self.profile, boot=1)
        self.keyed = keyed
        self.ordered = False
        self.now_ms = 0
        self.reached = set()  # states, and whether anything was driven in them
        self.widths_ns = self._widths()
        self.pushed = 0
        self.step(b"")

    def step(self, data: bytes) -> None:
        """Take one control step and assert what holds after each."""
        stops = frames.STOP in data
        out = self.core.step(self.now_ms, data, ROOM)
        self.now_ms += 5
        self._pushed()
        self._turned()
        on = any(self.board.chip.duty_permille) or any(self.widths_ns)
        core = self.core
        self.reached.add((core.state, on))
        assert len(out) <= ROOM
        assert not (stops and core.state != messages.TRIPPED)
        if core.state == messages.TRIPPED:
            assert not on
            assert not self.board.powered
        assert not on or core.control.selftest.running or self.ordered
        assert not on or core.state in (messages.ARMED, messages.RUNNING) or core.control.selftest.running
        if self.keyed:
            assert not on
            assert core.session == 0
        assert len(core.link._ahead) < WINDOW
        assert max(len(core.link.flight.waiting), len(core.link._posts)) <= QUEUE_MAX

    def _pushed(self) -> None:
        """Let the axis of a press follow, and assert that it does not push on beyond the force that trips."""
        if not self.axis:
            return
        self.axis.pass_time()
        most_n = self.profile.load.trip_mn / 1000 + PUSHED_MARGIN_N
        before_ns, (now_ns,) = self.widths_ns[0], self._widths()
        pushes = now_ns is not None and (before_ns is None or now_ns >= before_ns)
        self.pushed = self.pushed + 1 if pushes and self.axis.force_n > most_n else 0
        assert self.pushed <= PUSHED_MAX

    def _turned(self) -> None:
        """Assert that no joint was told an angle outside its range, or one too far from the last."""
        told_ns, self.widths_ns = self.widths_ns, self._widths()
        for before_ns, after_ns in zip(told_ns, self.widths_ns, strict=True):
            if after_ns is None:
                continue
            servo = self.profile.servo
            assert servo.width_ns(servo.least_centi) <= after_ns <= servo.width_ns(servo.most_centi)
            way_ns = servo.width_ns(servo.slew_centi_per_s * FRAME_MS // 1000) - servo.width_ns(-2)
            assert before_ns is None or abs(after_ns - before_ns) <= way_ns

    def _widths(self) -> list:
        return [servo.width_ns for servo in self.board.servos.values()]


def core(data: bytes) -> None:
    """Whatever a script does to a robot of coils, what `Robot.step` asserts holds after each step."""
    played(data, ROUND)


def hand(data: bytes) -> None:
    """And to a robot of joints, or one that has coils besides."""
    played(data, BOTH if data[:1] and data[0] & 2 else FINGER)


def press(data: bytes) -> None:
    """And to a press."""
    played(data, PUSHER)


def played(data: bytes, kind: Kind) -> Robot:
    """Greet, order, upload, break parts, let time pass; the session's numbers are kept right if the script likes."""
    script = Script(data)
    mode = script.byte()
    robot = Robot(kind, mode & 1 != 0)
    script.crc = robot.core.link.decoder.dictionary_crc
    seq = 0
    while script and robot.now_ms < 4000:
        act = script.byte()
        what, line = act & 15, b""
        if what == 0:
            line = script.some()
        elif what == 1:
            session = SESSION + (act >> 4)
            script.session, seq = session, 0
            fields = {"version": frames.VERSION, "session": session, "attach": SESSION, "nonce_a": 1, "nonce_b": 2}
            line = script.sealed(messages.HELLO.number, messages.HELLO.pack(**fields))
        elif what == 2:
            line = script.line()
        elif what == 3:
            line = frames.STOP
        elif what == 4:
            line, seq = _program(script, robot.profile.crc, seq, act >> 4)
        elif what == 5:
            _break(robot.board, robot.profile, act >> 4)
            _break_senses(robot, act >> 4)
        elif what == 6:
            line = script.sealed(messages.ARM.number, _arm(script), seq, 0, frames.RELIABLE)
            seq += 1
        elif what == 11:
            line = script.sealed(messages.CODE.number, _piece(script, robot.core), seq & 255, 0, frames.RELIABLE)
            seq += 1
        elif what < 11:
            kind = script.byte()
            line = script.sealed(kind, script.some(), seq & 255, script.byte(), frames.RELIABLE)
            seq += 1
            robot.ordered = robot.ordered or kind in DRIVING
        robot.ordered = robot.ordered or what in (0, 2, 4)
        robot.step(line)
        for _ in range(min(act >> 4, 15) if what >= 12 else 0):
            robot.step(_alive(script, robot.core))
    return robot


def _arm(script: Script) -> bytes:
    return messages.ARM.pack(session=script.session, lease_ms=0, without=script.byte())


def _alive(script: Script, core: Core) -> bytes:
    """Return what acknowledges all that the robot has said, and renews the lease."""
    payload = messages.ALIVE.pack(have=0, slots=16, bytes=4096)
    return script.sealed(messages.ALIVE.number, payload, core.link._next_posted & 255, core.link._next_send & 255)


def _program(script: Script, robot_crc: int, seq: int, flags: int) -> tuple[bytes, int]:
    """Return a program as the script's bytes say, uploaded or, of flag 4, streamed; and started, of flag 8 paused."""
    code = script.some()
    streamed = program.STREAMED | program.CATCHES if flags & 4 else 0
    started = {"paused": flags >> 3, "at_ms": messages.AT_SYNC if flags & 2 else 0}
    rows = (
        (messages.PROGRAM.number, program.header(code, robot_crc, flags & 1 | streamed)),
        (messages.CODE.number, messages.CODE.pack(offset=0, code=code)),
        (messages.START.number, messages.START.pack(**started)),
    )
    line = b""
    for kind, payload in rows:
        line += script.sealed(kind, payload[: frames.PAYLOAD_MAX], seq & 255, 0, frames.RELIABLE)
        seq += 1
    return line, seq


def _piece(script: Script, core: Core) -> bytes:
    """Return what comes next of a streamed program, as the script's bytes say."""
    upload = core.commands.upload
    at = upload._gone + upload._check.end if upload.streamed and upload._check else 0
    return messages.CODE.pack(offset=at & 0xFFFF, code=script.some())[: frames.PAYLOAD_MAX]


def _break(board: Table, profile: Profile, what: int) -> None:
    """Open the e-stop, lose a chip or the object, or make all well again."""
    board.closed = what != 1
    board.supply.absent = what == 3
    board.alerting = what == 4
    board.decidegc = 1200 if what == 5 else 250
    board.flash.broken = what == 6
    board.coil_mohm[0] = 0 if what == 7 else 10_850
    board.supply.mv = 900 if what == 8 else profile.supply.nominal_mv
    board.watcher.absent, board.watcher.frozen, board.watcher.seen = what == 9, what == 10, what != 11
    board.watcher.centideg = 6000 if what == 12 else 0


def _break_senses(robot: Robot, what: int) -> None:
    """Lose or strain a joint, the load cell of a press or its force cells, or raise its block."""
    axis = robot.axis
    if axis is None:
        robot.board.converter.stuck_counts = {3: 4095} if what == 13 else {}
        robot.board.converter.ma[0] = 2500 if what == 14 else 100
        return
    axis.load_counts = {9: 0, 10: 4095}.get(what)
    axis.cell_counts = [4095 if what == 11 else 800] * 6
    axis.surface_mm = -3.0 if what == 12 else 0.0
    axis.stuck = what == 13
