"""Random trials of the whole path: what a host does, a fault of hil_sim/faults/, the instant; each from its number.

One trial runs on a bench of its own: the host does its work, the fault comes, the host goes on for as long as its
errors let it; then the fault is mended, and the robot must be reachable, clear itself and arm.

    trial = trial_of(17)                 # always the same one
    outcome = run(trial)
    outcome.wrong                        # sentences, none when all is well
"""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import cache
from math import exp, log
from random import Random
from typing import Any

from hil_sim.bench import Bench
from hil_sim.faults.happening import Happening, schedule
from hil_sim.faults.table import (
    BATTERY,
    CAMERA,
    CELL,
    CONVERTER,
    IMU,
    JOINT,
    LABEL,
    LOAD_CELL,
    TABLE,
    Argument,
    Fault,
)
from hil_sim.link import BOOTED_US, SimLink, open_link
from hil_sim.robots.file import RobotFile, load
from host.errors import SoftrigError
from host.robot import Robot
from tests.jobs import JOBS, cleared, job_of, scripts_of
from tests.witness import Witness

ROBOTS = (("circular", 7), ("sphere-b", 2), ("sphere-a", 1), ("fingers", 2), ("fingers-experiment", 2), ("press", 4))
COARSE = "set=block.columns_count:16&set=block.rows_count:8&set=material.youngs_modulus_kpa:120&"
MOVING = 0.03  # share of the trials whose body moves: each costs many others
BUSY_US = 4_000_000  # faults come within so long from the start
SETTLE_US = 2_200_000  # and are given so long to be dealt with
FOR_US = (1_000, 2_000_000)
CAPS = {"COUNT": (1, 200), "MS": (1, 3_000), "BAUD": (300, 1_000_000)}  # what is drawn of a wider range
DRIFT = 30.0
ALONE_S = 1.0  # longer than any lease of these hosts


@dataclass(frozen=True)
class Trial:
    """One triple of script, fault and instant, on one robot."""

    number: int
    address: str
    job: str  # of jobs.py, or the path of a script
    fault: str
    at_us: int
    for_us: int | None


@dataclass(frozen=True)
class Outcome:
    """What became of a trial; times are of the bench's clock."""

    trial: Trial
    wrong: tuple[str, ...]
    told: str  # the robot's state and last fault after it all
    error: str  # with which the host ended, if it did
    off_ms: float | None  # from the fault until every coil and joint was off, None: none was on

    def row(self) -> dict[str, Any]:
        """Return it as one flat record."""
        return {**asdict(self.trial), **{key: value for key, value in asdict(self).items() if key != "trial"}}


def trial_of(number: int) -> Trial:
    """Return the trial of that number."""
    draw = Random(f"trial {number}")
    fault = draw.choice(TABLE)
    robots = {name: weight for name, weight in ROBOTS if _has(name, fault)}
    robot = draw.choices(list(robots), list(robots.values()))[0]
    body = body_of(robot, draw.random() < MOVING)
    job = draw.choice((*JOBS, *scripts_of(robot)))
    for_us = round(_between(draw, *FOR_US)) if fault.ends and draw.random() < 0.5 else None
    at_us = draw.randrange(BOOTED_US, BOOTED_US + BUSY_US)
    name = fault.name + _argument(draw, fault.argument, _file(robot))
    return Trial(number, f"sim:{robot}?{body}seed={number}", job, name, at_us, for_us)


def run(trial: Trial) -> Outcome:
    """Run a trial to its end and hold it against the invariants."""
    link = open_link(trial.address)
    bench = link.bench
    witness = getattr(bench, "witness", None) or Witness(bench)
    happening = schedule(bench, trial.at_us, trial.fault, trial.for_us, seed=str(trial.number))
    error, wrong = _worked(link, trial)
    bench.run(ALONE_S)
    _mend(bench, happening)
    told, unreached = _reached(link)
    crashed = [f"the firmware crashed: {crash.error}" for crash in bench.crashes]
    wrong += [*unreached, *witness.broken(), *crashed]
    link.close()
    return Outcome(trial, tuple(wrong), told, error, off_ms(witness, trial.at_us))


def row_of(number: int) -> dict[str, Any]:
    """Run the trial of that number and return what became of it as a flat record."""
    return run(trial_of(number)).row()


def _worked(link: SimLink, trial: Trial) -> tuple[str, list[str]]:
    """Let the host work until the fault was dealt with; return the error that ended it, and what it must not raise.

    A script of which the robot has had enough before the fault came, as by its heat, is cleared and begun again.
    """
    draw, until_s, told, wrong = Random(f"job {trial.number}"), (trial.at_us + SETTLE_US) / 1e6, "", []
    while not told or link.bench.clock.now_us < trial.at_us:
        try:
            cleared(link)
            job_of(trial.job)(link, draw, until_s)
            break
        except SoftrigError as error:
            told = f"{type(error).__name__}: {error}"
        except Exception as error:
            told, wrong = repr(error), [f"the host raised {error!r}"]
    link.bench.clock.run_until(max(link.bench.clock.now_us, trial.at_us + SETTLE_US))
    return told, wrong


def _mend(bench: Bench, happening: Happening) -> None:
    """End the fault and let the robot feel it for a second; an empty battery is exchanged."""
    happening.mend()
    if bench.supply.battery is not None and bench.supply.battery.cut:
        bench.supply.battery.charge, bench.supply.battery.cut = 1.0, False
        bench.world.power_on()
    bench.run(1.0)


def _reached(link: SimLink) -> tuple[str, list[str]]:
    """Connect, clear and arm; return state and fault found at first, and what did not work."""
    found = "unreached"
    try:
        robot = Robot(link)
        robot.connect()
        status = robot.status()
        found = f"{status.state} {status.code}"
        if status.state == "running":
            robot.stop()
        if status.state in ("running", "tripped"):
            robot.clear()
        robot.arm()
        robot.disarm()
    except SoftrigError as error:
        return found, [f"not to be had again ({found}): {type(error).__name__}: {error}"]
    return found, []


def off_ms(witness: Witness, at_us: int) -> float | None:
    """Return how long after a time the last of the coils and joints that were on then went off, None when none was."""
    ends = []
    for history in witness.driven():
        before = [duty for time_us, duty in history if time_us <= at_us]
        if before and before[-1]:
            ends += [time_us for time_us, duty in history if time_us > at_us and not duty][:1]
    return max(ends) / 1e3 - at_us / 1e3 if ends else None


def body_of(robot: str, moves: bool = False) -> str:
    """Return the options of an address that say how a body moves.

    Fingers cost so little that they always do; so does the block under a press if it has few triangles. That one is
    harder, so that many a move trips.
    """
    if _file(robot).cells:
        return "" if moves else COARSE
    return "" if _file(robot).joints else "body=moving&" if moves else "body=still&set=start.settle_s:0&"


@cache
def _file(robot: str) -> RobotFile:
    return load(robot)


def _has(robot: str, fault: Fault) -> bool:
    """Return whether a robot has what a fault breaks."""
    file = _file(robot)
    parts = {
        BATTERY: file.battery is not None,
        IMU: file.sensors.imu > 0,
        CAMERA: file.camera is not None,
        CONVERTER: bool(file.joints),
        LOAD_CELL: file.load_cell is not None,
    }
    return parts.get(fault.of, True) and bool(_named(file).get(fault.argument, True))


def _named(file: RobotFile) -> dict[Argument, Sequence[str]]:
    """Return what may stand after the colon of a fault of one coil, joint or force cell."""
    return {LABEL: file.labels, JOINT: file.joints, CELL: file.cells}


def _argument(draw: Random, argument: Argument, file: RobotFile) -> str:
    """Return what stands after the colon, with it."""
    if argument.words:
        return draw.choice(("", *(f":{word}" for word in argument.words)))
    if argument in _named(file):
        return f":{draw.choice(_named(file)[argument])}"
    if not argument.form:
        return ""
    if argument.least < 0:
        return f":{draw.uniform(-DRIFT, DRIFT):.2f}"
    least, most = CAPS.get(argument.form, (argument.least, argument.most))
    return f":{round(_between(draw, least, most))}"


def _between(draw: Random, least: float, most: float) -> float:
    """Return a number whose logarithm is evenly spread: small ones are as likely as great ones."""
    return exp(draw.uniform(log(least), log(most)))
