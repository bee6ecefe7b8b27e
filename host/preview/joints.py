"""What joints are told over time: lines from target to target, and spans in which the robot regulates them itself."""

from __future__ import annotations

from dataclasses import dataclass, field

from host.gait.model.course import Course
from host.profile import Profile

Point = tuple[float, float]  # ms, value


@dataclass(slots=True)
class Targets:
    """One joint, the object that is held, or the force: where it should be when, in the unit of the lane."""

    label: str
    unit: str
    lines: list[list[Point]] = field(default_factory=list)
    spans: list[Point] = field(default_factory=list)  # from, until: the robot itself says where it is
    guesses: list[list[Point]] = field(default_factory=list)  # on their way from nobody knows where

    @property
    def values(self) -> list[float]:
        """Return every value that occurs."""
        return [value for line in [*self.lines, *self.guesses] for _, value in line]


def targets_of(course: Course, profile: Profile) -> list[Targets]:
    """Return what is asked of each joint that is moved, of the object and of the force, in this order."""
    found = [_joint(course, profile, label) for label in profile.joint_labels]
    found.append(_held("object", "deg", 100, "orient", course))
    found.append(_held("force", "N", 1000, "press", course))
    return [each for each in found if each.lines or each.spans or each.guesses]


def _joint(course: Course, profile: Profile, label: str) -> Targets:
    """Return the way of one joint; where it lies before its first order is not known."""
    targets, bit = Targets(label, profile.unit), 1 << profile.labels.index(label)
    motions = [motion for motion in course.motions if motion.mask & bit]
    line: list[Point] = []
    for i, motion in enumerate(motions):
        next_ms = motions[i + 1].begin_ms if i + 1 < len(motions) else course.end_ms
        if motion.kind != "move":
            targets.lines += [line] if line else []
            targets.spans.append((motion.begin_ms, max(next_ms, motion.begin_ms)))
            line = []
            continue
        goal, begin_ms, arrive_ms = motion.target / 100, motion.begin_ms, motion.arrive_ms
        there_ms = min(arrive_ms, next_ms)
        if not line:
            targets.guesses.append([(begin_ms, goal), (there_ms, goal)])
        else:
            share = (there_ms - begin_ms) / max(arrive_ms - begin_ms, 1)
            line += [(begin_ms, line[-1][1]), (there_ms, line[-1][1] + share * (goal - line[-1][1]))]
        line += [(arrive_ms, goal), (next_ms, goal)] if arrive_ms <= next_ms else []
    targets.lines += [line] if line else []
    return targets


def _held(label: str, unit: str, parts: int, kind: str, course: Course) -> Targets:
    """Return what is regulated: an order goes on from the one before, or from nothing."""
    targets = Targets(label, unit)
    for i, motion in enumerate(course.motions):
        if motion.kind != kind:
            continue
        later = [other.begin_ms for other in course.motions[i + 1 :] if other.mask & motion.mask]
        until_ms = min([motion.end_ms, course.end_ms, *later])
        if until_ms <= motion.begin_ms:
            continue
        follows = bool(targets.lines) and targets.lines[-1][-1][0] == motion.begin_ms
        line = targets.lines.pop() if follows else []
        before = line[-1][1] if line else 0.0
        arrive_ms = min(motion.arrive_ms if kind == "press" else motion.begin_ms, until_ms)
        goal = motion.target / parts
        line += [(motion.begin_ms, before)] if line or kind == "press" else []
        targets.lines.append([*line, (arrive_ms, goal), (until_ms, goal)])
    return targets
