"""Hostile hosts on the whole path, seeded: whatever arrives, the firmware lives, coils end, and `stop` stops.

Beside the seeds here, some hundred others were run; each virtual second costs some 20 ms.
"""

import random
from binascii import crc32
from collections.abc import Callable

import pytest

from hil_sim.link import open_link
from host.definitions import dictionary_of
from host.errors import SoftrigError
from host.robot import Robot
from protocol import frames, messages, program
from protocol.link import Link
from tests.fake_robot import LABELS, PROFILE
from tests.witness import profile_text

ROBOT = crc32(PROFILE)
BYTE_S = 10 / 115_200
TWO_STEPS_S = 0.010
TOO_HOT_DEGC = 130.0
Piece = Callable[[random.Random], bytes]


class Attacker:
    """A host that knows the wire and means no good; what it has sent is its ammunition."""

    def __init__(self, seed: int, address: str = "sim:circular") -> None:
        self.random = random.Random(seed)
        self.line = open_link(address)
        self.bench = self.line.bench
        text = profile_text(self.bench)
        self._seed, self._robot = crc32(dictionary_of(text)), crc32(text)
        self._sent = [b"\x00"]
        self._idle_s = 0.0
        self._acts = (
            self._noise, self._flipped, self._replayed, self._hellos, self._pages, self._sealed, self._pieces,
            self._program, self._program, self._orders, self._orders, self._words, self._silence, self._anew,
        )  # fmt: skip
        self._anew()

    def act(self) -> None:
        """Do one bad thing, and let some time pass."""
        self.random.choice(self._acts)()
        self.listen(self.random.choice((0.001, 0.005, 0.02, 0.1)))

    def listen(self, seconds: float) -> None:
        """Hear the robot for so long."""
        data = self.line.read(self.line.now_s() + seconds)
        self._link.receive(data, round(self.line.now_s() * 1000))

    def stop(self) -> None:
        """Send noise and in it the stop pattern; return when it has arrived and two control steps have passed."""
        self._write(self.random.randbytes(self.random.randrange(300)) + frames.STOP)
        self.bench.clock.run_until(round((self._idle_s + TWO_STEPS_S + BYTE_S) * 1e6))
        self._anew()

    def _write(self, data: bytes) -> None:
        self._idle_s = max(self._idle_s, self.line.now_s()) + len(data) * BYTE_S
        self.line.write(data)

    def _say(self, message, **fields) -> None:
        now_ms = round(self.line.now_s() * 1000)
        if message.number < frames.GREETINGS_BELOW:
            self._link.post(message.number, message.pack(**fields))
        elif self._link.room():
            self._link.send(message.number, message.pack(**fields), now_ms)
        self._sent.append(self._link.poll(now_ms))
        self._write(self._sent[-1])

    def _anew(self) -> None:
        self._link = Link()
        self._session = self.random.randrange(1 << 32)
        self._link.begin(self._seed, self._session)
        self._say(messages.HELLO, version=frames.VERSION, session=self._session, attach=0, nonce_a=0, nonce_b=0)

    def _noise(self) -> None:
        self._write(self.random.randbytes(self.random.randrange(600)))

    def _flipped(self) -> None:
        data = bytearray(self.random.choice(self._sent) or b"\x00")
        for _ in range(3):
            data[self.random.randrange(len(data))] ^= 1 << self.random.randrange(8)
        self._write(bytes(data))

    def _replayed(self) -> None:
        self._write(b"".join(self.random.choices(self._sent, k=6)))

    def _hellos(self) -> None:
        for _ in range(self.random.randrange(30)):
            version, session = self.random.choice((2, 2, 1, 0, 255)), self.random.randrange(1 << 32)
            attach = self.random.choice((0, self._session, self.random.randrange(1 << 32)))
            hello = messages.HELLO.pack(version=version, session=session, attach=attach, nonce_a=0, nonce_b=0)
            self._seal(messages.HELLO.number, hello)

    def _pages(self) -> None:
        part, offset, count = (self.random.randrange(1 << bits) for bits in (8, 16, 8))
        self._seal(messages.DICTIONARY.number, messages.DICTIONARY.pack(part=part, offset=offset, count=count))

    def _sealed(self) -> None:
        self._seal(self.random.randrange(256), self.random.randbytes(self.random.randrange(frames.PAYLOAD_MAX + 1)))

    def _seal(self, kind: int, payload: bytes) -> None:
        seq, ack, flags = (self.random.randrange(256) for _ in range(3))
        seed = self._seed if frames.is_open(kind) else frames.session_seed(self._seed, self._session)
        flags &= frames.RELIABLE | frames.SEALED
        self._write(frames.encode(frames.seal(kind, seq, ack, payload, seed, flags)))

    def _pieces(self) -> None:
        offset, size = self.random.randrange(1 << 16), self.random.randrange(200)
        self._say(messages.PROGRAM, header=program.header(bytes(self.random.choice((1, 4096, 4097))), self._robot))
        self._say(messages.CODE, offset=offset, code=self.random.randbytes(size))
        self._say(messages.START, paused=0, at_ms=0)

    def _program(self) -> None:
        code = self._code()
        self._armed()
        self._say(messages.PROGRAM, header=program.header(code, self._robot, self.random.randrange(2)))
        for at in range(0, len(code), 192):
            self._say(messages.CODE, offset=at, code=code[at : at + 192])
        self._say(messages.START, paused=0, at_ms=0)

    def _code(self) -> bytes:
        return program_of(self.random)

    def _orders(self) -> None:
        self._armed()
        for _ in range(self.random.randrange(5)):
            self._order()

    def _order(self) -> None:
        coils = self.random.choice((self.random.randrange(1 << 32), 1 << self.random.randrange(8)))
        duty = self.random.choice((1000, self.random.randrange(1 << 16)))
        hold = self.random.choice((self.random.randrange(1 << 16), self.random.randrange(10_000)))
        self._say(messages.FIRE, coils=coils, duty_permille=duty, hold_ms=hold)

    def _armed(self) -> None:
        self._say(messages.CLEAR)
        lease_ms, without = self.random.choice((0, 1, 5000, 65_535)), self.random.choice((0, 0, 0, 2, 1 << 31))
        self._say(messages.ARM, session=self._session, lease_ms=lease_ms, without=without)
        self.line.read(self.line.now_s() + self.random.choice((0.05, 0.1)))  # of the self-test, or after it

    def _words(self) -> None:
        self._say(
            messages.SUBSCRIBE, slot=0, period_ms=self.random.choice((0, 1, 50)), on_change=0, variables=b"",
        )  # fmt: skip
        self._say(self.random.choice((messages.STATUS_REQUEST, messages.CANCEL, messages.DISARM)))

    def _silence(self) -> None:
        self.line.read(self.line.now_s() + self.random.choice((0.6, 2.0)))


def program_of(rng: random.Random, piece: Piece | None = None) -> bytes:
    """Return a program that is whole, but in one of four cases for a byte; `piece` makes what is no loop."""
    code = bytearray(block_of(rng, 0, piece or piece_of) + program.halt())
    if rng.random() < 0.25:
        code[rng.randrange(len(code))] = rng.randrange(256)
    return bytes(code[:4096])


def block_of(rng: random.Random, depth: int, piece: Piece) -> bytes:
    return b"".join(op_of(rng, depth, piece) for _ in range(rng.randrange(1, 7)))


def op_of(rng: random.Random, depth: int, piece: Piece) -> bytes:
    if depth < program.DEPTH_MAX and rng.random() < 0.15:
        return program.repeat(rng.choice((1, 2, 5, 65_535))) + block_of(rng, depth + 1, piece) + program.next_()
    return piece(rng)


def piece_of(rng: random.Random) -> bytes:
    mask = rng.choice((1 << rng.randrange(8), rng.randrange(1, 256)))
    duty, time_ms = rng.choice((1000, rng.randrange(1001))), rng.randrange(3000)
    condition = program.Condition(
        rng.randrange(1, 5), rng.randrange(2), rng.randrange(2), rng.randrange(200, 1000), mask
    )
    return rng.choice((
        program.fire(mask, duty, time_ms), program.fire(mask, duty, time_ms, rng.randrange(300, 1500)),
        program.ramp(mask, duty, time_ms, 0, rng.randrange(3000)), program.delay(rng.randrange(700)),
        program.wait(condition, rng.randrange(800), rng.randrange(2)), program.off(mask),
        program.guard(condition) if rng.random() < 0.2 else program.step(rng.randrange(1 << 16)),
    ))  # fmt: skip


@pytest.mark.parametrize("seed", [0, 2, 11, 34])
def test_whatever_arrives_the_firmware_lives_no_coil_cooks_and_stop_stops(seed):
    attacker = Attacker(seed)
    bench = attacker.bench

    while bench.clock.now_us < 10_000_000:
        attacker.act()
        assert bench.plant.temperature.max() < TOO_HOT_DEGC
        if attacker.random.random() < 0.05:
            attacker.stop()
            assert not bench.any_coil_on
    attacker.stop()

    assert not bench.any_coil_on
    assert bench.crashes == []
    assert bench.world.resets == 0


@pytest.mark.parametrize("seed", [3, 8])
def test_random_programs_neither_cook_a_coil_nor_outlive_a_stop(seed):
    rng = random.Random(seed)
    with Robot(open_link("sim:circular")) as robot:
        bench = robot.link.bench
        robot.connect()
        for _ in range(8):
            try_out(robot, program_of(rng))
            assert not bench.any_coil_on
            bench.run(rng.choice((0.1, 3.0)))

        assert max(bench.coil(label).peak_degc for label in LABELS) < TOO_HOT_DEGC
        assert bench.crashes == []


def try_out(robot: Robot, code: bytes) -> None:
    """Run a program for ten seconds at most, then stop."""
    try:
        robot.clear()
        robot.upload(program.header(code, ROBOT), code)
        robot.arm()
        robot.start()
        for record in robot.listen(10_000):
            if getattr(record, "event", "") in ("finished", "aborted", "tripped", "disarmed"):
                break
    except SoftrigError:
        pass
    robot.stop()
