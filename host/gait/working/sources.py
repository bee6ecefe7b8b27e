"""What a robot can be asked in a condition: each quantity with its code, its kind and whose it is."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from host.gait import units
from host.gait.working.jointunits import UNITS
from host.profile import Profile
from protocol import program


class Source(NamedTuple):
    """What the robot compares: its code, the kind of quantity, and its step in that kind's base unit."""

    code: int
    kind: str
    size: int = 1


Sources = Mapping[str, Source]

SUPPLY = {"current": Source(program.CURRENT, units.CURRENT), "voltage": Source(program.VOLTAGE, units.VOLTAGE)}
BOARD = {"temperature": Source(program.BOARD, units.TEMPERATURE)}
PARTS = {"supply": SUPPLY, "board": BOARD}
COIL = {
    "temperature": Source(program.TEMPERATURE, units.TEMPERATURE),
    "heat": Source(program.HEAT, units.ENERGY),
    "resistance": Source(program.RESISTANCE, units.RESISTANCE, 10),
    "martensite": Source(program.MARTENSITE, units.SHARE),
}
POSITION = {unit.quantity: Source(program.POSITION, unit.kind) for unit in UNITS.values()}
JOINT = {**POSITION, "current": Source(program.JOINT_CURRENT, units.CURRENT)}
CELL = {"pressure": Source(program.PRESSURE, units.PRESSURE)}
BODY = {"roll": Source(program.ROLL, units.ANGLE, 10), "pitch": Source(program.PITCH, units.ANGLE, 10)}
OBJECT = {"orientation": Source(program.ORIENTATION, units.ANGLE)}
LOAD = {"force": Source(program.FORCE, units.FORCE)}
CLOCK = {"time": Source(program.TIME, units.TIME)}
WHOLE = BODY | OBJECT | LOAD | CLOCK


def of_joint(profile: Profile) -> Sources:
    """Return what can be asked of a joint of this robot: its angle or its depth, and its current."""
    return {name: source for name, source in JOINT.items() if name in (UNITS[profile.unit].quantity, "current")}


def owner(quantity: str, profile: Profile) -> str:
    """Return how to ask for a quantity that belongs to something else than what was asked, or an empty text."""
    if quantity in POSITION and profile.joint_labels and quantity != UNITS[profile.unit].quantity:
        return f"write `{UNITS[profile.unit].quantity}`: the joints of {profile.robot} go by {profile.unit}"
    if quantity in LOAD and profile.load is not None:
        return f"write `{quantity}` by itself: the robot has one load cell"
    if quantity in CLOCK:
        return f"write `{quantity}` by itself: it counts from the start of the program"
    several: dict[str, Source] = {}
    for has, sources in ((profile.coil_labels, COIL), (profile.joint_labels, of_joint(profile)), (profile.cells, CELL)):
        several |= sources if has else {}
    owners = {"any": several, **PARTS}
    return next((f"write `{owner}.{quantity}`" for owner, measured in owners.items() if quantity in measured), "")
