"""Proves a compiled script against the limits that its robot reports, before a byte is sent.

Nothing is run: loops and waits are bounded, so the worst case is a fact of the text.

    report = check(compiled)
    if not report.sound: print(*report.diagnostics, sep="\\n")
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from math import ceil

from host.gait.coiltrial import STEP_MS
from host.gait.compiler import Compiled
from host.gait.diagnostics import Diagnostic, Problems, exit_code, in_order
from host.gait.plan import Delay, Fire, Guard, Loop, Op, Wait
from host.gait.tree import Clause, Condition, Place
from host.gait.trial import TooLong, Trial
from host.profile import Profile
from protocol import program


@dataclass(frozen=True, slots=True)
class CoilReport:
    """The most that one coil can come to."""

    label: str
    orders: int
    on_ms: int
    energy_mj: int
    heat_peak_mj: int


@dataclass(frozen=True, slots=True)
class Report:
    """The worst case of a script, and where it breaks a limit."""

    script: str
    profile: Profile
    longest_ms: int
    shortest_ms: int
    coils: tuple[CoilReport, ...]
    at_once: int
    current_ma: int
    program_bytes: int
    depth: int
    guards: int
    steps: int
    diagnostics: tuple[Diagnostic, ...]

    @property
    def sound(self) -> bool:
        """Return whether the script keeps every limit."""
        return not self.diagnostics

    @property
    def exit_code(self) -> int:
        """Return 0, or 4 when a limit would be broken."""
        return exit_code(self.diagnostics)

    def as_dict(self) -> dict[str, object]:
        """Return the fields for JSON."""
        limits, supply = self.profile.coil, self.profile.supply
        return {
            "script": self.script,
            "robot": self.profile.robot,
            "sound": self.sound,
            "longest_ms": self.longest_ms,
            "shortest_ms": self.shortest_ms,
            "at_once": {"most": self.at_once, "limit": supply.at_once_max},
            "supply_current_ma": {"most": self.current_ma, "limit": supply.current_max_ma},
            "heat_mj": {"most": max((coil.heat_peak_mj for coil in self.coils), default=0),
                        "limit": limits.heat_budget_mj},
            "program_bytes": {"most": self.program_bytes, "limit": self.profile.program.bytes_max},
            "depth": self.depth,
            "guards": self.guards,
            "steps": self.steps,
            "coils": {
                coil.label: {"orders": coil.orders, "on_ms": coil.on_ms, "energy_mj": coil.energy_mj,
                             "heat_peak_mj": coil.heat_peak_mj}
                for coil in self.coils
            },
            "diagnostics": [item.as_dict() for item in self.diagnostics],
        }  # fmt: skip

    def lines(self) -> Iterator[str]:
        """Yield the report as a user reads it."""
        supply, limits = self.profile.supply, self.profile.coil
        verdict = "keeps" if self.sound else "does not keep"
        yield f"{self.script} {verdict} the limits of {self.profile.robot}"
        yield f"  time      {self.shortest_ms / 1000:.1f} s at least, {self.longest_ms / 1000:.1f} s at most"
        yield f"  at once   {self.at_once} of {supply.at_once_max} coils"
        yield f"  supply    {self.current_ma} of {supply.current_max_ma} mA"
        yield f"  program   {self.program_bytes} of {self.profile.program.bytes_max} bytes, {self.steps} steps"
        yield f"  coil  orders   on time    energy   heat (of {limits.heat_budget_mj} mJ)"
        for coil in self.coils:
            figures = f"{coil.on_ms / 1000:7.2f} s {coil.energy_mj:6d} mJ {coil.heat_peak_mj:6d} mJ"
            if coil.orders:
                yield f"  {coil.label:<6}{coil.orders:6d} {figures}"


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
        at_once=trial.at_once_peak,
        current_ma=trial.current_peak_ma,
        program_bytes=len(compiled.code),
        depth=max(depths, default=0),
        guards=sum(isinstance(op, Guard) for op in compiled.plan),
        steps=len(compiled.steps),
        diagnostics=in_order(problems.found),
    )


def _coils(profile: Profile, trial: Trial) -> Iterator[CoilReport]:
    for label, coil in zip(profile.labels, trial.coils, strict=True):
        energy_mj, heat_mj = ceil(coil.energy_uj / 1000), ceil(coil.heat_peak_uj / 1000)
        yield CoilReport(label, coil.orders, coil.on_ms, energy_mj, heat_mj)


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
    limits = profile.coil
    if isinstance(op, Loop) and depth > program.DEPTH_MAX:
        problems.add(op.node.place, "E308", f"repeats are nested {depth} deep, at most {program.DEPTH_MAX}")
    if isinstance(op, Guard) and op.condition.source == program.TEMPERATURE:
        assert isinstance(op.node.condition, Condition)
        _check_trip(op.condition.value, op.node.condition.value.place, profile, problems)
    if not isinstance(op, Fire):
        return
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
        problems.add(place, "E307", f"{size} bytes of program, at most {most}")
    guards = [op for op in compiled.plan if isinstance(op, Guard)]
    for op in guards[program.GUARDS_MAX :]:
        problems.add(op.node.place, "E309", f"{len(guards)} guards, at most {program.GUARDS_MAX}")


def _place(op: Op, compiled: Compiled) -> Place:
    if isinstance(op, Delay):
        step = compiled.step(op.step)
        return step.place if step else Place(compiled.script.main.name, 1, 1, 2)
    return op.node.place


def _value(clause: Clause) -> Place:
    return clause.value.place
