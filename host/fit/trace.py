"""The first press in a log, as a fit needs it: when, how deep, told to go how deep, with what force.

Force and depth of a row are of one instant of the robot's clock, so no clock has to be compared. `softrig run --log`
records them each 10 ms, and that is what to record. Telemetry, twenty a second, misses the corners of the depth, by
which a dashpot's force is told from a spring's: it is refused.

The press goes from a moment before the force rises to where the axis is first told to come back, and must hold still
for a while at its end. Later presses are left out: they meet a block that remembers.

    press = press_of(read_log("press.mcap"))
    press.t, press.depth, press.force, press.hold_s
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from host.errors import BadRequest
from host.logbook import Log
from host.robotclock import since
from protocol import variables

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
STRETCH_S = 0.1
Reading = tuple[int, float, float | None, float]  # robot's clock [ms], depth and command [mm], force [N]
TOUCH_N, IN_A_ROW = 0.1, 3  # a force that is pressed with, and for so many readings
BEFORE_S = 1.0  # the axis' history that still matters, and rest to see the load cell's zero in
BACK_MM = 0.02  # the axis is told to come back
HOLD_S, HELD, PUSHED = 0.5, 10, 5  # at least: seconds and readings of the hold, readings of the push
MOST = 3000  # readings of a hold; of a longer one every second is used, or third ...
PERIOD_MAX_S = 0.025


@dataclass(frozen=True)
class Press:
    """A push and the hold after it; all arrays have an entry for each reading."""

    t: Floats  # [s] since the first reading
    depth: Floats  # [mm] measured
    command: Floats  # [mm] that the axis is told
    force: Floats  # [N]
    stretches: Indices  # the first reading of each stretch over which a fit takes means
    touched_s: float  # when the force rose
    held_from_s: float  # when the axis was told its last depth
    began_ms: int  # the robot's clock at the first reading

    @property
    def push_s(self) -> float:
        """Return how long it pressed deeper and deeper."""
        return self.held_from_s - self.touched_s

    @property
    def hold_s(self) -> float:
        """Return how long it stood still."""
        return float(self.t[-1]) - self.held_from_s

    def means(self, values: Floats) -> Floats:
        """Return the means over stretches of a tenth of a second of a value of each reading."""
        counts = np.diff(np.append(self.stretches, len(values)))
        means: Floats = np.add.reduceat(values, self.stretches) / counts
        return means

    @property
    def period_s(self) -> float:
        """Return the time from reading to reading while it pushed."""
        return float(np.median(np.diff(self.t[self.t <= self.held_from_s])))


def press_of(log: Log) -> Press:
    """Return the first press that a log holds; BadRequest says what it has not."""
    readings = max(_sources(log), key=len, default=[])
    if not readings:
        raise BadRequest(f"{log.path} tells no force and depth: it is not of a robot with a press and a load cell")
    t, depth, command, force, began_ms = _columns(readings)
    touched = _touched(force)
    if touched is None:
        raise BadRequest(f"{log.path} holds no press: its force never stays above {TOUCH_N:g} N")
    period_s = float(np.median(np.diff(t)))
    if period_s > PERIOD_MAX_S:
        raise BadRequest(
            f"{log.path} tells force and depth each {1000 * period_s:.0f} ms only, which misses the corners of a push:"
            " record it with `softrig run --log`, each 10 ms"
        )
    first = int(np.searchsorted(t, t[touched] - BEFORE_S))
    last = touched + _until_back(command[touched:])
    if last - touched < PUSHED:
        raise BadRequest(f"{log.path}: the press is too short, {last - touched} readings of it, {PUSHED} are needed")
    held = touched + int(np.argmax(command[touched:last] >= command[touched:last].max() - BACK_MM))
    if last - held < HELD or t[last - 1] - t[held] < HOLD_S:
        raise BadRequest(
            f"{log.path}: the press is not held: its depth must stay the same for {HOLD_S:g} s after the push, better"
            " for as long as the block takes to relax"
        )
    if held - touched < PUSHED:
        raise BadRequest(f"{log.path}: the push is too short, {held - touched} readings of it, {PUSHED} are needed")
    rows = np.r_[first:held, held : last : 1 + (last - held - 1) // MOST]
    begin = float(t[first])
    touched_s, held_s = float(t[touched]) - begin, float(t[held]) - begin
    t = t[rows] - begin
    stretches = np.flatnonzero(np.diff(np.floor(t / STRETCH_S), prepend=-1.0))
    return Press(
        t, depth[rows], command[rows], force[rows], stretches, touched_s, held_s, began_ms + round(1000 * begin)
    )


def _sources(log: Log) -> Iterator[list[Reading]]:
    """Yield what is told of force and depth in each way that the log has."""
    slots: dict[int, list[Reading]] = {}
    if "joint_mm" not in next(iter(log.rows.get("telemetry", ())), {}):
        return
    for row in log.rows.get("samples", ()):
        told = row["values"]
        if {"load_mn", "joint_centi", "commanded_centi"} <= told.keys() and told["load_mn"] is not None:
            depth, command = (_only(told[name]) for name in ("joint_centi", "commanded_centi"))
            known = None if command == variables.UNKNOWN_CENTI else command / 100
            slots.setdefault(row["slot"], []).append((row["now_ms"], depth / 100, known, told["load_mn"] / 1000))
    yield from slots.values()
    yield [
        (row["now_ms"], _only(row["joint_mm"]), _only(row["commanded_mm"]), row["load_n"])
        for row in log.rows["telemetry"]
        if row.get("load_n") is not None
    ]


def _only(by_label: dict[str, Any]) -> Any:
    """Return the value of the only joint."""
    return next(iter(by_label.values()))


def _columns(readings: list[Reading]) -> tuple[Floats, Floats, Floats, Floats, int]:
    """Return times [s], depths, commands [mm] and forces [N] in the order of time, and the clock at the first [ms].

    An axis that was not yet told where to go is where it was measured; a limp one, later, is told nothing (nan).
    """
    began_ms = readings[0][0]
    times = np.array([since(now_ms, began_ms) for now_ms, *_ in readings]) / 1000.0
    depth, command, force = (np.array([row[k] for row in readings], float) for k in (1, 2, 3))
    rising = np.diff(np.maximum.accumulate(times), prepend=-1.0) > 0.0
    told = np.isfinite(command)
    before = np.arange(len(told)) < (int(told.argmax()) if told.any() else len(told))
    return times[rising], depth[rising], np.where(before, depth, command)[rising], force[rising], began_ms


def _touched(force: Floats) -> int | None:
    """Return the first reading of a force that stays."""
    above = np.convolve(force > TOUCH_N, np.ones(IN_A_ROW), "valid") == IN_A_ROW
    return int(above.argmax()) if above.any() else None


def _until_back(command: Floats) -> int:
    """Return how many readings there are until the axis is told to come back, or nothing any more."""
    back = ~(command >= np.fmax.accumulate(command) - BACK_MM)
    return int(back.argmax()) if back.any() else len(command)
