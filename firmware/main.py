"""The super-loop: hands the core its bytes and the time every 5 ms and writes what it hands back."""

import sys
import time

from machine import WDT_RESET, reset, reset_cause

from firmware.boards import pico
from firmware.core import Core
from firmware.heap import Heap
from firmware.profile import Profile
from firmware.tasks import SEND
from firmware.trial import Trial
from firmware.wires import Wires

STEP_MS = 5


def run(loud: int, is_new: bool, settled) -> None:
    """Serve for ever. An error opens the coil supply and is left to the watchdog, which restarts the firmware.

    `loud` is the PWM chip that boot.py could not switch off, or 0; for `is_new` and `settled` see trial.py.
    """
    board = pico.Board()
    try:
        with open(sys.path[0] + "/robot.json", "rb") as file:
            core = Core(board, Profile(file.read()), pico.boot_number(), reset_cause() == WDT_RESET, loud)
        if board.warm():
            core.sense.assume_hot()  # the power was gone, and with it what was known of the coils
        node = core.records.settings.node
        loop(board, core, Wires(board, core, board.can(node) if node else None), Trial(is_new, settled))
        if core.leaves():
            raise KeyboardInterrupt  # which start.py takes for Ctrl-C on the console
    finally:
        board.power(False)
    reset()


def loop(board: pico.Board, core: Core, wires: Wires, trial: Trial) -> None:
    """Step the core at its period until its clock must begin anew, or its trial is lost; a late step is counted."""
    now_ms = 0
    last = time.ticks_ms()
    due = last
    heap = Heap()
    while not (core.may_restart() or core.leaves() or trial.over(now_ms, core)):
        wires.step(now_ms)
        core.tasks.report(SEND)
        if core.tasks.complete():
            board.feed()
        due = time.ticks_add(due, STEP_MS)
        left = time.ticks_diff(due, time.ticks_ms())
        if heap.collect(left):
            left = time.ticks_diff(due, time.ticks_ms())
        if left > 0:
            board.rest(left)
        else:
            core.overruns += 1
            due = time.ticks_ms()
        ticks = time.ticks_ms()
        now_ms += time.ticks_diff(ticks, last)
        last = ticks
