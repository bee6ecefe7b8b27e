"""What is left of a compiled script from one of its steps on: how a run that ended early is taken up again.

rest = cut(compiled, 7)     # step 7, as `softrig run` and `softrig status` print it

All guards stay, and so does the last `let` of each name: the robot chooses anew. A loop that the step stands in goes on
with the rest of its first turn and has all its other turns. What was heated or moved before the step is not repeated;
what runs `on fault` stays, and is no place to begin from.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

from host.errors import BadRequest
from host.gait.compiler import Compiled
from host.gait.plan import Aim, Guard, Loop, OnFault, Op, encode


def cut(compiled: Compiled, step: int) -> Compiled:
    """Return the script from that step on, its steps numbered as before; BadRequest names the steps there are."""
    passed: list[Op] = []
    rest = _from(compiled.plan, step, passed)
    if rest is None:
        known = _ranges(sorted(set(_numbers(compiled.plan))))
        raise BadRequest(f"no step {step} to begin from: {compiled.script.main.name} has {known}")
    plan = (*_kept(passed), *rest)
    return replace(compiled, plan=plan, code=encode(plan))


def _from(plan: Sequence[Op], step: int, passed: list[Op]) -> list[Op] | None:
    """Return the ops from the first one of that step on, None where there is none; `passed` gains those before it."""
    for place, op in enumerate(plan):
        if isinstance(op, Loop):
            rest = _from(op.body, step, passed)
            if rest is not None:
                turns = [replace(op, count=op.count - 1)] if op.count > 1 else []
                return [*rest, *turns, *plan[place + 1 :]]
        elif not isinstance(op, Guard | OnFault) and op.step == step:
            return list(plan[place:])
        passed.append(op)
    return None


def _kept(passed: Iterable[Op]) -> list[Op]:
    """Return those of the ops passed over whose work lasts."""
    guards = [op for op in passed if isinstance(op, Guard)]
    aims = {op.kept: op for op in passed if isinstance(op, Aim)}
    return [*guards, *aims.values()]


def _numbers(plan: Iterable[Op]) -> Iterator[int]:
    for op in plan:
        if isinstance(op, Loop):
            yield from _numbers(op.body)
        elif not isinstance(op, Guard | OnFault):
            yield op.step


def _ranges(numbers: Sequence[int]) -> str:
    """Return the numbers as words: "steps 1 to 4 and 6"."""
    runs: list[list[int]] = []
    for number in numbers:
        if runs and number == runs[-1][-1] + 1:
            runs[-1].append(number)
        else:
            runs.append([number])
    told = [str(run[0]) if len(run) == 1 else f"{run[0]} to {run[-1]}" for run in runs]
    if not told:
        return "none"
    return f"step{'s' if len(numbers) > 1 else ''} {', '.join(told[:-1])}{' and ' if told[1:] else ''}{told[-1]}"
