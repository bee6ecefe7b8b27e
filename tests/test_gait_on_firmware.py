"""What the checker passes, the robot runs: the same programs on the firmware's own sequencer, channels and estimate."""

import json
from random import Random

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from firmware.attitude import Blind
from firmware.channels import Channels
from firmware.player import FINISHED, RUNNING, TIMED_OUT, Player
from firmware.profile import Profile
from firmware.sense import Sense
from host.gait.checker import check
from tests.firmware_bench import Chip, Table
from tests.gait_scripts import CIRCLE, ROUND, ball, ball_robot, compiled, report
from tests.loaded import Loaded

STEP_MS = 5

coils = st.lists(st.sampled_from("ABCD"), min_size=1, max_size=3, unique=True).map(" ".join)
fires = st.builds(
    "fire {} at {} % for {} ms{}".format,
    coils,
    st.integers(1, 70),
    st.integers(20, 2000),
    st.sampled_from(["", "", " overlap 20 ms", " overlap 13 ms", " until 80 C", " ramp 17 ms"]),
)
waits = st.one_of(
    st.integers(1, 3000).map("wait {} ms".format),
    st.builds("wait until {}.temperature > {} C timeout {} ms else continue".format,
              st.sampled_from(["A", "any", "all"]), st.integers(30, 90), st.integers(1, 500)),
)  # fmt: skip


def blocks(inner):
    bodies = st.lists(inner, min_size=1, max_size=3).map(lambda lines: "\n".join(lines).replace("\n", "\n    "))
    return st.builds("repeat {}:\n    {}\n    wait 1 ms".format, st.integers(1, 4), bodies)


bodies = st.lists(st.recursive(fires | waits, blocks, max_leaves=5), min_size=1, max_size=5).map("\n".join)


class Bare:
    """The firmware's sequencer, channels and estimate on a table top, without link or guard."""

    def __init__(self, code: bytes, data=ROUND, attitude=None) -> None:
        profile, board = Profile(json.dumps(data).encode()), Table()
        outputs = [(Chip(), output) for output in range(8)]
        self.channels = Channels([], outputs, profile.coil, profile.supply.at_once_max)
        self.sense = Sense(board, board.supply, 8, profile)
        self.player = Player(self.channels, self.sense, attitude or Blind())
        self.on_ms, self.heat_uj, self.at_once, self.too_long = [0] * 8, [0] * 8, 0, -1
        self.sense.begin_supply()
        self.player.load(Loaded(code), 0)
        self.now_ms = 0

    def run(self) -> int:
        """Run to the end and return the outcome; Refused passes through."""
        outcome = RUNNING
        while outcome == RUNNING:
            self.sense.update(self.now_ms, self.channels.on_mask, self.channels.duty_permille)
            self.sense.read()
            self.player._attitude.look(self.now_ms)
            outcome = self.player.run(self.now_ms)
            self.too_long = max(self.too_long, self.channels.update(self.now_ms, self.sense.temperature_millidegc))
            self._measure()
            self.now_ms += STEP_MS
        return outcome

    def _measure(self) -> None:
        on = [channel for channel in range(8) if self.channels.on_mask >> channel & 1]
        self.at_once = max(self.at_once, len(on))
        for channel in on:
            self.on_ms[channel] += STEP_MS
            self.heat_uj[channel] = max(self.heat_uj[channel], self.sense.heat_uj[channel])


def test_a_script_runs_for_as_long_as_its_text_says():
    made = compiled("fire A at 50 % for 1 s\nrepeat 3:\n    fire B at 50 % for 200 ms overlap 50 ms\nwait 500 ms")
    bare = Bare(made.code)

    assert bare.run() == FINISHED
    assert bare.now_ms - STEP_MS == check(made).shortest_ms == 1950
    assert bare.on_ms[:2] == [1000, 500]


def test_what_an_order_heats_until_the_control_step_that_replaces_it_is_in_its_peak():
    made = compiled("fire A at 36 % for 456 ms overlap 20 ms\nfire A at 1 % for 20 ms\nwait 10 ms")
    bare = Bare(made.code)

    bare.run()

    assert 0 < bare.heat_uj[0] <= check(made).coils[0].heat_peak_mj * 1000


def test_a_wait_that_runs_out_ends_within_its_longest_time():
    made = compiled("wait until A.temperature > 60 C timeout 703 ms else abort")
    bare = Bare(made.code)

    assert bare.run() == TIMED_OUT
    assert bare.now_ms - STEP_MS <= check(made).longest_ms


@pytest.mark.parametrize(
    "body",
    [
        "wait 13 ms\n" + 'note "x"\n' * 40,
        "repeat 3:\n    " + 'note "x"\n    ' * 21 + "fire A at 5 % for 3 ms overlap 3 ms\n    wait 1 ms",
        'note "x"\n' * 200 + "wait until A.temperature > 60 C timeout 1 ms else abort",
    ],
)
def test_more_than_a_control_step_takes_is_late_within_the_longest_time(body):
    made = compiled(body)
    bare = Bare(made.code)

    bare.run()

    assert bare.now_ms - STEP_MS <= check(made).longest_ms


@settings(max_examples=60, deadline=None)
@given(bodies)
def test_what_the_checker_passes_is_never_refused_and_never_beyond_its_worst_case(body):
    worst = report(body)
    assume(worst.sound and worst.longest_ms < 60_000)
    bare = Bare(compiled(body).code)

    assert bare.run() == FINISHED

    assert bare.too_long == -1
    assert bare.now_ms - STEP_MS <= worst.longest_ms
    assert bare.at_once <= worst.at_once
    for channel, coil in enumerate(worst.coils):
        assert bare.on_ms[channel] <= coil.on_ms
        assert bare.heat_uj[channel] <= coil.heat_peak_mj * 1000


class Tumbling:
    """An attitude that is another at random moments."""

    known = True

    def __init__(self, random: Random) -> None:
        self._random = random
        self._down = 0

    def look(self, now_ms: int) -> None:
        if self._random.random() < 0.02:
            self._down = self._random.randrange(8)

    def nearness(self, channel: int) -> int:
        return 100 - min((channel - self._down) % 8, (self._down - channel) % 8)

    def down_channel(self) -> int:
        return self._down


lets = st.builds("let {} = roll[down + {}]".format, st.sampled_from("xy"), st.integers(0, 2))
chosen = st.builds(
    "fire ${} at {} % for {} ms{}".format,
    st.sampled_from("xy"),
    st.integers(1, 90),
    st.integers(20, 2000),
    st.sampled_from(["", " overlap 20 ms"]),
)
stills = st.one_of(
    st.sampled_from([10, 20, 1000]).map("wait {} ms".format),
    st.builds("wait until ${}.heat < {} mJ timeout 9 s else abort".format, st.sampled_from("xy"), st.integers(50, 400)),
    st.builds("wait until down is ${} timeout 200 ms else continue".format, st.sampled_from("xy")),
    st.builds("fire A00m1 at {} % for {} ms".format, st.integers(1, 90), st.integers(20, 2000)),
)
turns = st.lists(lets | chosen | stills, min_size=2, max_size=7).map("\n    ".join)
tumbles = st.builds(
    "{}\nrepeat {}:\n    {}\n    wait 10 ms".format,
    turns.map(lambda text: text.replace("    ", "")),
    st.integers(1, 5),
    turns,
)


@settings(max_examples=150, deadline=None)
@given(tumbles, st.integers(0, 0xFFFF))
def test_whatever_coils_the_robot_chooses_none_goes_beyond_the_worst_case(body, seed):
    text = CIRCLE + "let x = roll[down]\nlet y = roll[down + 1]\n" + body
    worst = report(text, profile=ball_robot())
    assume(worst.sound)
    bare = Bare(compiled(text, profile=ball_robot()).code, ball(), Tumbling(Random(seed)))

    assert bare.run() in (FINISHED, TIMED_OUT)

    assert bare.too_long == -1
    assert bare.at_once <= worst.at_once
    for channel, coil in enumerate(worst.coils):
        assert bare.on_ms[channel] <= coil.on_ms
        assert bare.heat_uj[channel] <= coil.heat_peak_mj * 1000


def test_what_an_order_heats_until_a_pile_of_notes_lets_the_next_one_begin_is_in_its_peak():
    pile = 'note "n"\n' * 40
    made = compiled(f"fire A at 80 % for 100 ms overlap 50 ms\n{pile}fire A at 0.1 % for 5 ms\nwait 10 ms")
    bare = Bare(made.code)

    assert bare.run() == FINISHED

    worst = check(made).coils[0]
    assert bare.heat_uj[0] > 380 * 0.8 * 50  # the first order went on for longer than the script says
    assert bare.heat_uj[0] <= worst.heat_peak_mj * 1000
    assert bare.on_ms[0] <= worst.on_ms
