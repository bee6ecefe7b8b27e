"""Ctrl-C and the benches of this process: the host feels it, between two events, the firmware never.

with interrupts_deferred(clock):
    clock.run_until(until_us)
"""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

from hil_sim.clock import Clock


@contextmanager
def interrupts_deferred(clock: Clock | None) -> Iterator[None]:
    """Let Ctrl-C end the run of `clock` at its present instant and be felt only after it: it belongs to the host.

    Without a clock, when benches are being built: machine code is loaded by callbacks that lose an exception or abort.
    A second Ctrl-C is felt at once there, as a first compilation takes its time.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    came: list[int] = []

    def note(number: int, frame: FrameType | None) -> None:
        if came and clock is None:
            raise KeyboardInterrupt
        came.append(number)
        if clock is not None:
            clock.stop_at(0)

    before: Any = signal.signal(signal.SIGINT, note)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
        if came:
            signal.raise_signal(signal.SIGINT)
