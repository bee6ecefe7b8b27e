"""Chooses the instants of a run of two fingers: parallel, gripping, and where they turn back as they swing together.

The grip is half of how far the joints are turned towards each other, the swing half of how far both are turned the same
way: right = swing + grip, left = swing - grip.
"""

from __future__ import annotations

import numpy as np

from host.errors import BadRequest
from host.recording import Recording, Scene
from host.view.hand import side_of
from host.view.instants import Numbers, scene_times

LEAST_DEG = 0.5  # a swing
LEAST_STEP_DEG = 0.01  # a movement from scene to scene
BACK, STILL = 0.25, 0.02  # of the greatest swing: they have turned back; they stand


def joints_deg(recording: Recording) -> Numbers:
    """Return the angles of the right and the left joint at each scene, in degrees."""
    return np.array([[_finger(scene, side)["deg"] for side in (1.0, -1.0)] for scene in recording.scenes], dtype=float)


def grip_deg(recording: Recording) -> Numbers:
    """Return how far both fingers are turned inward at each scene."""
    right, left = joints_deg(recording).T
    grip: Numbers = (right - left) / 2
    return grip


def swing_deg(recording: Recording) -> Numbers:
    """Return how far both fingers are turned the same way at each scene, counter-clockwise."""
    right, left = joints_deg(recording).T
    swing: Numbers = (right + left) / 2
    return swing


def object_deg(recording: Recording) -> Numbers:
    """Return the object's angle at each scene."""
    return np.array([scene["object"]["deg"] for scene in recording.scenes], dtype=float)


def of_fingers(recording: Recording, name: str) -> Numbers:
    """Return what each scene tells of the right and the left finger."""
    return np.array([[_finger(scene, side)[name] for side in (1.0, -1.0)] for scene in recording.scenes], dtype=float)


def turning(recording: Recording) -> list[int]:
    """Return the scenes that end each swing, just before the fingers turn back; BadRequest when they never swung."""
    swing = swing_deg(recording)
    greatest = _greatest(swing)
    found: list[int] = []
    best, rising = 0, 0.0
    for i, now in enumerate(swing):
        further = float(now - swing[best])
        if rising and further * rising < -BACK * greatest:
            found.append(best)
        if further * rising > 0 or abs(further) > BACK * greatest:
            best, rising = i, float(np.sign(further))
    found.append(best)
    ends = zip(found, [*found[1:], len(swing)], strict=True)
    return [_last(recording, swing, i, until) for i, until in ends if abs(swing[i]) > BACK * greatest]


def parallel(recording: Recording) -> int:
    """Return the last scene before the fingers close, at rest if they ever were."""
    grip = grip_deg(recording)
    closed = np.flatnonzero(grip > STILL * float(grip.max()))
    return resting(recording, 0, int(closed[0])) if len(closed) else 0


def held(recording: Recording) -> list[int]:
    """Return the scenes from the first swing to the last rest with that grip; BadRequest without a swing."""
    grip, begin = grip_deg(recording), gripping(recording)
    gone = np.flatnonzero(np.abs(grip[begin:] - grip[begin]) > STILL * abs(grip[begin]))
    end = resting(recording, begin, begin + int(gone[0])) + 1 if len(gone) else len(grip)
    return list(range(begin, end))


def gripping(recording: Recording) -> int:
    """Return the last scene before the fingers first swing together, at rest if they were; BadRequest without swing."""
    swing = swing_deg(recording)
    moved = int(np.flatnonzero(np.abs(swing) > STILL * _greatest(swing))[0])
    grip = grip_deg(recording)[:moved]
    closed = np.flatnonzero(grip > (1 - STILL) * float(grip.max(initial=0.0)))
    return resting(recording, int(closed[0]), moved) if len(closed) else 0


def phases(recording: Recording) -> list[int]:
    """Return the scenes that end the paper's phases: parallel, gripping, and each swing."""
    return [parallel(recording), gripping(recording), *turning(recording)]


def phase_names(recording: Recording) -> list[str]:
    """Return the paper's number of each of these phases: 2 for a swing to the left, 3 for one to the right."""
    swing = swing_deg(recording)
    return ["0", "1", *("2" if swing[i] > 0 else "3" for i in turning(recording))]


def telling(recording: Recording, count: int) -> list[int]:
    """Return at most so many scenes that tell a run: the ends of its phases, or evenly when the fingers never swung."""
    if np.abs(swing_deg(recording)).max() < LEAST_DEG:
        return spread(recording, count)
    return filled(sorted({*phases(recording)[: count - 1], len(recording.scenes) - 1}), count)


def filled(chosen: list[int], count: int) -> list[int]:
    """Return so many scenes: these, and ones halfway in the widest gaps between them, the first gap left as it is."""
    scenes = list(chosen)
    while len(scenes) < count and (gaps := np.diff(scenes[1:])).size and gaps.max() > 1:
        widest = int(gaps.argmax()) + 1
        scenes.insert(widest + 1, (scenes[widest] + scenes[widest + 1]) // 2)
    return scenes


def spread(recording: Recording, count: int) -> list[int]:
    """Return scenes that tell a run: evenly in time and in the movement of joints and object alike."""
    moved = np.column_stack([joints_deg(recording), object_deg(recording)])
    way = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(moved, axis=0)).sum(axis=1))])
    times = scene_times(recording)
    share = _shared(times) + 2 * _shared(way)
    return sorted({int(np.abs(share - goal).argmin()) for goal in np.linspace(share[0], share[-1], count)})


def _greatest(swing: Numbers) -> float:
    """Return the greatest swing to either side."""
    greatest = float(np.abs(swing).max())
    if greatest < LEAST_DEG:
        raise BadRequest("the fingers never swung together in this run")
    return greatest


def resting(recording: Recording, begin: int, end: int) -> int:
    """Return the last scene from `begin` to before `end` that finds the joints as the one before, or just the last."""
    joints = joints_deg(recording)[max(0, begin - 1) : end]
    moved = np.abs(np.diff(joints, axis=0)).max(axis=1)
    still = np.flatnonzero(moved < LEAST_STEP_DEG)
    return max(0, begin - 1) + 1 + int(still[-1]) if len(still) else max(0, end - 1)


def _last(recording: Recording, swing: Numbers, index: int, until: int) -> int:
    """Return the last scene before `until` whose swing is that of the one at `index`."""
    near = np.flatnonzero(np.abs(swing[index:until] - swing[index]) < STILL * _greatest(swing))
    return resting(recording, index, index + int(near[-1]) + 1)


def _finger(scene: Scene, side: float) -> Scene:
    finger: Scene = next(scene["fingers"][label] for label in scene["fingers"] if side_of(scene, label) == side)
    return finger


def _shared(values: Numbers) -> Numbers:
    """Return the values from 0 to 1."""
    share: Numbers = (values - values[0]) / max(float(values[-1] - values[0]), 1e-9)
    return share
