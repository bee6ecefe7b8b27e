"""Robot files: the body of a robot as the bench builds it, read from TOML.

    robot = load("circular", {"shell.mass_g": "2.0", "ground.slope_deg": "10"})
    robot.ring.R, robot.coil.d, robot.labels, robot.wiring.outputs["A"]

Each number stands in the file as its source prints it, `key_unit = [value, "standing: source"]`; here is the border
behind which everything is SI. A file with an unknown or missing key, without a unit or without a standing is refused
with all its mistakes, each as file:line and what to do. A lab's own robot is the path of such a file.
"""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hil_sim.bodies.pressnumbers import PressNumbers
from hil_sim.devices.anglecamera import Optics
from hil_sim.loadcells import ForceCells, LoadCell
from hil_sim.physics.battery import BatteryNumbers
from hil_sim.physics.bodies import Attitude, GroundNumbers, RingNumbers, SphereNumbers, StartNumbers
from hil_sim.physics.coilset import CoilNumbers
from hil_sim.physics.hand.numbers import HandNumbers
from hil_sim.robots.check import Check, Entry
from hil_sim.robots.keys import COILS, FINGERS, KINDS, PRESS, RING, SHELL, SPHERE
from hil_sim.robots.pressfile import centres_of, press_numbers
from hil_sim.spelling import near

FOLDER = Path(__file__).parent
PROFILES = Path(__file__).parents[2] / "firmware" / "robots"


class RobotFileError(ValueError):
    """A robot file, its name or an override that cannot be used; the text has one line for each mistake."""


class NoSuchRobot(RobotFileError, LookupError):
    """There is no robot of that name, and no file at that path."""


@dataclass(frozen=True)
class Wiring:
    """The resistances between supply and coils, and where each coil and each servo is soldered."""

    source_ohm: float  # shared by all coils and servos
    outputs: dict[str, tuple[int, int]]  # label of a coil: chip (I2C address), output
    pins: dict[str, int]  # label of a joint: the processor's pin for its servo
    lead_ohm: float = 0.0  # copper of one coil
    switch_ohm: float = 0.0  # MOSFET of one coil
    dead_band_us: float = 0.0  # of the servos
    supply_v: float = 0.0  # of the bench supply; a robot with a battery has none

    @property
    def series_ohm(self) -> float:
        """Return the resistance in series with each single coil."""
        return self.lead_ohm + self.switch_ohm


@dataclass(frozen=True)
class Sensors:
    """The parts around the chips that measure."""

    shunt_ohm: float
    ntc_ohm: float  # at 25 degC
    ntc_beta_k: float
    ntc_pull_up_ohm: float
    imu: float = 0.0  # how many attitude sensors ride on the core


@dataclass(frozen=True)
class RobotFile:
    """A robot's body: SI numbers for the physics, labels and wiring for the netlist, entries for the reader."""

    name: str
    about: str
    profile: Path
    kind: str  # "ring", "sphere", "fingers" or "press"
    labels: tuple[str, ...]  # of the coils from the core, then of those between points of the hoops
    jumps: tuple[tuple[str, str], ...]  # labels of the points between which each of the latter runs, in their order
    joints: tuple[str, ...]  # labels of the joints: of the right finger, then of the left one, or of the press
    cells: tuple[str, ...]  # labels of the force cells
    ring: RingNumbers | None
    sphere: SphereNumbers | None
    fingers: HandNumbers | None
    press: PressNumbers | None
    camera: Optics | None
    load_cell: LoadCell | None
    force_cells: ForceCells | None
    coil: CoilNumbers | None
    ground: GroundNumbers | None
    start: StartNumbers | Attitude | None
    tolerance: float  # of a step in time [m]
    ambient_degc: float
    wiring: Wiring
    battery: BatteryNumbers | None
    sensors: Sensors
    entries: tuple[Entry, ...]


def names() -> list[str]:
    """Return the names of the robots that come with the bench."""
    return sorted(path.stem for path in FOLDER.glob("*.toml"))


def load(robot: str, overrides: Mapping[str, str] | None = None) -> RobotFile:
    """Read the robot of that name, or the file at that path; RobotFileError tells all that is wrong with it."""
    path = find(robot)
    try:
        text = path.read_text(encoding="utf-8")
        data = tomllib.loads(text)
    except UnicodeDecodeError:
        raise RobotFileError(f"{path}: not TOML: it is not UTF-8 text") from None
    except RecursionError:
        raise RobotFileError(f"{path}: not TOML: nested too deeply") from None
    except tomllib.TOMLDecodeError as error:
        raise RobotFileError(f"{path}: not TOML: {error}") from None
    check = Check(path, text, data, overrides or {})
    if check.mistakes:
        raise RobotFileError("\n".join(check.mistakes))
    return _robot(path, data, check)


def find(robot: str) -> Path:
    """Return the path of a robot's file; RobotFileError when there is none."""
    is_path = "/" in robot or robot.endswith(".toml")
    path = Path(robot) if is_path else FOLDER / f"{robot}.toml"
    if path.is_file():
        return path
    if is_path:
        raise NoSuchRobot(f"{robot}: no such robot file")
    known = names()
    what = f"no robot {robot!r}{near(robot, known)}"
    raise NoSuchRobot(f"{what}; known are {', '.join(known)}, or give the path of a robot file")


def _robot(path: Path, data: dict[str, Any], check: Check) -> RobotFile:
    """Return a file without mistakes in SI units."""
    kind, coils, wiring = check.kind, data.get("coils", {}), data["wiring"]
    points = tuple(coils.get("jump_labels", ()))
    groups = _groups(check)
    shelled = SHELL in KINDS[kind]
    return RobotFile(
        name=path.stem,
        about=data["about"],
        profile=_profile(path, data["profile"]),
        kind=kind,
        labels=(*coils.get("labels", ()), *points),
        jumps=tuple(zip(points, points[1:] + points[:1], strict=True)),
        joints=tuple(data[kind]["labels"]) if kind in (FINGERS, PRESS) else (),
        cells=tuple(centres_of(data)),
        ring=RingNumbers(**groups["body"]) if kind == RING else None,
        sphere=SphereNumbers(**groups["body"]) if kind == SPHERE else None,
        fingers=_hand(groups, check.choices) if kind == FINGERS else None,
        press=press_numbers(path, data, groups, check.choices) if kind == PRESS else None,
        camera=Optics(**groups["camera"]) if "camera" in groups else None,
        load_cell=LoadCell(**groups["load_cell"]) if "load_cell" in groups else None,
        force_cells=ForceCells(**groups["cells"]) if "cells" in groups else None,
        coil=CoilNumbers(**groups["coil"]) if COILS in KINDS[kind] else None,
        ground=GroundNumbers(**groups["ground"]) if shelled else None,
        start=(StartNumbers if kind == RING else Attitude)(**groups["start"]) if shelled else None,
        tolerance=groups["numerics"]["tolerance"] if shelled else 0.0,
        ambient_degc=groups["ground"]["T_amb"],
        wiring=Wiring(outputs=_outputs(wiring), pins=dict(wiring.get("pins", {})), **groups["wiring"]),
        battery=BatteryNumbers(**groups["battery"]) if "battery" in groups else None,
        sensors=Sensors(**groups["sensors"]),
        entries=tuple(check.entries.values()),
    )


def _groups(check: Check) -> dict[str, dict[str, Any]]:
    """Return the numbers in SI units by their group and field."""
    groups: dict[str, dict[str, Any]] = {}
    for key in check.rows:
        if key.name in check.entries:
            groups.setdefault(key.target, {})[key.field] = check.entries[key.name].value * key.si
    if "nodes" in groups.get("body", {}):
        groups["body"]["nodes"] = int(groups["body"]["nodes"])
    return groups


def _hand(groups: dict[str, dict[str, Any]], choices: Mapping[str, str]) -> HandNumbers:
    numbers = groups["fingers"]
    numbers["B"] = numbers["a"] + numbers["w"] / 2 + numbers["e"] + numbers.pop("gap")
    numbers |= {name.removeprefix("fingers."): word for name, word in choices.items()}
    return HandNumbers(g=groups["ground"]["gravity"], **numbers)


def _outputs(wiring: Mapping[str, Any]) -> dict[str, tuple[int, int]]:
    return {label: (chip, output) for label, (chip, output) in wiring.get("outputs", {}).items()}


def _profile(path: Path, name: str) -> Path:
    """Return the path of the firmware profile: by name with the firmware, by file name beside the robot file."""
    return path.parent / name if name.endswith(".json") else PROFILES / f"{name}.json"
