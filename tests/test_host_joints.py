"""The host and a robot with joints: its profile, its telemetry, its orders."""

import csv
import io
import json
import re
import struct

import pytest

from host.errors import BadRequest, Interrupted, Mismatch, Refused
from host.log import LogWriter
from host.logbook import read_log
from host.profile import Parts, read_profile
from host.records import Sample, Telemetry, ended, row_of
from host.robot import Robot
from host.run import run
from host.selections import Selection, Selections
from protocol import codes, messages, program, variables
from tests.fake_robot import FakeLine, FakeRobot, telemetry_of
from tests.joint_samples import FINGERS, HAND

FINGER, BOTH = read_profile(FINGERS), read_profile(HAND)
LIMP = variables.UNKNOWN_CENTI
CODE = program.move(0b11, 800, 300) + program.delay(300) + program.halt()
PROGRAM = program.header(CODE, 0) + CODE


@pytest.fixture
def peer():
    return FakeRobot(FINGERS)


@pytest.fixture
def robot(peer):
    robot = Robot(FakeLine(peer))
    robot.connect()
    return robot


def test_a_robot_of_joints_alone_has_no_coils():
    assert FINGER.labels == FINGER.joint_labels == ("R", "L")
    assert FINGER.coil_labels == ()
    assert FINGER.servo.most_centi == 3000
    with pytest.raises(BadRequest, match="fingers has no coils"):
        _ = FINGER.coil


def test_a_mask_counts_all_channels_whatever_their_kind():
    assert BOTH.labels == ("A", "B", "R", "L")
    assert BOTH.coil_mask(["B"]) == 0b10
    assert BOTH.joint_mask(["L"]) == 0b1000
    assert BOTH.mask(["all"]) == 0b1111


def test_who_fires_a_joint_is_told_to_move_it():
    with pytest.raises(BadRequest, match="R is a joint, no coil: `softrig move R --to 1deg` moves it"):
        BOTH.coil_mask(["A", "R"])


def test_who_moves_a_coil_is_told_to_fire_it():
    with pytest.raises(BadRequest, match="B is a coil, no joint: `softrig fire B` heats it"):
        BOTH.joint_mask(["R", "B"])


@pytest.mark.parametrize(("profile", "what"), [(FINGER, "joint"), (BOTH, "channel")])
def test_a_label_that_there_is_not_is_named_for_what_the_robot_has(profile, what):
    with pytest.raises(BadRequest, match=f"no {what} Z on {profile.robot}: it has "):
        profile.mask(["Z"])


@pytest.mark.parametrize(
    ("code", "value", "limit", "told"),
    [
        (codes.RANGE_LIMIT, 3100, 3000, "31 deg, at most 30"),
        (codes.RANGE_LIMIT, -100, 0, "-1 deg, at least 0"),
        (codes.RANGE_LIMIT, 100, 500, "1 deg, at least 5"),
        (codes.SLEW_LIMIT, 40_000, 36_000, "400 deg/s, at most 360"),
    ],
)
def test_a_limit_is_told_for_the_side_on_which_it_was_passed(code, value, limit, told):
    assert f". {told}. " in str(Refused("move", code, value, limit, "R", "joint"))


@pytest.mark.parametrize("section", ["servo", "channels"])
def test_joints_without_their_limits_are_a_mismatch(section):
    data = json.loads(FINGERS)
    del data[section]

    with pytest.raises(Mismatch, match=f"profile cannot be read .*{section}"):
        read_profile(json.dumps(data).encode())


def test_a_channel_of_an_unknown_kind_is_a_mismatch():
    with pytest.raises(Mismatch, match="a channel of kind 'valve'"):
        read_profile(FINGERS.replace(b'"servo", "pin": 8', b'"valve", "pin": 8'))


def test_telemetry_tells_of_joints_and_of_the_object_in_degrees():
    values = struct.pack("<BHHHhhhB2h2h2Hh", 2, 7, 6000, 350, 231, 0, 0, 255, 812, -795, 800, LIMP, 300, 12, -259)

    told = Selections().take(telemetry_of(0, values), FINGER.parts, host_ms=80)

    assert (told.joint_position, told.commanded_position) == ((8.12, -7.95), (8.0, None))
    assert (told.joint_ma, told.object_deg) == ((300, 12), -2.59)
    assert (told.duty_permille, told.temperature_degc) == ((), ())


def test_an_object_that_the_camera_does_not_see_has_no_angle():
    values = struct.pack("<BHHHhhhB2h2h2Hh", 2, 7, 6000, 350, 231, 0, 0, 255, 0, 0, LIMP, LIMP, 0, 0, LIMP)

    assert Selections().take(telemetry_of(0, values), FINGER.parts, host_ms=80).object_deg is None


def test_a_sample_has_joints_by_label_and_no_object_without_a_camera():
    numbers = tuple(map(variables.number, ("joint_ma", "object_centideg", "coil_decidegc")))
    parts, selections = Parts(("A", "R"), ("A",), ("R",), cameras=0), Selections()
    selections.ask(7, Selection(0, numbers, 10, False))

    told = selections.take(telemetry_of(8, struct.pack("<Hh", 300, 251)), parts, host_ms=80)

    named = {"joint_ma": {"R": 300}, "object_centideg": None, "coil_decidegc": {"A": 251}}
    assert told == Sample(80, 70, 0, named)


def test_a_log_gives_joints_back_and_exports_them_by_label(tmp_path):
    told = Telemetry(
        57, 50, "armed", 0, 6000, 350, 23.1, (), (),
        joint_position=(8.12, -7.95), commanded_position=(8.0, None), joint_ma=(300, 12), object_deg=-2.59,
    )  # fmt: skip
    with LogWriter(tmp_path / "a.mcap") as log:
        log.parts = FINGER.parts
        log.record(told)

    kept, table = read_log(tmp_path / "a.mcap"), io.StringIO()
    kept.write_csv(table, "telemetry")

    assert kept.recording().telemetry == [told]
    assert (kept.recording().labels, kept.recording().joints) == ((), ("R", "L"))
    (row,) = csv.DictReader(io.StringIO(table.getvalue()))
    assert (row["joint_deg.R"], row["commanded_deg.L"], row["object_deg"]) == ("8.12", "", "-2.59")
    assert not [name for name in row if name.startswith(("duty", "temperature"))]


def test_a_robot_without_a_camera_has_no_object_in_its_rows():
    told = Telemetry(
        0, 0, "idle", 0, 6000, 0, 25.0, (), (), joint_position=(1.0,), commanded_position=(None,), joint_ma=(5,)
    )

    assert "object_deg" not in row_of(told, Parts(("R",), (), ("R",)))
    assert row_of(told, Parts(("R",), (), ("R",), cameras=1))["object_deg"] is None


def test_joints_are_moved_by_label_and_group(robot, peer):
    robot.move(["all"], -800, over_ms=1000, hold_ms=2000)

    assert peer.last_order == (0b11, -800, 1000, 2000)


def test_an_object_is_turned_to_an_angle(robot, peer):
    robot.orient(500, time_ms=3000, hold_ms=2000)

    assert peer.last_order == (500, 3000, 2000)


@pytest.mark.parametrize(("centideg", "limit"), [(32_768, 3000), (-40_000, -3000)])
def test_an_angle_that_no_message_carries_is_refused_as_the_robot_would(robot, centideg, limit):
    with pytest.raises(Refused) as caught:
        robot.move(["R"], centideg, 1000, 1000)

    assert (caught.value.code, caught.value.value, caught.value.limit) == (codes.RANGE_LIMIT, centideg, limit)
    assert f"{centideg / 100:g} deg, at {'most 30' if limit > 0 else 'least -30'}." in str(caught.value)


def test_numbers_that_no_message_carries_are_refused(robot):
    with pytest.raises(Refused, match=r"R05 .* 4294967296 ms, at most 60000"):
        robot.move(["R"], 0, 1000, 1 << 32)
    with pytest.raises(BadRequest, match="over 70000 ms: at most 65535 ms"):
        robot.move(["R"], 0, 70_000, 1000)
    with pytest.raises(BadRequest, match="for 70000 ms: at most 65535 ms"):
        robot.orient(0, 70_000, 1000)
    with pytest.raises(BadRequest, match="orient to -400 deg: at most 327"):
        robot.orient(-40_000, 1000, 1000)


def test_a_refusal_about_a_joint_says_joint(robot, peer):
    peer.refuse["move"] = (codes.SLEW_LIMIT, 1, 40_000, 36_000)

    with pytest.raises(Refused, match=r"move \(joint L\) refused: R32 .* 400 deg/s, at most 360\."):
        robot.move(["L"], 0, 10, 1000)


def test_no_joint_can_be_left_out(robot):
    with pytest.raises(BadRequest, match="R is a joint: only a coil can be left out"):
        robot.arm(without=["R"])


@pytest.mark.parametrize(
    ("ending", "result", "status", "told_as"),
    [
        ((messages.ABORTED, codes.CAMERA, 255, 105), "camera lost", 1, "the script ended early: F27"),
        ((messages.TRIP, codes.STALL, 1, 2450), "fault", 6, r"the robot tripped \(joint L\): F25 .* 2450 mA"),
    ],
)
def test_a_run_that_joints_or_camera_end_says_so(robot, peer, ending, result, status, told_as):
    peer.ending = ending

    got = run(robot, PROGRAM, lambda stage, done: None)

    assert (got.result, got.error().exit_code) == (result, status)
    assert re.search(told_as, str(got.error()))


def test_ctrl_c_names_the_joints_that_were_driven(peer):
    robot = Robot(FakeLine(peer))
    robot.connect()
    robot.move(["R", "L"], 800, 10, 1000)

    with pytest.raises(Interrupted, match="joints R L were driven and are limp now"), robot:
        raise KeyboardInterrupt


def test_what_was_driven_is_told_of_each_kind():
    assert ended(("A", "L"), BOTH.parts) == "coils A were on and are off now and joints L were driven and are limp now"
    assert ended((), BOTH.parts) == "no coil was on"
    assert ended((), FINGER.parts) == "no joint was driven"


def test_info_lists_coils_and_joints_apart(robot):
    assert (robot.info()["coils"], robot.info()["joints"]) == ([], ["R", "L"])
