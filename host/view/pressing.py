"""Chooses the instants of a press that a picture shows: push, end of the hold, just after release, long after.

The press is the one with the greatest force, from touching the block to letting go of it; the push ends where that
force is first reached, the hold ends when the indenter begins to rise.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from host.errors import BadRequest
from host.fields import Slice
from host.recording import Recording, Scene
from host.view.instants import Numbers

NAMES = ("push", "end of the hold", "just after release", "long after")
FULL = 0.99  # of the greatest force: the push is over
APART_MS = 10  # scene and slice of one instant
RISEN_MM = 0.01  # above where it was deepest: the hold is over


class Press(NamedTuple):
    """One press by its scenes: before it, at the end of push and hold, the first after it, the last before the next."""

    before: int
    push: int
    hold: int
    freed: int
    after: int


def press_of(recording: Recording) -> Press:
    """Return the press of the greatest force; BadRequest when nothing was pressed, or not released."""
    force, touching = of_scenes(recording, "force_n"), of_scenes(recording, "touching") > 0
    if not touching.any():
        raise BadRequest("the press touched nothing in this run")
    best = int(np.where(touching, force, -np.inf).argmax())
    begin, end = _around(touching, best)
    if end == len(touching):
        raise BadRequest("the press was not lifted off the block in this run: nothing is left alone")
    inside = np.arange(begin, end)
    depth = of_scenes(recording, "depth_mm")[inside]
    push = int(inside[force[inside] >= FULL * force[best]][0])
    hold = int(inside[depth >= depth.max() - RISEN_MM][-1])
    again = np.flatnonzero(touching[end:])
    after = end + int(again[0]) - 1 if len(again) else len(touching) - 1
    return Press(max(0, begin - 1), push, max(push, hold), end, after)


def slices_of(recording: Recording) -> list[Slice]:
    """Return the fields at the four instants; BadRequest when there were none, or the press was not lifted."""
    if recording.mesh is None or not recording.slices:
        raise BadRequest("this figure needs the fields of a block: run it on the bench, --robot sim:press")
    press, seen = press_of(recording), [scene["host_ms"] for scene in recording.scenes]
    times = np.array([each.host_ms for each in recording.slices])
    hold, after = (int(np.searchsorted(times, seen[i] + APART_MS, "right")) - 1 for i in (press.hold, press.after))
    push = min(nearest(recording.slices, seen[press.push]), max(0, hold))
    freed = min(int(np.searchsorted(times, seen[press.freed] - APART_MS)), after)
    return [recording.slices[max(0, i)] for i in (push, hold, freed, after)]


def of_scenes(recording: Recording, name: str) -> Numbers:
    """Return what each scene tells."""
    return np.array([scene[name] for scene in recording.scenes], dtype=float)


def at_slice(recording: Recording, each: Slice, name: str) -> float:
    """Return what the scenes around a slice tell for its time."""
    seen = [scene["host_ms"] for scene in recording.scenes]
    return float(np.interp(each.host_ms, seen, of_scenes(recording, name)))


def nearest(seen: Sequence[Scene] | Sequence[Slice], host_ms: int) -> int:
    """Return which of scenes or slices is nearest in time."""
    times = [each.host_ms if isinstance(each, Slice) else each["host_ms"] for each in seen]
    return int(np.abs(np.array(times) - host_ms).argmin())


def _around(touching: NDArray[np.bool_], index: int) -> tuple[int, int]:
    """Return from which scene to before which the press touches the block around one at which it does."""
    apart = np.flatnonzero(~touching)
    before, after = apart[apart < index], apart[apart > index]
    return int(before[-1]) + 1 if len(before) else 0, int(after[0]) if len(after) else len(touching)
