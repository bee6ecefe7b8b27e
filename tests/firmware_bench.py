"""A table top for the firmware alone: chips that remember, sensors that are set, a host made of frames.

For tests of one firmware module in CPython. Whole-robot tests use the bench (`rig` in conftest.py) instead.
"""

import io
from array import array
from pathlib import Path

from firmware.core import Core
from firmware.dictionary import Dictionary
from firmware.profile import Profile
from protocol import frames, messages, program, variables
from protocol.link import Link

ROOT = Path(__file__).parents[1]
PROFILE = ROOT / "firmware" / "robots" / "circular.json"
BALL = PROFILE.with_name("sphere-a.json")  # a robot with an attitude sensor
FINGERS = PROFILE.with_name("fingers.json")  # a robot with joints and a camera, and no coils
SESSION = 77


class Chip:
    """A PWM chip that remembers what it was told, or does not answer."""

    def __init__(self) -> None:
        self.address = 0x60
        self.duty_permille = [0] * 16
        self.writes = 0
        self.absent = False
        self.lost = False

    def begin(self) -> None:
        self._reach()
        self.lost = False
        self.all_off()

    def set(self, output: int, permille: int) -> None:
        self._reach()
        self.writes += 1
        self.duty_permille[output] = permille

    def all_off(self) -> None:
        self._reach()
        self.duty_permille = [0] * 16

    def configured(self) -> bool:
        self._reach()
        return not self.lost

    def _reach(self) -> None:
        if self.absent:
            raise OSError(5, "EIO")


class Monitor:
    """A supply monitor that reads what the coils take, or what a test sets in its place."""

    address = 0x40

    def __init__(self, table) -> None:
        self.ma = None  # the mean current that a test wants read
        self.mv = 2000
        self.absent = False
        self.looks = 0
        self._table = table
        self._seen_ma = 0

    def begin(self) -> None:
        self._read(0)
        self._table.alerting = False

    def configured(self) -> bool:
        return True

    def average(self) -> None:
        self._read(0)

    def hasten(self) -> None:
        self._read(0)

    def look(self) -> None:
        self.looks += 1
        self._seen_ma = self._read(self._table.current_ma())

    def seen_ma(self) -> int:
        return self._seen_ma

    def seen_mv(self) -> int:
        return self.mv

    def seen_mohm(self) -> int:
        return self.mv * 1000 // self._seen_ma if self._seen_ma else 0x3FFFFFFF

    def current_ma(self) -> int:
        return self._read(self._table.current_ma() if self.ma is None else self.ma)

    def voltage_mv(self) -> int:
        return self._read(self.mv)

    def _read(self, value: int) -> int:
        if self.absent:
            raise OSError(5, "EIO")
        return value


class Imu:
    """An attitude sensor on a body that lies as a test says; its last bits are never still."""

    def __init__(self) -> None:
        self.words = array("h", [0] * 6)
        self.force = (0, 0, 8197)  # of one g at rest, upright
        self.rate = (0, 0, 0)
        self.absent = self.other = self.lost = self.stuck = self.silent = False
        self.starts = 0

    def begin(self) -> None:
        self.starts += 1
        self._reach()
        if self.other:
            raise OSError(19, "ENODEV")
        self.lost = False

    def configured(self) -> bool:
        self._reach()
        return not self.lost

    def read(self) -> bool:
        self._reach()
        if not self.stuck:
            noise = 1 - (self.words[0] - self.rate[0])
            for i, word in enumerate((self.rate[0] + noise, *self.rate[1:], *self.force)):
                self.words[i] = word
        return not (self.silent or self.lost)

    def _reach(self) -> None:
        if self.absent:
            raise OSError(5, "EIO")


class Servo:
    """The pulses of one servo, None: there are none."""

    def __init__(self) -> None:
        self.width_ns = None
        self.writes = 0

    def pulse(self, width_ns: int) -> None:
        self.width_ns = width_ns
        self.writes += 1

    def off(self) -> None:
        self.width_ns = None


class Converter:
    """What a converter reads: the angle of a joint that follows its pulses but for a `lag`, and its current."""

    def __init__(self, servos) -> None:
        self.ma = [100, 100]
        self.lag = 0.0
        self.stuck_counts = {4: 62, 5: 2048}  # of an input, whatever the joint does; of a third one from the start
        self.rest_centi = [0, 0]  # where a limp joint stands
        self._servos = servos

    def counts(self, channel: int) -> int:
        if channel in self.stuck_counts:
            return self.stuck_counts[channel]
        if channel < 2:
            return self.ma[channel] * 1000 // 1611 + 1
        servo = list(self._servos.values())[channel - 2]
        if servo.width_ns is not None:
            told_centi = (servo.width_ns - 1_500_000) * 9 / 1000
            self.rest_centi[channel - 2] += (told_centi - self.rest_centi[channel - 2]) * (1 - self.lag)
        return 410 + round((self.rest_centi[channel - 2] + 9000) * 3276 / 18000)


class Watcher:
    """A camera with a frame every second control step, of an object that lies as a test says."""

    def __init__(self) -> None:
        self.seen = True
        self.centideg = 0
        self.absent = self.frozen = False
        self.turns = 0

    def read(self) -> bool:
        if self.absent:
            raise OSError(5, "EIO")
        self.turns += 1
        return self.turns % 2 == 0 and not self.frozen


class Flash:
    """Files that are written whole, or not at all."""

    def __init__(self) -> None:
        self.files: dict[str, bytes] = {}
        self.broken = False

    def open(self, path: str, mode: str):
        if mode == "wb":
            return Written(self, path)
        if path not in self.files:
            raise OSError(2, "ENOENT")
        return io.BytesIO(self.files[path])


class Written(io.BytesIO):
    """A file that is open for writing."""

    def __init__(self, flash: Flash, path: str) -> None:
        super().__init__()
        if flash.broken:
            raise OSError(5, "EIO")
        self._flash, self._path = flash, path

    def close(self) -> None:
        self._flash.files[self._path] = self.getvalue()
        super().close()


class Table:
    """The board of the core under test."""

    def __init__(self) -> None:
        self.chip = Chip()
        self.supply = Monitor(self)
        self.coil_mohm = [10_850] * 16  # cold, with its wires, 9500 mohm when it is hot; 0: open
        self.stuck_mask = 0  # coils whose MOSFET conducts whatever its gate says
        self.servo_ma = 0  # what the servos take from the same supply
        self.welded = False
        self.alerting = False
        self.waited_us = 0
        self.sensor = Imu()
        self.servos = {}  # by pin
        self.converter = Converter(self.servos)
        self.watcher = Watcher()
        self.powered = False
        self.serial = b"the table"
        self.credit_bytes = 960
        self.byte_ns = 86_805
        self.beats = 0
        self.closed = True
        self.decidegc = 250
        self.flash = Flash()
        self.robot_file = PROFILE

    def open(self, path: str, mode: str):
        return self.flash.open(path, mode)

    def dictionary(self) -> Dictionary:
        return Dictionary(self._text, "")

    def _text(self, path: str, mode: str):
        return (self.robot_file if path == "/robot.json" else ROOT / path.lstrip("/")).open(mode)

    def pwm(self, address: int) -> Chip:
        return self.chip

    def monitor(self, shunt_mohm: int, alert_ma: int) -> Monitor:
        return self.supply

    def current_ma(self) -> int:
        """Return the mean current of all coils."""
        if not (self.powered or self.welded):
            return 0
        shares = [1000 if self.stuck_mask >> i & 1 else duty for i, duty in enumerate(self.chip.duty_permille)]
        rows = zip(shares, self.coil_mohm, strict=True)
        return self.servo_ma + sum(share * self.supply.mv // mohm for share, mohm in rows if mohm)

    def alert(self) -> bool:
        return self.alerting

    def wait_us(self, time_us: int) -> None:
        self.waited_us += time_us

    def imu(self, address: int) -> Imu:
        return self.sensor

    def servo(self, pin: int, hz: int) -> Servo:
        self.servos[pin] = Servo()
        return self.servos[pin]

    def adc(self) -> Converter:
        return self.converter

    def camera(self, address: int) -> Watcher:
        return self.watcher

    def power(self, on: bool) -> None:
        self.powered = on

    def beat(self) -> None:
        self.beats += 1

    def estop_closed(self) -> bool:
        return self.closed

    def board_decidegc(self) -> int:
        return self.decidegc


class Rig:
    """A core on the table and a host that talks to it frame by frame, in steps of 5 ms."""

    def __init__(self, profile: Path = PROFILE) -> None:
        self.board = Table()
        self.board.robot_file = profile
        self.profile = Profile(profile.read_bytes())
        self.board.supply.mv = self.profile.supply.nominal_mv
        self.core = Core(self.board, self.profile, boot=1)
        self.host = Link()
        self.got = []
        self.now_ms = 0
        self.hello()
        self.run(10)

    def hello(self, session: int = SESSION, attach: int = 0):
        """Begin a session and return the answers to its hello."""
        self.host.begin(self.core.link.decoder.dictionary_crc, session)
        hello = messages.HELLO.pack(version=frames.VERSION, session=session, attach=attach, nonce_a=0, nonce_b=0)
        self.host.post(messages.HELLO.number, hello)
        return self.run(10, silent=True, line=self.host.poll(self.now_ms))

    def say(self, message, **fields):
        """Send one message and return the answers of the next steps: a list of (message name, fields)."""
        if message.number < 16:
            self.host.post(message.number, message.pack(**fields))
        else:
            self.host.send(message.number, message.pack(**fields), self.now_ms)
        return self.run(10)

    def run(self, ms: int, silent: bool = False, line: bytes = b""):
        """Let time pass; the host acknowledges and keeps the lease alive unless it is silent."""
        fresh = []
        for _ in range(0, ms, 5):
            if not silent:
                self.host.acknowledge()
                line += self.host.poll(self.now_ms)
            answer = self.core.step(self.now_ms, line, 1024)
            line = b""
            self.now_ms += 5
            for received in self.host.receive(answer, self.now_ms):
                message = messages.by_number(received.kind)
                fresh.append((message.name, message.unpack(received.payload)))
        self.got += fresh
        return fresh

    def arm(self, lease_ms: int = 0, without: int = 0):
        """Arm and return the answers, up to that which follows the self-test."""
        answers = self.say(messages.ARM, session=SESSION, lease_ms=lease_ms, without=without)
        while self.core.control.selftest.running or self.core.control.selftest.done:
            answers += self.run(5)
        return answers

    def fire(self, coils: int, duty_permille: int = 500, hold_ms: int = 1000):
        """Fire and return the answers."""
        return self.say(messages.FIRE, coils=coils, duty_permille=duty_permille, hold_ms=hold_ms)

    def move(self, joints: int, target_centi: int, over_ms: int = 100, hold_ms: int = 5000):
        """Move joints and return the answers."""
        return self.say(
            messages.MOVE, joints=joints, target_centi=target_centi, over_ms=over_ms, hold_ms=hold_ms
        )  # fmt: skip

    def upload(self, code: bytes, header: bytes):
        """Send a program; return all answers."""
        answers = self.say(messages.PROGRAM, header=header)
        for offset in range(0, len(code), 200):
            answers += self.say(messages.CODE, offset=offset, code=code[offset : offset + 200])
        return answers

    def events(self, name: str):
        """Return the events of that name that arrived so far."""
        return [body for kind, body in self.got if kind == "event" and messages.EVENTS[body.event] == name]


def usual(telemetry, coils: int = 8) -> list:
    """Return the usual variables of a record of telemetry."""
    return variables.unpack(variables.USUAL, variables.veiled(telemetry.values), variables.counts(coils))


def refusal(answers):
    """Return the refusal among answers."""
    return next(body for name, body in answers if name == "refused")


def run_program(rig: Rig, code: bytes, flags: int = 0, robot_crc: int | None = None):
    """Upload a program, arm and start it; return all answers."""
    header = program.header(code, rig.profile.crc if robot_crc is None else robot_crc, flags)
    answers = rig.upload(code, header)
    rig.arm()
    return answers + rig.say(messages.START, paused=0, at_ms=0)
