"""The commands about what a robot keeps, each its own session with one robot on the bench."""

import json

import pytest

from tests.fake_robot import plug_in
from tests.hil_rig import HilRig


class Lasting:
    """A line that outlives the sessions on it."""

    def __init__(self, link) -> None:
        self._link = link

    def __getattr__(self, name):
        return getattr(self._link, name)

    def close(self) -> None:
        """Leave the bench running."""


@pytest.fixture
def rig():
    rig = HilRig("sim:circular?body=still")
    yield rig
    rig.link.close()


@pytest.fixture
def softrig(rig, softrig, monkeypatch):
    """Run a command line on the rig's robot."""
    plug_in(Lasting(rig.link), monkeypatch)
    return softrig


def trip(rig):
    """Open the emergency stop under a coil that is on, and close it again."""
    rig.fire("A", duty_percent=50, hold_s=0.2)
    rig.bench.board.set_estop(False)
    rig.run_alone(seconds=0.2)
    rig.bench.board.set_estop(True)


def test_faults_lists_none_on_a_fresh_robot(softrig):
    assert softrig("faults").out == "no faults are kept\n"


def test_faults_says_when_where_and_what(softrig, rig):
    trip(rig)

    told = softrig("faults").out

    assert told.startswith("start 1 (power-on), ")
    assert told.endswith(" s, armed: F02 The emergency-stop loop is open.\n")


def test_faults_are_told_before_they_are_cleared(softrig, rig):
    trip(rig)

    (fault,) = json.loads(softrig("faults", "--clear", "--json").out)["faults"]

    assert (fault["code"], fault["state"], fault["cause"], fault["coil"]) == ("F02", "armed", "power-on", None)
    assert json.loads(softrig("faults", "--json").out)["faults"] == []


def test_settings_lists_every_setting_with_its_value(softrig):
    lines = softrig("settings").out.splitlines()

    assert lines[0] == "settings the defaults: none was ever set"
    assert lines[1:4] == ["  node          1", "  board-offset  0 K", "  resistance.A    9.500 ohm, of the profile"]
    assert len(lines) == 3 + 8


@pytest.mark.parametrize(
    ("name", "value", "key", "number"),
    [
        ("node", "9", "node", 9),
        ("board-offset", "-1.5", "board_offset_k", -1.5),
        ("board-offset", "0.3 K", "board_offset_k", 0.3),
    ],
)
def test_a_setting_is_changed_and_kept(softrig, name, value, key, number):
    assert softrig("settings", name, value).status == 0

    assert json.loads(softrig("settings", "--json").out)[key] == number


def test_a_resistance_is_set_for_a_coil_and_given_back(softrig):
    softrig("settings", "resistance.C", "9.8 ohm")
    assert json.loads(softrig("settings", "--json").out)["resistance_ohm"]["C"] == 9.8

    softrig("settings", "resistance.C", "default")
    assert json.loads(softrig("settings", "--json").out)["resistance_ohm"]["C"] is None


@pytest.mark.parametrize(
    ("arguments", "status", "words"),
    [
        (("node",), 2, "node has no value"),
        (("node", "7.5"), 2, "write a whole number"),
        (("node", "127"), 4, "R21"),
        (("board-offset", "0.25"), 2, "in K, in steps of 0.1"),
        (("resistance.Z", "9"), 2, "no coil Z"),
        (("resistance.A", "1"), 4, "R21"),
        (("colour", "red"), 2, "no setting 'colour'"),
    ],
)
def test_what_is_no_setting_or_no_value_of_one_is_refused(softrig, rig, arguments, status, words):
    told = softrig("settings", *arguments)

    assert (told.status, words in told.err) == (status, True)
    assert rig.bench.board.flash.operations == 0


def test_calibrate_prints_each_coil_against_the_profile(softrig):
    lines = softrig("calibrate", "--without", "B").out.splitlines()

    assert lines[1] == "B      not measured"
    assert len(lines) == 8
    assert all(" % of the profile's" in line for line in lines if line[0] != "B")


def test_calibrate_refuses_a_warm_coil_and_says_which(softrig, rig):
    rig.fire("D", duty_percent=60, hold_s=0.5)
    rig.run(seconds=0.6)
    rig.robot.disarm()

    told = softrig("calibrate")

    assert told.status == 4
    assert "coil D" in told.err
    assert "R24" in told.err
