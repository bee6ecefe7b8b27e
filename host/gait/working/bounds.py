"""Single orders and conditions held against the limits of a robot, each with the place that breaks one.

What orders come to together, over time, is the trial's part.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from host.gait.diagnostics import Problems
from host.gait.plan import Fire, Guard, Loop, Move, OnFault, Op, Press, Wait
from host.gait.tree import Clause, Facing, Order, Place
from host.gait.working.jointunits import UNITS
from host.profile import Profile
from protocol import program


def hold_to_limits(ops: Iterable[Op], profile: Profile, problems: Problems) -> None:
    """Report every limit that one of these ops breaks by itself."""
    for op, depth in nested(ops):
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


def nested(ops: Iterable[Op], depth: int = 1) -> Iterator[tuple[Op, int]]:
    """Yield every op once, with the depth of loops it would open or stand in."""
    for op in ops:
        yield op, depth
        if isinstance(op, Loop | OnFault):
            yield from nested(op.body, depth + isinstance(op, Loop))


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
    limits, unit = profile.servo_limits, UNITS[profile.unit]
    if limits is not None and not limits.least_centi <= op.target_centi <= limits.most_centi:
        ends = f"{unit.written(limits.least_centi)} .. {unit.written(limits.most_centi)}"
        problems.add(_clause(op, "to"), "E317", f"{unit.written(op.target_centi)} is outside {ends}")


def _check_press(op: Press, profile: Profile, problems: Problems) -> None:
    if profile.press is None or profile.load is None:
        return
    if op.target_mn > profile.load.most_mn:
        message = f"{op.target_mn / 1000:g} N, at most {profile.load.most_mn / 1000:g} N"
        problems.add(_clause(op, "to"), "E323", message)
    if profile.servo_limits is not None and op.time_ms > profile.servo_limits.hold_max_ms:
        message = f"a press of {op.time_ms} ms, at most {profile.servo_limits.hold_max_ms} ms"
        problems.add(_clause(op, "for"), "E324", message)


def _check_fire(op: Fire, profile: Profile, problems: Problems) -> None:
    limits = profile.coil_limits
    if limits is None:
        return
    duty, temperature = ("with", "at") if op.holds else ("at", "until")
    if op.duty_permille > limits.duty_max_permille:
        message = f"duty {op.duty_permille / 10:g} %, at most {limits.duty_max_permille / 10:g} %"
        problems.add(_clause(op, duty), "E301", message)
    if op.time_ms > limits.hold_max_ms:
        message = f"an order of {op.time_ms} ms, at most {limits.hold_max_ms} ms"
        problems.add(_clause(op, "for"), "E302", message)
    count, supply = op.mask.bit_count() if op.kept is None else 1, profile.supply
    current_ma = count * limits.current_ma(profile.supply_mv, op.duty_permille)
    if count > supply.at_once_max:
        message = f"{count} coils would be on at once, at most {supply.at_once_max}"
        problems.add(op.node.place, "E304", message)
    if current_ma > supply.current_max_ma:
        message = f"the supply would give {current_ma} mA, at most {supply.current_max_ma} mA"
        problems.add(op.node.place, "E305", message)
    if op.cutoff_decidegc:
        _check_trip(op.cutoff_decidegc, _clause(op, temperature), profile, problems)


def _check_trip(value_decidegc: int, place: Place, profile: Profile, problems: Problems) -> None:
    limits = profile.coil_limits
    if limits is not None and value_decidegc >= limits.trip_degc * 10:
        own = f"the robot's own trip at {limits.trip_degc} C"
        problems.add(place, "E310", f"{value_decidegc / 10:g} C is not below {own}")


def _clause(op: Fire | Move | Press, word: str) -> Place:
    node: Order = op.node
    clause = node.clause(word)
    return _value(clause) if clause else node.place


def _value(clause: Clause) -> Place:
    return clause.value.place
