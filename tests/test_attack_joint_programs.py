"""Whatever code the verification passes, a robot of coils and joints runs it or refuses a step; no joint jumps."""

import json
from contextlib import suppress
from itertools import pairwise

from hypothesis import assume, given, settings
from hypothesis import strategies as st

from firmware.attitude import Blind
from firmware.channels import Channels, Refused
from firmware.limbs import Limbs
from firmware.player import RUNNING, Player
from firmware.profile import Profile
from firmware.sense import Sense
from protocol import program, verify
from tests.firmware_bench import Table
from tests.loaded import Loaded
from tests.odd_robots import MIXED

STEP_MS = 5
LIMP = -32768
JOINTS = st.sampled_from([0b0100, 0b1000, 0b1100])
MASKS = JOINTS | st.integers(0, 15) | st.sampled_from([0, 1 << 31, (1 << 32) - 1])
ANGLES = st.integers(-3000, 3000) | st.sampled_from([-32768, -9000, -3001, 3001, 32767])
TIMES = st.integers(0, 400) | st.sampled_from([0, 1, 65535])
VALUES = st.integers(-600, 600) | st.sampled_from([-32768, 32767])
PROFILE = json.dumps(MIXED).encode()


def condition(source, quantifier, compare, value, mask):
    return program.Condition(source, quantifier, compare, value, mask)


CONDITIONS = st.builds(
    condition, st.integers(0, 16), st.integers(0, 3), st.integers(0, 2), VALUES, MASKS | st.sampled_from([3, 1])
)
SPIN = program.wait(condition(program.CURRENT, 0, 1, -0x8000, 0), 1, program.CONTINUE)  # holds at once
LEGAL = (
    st.builds(program.move, JOINTS, st.integers(-1500, 1500), st.integers(170, 400))
    | st.builds(program.orient, st.integers(-3000, 3000), st.integers(100, 900))
    | st.builds(program.delay, st.integers(0, 200))
    | st.sampled_from([300, 2000]).map(lambda turns: program.repeat(turns) + SPIN + program.next_())
)
WILD = (
    st.builds(program.move, MASKS, ANGLES, TIMES)
    | st.builds(program.orient, ANGLES, TIMES)
    | st.builds(program.wait, CONDITIONS, st.integers(0, 200), st.integers(0, 1))
    | st.builds(program.guard, CONDITIONS)
    | st.builds(program.fire, st.integers(1, 3), st.integers(0, 800), TIMES)
    | st.builds(program.off, st.integers(0, 3))
)
BLOCKS = st.recursive(
    LEGAL | WILD,
    lambda inner: st.builds(
        lambda count, body: program.repeat(count) + SPIN + b"".join(body) + program.next_(),
        st.sampled_from([1, 3, 300, 65535]),
        st.lists(inner, min_size=1, max_size=4),
    ),
    max_leaves=8,
)
CODES = st.lists(BLOCKS, max_size=8).map(b"".join)
GRIP = program.move(0b0100, 250, 100) + program.move(0b1000, -250, 100) + program.delay(150)
SIGHTS = st.lists(st.sampled_from(["seen", "turned", "frozen", "absent"]), min_size=12, max_size=12)


class Bare:
    """The firmware's sequencer with the coils and joints of one robot on a table top."""

    def __init__(self, code: bytes) -> None:
        self.board, self.profile = Table(), Profile(PROFILE)
        sense = Sense(self.board, self.board.supply, 2, self.profile)
        self.channels = Channels([self.board.chip], [(self.board.chip, 0), (self.board.chip, 1)], self.profile.coil, 2)
        self.limbs = Limbs(self.board, self.profile)
        self.player = Player(self.channels, sense, Blind(), self.limbs)
        self.sense, self.now_ms = sense, 0
        self.told = ([], [])
        for _ in range(10):
            self.step()
        self.player.load(Loaded(code, 2, 2), self.now_ms)

    def play(self, sights: list[str]) -> int:
        """Run for a second, in which the camera sees the object here or there, as it is told, or nothing."""
        for sight in sights:
            self.board.watcher.absent, self.board.watcher.frozen = sight == "absent", sight == "frozen"
            self.board.watcher.centideg = 3000 if sight == "turned" else 0
            for _ in range(17):
                outcome = self.player.run(self.now_ms)
                self.step()
                if outcome != RUNNING:
                    return outcome
        return RUNNING

    def step(self) -> None:
        self.limbs.look(self.now_ms)
        self.channels.update(self.now_ms, self.sense.temperature_millidegc)
        self.limbs.drive(self.now_ms, True)
        for told, centideg in zip(self.told, self.limbs.joints.commanded_centi, strict=True):
            told.append(centideg)
        self.now_ms += STEP_MS


def passed(code: bytes) -> bool:
    try:
        verify.check_code(code, 2, 4096, 2)
    except program.BadProgram:
        return False
    return True


def refused_or_played(code: bytes, sights: list[str]) -> Bare:
    """Play a code and return what it was played on; what is raised but Refused goes on."""
    bare = Bare(code)
    with suppress(Refused):
        bare.play(sights)
    return bare


@settings(max_examples=120, deadline=None)
@given(st.lists(LEGAL, max_size=8).map(b"".join), SIGHTS)
def test_no_program_makes_a_joint_jump(code, sights):
    bare = refused_or_played(GRIP + code + program.halt(), sights)

    for told in bare.told:
        assert all(-3000 <= centideg <= 3000 for centideg in told if centideg != LIMP)
        both = [pair for pair in pairwise(told) if LIMP not in pair]
        assert all(abs(after - before) <= 360 for before, after in both)  # a frame's way


@settings(max_examples=80, deadline=None)
@given(st.booleans(), CODES, st.lists(st.tuples(st.integers(0, 10_000), st.integers(0, 255)), max_size=3), SIGHTS)
def test_what_is_verified_runs_or_is_refused_whatever_it_is(grips, code, flips, sights):
    torn = bytearray((GRIP if grips else b"") + code + program.halt())
    for at, value in flips:
        torn[at % len(torn)] = value
    assume(passed(bytes(torn)))

    refused_or_played(bytes(torn), sights)
