"""Chooses the instants of a run that a picture shows: where the body rests, how far it came, its fastest movement."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from host.recording import Recording, Scene

Numbers = NDArray[np.float64]
NEAR = 7.5  # of the body's width: one that rolls farther is drawn up to here; its curves go on
LEAP = 0.6  # of the body's width: a rise that is a jump and no step
GAP = 1.0  # of the body's width: a jump is shown at least this often along its path


def hub(scene: Scene) -> Numbers:
    """Return the place of the hub, with as many coordinates as a node has."""
    return np.array(scene["hub"][: len(scene["nodes"][0])], dtype=float)


def hubs_of(scenes: Sequence[Scene]) -> Numbers:
    """Return the places of the hub, one row for each scene."""
    return np.array([hub(scene) for scene in scenes])


def width_mm(scene: Scene) -> float:
    """Return the extent of the body along the ground."""
    return float(np.ptp(np.asarray(scene["nodes"], dtype=float)[:, 0]))


def nearby(recording: Recording) -> Recording:
    """Return the recording with the scenes up to where the body first leaves the neighbourhood of its start."""
    if not recording.scenes:
        return recording
    hubs = hubs_of(recording.scenes)
    away = np.flatnonzero(np.linalg.norm(hubs - hubs[:1], axis=1) > NEAR * width_mm(recording.scenes[0]))
    return replace(recording, scenes=recording.scenes[: away[0]] if len(away) else recording.scenes)


def onsets(recording: Recording) -> list[float]:
    """Return the times in seconds at which a coil begins to be driven."""
    found = []
    before: tuple[int, ...] = ()
    for row in recording.telemetry:
        if any(now and not was for now, was in zip(row.duty_permille, before or [0] * 99, strict=False)):
            found.append(recording.seconds(row.host_ms))
        before = row.duty_permille
    return found


def scene_times(recording: Recording) -> Numbers:
    """Return the times of the scenes in seconds."""
    return np.array([recording.seconds(scene["host_ms"]) for scene in recording.scenes])


def path_mm(scenes: Sequence[Scene]) -> Numbers:
    """Return how far the hub has come along its path at each scene."""
    return _added(np.linalg.norm(np.diff(hubs_of(scenes), axis=0), axis=1))


def movement_mm(scenes: Sequence[Scene]) -> Numbers:
    """Return the summed movement of the rim (root mean square over its nodes) at each scene."""
    rims = np.array([scene["nodes"] for scene in scenes], dtype=float)
    return _added(np.sqrt((np.diff(rims, axis=0) ** 2).sum(axis=2).mean(axis=1)))


def resting(recording: Recording) -> list[int]:
    """Return scenes that tell the whole path: the first and last, each before a drive, an apex, and no big gap."""
    times, path = scene_times(recording), path_mm(recording.scenes)
    starts = [max(0, int(np.searchsorted(times, t)) - 1) for t in onsets(recording)]
    chosen, gap_mm = [0], GAP * width_mm(recording.scenes[0])
    for index in sorted({*starts, *_highest(recording), len(times) - 1} - {0}):
        gap = path[index] - path[chosen[-1]]
        filled = np.linspace(path[chosen[-1]], path[index], int(gap // gap_mm) + 2)[1:-1]
        chosen += [int(np.searchsorted(path, mm)) for mm in filled] + [index]
    return sorted(set(chosen))


def apart(recording: Recording, candidates: Sequence[int], distance_mm: float, upward: float = 1.0) -> list[int]:
    """Return candidates whose hubs are at least that far apart: the first, the last, and what fits best between.

    A distance upward counts `upward` times.
    """
    hubs = hubs_of([recording.scenes[i] for i in candidates])
    hubs[:, -1] *= upward
    chosen = [0]
    nearest = np.linalg.norm(hubs - hubs[0], axis=1)
    following = len(hubs) - 1 if nearest[-1] >= distance_mm else int(nearest.argmax())
    while nearest[following] >= distance_mm:
        chosen.append(following)
        nearest = np.minimum(nearest, np.linalg.norm(hubs - hubs[following], axis=1))
        following = int(nearest.argmax())
    return sorted(candidates[i] for i in chosen)


def fastest(recording: Recording, count: int) -> list[int]:
    """Return `count` scenes of the movement about the fastest moment, from one drive to the next.

    They stand evenly in time and movement alike, so that a quick movement is not missed between two long rests.
    """
    times, moved = scene_times(recording), movement_mm(recording.scenes)
    peak = times[int(np.argmax(np.diff(moved) / np.maximum(np.diff(times), 1e-6)))]
    edges = [times[0], *onsets(recording), times[-1]]
    begin = max(t for t in edges if t <= peak)
    end = min([t for t in edges if t > peak], default=times[-1])
    return between(recording, begin, end, count)


def between(recording: Recording, begin_s: float, end_s: float, count: int) -> list[int]:
    """Return `count` scenes from begin to end, evenly in time and movement alike."""
    times, moved = scene_times(recording), movement_mm(recording.scenes)
    inside = np.flatnonzero((times >= begin_s - 1e-9) & (times <= end_s + 1e-9))
    share = _shared(times[inside]) + _shared(moved[inside])
    return [int(inside[np.abs(share - goal).argmin()]) for goal in np.linspace(share[0], share[-1], count)]


def _highest(recording: Recording) -> list[int]:
    """Return the scene of the greatest height of a body that leaped, else none."""
    heights = hubs_of(recording.scenes)[:, -1]
    return [int(heights.argmax())] if np.ptp(heights) > LEAP * width_mm(recording.scenes[0]) else []


def _added(steps: Numbers) -> Numbers:
    return np.concatenate([[0.0], np.cumsum(steps)])


def _shared(values: Numbers) -> Numbers:
    """Return the values from 0 to 1."""
    share: Numbers = (values - values[0]) / max(float(values[-1] - values[0]), 1e-9)
    return share
