"""Puts a bench together from an address: robot file, body, wires and firmware image."""

import json
from pathlib import Path
from typing import Any

from hil_sim.address import BODIES, Address, AddressError
from hil_sim.bench import Bench, Parts
from hil_sim.bodies.ring import RingPlant
from hil_sim.bodies.sphere import SpherePlant
from hil_sim.bodies.still import still
from hil_sim.clock import Clock
from hil_sim.devices.canwire import CanWire
from hil_sim.devices.ntc import Ntc
from hil_sim.faults.file import load as load_faults
from hil_sim.faults.file import plan
from hil_sim.faults.happening import schedule
from hil_sim.joints import position_input
from hil_sim.loadcells import cell_input, load_input
from hil_sim.meshfile import MeshFileError
from hil_sim.physics.block.material import BlockError
from hil_sim.physics.hand.fingertip import HandError
from hil_sim.plant import Plant
from hil_sim.robots.file import PROFILES, RobotFile, RobotFileError, load
from hil_sim.robots.keys import COILS, FINGERS, KINDS, PRESS, RING
from hil_sim.soundness import CameApart
from hil_sim.spelling import near
from hil_sim.supply import Battery
from hil_sim.worlds import cpython, micropython, preset
from hil_sim.worlds.image import Image
from hil_sim.worlds.world import Interpreter

KEY = "key"  # where the firmware looks for its pairing key
KEY_BYTES_MAX = 4096


def assemble(address: Address, clock: Clock | None = None, can_wire: CanWire | None = None) -> Bench:
    """Return the bench of an address, powered on, with a clock and a CAN bus of its own unless they are given.

    RobotFileError when its robot cannot be built, FaultFileError when its fault file cannot be used, AddressError when
    its key file cannot be read.
    """
    faults = load_faults(Path(address.faults)) if address.faults else []
    key_file = _key_file(address.key) if address.key else b""
    robot = load(address.robot, address.overrides)
    for label in address.open:
        if label not in robot.labels:
            what = f"such coil{near(label, robot.labels)}" if robot.labels else "coils"
            raise RobotFileError(f"open={label}: {robot.name} has no {what}")
    profile = _profile_file(robot.profile)
    _agree(robot, profile)
    image = Image.installed(profile)
    execute = interpreter_of(address.world)
    identity = f"{robot.name} {address.seed}" + (f" {address.node}" if address.node else "")
    wired: dict[str, Any] = {"baud": address.baud, "identity": identity, "clock": clock, "can_wire": can_wire}
    try:
        plant = plant_of(robot, address.seed, address.body)
        bench = Bench(parts_of(robot), plant, image, execute, **wired)
    except (ArithmeticError, CameApart, HandError, BlockError) as error:
        raise RobotFileError(f"{robot.name} cannot be built from these numbers: {error}") from error
    except MeshFileError as error:
        raise RobotFileError(f"the mesh of {robot.name}, {error}") from error
    if address.node:
        for path, data in preset.number(image, address.node).items():
            bench.board.flash.store(path, data)
    if address.key:
        bench.board.flash.store(KEY, key_file)
    for label in address.open:
        schedule(bench, bench.clock.now_us, f"coil-open:{label}")
    plan(bench, faults)
    return bench


def plant_of(robot: RobotFile, seed: int, body: str = BODIES[0]) -> Plant:
    """Return the body of a robot; the seed makes its terrain. A "still" one keeps the shape in which it rests."""
    if body != BODIES[0] and COILS not in KINDS[robot.kind]:
        raise RobotFileError(f"body={body}: {robot.name} has no coils to heat while it does not move")
    if robot.kind == FINGERS:
        from hil_sim.bodies.fingers import FingersPlant  # noqa: PLC0415  (compiled physics that others do without)

        return FingersPlant(robot)
    if robot.kind == PRESS:
        from hil_sim.bodies.press import PressPlant  # noqa: PLC0415  (likewise)

        return PressPlant(robot)
    plant = RingPlant(robot, seed) if robot.kind == RING else SpherePlant(robot, seed)
    return plant if body == BODIES[0] else still(plant)


def interpreter_of(world: str) -> Interpreter:
    """Return what runs the firmware in a world; LookupError when MicroPython is not there."""
    if world == "cpython":
        return cpython.execute
    micropython.interpreter()
    return micropython.execute


def _profile_file(path: Path) -> bytes:
    """Return what a profile holds; RobotFileError where there is none, with those that the firmware brings."""
    try:
        return path.read_bytes()
    except OSError as error:
        known = ", ".join(sorted(each.stem for each in PROFILES.glob("*.json")))
        raise RobotFileError(f"profile: {path}: {error.strerror}; known are {known}, or your FILE.json") from error


def _key_file(path: str) -> bytes:
    """Return what a file holds, whatever that is, as somebody with a cable would put it on the board."""
    try:
        with open(path, "rb") as file:
            return file.read(KEY_BYTES_MAX)
    except OSError as error:
        raise AddressError(f"key={path}: {error.strerror}") from error


def _agree(robot: RobotFile, profile: bytes) -> None:
    """Raise RobotFileError unless the firmware's profile names the same coils, servos and cells in the same places."""
    try:
        told = json.loads(profile)
        rows = [(row["label"], _place(row)) for row in told["channels"]]
        rows += [(row["label"], (row["input"],)) for row in told.get("cells", ())]
        rows += [("load", (told["load"]["input"],))] if "load" in told else []
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise RobotFileError(f"{robot.profile}: no profile of a robot ({error!r})") from None
    wiring = robot.wiring
    wired: list[tuple[str, tuple[Any, ...]]] = [(label, wiring.outputs[label]) for label in robot.labels]
    count = len(robot.joints)
    wired += [(label, (wiring.pins[label], i, position_input(i, count))) for i, label in enumerate(robot.joints)]
    wired += [(label, (cell_input(i, count),)) for i, label in enumerate(robot.cells)]
    wired += [("load", (load_input(len(robot.cells), count),))] if robot.load_cell and "load" in told else []
    if rows != wired:
        odd = [label for label, _ in dict.fromkeys([row for row in [*wired, *rows] if (row in wired) != (row in rows)])]
        which = " ".join(dict.fromkeys(odd)) or "their order"
        what = "differ in labels, outputs or inputs"
        raise RobotFileError(f"{robot.name} and its profile {robot.profile} {what}: {which}")


def _place(row: dict[str, Any]) -> tuple[Any, ...]:
    """Return chip and output of a coil of the profile, or the pin of a servo and the inputs of current and position."""
    return (row["pin"], row["current"], row["position"]) if row["kind"] == "servo" else (row["chip"], row["output"])


def parts_of(robot: RobotFile) -> Parts:
    """Return the electrical side of a robot in the order of its coils and joints."""
    wiring, sensors = robot.wiring, robot.sensors
    return Parts(
        outputs=[wiring.outputs[label] for label in robot.labels],
        series_ohm=[wiring.series_ohm] * len(robot.labels),
        source_ohm=wiring.source_ohm,
        shunt_ohm=sensors.shunt_ohm,
        supply_v=wiring.supply_v,
        battery=Battery(robot.battery) if robot.battery else None,
        ambient_degc=robot.ambient_degc,
        ntc=Ntc(sensors.ntc_ohm, sensors.ntc_beta_k, sensors.ntc_pull_up_ohm),
        imu=sensors.imu > 0,
        servos=[wiring.pins[label] for label in robot.joints],
        servo_dead_band_us=wiring.dead_band_us,
        camera=robot.camera,
        load_cell=robot.load_cell,
        force_cells=robot.force_cells,
    )
