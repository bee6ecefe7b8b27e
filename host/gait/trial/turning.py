"""The joints in the worst case of a plan: how far and how fast they are told to go, how long they are left alone.

Where a joint stands is known from its last order; while a wait may cut its way short it is anywhere on the part that is
left. At the start and after a press it is taken to be anywhere in its range, after an orient anywhere within the swing
of that.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy

from host.gait.diagnostics import Problems
from host.gait.plan import Move, Op, Orient, Press
from host.gait.tree import Order, Place
from host.gait.trial.clock import Clock
from host.gait.trial.jointtrial import JointTrial
from host.gait.working.jointunits import UNITS
from host.profile import Profile

Sums = list[tuple[int, ...]]


class Turning:
    """The joints of a robot; one that has none takes no order."""

    def __init__(self, profile: Profile, problems: Problems, clock: Clock) -> None:
        self._labels = profile.joint_labels
        self._first = len(profile.coil_labels)
        self._unit = UNITS[profile.unit]
        self._profile, self._problems, self._clock = profile, problems, clock
        self.joints: list[JointTrial] = []
        if self._labels:
            limits = profile.servo
            least, most = limits.least_centi, limits.most_centi
            self.joints = [JointTrial(least, most, low_centi=least, high_centi=most) for _ in self._labels]
        self._best: list[JointTrial] = []

    def expect(self, plan: Sequence[Op]) -> None:
        """Nothing that comes changes what is known now."""

    def take(self, op: Op) -> None:
        """Take what is for joints."""
        if not isinstance(op, Move | Orient | Press):
            return
        chosen = [joint for joint in range(len(self.joints)) if op.mask >> self._first + joint & 1]
        for joint in chosen:
            self._hold(joint)
        if isinstance(op, Orient):
            self._orient(op, chosen)
            return
        for joint in chosen:
            self._one(joint, op)

    def abort(self) -> None:
        """Have every joint stand where it is."""
        for joint, trial in enumerate(self.joints):
            self._hold(joint)
            trial.driven_ms += trial.driven(self._clock.most_ms)
            trial.low_centi, trial.high_centi = self._place(trial)
            trial.order = None

    def lose(self) -> None:
        """Take it that an abort may come at any time: every joint may stand anywhere."""
        self.joints = [copy(joint) for joint in self._best]
        for trial in self.joints:
            trial.order = None
            trial.low_centi, trial.high_centi = trial.least_centi, trial.most_centi

    def save(self) -> list[JointTrial]:
        """Return copies of the joints as they are now."""
        return [copy(joint) for joint in self.joints]

    def restore(self, saved: list[JointTrial]) -> None:
        """Go on from what was saved."""
        self.joints = saved

    def raise_to(self, mine: list[JointTrial], other: list[JointTrial]) -> None:
        """Take over into one save what is more in another that is like it."""
        for joint, more in zip(mine, other, strict=True):
            joint.raise_to(more)

    def lengthen(self, saved: list[JointTrial], sums: Sums) -> None:
        """Raise the sums of a save to these."""
        for joint, (moves, driven_ms) in zip(saved, sums, strict=True):
            joint.moves, joint.driven_ms = max(joint.moves, moves), max(joint.driven_ms, driven_ms)

    def keep(self) -> None:
        """Keep what the joints came to on this way, where it is more than on those before."""
        if self._best:
            self.raise_to(self._best, self.joints)
        else:
            self._best = self.save()

    @property
    def most(self) -> list[JointTrial]:
        """Return the most that each joint came to on any way."""
        return self._best or self.joints

    def key(self) -> tuple[tuple[object, ...], ...]:
        """Return all but sums that what comes depends on."""
        return self.state()

    def state(self) -> tuple[tuple[object, ...], ...]:
        """Return all that the next turn of a loop depends on, as seen from now."""
        return tuple(self._row(joint) for joint in self.joints)

    def sums(self) -> Sums:
        """Return how many orders each joint has had so far, and how long these drove it."""
        return [(joint.moves, joint.driven_ms) for joint in self.joints]

    def skip(self, turns: int, turn_ms: int, most_ms: int, sums: Sums) -> None:
        """Count `turns` more turns that are copies of the last one; what no turn orders goes on as it was."""
        for joint, (moves, driven_ms) in zip(self.joints, sums, strict=True):
            if joint.moves > moves:
                joint.moves += turns * (joint.moves - moves)
                joint.driven_ms += turns * (joint.driven_ms - driven_ms)
                joint.begin_ms += turns * turn_ms
                joint.begin_most_ms += turns * most_ms

    def tail_ms(self) -> int:
        """Return how long it takes until every joint has arrived; then it only holds."""
        now_ms = self._clock.now_ms
        return max((max(j.begin_ms + j.order.time_ms - now_ms, 0) for j in self.joints if j.order), default=0)

    def least_tail_ms(self) -> int:
        """Return the same: no joint arrives early."""
        return self.tail_ms()

    def finish(self) -> None:
        """Hold to account how long each joint was left alone, up to the end of the program."""
        for joint, trial in enumerate(self.joints):
            self._hold(joint)
            trial.driven_ms += trial.order.time_ms if trial.order else 0

    def _row(self, joint: JointTrial) -> tuple[object, ...]:
        order = joint.order
        if order is None:
            return (None, joint.low_centi, joint.high_centi)
        passed_ms = min(self._clock.now_ms - joint.begin_ms, order.time_ms)
        longest_ms = order.time_ms + self._profile.servo.hold_max_ms + 1
        passed_most_ms = min(self._clock.most_ms - joint.begin_most_ms, longest_ms)
        return (id(order), joint.low_centi, joint.high_centi, passed_ms, passed_most_ms)

    def _one(self, joint: int, op: Move | Press) -> None:
        """Begin what drives a joint by itself; a press may drive it anywhere in its range."""
        trial = self.joints[joint]
        if isinstance(op, Move):
            trial.reach(op.target_centi, op.target_centi)
            self._begin(trial, op, *self._way(joint, op))
        else:
            trial.reach(trial.least_centi, trial.most_centi)
            self._begin(trial, op, trial.least_centi, trial.most_centi)

    def _way(self, joint: int, op: Move) -> tuple[int, int]:
        """Return between which places a move may begin; one that would be too fast is reported."""
        trial, slew = self.joints[joint], self._profile.servo.slew_centi_per_s
        low, high = self._place(trial)
        way_centi = max(op.target_centi - low, high - op.target_centi)
        speed = -(-way_centi * 1000 // op.time_ms)
        trial.fastest_centi_per_s = max(trial.fastest_centi_per_s, speed)
        if speed > slew:
            unit = self._unit
            message = (
                f"joint {self._labels[joint]} would {unit.verb} at {unit.speed(speed)}, at most {unit.speed(slew)}"
            )
            begins = f"it begins between {unit.written(low)} and {unit.written(high)}" if high - low > 1 else ""
            pressed = ": a press leaves it anywhere in its range" if isinstance(trial.order, Press) else ""
            self._problems.add(_value(op.node, "over"), "E318", message, begins + pressed)
        return low, high

    def _orient(self, op: Orient, chosen: Sequence[int]) -> None:
        """Begin an orient, which keeps the grip and swings both joints; a limp one is reported."""
        limp = [self._labels[joint] for joint in chosen if self.joints[joint].order is None]
        if limp:
            help = f"move it first: `move {limp[0]} to 8 deg over 2 s`"
            self._problems.add(op.node.place, "E320", f"joint {limp[0]} is not held when orient begins", help)
            return
        right, left = (self.joints[joint] for joint in chosen)
        ends = self._place(right), self._place(left)
        if right.order is not left.order or not isinstance(right.order, Orient):
            ends = self._swung(op, *ends)
        for trial, (low, high) in zip((right, left), ends, strict=True):
            trial.reach(low, high)
            self._begin(trial, op, low, high)

    def _swung(
        self, op: Orient, right: tuple[int, int], left: tuple[int, int]
    ) -> tuple[tuple[int, int], tuple[int, int]]:
        """Return where an orient may turn two joints that begin between these angles."""
        limits, servo = self._profile.orient, self._profile.servo
        assert limits is not None
        most = limits.swing_max_centideg
        swing = max(-right[0] - left[0], right[1] + left[1]) / 2
        if swing > most:
            message = f"the joints may be swung by {swing / 100:g} deg when orient begins, at most {most / 100:g} deg"
            self._problems.add(op.node.place, "E321", message)
        low, high = (right[0] - left[1]) // 2 - most, (right[1] - left[0] + 1) // 2 + most
        bottom, top = servo.least_centi, servo.most_centi
        return (max(low, bottom), min(high, top)), (max(-high, bottom), min(-low, top))

    def _place(self, trial: JointTrial) -> tuple[int, int]:
        return trial.place(self._clock.now_ms, self._clock.most_ms)

    def _begin(self, trial: JointTrial, op: Move | Orient | Press, low: int, high: int) -> None:
        """Begin a new order on one joint, in place of the one it may have."""
        trial.driven_ms += trial.driven(self._clock.most_ms)
        trial.low_centi, trial.high_centi = low, high
        trial.begin_ms, trial.begin_most_ms = self._clock.now_ms, self._clock.most_ms
        trial.order = op
        trial.moves += 1

    def _hold(self, joint: int) -> None:
        """Report a joint that was left alone for too long."""
        trial, most_ms = self.joints[joint], self._profile.servo.hold_max_ms
        held_ms = trial.held(self._clock.most_ms)
        trial.held_ms = max(trial.held_ms, held_ms)
        if held_ms > most_ms and trial.order:
            label = self._labels[joint]
            message = f"joint {label} would be without an order for {held_ms} ms after this one, at most {most_ms} ms"
            self._problems.add(trial.order.node.place, "E319", message)


def _value(node: Order, word: str) -> Place:
    clause = node.clause(word)
    return clause.value.place if clause else node.place
