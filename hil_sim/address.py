"""Addresses of the bench: `sim:NAME[@NODE]?option=value&...`, read into a robot file and the options of a run.

    parse("sim:circular?slope=10&seed=2&set=shell.mass_g:2.0&open=A,C")

NAME is a robot of the bench or the path of a robot file, NODE its number on a bus, which node= gives as well. Whatever
cannot be read raises AddressError with what is allowed and what was perhaps meant.
"""

from dataclasses import dataclass, field
from math import isfinite
from urllib.parse import unquote

from hil_sim.robots.texts import CHOICES
from hil_sim.spelling import near

SHORT = {
    "slope": "ground.slope_deg",
    "gravity": "ground.gravity_m_per_s2",
    "mu": "ground.friction_ratio",
    "supply": "wiring.supply_v",
}
CHOSEN = {name.partition(".")[2]: name for name in CHOICES}
OPTIONS = (*SHORT, *CHOSEN, "seed", "set", "open", "world", "baud", "body", "faults", "node", "key")
WORLDS = ("cpython", "micropython")
BODIES = ("moving", "still")
BAUD_MAX = 4_000_000
NODE_MAX = 126


class AddressError(ValueError):
    """An address of the bench that cannot be read."""


@dataclass
class Address:
    """A robot, the numbers to change in its file, and how to run it."""

    robot: str
    overrides: dict[str, str] = field(default_factory=dict)
    seed: int = 1
    world: str = WORLDS[0]
    baud: int = 115_200
    open: tuple[str, ...] = ()  # coils whose wire is broken
    body: str = BODIES[0]
    faults: str = ""  # path of a fault file
    key: str = ""  # path of the file that it was given as its pairing key
    node: int = 0  # its number on a bus, which it was given before; 0: none was


def parse(text: str) -> Address:
    """Return what an address says, with or without the `sim:` before it."""
    robot, _, query = text.removeprefix("sim:").partition("?")
    if not robot:
        raise AddressError("no robot in the address: write sim:circular")
    name, _, number = robot.rpartition("@")
    numbered = bool(name) and number.isdigit()
    address = Address(unquote(name if numbered else robot))
    if numbered:
        _take(address, "node", number)
    for part in filter(None, query.split("&")):
        name, equals, value = part.partition("=")
        if name not in OPTIONS:
            raise AddressError(f"no option {name!r}: known are {', '.join(OPTIONS)}{near(name, OPTIONS)}")
        if not equals or not value:
            raise AddressError(f"option {name} has no value: write {name}=...")
        _take(address, name, unquote(value))
    return address


def _take(address: Address, name: str, value: str) -> None:
    if name in SHORT:
        address.overrides[SHORT[name]] = _number(name, value)
    elif name in CHOSEN:
        address.overrides[CHOSEN[name]] = _one_of(name, value, CHOICES[CHOSEN[name]])
    elif name == "set":
        key, colon, number = value.partition(":")
        if not colon:
            raise AddressError(f"set={value}: write set=section.key_unit:number, as in set=shell.mass_g:2.0")
        address.overrides[key] = _number(f"set={key}", number)
    elif name == "open":
        address.open += tuple(value.split(","))
    elif name == "seed":
        address.seed = _whole(name, value, 0, 2**32 - 1)
    elif name == "baud":
        address.baud = _whole(name, value, 300, BAUD_MAX)
    elif name == "node":
        address.node = _whole(name, value, 1, NODE_MAX)
    elif name == "faults":
        address.faults = value
    elif name == "key":
        address.key = value
    elif name == "body":
        address.body = _one_of(name, value, BODIES)
    else:
        address.world = _one_of(name, value, WORLDS)


def _one_of(name: str, value: str, known: tuple[str, ...]) -> str:
    if value in known:
        return value
    raise AddressError(f"no {name} {value!r}: known are {', '.join(known)}{near(value, known)}")


def _number(name: str, value: str) -> str:
    try:
        if isfinite(float(value)):
            return value
    except ValueError:
        pass
    raise AddressError(f"{name}: {value!r} is not a number")


def _whole(name: str, value: str, least: int, most: int) -> int:
    if value.isascii() and value.isdigit() and least <= int(value) <= most:
        return int(value)
    raise AddressError(f"{name}={value}: a whole number from {least} to {most}")
