"""Fuzz target: the robot's core on the table top. Whatever arrives, no coil is on that nobody ordered."""

from binascii import crc32

from firmware.core import Core
from firmware.profile import Profile
from protocol import frames, messages, program
from protocol.link import QUEUE_MAX, WINDOW
from tests.firmware_bench import PROFILE, Table
from tests.fuzz_script import SESSION, Script

ROOM = 512
KEY = bytes(range(32))
HEATING = (messages.FIRE.number, messages.START.number)
PROFILE_BYTES = PROFILE.read_bytes()
ROBOT = Profile(PROFILE_BYTES)
DICTIONARY = Table().dictionary()


class Board(Table):
    """A table whose dictionary need not be read from disk for every input."""

    def dictionary(self):
        return DICTIONARY


class Robot:
    """A core; what it hears is kept, so that each step can be judged."""

    def __init__(self, keyed: bool) -> None:
        self.board = Board()
        if keyed:
            self.board.flash.files["/key"] = KEY + crc32(KEY).to_bytes(4, "little")
        self.board.supply.mv = ROBOT.supply.nominal_mv
        self.core = Core(self.board, ROBOT, boot=1)
        self.keyed = keyed
        self.ordered = False
        self.now_ms = 0
        self.reached = set()  # states, and whether a coil was on in them
        self.step(b"")

    def step(self, data: bytes) -> None:
        """Take one control step and assert what holds after each."""
        stops = frames.STOP in data
        out = self.core.step(self.now_ms, data, ROOM)
        self.now_ms += 5
        on = any(self.board.chip.duty_permille)
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


def core(data: bytes) -> None:
    """Whatever a script does to a robot, what `Robot.step` asserts holds after each step."""
    played(data)


def played(data: bytes) -> Robot:
    """Greet, order, upload, break parts, let time pass; the session's numbers are kept right if the script likes."""
    script = Script(data)
    mode = script.byte()
    robot = Robot(mode & 1 != 0)
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
            line, seq = _program(script, seq, act >> 4)
        elif what == 5:
            _break(robot.board, act >> 4)
        elif what == 6:
            line = script.sealed(messages.ARM.number, _arm(script), seq, 0, frames.RELIABLE)
            seq += 1
        elif what < 12:
            kind = script.byte()
            line = script.sealed(kind, script.some(), seq & 255, script.byte(), frames.RELIABLE)
            seq += 1
            robot.ordered = robot.ordered or kind in HEATING
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


def _program(script: Script, seq: int, flags: int) -> tuple[bytes, int]:
    """Return a program as the script's bytes say, uploaded and started."""
    code = script.some()
    rows = (
        (messages.PROGRAM.number, program.header(code, ROBOT.crc, flags & 1)),
        (messages.CODE.number, messages.CODE.pack(offset=0, code=code)),
        (messages.START.number, messages.START.pack(at_ms=messages.AT_SYNC if flags & 2 else 0)),
    )
    line = b""
    for kind, payload in rows:
        line += script.sealed(kind, payload[: frames.PAYLOAD_MAX], seq & 255, 0, frames.RELIABLE)
        seq += 1
    return line, seq


def _break(board: Table, what: int) -> None:
    """Open the e-stop, lose a chip, weld a switch, or make all well again."""
    board.closed = what != 1
    board.supply.absent = what == 3
    board.alerting = what == 4
    board.decidegc = 1200 if what == 5 else 250
    board.flash.broken = what == 6
    board.coil_mohm[0] = 0 if what == 7 else 10_850
    board.supply.mv = 900 if what == 8 else ROBOT.supply.nominal_mv
