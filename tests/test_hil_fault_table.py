"""Every row of tests/fault_table.py through the whole stack: script, host, line, firmware, chips, coils and joints.

A body of coils keeps still: what they do to it decides nothing here.
"""

from itertools import pairwise
from random import Random

import pytest

from hil_sim.faults.happening import schedule
from hil_sim.faults.table import NAMES
from host.errors import Refused, SoftrigError
from host.gait.compiler import compile_script
from host.gait.script import loads
from host.robot import Robot
from host.run import run
from protocol import causes
from tests.fault_table import ANY, BEFORES, FINGERS, GUARDED, IDLE, ORDERS, PRESS, RECOVERIES, ROWS
from tests.hil_rig import HilRig

COILS = {"circular": {"one": "A", "two": "A B"}, "sphere-a": {"one": "A100", "two": "A100 Am100"}}
SEEDS = ("1", "2")  # each draws another instant
AGAIN = {FINGERS: "move R to -28 deg over 2 s", PRESS: "move P to -2 mm over 2200 ms"}
BODIES = {FINGERS: "", PRESS: "?set=block.columns_count:16&set=block.rows_count:8"}
AGAIN_COILS = "fire {one} at 30 % for 400 ms"
INSTEAD = {"battery-empty": "battery-full"}  # what mends a fault that does not end
ELSEWHERE = {"imu-forgets"}  # tests/test_hil_attitude.py
AFTERWARDS_S = 0.6  # in which a robot without its host is done


class Trial:
    """A run of a script on a robot to which something happens."""

    def __init__(self, row, seed="1"):
        script, (earliest_ms, latest_ms) = ORDERS[row.during]
        self.row = row
        self.rig = HilRig(f"sim:{row.robot}{BODIES.get(row.robot, '?body=still')}")
        self.bench = self.rig.bench
        draw = Random(f"{seed}/{row.fault}")
        self.at_us = self.bench.clock.now_us + draw.randint(earliest_ms * 1000, latest_ms * 1000)
        self._happening = schedule(self.bench, self.at_us, row.fault, seed=seed)
        self.ending, self.code, self.exit_code = self._run(self.rig.robot, script)
        self.bench.run(AFTERWARDS_S)

    def again(self):
        """Return the code with which another run ends, of a host that has just come."""
        again = AGAIN.get(self.row.robot, AGAIN_COILS)
        script = ORDERS[self.row.during][0] if self.row.again in ("R20", "R33") else again
        return self._run(self.host(), script)[1]

    def host(self):
        """Return a host that has just come."""
        robot = Robot(self.rig.link)
        robot.connect()
        return robot

    def mend(self):
        """End the fault, or put in what it has used up."""
        self._happening.mend()
        if self.row.fault in INSTEAD:
            self.rig.happens(INSTEAD[self.row.fault])
            self.bench.run(AFTERWARDS_S)

    @property
    def off_ms(self):
        """Return the time from the fault until the last coil was switched off and the last joint let go."""
        last_us = self.at_us
        for history in self._histories():
            for (_, before), (time_us, _) in pairwise(history):
                last_us = max(last_us, time_us) if before else last_us
        return (last_us - self.at_us) / 1000

    @property
    def longest_on_ms(self):
        """Return for how long in all the coil was on, or the joint driven, that was for longest."""
        now_us = self.bench.clock.now_us
        on_us = [coil.on_us(now_us) for coil in self.bench.coils]
        return max(on_us + [joint.driven_us(now_us) for joint in self.bench.joints]) / 1000

    @property
    def is_on(self):
        """Return whether a coil is on or a joint driven."""
        return any(on for history in self._histories() for _, on in history[-1:])

    @property
    def was_on(self):
        """Return whether a coil was on, or a joint driven, just before the fault."""
        return any(on for history in self._histories() for time_us, on in history[-1:] if time_us < self.at_us) or any(
            before
            for history in self._histories()
            for (_, before), (time_us, _) in pairwise(history)
            if time_us >= self.at_us
        )

    def _histories(self):
        """Return of each coil and joint since when it was on, or driven, and since when not."""
        coils = [[(time_us, duty > 0) for time_us, duty in coil.history] for coil in self.bench.coils]
        return coils + [[(time_us, deg is not None) for time_us, deg in joint.history] for joint in self.bench.joints]

    def _run(self, host, script):
        text = f"gait 1\nrobot {self.row.robot}\n{script.format(**COILS.get(self.row.robot, {}))}\n"
        made = compile_script(loads(text), host.profile)
        try:
            ending = run(host, made.program, lambda stage, done: None)
        except SoftrigError as error:
            refused = isinstance(error, Refused)
            return "refused" if refused else "fault", name_of(getattr(error, "code", 0)), error.exit_code
        error = ending.error()
        return ending.result, name_of(ending.event.code if ending.event else 0), error.exit_code if error else 0


def name_of(code):
    """Return F08 for 108."""
    return causes.row(code).name if code else ""


def named(case):
    """Return how pytest shows a row."""
    return case if isinstance(case, str) else f"{case.fault}-{case.during}".replace(" ", "_")


@pytest.fixture
def tried():
    """Make trials, and end their benches."""
    trials = []

    def make(row, seed="1"):
        trials.append(Trial(row, seed))
        return trials[-1]

    yield make
    for trial in trials:
        trial.rig.link.close()


CASES = [(row, seed) for row in ROWS for seed in SEEDS[: 1 if row.during in BEFORES else None]]


@pytest.mark.parametrize(("row", "seed"), CASES, ids=named)
def test_every_coil_is_off_and_every_joint_limp_in_time_and_the_host_is_told(tried, row, seed):
    trial = tried(row, seed)

    assert (trial.ending, trial.exit_code) in zip(row.endings, row.exit_codes, strict=True)
    assert row.code in (trial.code, ANY)
    assert not trial.is_on
    assert trial.bench.crashes == []
    if row.during in BEFORES:
        assert trial.longest_on_ms <= row.off_ms
    elif row.off_ms is not None:
        assert trial.off_ms <= row.off_ms, trial.off_ms


@pytest.mark.parametrize("row", [row for row in ROWS if row.during not in (*BEFORES, IDLE, GUARDED)], ids=named)
def test_the_fault_meets_a_coil_that_is_on_or_a_joint_that_is_driven(tried, row):
    assert tried(row).was_on


@pytest.mark.parametrize("row", [row for row in ROWS if row.recovery == "none" and not row.again], ids=named)
def test_where_there_is_nothing_to_do_the_robot_goes_again(tried, row):
    trial = tried(row)
    trial.mend()  # a host that has just come asks much of a bad line

    assert trial.again() == ""


@pytest.mark.parametrize("row", [row for row in ROWS if row.recovery == "clear"], ids=named)
def test_after_clear_the_robot_goes_again(tried, row):
    trial = tried(row)
    host = trial.host()
    status = host.status()
    if trial.ending != "done":
        assert (status.state, name_of(status.code)) == ("tripped", row.after or trial.code)

    host.clear()

    assert trial.again() == ""


@pytest.mark.parametrize("row", [row for row in ROWS if row.recovery == "mend, clear"], ids=named)
def test_clear_is_refused_while_the_cause_is_there(tried, row):
    trial = tried(row)
    with pytest.raises(Refused, match="R18"):
        trial.host().clear()

    trial.mend()
    trial.host().clear()

    assert trial.again() == ""


@pytest.mark.parametrize("row", [row for row in ROWS if row.again], ids=named)
def test_a_robot_that_is_not_mended_does_not_go_again(tried, row):
    trial = tried(row)
    trial.host().clear()
    assert trial.again() == row.again

    trial.mend()
    trial.host().clear()

    assert trial.again() == ""


@pytest.mark.parametrize("row", [row for row in ROWS if row.recovery == "mend"], ids=named)
def test_a_robot_that_could_not_be_reached_goes_again_when_it_can(tried, row):
    trial = tried(row)
    with pytest.raises(SoftrigError):
        trial.host()

    trial.mend()
    trial.bench.run(AFTERWARDS_S)
    trial.host().clear()

    assert trial.again() == ""


def test_every_fault_that_can_happen_has_a_row():
    mends = {"coil-whole", "thermistor-whole", "imu-whole", "i2c-free", "cable-join", "estop-close", "battery-full"}

    promised = {row.fault.partition(":")[0] for row in ROWS} | ELSEWHERE

    assert promised == set(NAMES) - mends


def test_every_way_back_is_described():
    assert {row.recovery for row in ROWS} == set(RECOVERIES)
