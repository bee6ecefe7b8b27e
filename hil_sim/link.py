"""The `sim:` line: a whole bench in this process, on virtual time.

The host's waiting drives the bench's clock; its own work costs no virtual time. So a run is the same on any machine,
under any load. An interrupt from the keyboard meets the host between two events, never the firmware.

    link = open_link("sim:circular?slope=10")
    link.write(b"...")
    data = link.read(link.now_s() + 0.1)
"""

import weakref
from collections.abc import Iterator
from contextlib import contextmanager
from math import ceil

from hil_sim.address import parse
from hil_sim.bench import Bench
from hil_sim.interrupts import interrupts_deferred

BOOTED_US = 100_000  # the robot has been on for a moment when the host finds it


def open_link(address: str) -> "SimLink":
    """Build the bench that an address describes and return the host's end of its serial line.

    ValueError (of the address or the robot file), LookupError or OSError say in their text what is wrong.
    """
    with interrupts_deferred(None):
        from hil_sim.assembly import assemble  # noqa: PLC0415  (heavy: the compiled physics)

        bench = assemble(parse(address))
        bench.clock.run_until(BOOTED_US)
    link = SimLink(bench)
    if bench.crashes:
        raise OSError(f"the firmware of the bench ended while it booted: {bench.crashes[0].error}")
    return link


class SimLink:
    """The host's end of the serial line of a bench in this process."""

    repeatable = True  # the same bytes at the same times for the same address, on any machine

    def __init__(self, bench: Bench) -> None:
        self.bench = bench
        self._line = bench.board.uart
        self._end = weakref.finalize(self, bench.close)

    @property
    def observer(self) -> Bench:
        """What watches the robot from outside: `observe()` and `snapshot()`."""
        return self.bench

    def now_s(self) -> float:
        """Return virtual time."""
        return self.bench.clock.now_us / 1e6

    def write(self, data: bytes) -> None:
        """Put bytes on the line; they take their time from now on."""
        if not self._end.alive:
            raise OSError(9, "the bench is closed")
        self.bench.board.host_write(bytes(data))

    def read(self, until_s: float) -> bytes:
        """Return bytes as soon as a device write has arrived as a whole, or what there is at `until_s`."""
        if not self._end.alive:
            raise OSError(9, "the bench is closed")
        clock = self.bench.clock
        until_us = max(clock.now_us, ceil(until_s * 1e6 - 1e-3))
        data = self._line.host_read(clock.now_us)
        while not data and clock.now_us < until_us:
            wake_us = self._line.host_wake_us()
            with self._woken_by_bytes(), interrupts_deferred(clock):
                clock.run_until(until_us if wake_us is None else min(until_us, wake_us))
            data = self._line.host_read(clock.now_us)
        return data

    @contextmanager
    def _woken_by_bytes(self) -> Iterator[None]:
        self._line.sent = self.bench.clock.stop_at
        try:
            yield
        finally:
            self._line.sent = None

    def close(self) -> None:
        """End the bench; closing twice does nothing."""
        self._end()
