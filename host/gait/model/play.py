"""Plays a plan on a model of its robot's coils, one way through: waits for what the model knows end as it says, all
others at once (`early`) or only when their time is over.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from host.gait.model.blind import Blind
from host.gait.model.course import ABORTED, GIVEN_UP, GUARDED, Course, Gap, Mark, Motion, Pause, Track
from host.gait.model.warmth import Endless, Warmth
from host.gait.plan import Aim, Delay, Fire, Guard, Label, Loop, Move, OnFault, Op, Orient, Press, Wait
from host.gait.tree import Place
from host.gait.trial.coiltrial import STEP_MS
from host.predictors import Coils
from host.profile import Profile
from protocol import program

WHOLE_TURNS = 24  # of a traced loop that are told one by one, even if they are copies


class _Jump(Exception):
    """A wait ran out: go on at this label."""

    def __init__(self, label: int) -> None:
        super().__init__()
        self.label = label


class _Over(Exception):
    """The program ends here, for this reason."""

    def __init__(self, outcome: str, where: Place | None) -> None:
        super().__init__()
        self.outcome, self.where = outcome, where


class Play:
    """One way through a plan; `unknown` is whether anything was met that the model does not know."""

    def __init__(self, profile: Profile, coils: Coils | None, early: bool, every_ms: int = 0) -> None:
        spare = [Track(f"aim {place}") for place in range(program.AIMS_MAX)]
        self.course = Course([Track(label) for label in profile.coil_labels] + spare)
        self.unknown = False
        self._profile, self._early, self._traced = profile, early, every_ms > 0
        self._modelled = coils is not None and bool(profile.coil_labels)
        self._warmth = Warmth(profile, coils or Blind(profile.coil_labels, program.AIMS_MAX), self.course, every_ms)

    def run(self, plan: Sequence[Op]) -> Course:
        """Play all of it, and let every order end."""
        course, warmth = self.course, self._warmth
        try:
            self._whole(plan)
            self._pass(max(warmth.busy_ms, course.settled_ms))
        except Endless:
            course.outcome = GIVEN_UP
        except _Over as over:
            course.outcome, course.where = over.outcome, over.where
            warmth.off()
            self._catch(plan)
        warmth.off()
        course.end_ms = warmth.now_ms
        return course

    def _whole(self, plan: Sequence[Op]) -> None:
        """Play a plan, from label to label where waits run out."""
        at = 0
        while True:
            try:
                self._ops(plan[at:])
                return
            except _Jump as jump:
                labels = [i for i, op in enumerate(plan) if isinstance(op, Label) and op.number == jump.label]
                at = labels[0]

    def _catch(self, plan: Sequence[Op]) -> None:
        """Play what follows an abort, if there is anything; nothing follows a trip."""
        body = next((op.body for op in plan if isinstance(op, OnFault)), ())
        if self.course.outcome != ABORTED or not body:
            return
        try:
            self._ops(body)
            self._pass(self._warmth.busy_ms)
        except (Endless, _Over, _Jump):
            return

    def _ops(self, ops: Iterable[Op]) -> None:
        for op in ops:
            if isinstance(op, Loop):
                self._loop(op)
            elif not isinstance(op, OnFault):
                self._op(op)

    def _op(self, op: Op) -> None:
        step = getattr(op, "step", 0)
        marks = self.course.marks
        if step and (not marks or marks[-1].step != step):
            marks.append(Mark(self._warmth.now_ms, step))
        match op:
            case Fire():
                self._warmth.fire(op)
            case Aim():
                self._warmth.aim(op, tuple(self._profile.labels[channel] for channel in op.circle))
            case Delay():
                self._pass(self._warmth.now_ms + op.time_ms)
            case Wait():
                self._wait(op)
            case Guard():
                self._guard(op)
            case Move() | Orient() | Press():
                self._move(op)

    def _pass(self, until_ms: int) -> None:
        self._warmth.pass_until(until_ms)
        self._look()

    def _look(self) -> None:
        """End the program where a guard trips."""
        where = self._warmth.guarded()
        if where is not None:
            raise _Over(GUARDED, where)

    def _loop(self, loop: Loop) -> None:
        """Play turns until one leaves everything as it found it; the rest are its copies."""
        before, warmth = self._warmth.state(), self._warmth
        for turn in range(loop.count):
            now_ms, sums = warmth.now_ms, warmth.sums()
            self._ops(loop.body)
            after, left = warmth.state(), loop.count - turn - 1
            if after == before and left > (WHOLE_TURNS if self._traced else 0):
                begin_ms = warmth.now_ms
                warmth.skip(left, begin_ms - now_ms, sums)
                self.course.gaps.append(Gap(begin_ms, warmth.now_ms, left))
                return
            before = after

    def _wait(self, op: Wait) -> None:
        begin_ms = self._warmth.now_ms
        until_ms = begin_ms + op.timeout_ms
        met = self._met(op, until_ms)
        known = met is not None
        if met is None:
            self.unknown = True
            met = self._early or op.otherwise == program.ABORT  # late: in the last moment, where all else ends here
            if not self._early:
                self._pass(until_ms)
        self._look()
        self.course.pauses.append(Pause(begin_ms, self._warmth.now_ms, met, known, op.step))
        if met or op.otherwise == program.CONTINUE:
            return
        if op.otherwise == program.ABORT:
            raise _Over(ABORTED, op.node.place)
        raise _Jump(op.otherwise - program.JUMP)

    def _met(self, op: Wait, until_ms: int) -> bool | None:
        """Let the time of a wait pass; return whether its condition was met, None: the model does not know."""
        asked, warmth = op.condition, self._warmth
        above, want_all = asked.compare == program.ABOVE, asked.quantifier == program.ALL
        if asked.source == program.TIME:
            return self._timed(asked.mask, above, until_ms)
        if asked.source not in (program.TEMPERATURE, program.HEAT) or not self._modelled:
            return None
        if asked.source == program.HEAT:
            return warmth.pass_cooler(until_ms, self._mask(asked), above, asked.value, want_all)
        return warmth.pass_until(until_ms, (self._mask(asked), above, asked.value / 10, want_all))

    def _timed(self, since_ms: int, above: bool, until_ms: int) -> bool:
        """Let time pass until the program is older, or younger, than that."""
        if above and self._warmth.now_ms <= since_ms:
            self._pass(min(since_ms + STEP_MS, until_ms))
        return (self._warmth.now_ms > since_ms) == above

    def _mask(self, asked: program.Condition) -> int:
        """Return the coils that are asked about, with those behind them that the robot chooses."""
        mask, count = int(asked.mask), len(self._profile.coil_labels)
        if asked.quantifier == program.CHOSEN:
            return 1 << count + mask
        chosen = ((1 << program.AIMS_MAX) - 1) << count
        return mask | chosen if mask & (mask - 1) else mask

    def _guard(self, op: Guard) -> None:
        """Heed a guard of temperatures, if any coil alone can trip it."""
        asked = op.condition
        mask = self._mask(asked)
        alone = asked.quantifier != program.ALL or mask & (mask - 1) == 0
        if (asked.source, asked.compare) == (program.TEMPERATURE, program.ABOVE) and alone and self._modelled:
            guard = mask, asked.value / 10, op.node.place
            self._warmth.guards += [guard] if guard not in self._warmth.guards else []
            self._look()

    def _move(self, op: Move | Orient | Press) -> None:
        now_ms = self._warmth.now_ms
        end_ms = now_ms + op.time_ms
        match op:
            case Move():
                row = Motion("move", op.mask, now_ms, end_ms, end_ms, op.target_centi, op.step)
            case Orient():
                row = Motion("orient", op.mask, now_ms, end_ms, end_ms, op.target_centideg, op.step)
            case Press():
                row = Motion("press", op.mask, now_ms, now_ms + op.over_ms, end_ms, op.target_mn, op.step)
        self.course.motions.append(row)
