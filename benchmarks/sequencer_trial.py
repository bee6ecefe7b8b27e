"""The sequencer alone in both interpreters: prints control steps and ops a second, see bench_sequencer.py.

A program of fires, delays, notes and waits in a loop, under two guards that look at all coils on each step, of a robot
with 22 coils; the chips take what they are told.
"""

import sys
import time
from array import array

from firmware.attitude import Blind
from firmware.channels import Channels
from firmware.player import RUNNING, Player
from protocol import program
from protocol.program import Condition
from tests.loaded import Loaded

COILS = 22
EVERY = (1 << COILS) - 1
STEP_MS = 5
TURNS = 500
OPS = 7  # that a turn runs
HOT = Condition(program.TEMPERATURE, program.ANY, program.ABOVE, 1100, EVERY)
SPENT = Condition(program.HEAT, program.ANY, program.ABOVE, 900, EVERY)
COLD = Condition(program.TEMPERATURE, program.ALL, program.BELOW, 0, EVERY)


class Sense:
    """What the sequencer asks, at room temperature."""

    def __init__(self):
        self.temperature_millidegc = array("i", [25_000] * COILS)
        self.heat_uj = array("i", [0] * COILS)


class Chip:
    """Takes duties."""

    def set(self, output, permille):
        """Take one."""


class Limits:
    """Of coils that may do anything."""

    duty_max_permille, hold_max_ms, on_max_ms, rest_ms = 1000, 10_000, 1 << 29, 0


def code():
    """Return the program."""
    turn = (
        program.step(1) + program.fire(0b11, 500, 10) + program.delay(10) + program.note(2)
        + program.wait(COLD, 15, program.CONTINUE) + program.ramp(0b100, 300, 10, 900, 5)
    )  # fmt: skip
    return program.guard(HOT) + program.guard(SPENT) + program.repeat(TURNS) + turn + program.next_() + program.halt()


def main():
    """Run the program to its end and print the figures."""
    channels = Channels([], [(Chip(), output) for output in range(COILS)], Limits(), COILS)
    player = Player(channels, Sense(), Blind())
    player.load(Loaded(code(), COILS), 0)
    micro = sys.implementation.name == "micropython"
    begun = time.ticks_us() if micro else time.perf_counter()
    now_ms = steps = 0
    while player.run(now_ms) == RUNNING:
        player.notes = 0
        now_ms += STEP_MS
        steps += 1
    passed_s = time.ticks_diff(time.ticks_us(), begun) / 1e6 if micro else time.perf_counter() - begun
    print(steps / passed_s, TURNS * OPS / passed_s)


main()
