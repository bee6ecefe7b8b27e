"""Proves a compiled script against the limits that its robot reports, before a byte is sent.

Nothing is run: loops and waits are bounded, so the worst case is a fact of the text.

    report = check(compiled)
    if not report.sound: print(*report.diagnostics, sep="\\n")
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import ceil

from host.gait.compiler import Compiled
from host.gait.diagnostics import Problems, in_order
from host.gait.plan import Delay, Guard, Label, Loop, OnFault, Op, Press, Wait, walk
from host.gait.tree import Place
from host.gait.trial.coiltrial import STEP_MS
from host.gait.trial.lag import Lag
from host.gait.trial.trial import TooLong, Trial
from host.gait.verdict import CoilReport, JointReport, Report
from host.gait.working.bounds import hold_to_limits, nested
from host.profile import Profile
from protocol import program


def check(compiled: Compiled) -> Report:
    """Return the worst case of a script on its robot, with each limit it breaks and the line that does."""
    profile = compiled.profile
    problems = Problems(compiled.script.files)
    hold_to_limits(compiled.plan, profile, problems)
    _check_program(compiled, problems)
    trial = Trial(profile, problems)
    try:
        trial.play(compiled.plan)
    except TooLong as error:
        place = _place(error.op, compiled)
        problems.add(place, "E311", "the worst case of this script takes too long to work out")
    depths = [depth for op, depth in nested(compiled.plan) if isinstance(op, Loop)]
    return Report(
        script=compiled.script.main.name,
        profile=profile,
        longest_ms=_longest_ms(compiled.plan) + Lag().play(compiled.plan).total_ms() + trial.tail_ms + STEP_MS,
        shortest_ms=trial.shortest_ms,
        coils=tuple(_coils(profile, trial)),
        joints=tuple(_joints(profile, trial)),
        force_mn=max((op.target_mn for op in walk(compiled.plan) if isinstance(op, Press)), default=0),
        at_once=trial.heating.at_once_peak,
        current_ma=trial.heating.current_peak_ma,
        program_bytes=len(compiled.code),
        depth=max(depths, default=0),
        guards=sum(isinstance(op, Guard) for op in compiled.plan),
        steps=len(compiled.steps),
        diagnostics=in_order(problems.found),
    )


def _coils(profile: Profile, trial: Trial) -> Iterator[CoilReport]:
    for label, coil in zip(profile.coil_labels, trial.coils, strict=True):
        energy_mj, heat_mj = ceil(coil.energy_uj / 1000), ceil(coil.heat_peak_uj / 1000)
        yield CoilReport(label, coil.orders, coil.on_ms, energy_mj, heat_mj)


def _joints(profile: Profile, trial: Trial) -> Iterator[JointReport]:
    for label, joint in zip(profile.joint_labels, trial.joints, strict=True):
        ends = joint.lowest_centi, joint.highest_centi
        yield JointReport(label, joint.moves, *ends, joint.fastest_centi_per_s, joint.held_ms, joint.driven_ms)


def _longest_ms(ops: Iterable[Op]) -> int:
    """Return how long `ops` take when every wait runs out; a wait may end one control step late."""
    total = 0
    for op in ops:
        if isinstance(op, Delay):
            total += op.time_ms
        elif isinstance(op, Wait):
            total += op.timeout_ms + STEP_MS
        elif isinstance(op, Loop):
            total += op.count * _longest_ms(op.body)
        elif isinstance(op, OnFault):
            total += _longest_ms(op.body)
    return total


def _check_program(compiled: Compiled, problems: Problems) -> None:
    size, most = len(compiled.code), compiled.profile.program.bytes_max
    if size > most:
        place = Place(compiled.script.main.name, 1, 1, 2)
        help = "`softrig run --stream` sends it in pieces"
        problems.add(place, "E307", f"{size} bytes of program, at most {most}", help)
    guards = [op for op in compiled.plan if isinstance(op, Guard)]
    for op in guards[program.GUARDS_MAX :]:
        problems.add(op.node.place, "E309", f"{len(guards)} guards, at most {program.GUARDS_MAX}")
    labels = [op for op in compiled.plan if isinstance(op, Label)]
    for label in labels[program.LABELS_MAX :]:
        problems.add(label.node.place, "E327", f"{len(labels)} labels, at most {program.LABELS_MAX}")


def _place(op: Op, compiled: Compiled) -> Place:
    if isinstance(op, Delay):
        step = compiled.step(op.step)
        return step.place if step else Place(compiled.script.main.name, 1, 1, 2)
    return op.node.place
