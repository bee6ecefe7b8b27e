"""Proves a compiled script against the limits that its robot reports, before a byte is sent.

Nothing is run: loops and waits are bounded, so the worst case is a fact of the text.

    report = check(compiled)
    if not report.sound: print(*report.diagnostics, sep="\\n")
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import ceil

from host.gait.coiltrial import STEP_MS
from host.gait.compiler import Compiled
from host.gait.diagnostics import Problems, in_order
from host.gait.jointunits import UNITS
from host.gait.plan import Delay, Fire, Guard, Loop, Move, Op, Press, Wait, walk
from host.gait.tree import Clause, Facing, Order, Place
from host.gait.trial import TooLong, Trial
from host.gait.verdict import CoilReport, JointReport, Report
from host.profile import Profile
from protocol import program


def check(compiled: Compiled) -> Report:
    """Return the worst case of a script on its robot, with each limit it breaks and the line that does."""
    profile = compiled.profile
    problems = Problems(compiled.script.files)
    for op, depth in _walk(compiled.plan):
        _check_op(op, depth, profile, problems)
    _check_program(compiled, problems)
    trial = Trial(profile, problems)
    try:
        trial.play(compiled.plan)
    except TooLong as error:
        place = _place(error.op, compiled)
        problems.add(place, "E311", "the worst case of this script takes too long to work out")
    depths = [depth for op, depth in _walk(compiled.plan) if isinstance(op, Loop)]
    return Report(
        script=compiled.script.main.name,
        profile=profile,
        longest_ms=_longest_ms(compiled.plan) + trial.tail_ms + STEP_MS,
        shortest_ms=trial.now_ms,
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


def _walk(ops: Iterable[Op], depth: int = 1) -> Iterator[tuple[Op, int]]:
    """Yield every op once, with the depth of loops it would open or stand in."""
    for op in ops:
        yield op, depth
        if isinstance(op, Loop):
            yield from _walk(op.body, depth + 1)


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
    return total


def _check_op(op: Op, depth: int, profile: Profile, problems: Problems) -> None:
    if isinstance(op, Loop) and depth > program.DEPTH_MAX:
        problems.add(op.node.place, "E308", f"repeats are nested {depth} deep, at most {program.DEPTH_MAX}")
    match op:
        case Guard() | Wait():
            _check_condition(op, profile, problems)
        case Move():
            _check_range(op, profile, problems)
        case Press():
            _check_press(op, profile, problems)
        case Fire():
            _check_fire(op, profile, problems)


def _check_condition(op: Guard | Wait, profile: Profile, problems: Problems) -> None:
    """Report a condition that comes too late: the robot trips before it, or the sensor reads no more."""
    asked, node = op.condition, op.node.condition
    if isinstance(node, Facing) or asked.compare == program.BELOW:
        return
    place = node.value.place
    if isinstance(op, Guard) and asked.source == program.TEMPERATURE:
        _check_trip(asked.value, place, profile, problems)
    if asked.source == program.FORCE and profile.load is not None and asked.value >= profile.load.trip_mn:
        own = f"the robot's own trip at {profile.load.trip_mn / 1000:g} N"
        problems.add(place, "E310", f"{asked.value / 1000:g} N is not below {own}")
    if asked.source == program.PRESSURE and profile.cell is not None and asked.value >= profile.cell.full_pa:
        most = f"a force cell reads {profile.cell.full_pa / 1000:g} kPa at most"
        problems.add(place, "E325", f"it is never above {asked.value / 1000:g} kPa: {most}")


def _check_range(op: Move, profile: Profile, problems: Problems) -> None:
    limits, unit = profile.servo, UNITS[profile.unit]
    if not limits.least_centi <= op.target_centi <= limits.most_centi:
        ends = f"{unit.written(limits.least_centi)} .. {unit.written(limits.most_centi)}"
        problems.add(_clause(op, "to"), "E317", f"{unit.written(op.target_centi)} is outside {ends}")


def _check_press(op: Press, profile: Profile, problems: Problems) -> None:
    most_ms = profile.servo.hold_max_ms
    if profile.load is not None and op.target_mn > profile.load.most_mn:
        message = f"{op.target_mn / 1000:g} N, at most {profile.load.most_mn / 1000:g} N"
        problems.add(_clause(op, "to"), "E323", message)
    if op.time_ms > most_ms:
        problems.add(_clause(op, "for"), "E324", f"a press of {op.time_ms} ms, at most {most_ms} ms")


def _check_fire(op: Fire, profile: Profile, problems: Problems) -> None:
    limits = profile.coil
    clauses = {clause.word: clause for clause in op.node.clauses}
    if op.duty_permille > limits.duty_max_permille:
        message = f"duty {op.duty_permille / 10:g} %, at most {limits.duty_max_permille / 10:g} %"
        problems.add(_value(clauses["at"]), "E301", message)
    if op.time_ms > limits.hold_max_ms:
        message = f"an order of {op.time_ms} ms, at most {limits.hold_max_ms} ms"
        problems.add(_value(clauses["for"]), "E302", message)
    if "until" in clauses:
        _check_trip(op.cutoff_decidegc, _value(clauses["until"]), profile, problems)


def _check_trip(value_decidegc: int, place: Place, profile: Profile, problems: Problems) -> None:
    trip_degc = profile.coil.trip_degc
    if value_decidegc >= trip_degc * 10:
        problems.add(place, "E310", f"{value_decidegc / 10:g} C is not below the robot's own trip at {trip_degc} C")


def _check_program(compiled: Compiled, problems: Problems) -> None:
    size, most = len(compiled.code), compiled.profile.program.bytes_max
    if size > most:
        place = Place(compiled.script.main.name, 1, 1, 2)
        help = "`softrig run --stream` sends it in pieces"
        problems.add(place, "E307", f"{size} bytes of program, at most {most}", help)
    guards = [op for op in compiled.plan if isinstance(op, Guard)]
    for op in guards[program.GUARDS_MAX :]:
        problems.add(op.node.place, "E309", f"{len(guards)} guards, at most {program.GUARDS_MAX}")


def _place(op: Op, compiled: Compiled) -> Place:
    if isinstance(op, Delay):
        step = compiled.step(op.step)
        return step.place if step else Place(compiled.script.main.name, 1, 1, 2)
    return op.node.place


def _clause(op: Move | Press, word: str) -> Place:
    node: Order = op.node
    clause = node.clause(word)
    return _value(clause) if clause else node.place


def _value(clause: Clause) -> Place:
    return clause.value.place
