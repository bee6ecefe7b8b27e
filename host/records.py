"""What a robot tells its host, decoded: telemetry, events, status and the answer to a stop.

Times carry both clocks: `host_ms` is the host's at arrival, `now_ms` the robot's at sending. Units are the wire's,
except temperatures, angles, positions, forces and pressures, which are whole units and parts of them.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from host.profile import Parts
from protocol import messages, program, variables


@dataclass(frozen=True, slots=True)
class Telemetry:
    """The robot at one instant; what there is for each coil or each joint is in the order of its channels."""

    host_ms: int
    now_ms: int
    state: str
    step: int
    supply_mv: int
    current_ma: int
    board_degc: float
    duty_permille: tuple[int, ...]
    temperature_degc: tuple[float, ...]
    roll_deg: float | None = None  # None, as the two below: the robot does not know how it lies
    pitch_deg: float | None = None
    down: str | None = None  # the coil whose direction is nearest to down
    joint_position: tuple[float, ...] = ()  # in the joints' unit, as the next one
    commanded_position: tuple[float | None, ...] = ()  # None: the joint is limp
    joint_ma: tuple[int, ...] = ()
    object_deg: float | None = None  # None: there is no camera, or it does not see the object
    load_n: float | None = None  # None: there is no load cell
    cell_kpa: tuple[float, ...] = ()  # of the force cells


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happened on the robot; `value` is in the unit of the code's row.

    `coil` is the label of the coil or joint that it is about, None when about none.
    """

    host_ms: int
    now_ms: int
    event: str
    code: int
    step: int
    coil: str | None
    value: int


@dataclass(frozen=True, slots=True)
class Stopped:
    """The robot's answer to a stop: `coils`, by label, joints among them, were driven when it came and are off now."""

    host_ms: int
    now_ms: int
    state: str
    code: int
    coils: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Status:
    """The robot's answer to a request for its status; `coils` are the labels of all that is driven, also of joints."""

    host_ms: int
    state: str
    code: int
    uptime_ms: int
    lease_ms: int
    step: int
    paused: bool
    coils: tuple[str, ...]
    supply_mv: int
    current_ma: int
    board_degc: float
    dropped: int
    forged: int
    repeated: int
    overruns: int
    roll_deg: float | None = None
    pitch_deg: float | None = None
    down: str | None = None


@dataclass(frozen=True, slots=True)
class Sample:
    """Other variables than the usual ones, by name, as protocol/variables.py has them; several of a kind by label."""

    host_ms: int
    now_ms: int
    slot: int
    values: dict[str, Any]


PER_COIL = ("duty_permille", "temperature_degc")  # of telemetry
PER_JOINT = ("joint_position", "commanded_position", "joint_ma")
PER_CELL = ("cell_kpa",)
IN_UNIT = {"joint_position": "joint", "commanded_position": "commanded"}  # begin the names that end in the joints' unit
USUAL_NAMES = tuple(variables.VARIABLES[number].name for number in variables.USUAL)

Record = Telemetry | Sample | Event | Stopped


def telemetry_of(values: list[Any], parts: Parts, host_ms: int, now_ms: int) -> Telemetry:
    """Return the record of the usual variables."""
    told = dict(zip(USUAL_NAMES, values, strict=True))
    return Telemetry(
        host_ms,
        now_ms,
        state_name(told["state"]),
        told["step"],
        told["supply_mv"],
        told["current_ma"],
        told["board_decidegc"] / 10,
        told["duty_permille"],
        tuple([decidegc / 10 for decidegc in told["coil_decidegc"]]),
        **_attitude(told["roll_decideg"], told["pitch_decideg"], told["down"], parts.channels),
        joint_position=tuple([centi / 100 for centi in told["joint_centi"]]),
        commanded_position=tuple([_known(centi) for centi in told["commanded_centi"]]),
        joint_ma=told["joint_ma"],
        object_deg=_known(*told["object_centideg"]),
        load_n=told["load_mn"][0] / 1000 if told["load_mn"] else None,
        cell_kpa=tuple([pa / 1000 for pa in told["cell_pa"]]),
    )


def sample_of(
    slot: int, numbers: tuple[int, ...], values: list[Any], parts: Parts, host_ms: int, now_ms: int
) -> Sample:
    """Return the record of these variables: of several of a kind by label, a state by its name.

    What only a camera or a load cell tells is None on a robot without.
    """
    named: dict[str, Any] = {}
    labels = {"*": parts.coils, "+": parts.joints, "#": parts.cells}
    for number, value in zip(numbers, values, strict=True):
        name, letter = variables.VARIABLES[number]
        if letter[1:] in labels:
            named[name] = dict(zip(labels[letter[1:]], value, strict=True))
        elif letter.endswith(("@", "!")):
            named[name] = value[0] if value else None
        else:
            named[name] = state_name(value) if name == "state" else value
    return Sample(host_ms, now_ms, slot, named)


def event_of(payload: bytes, labels: tuple[str, ...], host_ms: int) -> Event:
    """Return the record of that payload; ValueError when it is none."""
    row = messages.EVENT.unpack(payload)
    name = messages.EVENTS[row.event] if row.event < len(messages.EVENTS) else f"event {row.event}"
    return Event(host_ms, row.now_ms, name, row.code, row.step, channel_name(row.channel, labels), row.value)


def stopped_of(payload: bytes, labels: tuple[str, ...], host_ms: int) -> Stopped:
    """Return the record of that payload; ValueError when it is none."""
    row = messages.STOPPED.unpack(payload)
    return Stopped(host_ms, row.now_ms, state_name(row.state), row.code, channel_names(row.coils, labels))


def status_of(payload: bytes, labels: tuple[str, ...], host_ms: int) -> Status:
    """Return the record of that payload; ValueError when it is none."""
    row = messages.STATUS.unpack(payload)
    return Status(
        host_ms=host_ms,
        state=state_name(row.state),
        code=row.code,
        uptime_ms=row.uptime_ms,
        lease_ms=row.lease_ms,
        step=row.step,
        paused=row.paused != 0,
        coils=channel_names(row.coils, labels),
        supply_mv=row.supply_mv,
        current_ma=row.current_ma,
        board_degc=row.board_decidegc / 10,
        dropped=row.dropped,
        forged=row.forged,
        repeated=row.repeated,
        overruns=row.overruns,
        **_attitude(row.roll_decideg, row.pitch_decideg, row.down, labels),
    )


def _attitude(roll_decideg: int, pitch_decideg: int, down: int, labels: tuple[str, ...]) -> dict[str, Any]:
    """Return how the robot lies, or nothing where it does not know."""
    if down == program.NO_COIL:
        return {}
    return {"roll_deg": roll_decideg / 10, "pitch_deg": pitch_decideg / 10, "down": channel_name(down, labels)}


def _known(centi: int = variables.UNKNOWN_CENTI) -> float | None:
    """Return an angle or a position, or None where the robot says that there is none, or nothing."""
    return None if centi == variables.UNKNOWN_CENTI else centi / 100


def state_name(state: int) -> str:
    """Return the state's name, or its number when this version has no name for it."""
    return messages.STATES[state] if state < len(messages.STATES) else f"state {state}"


def channel_name(channel: int, labels: tuple[str, ...]) -> str | None:
    """Return the label of a channel number, or None when it names no channel."""
    return labels[channel] if channel < len(labels) else None


def channel_names(mask: int, labels: tuple[str, ...]) -> tuple[str, ...]:
    """Return the labels of a mask; before the labels are known, the channel numbers."""
    names = labels or tuple(str(channel) for channel in range(32))
    return tuple(name for i, name in enumerate(names) if mask >> i & 1)


def ended(labels: tuple[str, ...], parts: Parts) -> str:
    """Return in words what was driven when the stop came: "coils A B were on and are off now".

    An axis, unlike a joint that turns, stays where it is when it is limp.
    """
    joints = [label for label in labels if label in parts.joints]
    coils = [label for label in labels if label not in parts.joints]
    if not labels:
        return "no joint was driven" if parts.joints and not parts.coils else "no coil was on"
    told = [f"coils {' '.join(coils)} were on and are off now"] if coils else []
    if joints:
        where = " where they stand" if parts.unit == "mm" else ""  # a screw holds them
        told.append(f"joints {' '.join(joints)} were driven and are limp now{where}")
    return " and ".join(told)


def as_json(record: Any) -> dict[str, Any]:
    """Return the record's fields by name, as they stand in logs and on `--json`."""
    return asdict(record)


def row_of(record: Record, parts: Parts) -> dict[str, Any]:
    """Return the record's fields by name, with what there is for each coil, joint or force cell by its label.

    Where joints are says the unit: `joint_deg`, or `joint_mm`. What the robot has none of is left out.
    """
    row = as_json(record)
    if not isinstance(record, Telemetry):
        return row
    single = {"object_deg": (row.pop("object_deg"), parts.cameras), "load_n": (row.pop("load_n"), parts.loads)}
    for names, labels in ((PER_COIL, parts.coils), (PER_JOINT, parts.joints), (PER_CELL, parts.cells)):
        for name in names:
            values = row.pop(name)
            if labels:
                row[column(name, parts.unit)] = dict(zip(labels, values, strict=False))
    return {**row, **{name: value for name, (value, present) in single.items() if present}}


def column(name: str, unit: str) -> str:
    """Return what a field of Telemetry is called in rows of a robot whose joints count in that unit."""
    return f"{IN_UNIT[name]}_{unit}" if name in IN_UNIT else name
