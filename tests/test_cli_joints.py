"""The commands on a robot that has joints and no coils: what they order, and what they print."""

import json

import pytest

from host.cli.motion import stretch_ms
from host.profile import read_profile
from protocol import codes, messages
from tests.fake_robot import FakeLine, FakeRobot, plug_in
from tests.joint_samples import FINGERS, HAND


@pytest.fixture
def peer():
    return FakeRobot(FINGERS)


@pytest.fixture
def line(peer, monkeypatch):
    """A line to `peer`, at the address fake:."""
    line = FakeLine(peer)
    plug_in(line, monkeypatch)
    return line


@pytest.fixture
def hand(monkeypatch):
    """A robot of coils and joints at the address fake:."""
    peer = FakeRobot(HAND)
    plug_in(FakeLine(peer), monkeypatch)
    return peer


def interrupt():
    raise KeyboardInterrupt


def test_move_arms_moves_watches_to_the_end_of_the_hold_and_disarms(softrig, peer, line):
    told = softrig("move", "R", "L", "--to", "8deg", "--over", "0.5s", "--hold", "300ms")

    assert told.status == 0
    assert [name for name, *_ in peer.taken("arm", "move", "disarm")] == ["arm", "move", "disarm"]
    assert peer.taken("move") == [("move", 0b11, 800, 500, 300)]
    assert told.out.splitlines() == [
        "R reached 8.00 deg, told 8 deg; 1.20 A at most",
        "L reached 8.00 deg, told 8 deg; 1.20 A at most",
    ]


def test_a_move_ends_when_its_joints_are_limp(softrig, peer, line):
    softrig("move", "R", "L", "--to", "8deg", "--over", "0.5s", "--hold", "300ms")

    at_ms = {name: now_ms for now_ms, name, _ in peer.orders}
    assert 800 <= at_ms["disarm"] - at_ms["move"] <= 900


def test_a_limp_joint_may_take_as_long_as_its_whole_range():
    assert stretch_ms(read_profile(FINGERS).servo) == 167  # 60 degrees at 360 a second


def test_move_tells_the_same_as_json(softrig, line):
    told = json.loads(softrig("move", "L", "--to", "-8.25", "--over", "100ms", "--hold", "0.2", "--json").out)

    assert told == {
        "target_deg": -8.25,
        "over_ms": 100,
        "hold_ms": 200,
        "joints": {"L": {"reached_deg": -8.25, "peak_ma": 1200}},
    }


@pytest.mark.parametrize(
    ("text", "centideg"), [("8", 800), ("-8deg", -800), (" +8.5 deg", 850), ("-.25deg", -25), ("-0", 0), ("0.005", 0)]
)
def test_angles_are_read_as_an_operator_writes_them(softrig, peer, line, text, centideg):
    softrig("move", "R", "--to", text, "--over", "50ms", "--hold", "50ms")

    assert peer.taken("move")[0][2] == centideg


@pytest.mark.parametrize("text", ["", "-", "--8", "8rad", "8 s", "8 %", "deg", "+-8", "- 8 deg deg", "1e1"])
def test_an_angle_that_is_none_is_a_mistake_of_usage(softrig, peer, line, text):
    told = softrig("move", "R", "--to", text)

    assert told.status == 2
    assert peer.orders == []


def test_a_joint_that_stalls_ends_a_move_as_a_robot_fault(softrig, peer, line):
    line.at[2000] = lambda: peer.tell(messages.TRIP, codes.STALL, 1, 2450, line.now_ms)

    told = softrig("move", "L", "--to", "20deg", "--hold", "5s")

    assert told.status == 6
    assert "the robot tripped (joint L): F25 A joint's servo took its stall current" in told.err
    assert "2450 mA" in told.err


def test_orient_grips_turns_and_tells_how_the_object_lies(softrig, peer, line):
    told = softrig("orient", "-5deg", "--grip", "8deg", "--for", "1s", "--hold", "0.5s")

    assert told.status == 0
    assert peer.taken("move", "orient") == [
        ("move", 0b01, 800, 1000, 2300),
        ("move", 0b10, -800, 1000, 2300),
        ("orient", -500, 1000, 500),
    ]
    assert told.out.splitlines() == [
        "object at -5.00 deg, told -5 deg; swing 5.00 deg, grip 8 deg",
        "R reached 13.00 deg; 1.20 A at most",
        "L reached -3.00 deg; 1.20 A at most",
    ]


def test_orient_tells_the_same_as_json(softrig, line):
    told = json.loads(softrig("orient", "5deg", "--grip", "8deg", "--json").out)

    assert (told["target_deg"], told["reached_deg"], told["grip_deg"], told["swing_deg"]) == (5.0, 5.0, 8.0, -5.0)
    assert (told["for_ms"], told["hold_ms"]) == (3000, 1000)
    assert told["joints"]["L"] == {"reached_deg": -13.0, "peak_ma": 1200}


def test_orient_closes_where_the_object_was_let_go(softrig, peer, line):
    told = softrig("orient", "-5deg", "--grip", "8deg", "--swing", "-6.4deg")

    assert told.status == 0
    assert [order[1:3] for order in peer.taken("move")] == [(0b01, 160), (0b10, -1440)]


def test_orient_tells_when_the_swing_is_at_its_limit(softrig, line):
    told = softrig("orient", "25deg", "--grip", "8deg")

    assert "the swing is at its limit of 20 deg: it turns the object no further\n" in told.out


@pytest.mark.parametrize(("angle", "most"), [("25deg", 2.0), ("-25deg", 20.0)])
def test_the_limit_of_the_swing_is_that_of_its_side(softrig, monkeypatch, angle, most):
    one_sided = FINGERS.replace(b'"least_centi": -3000', b'"least_centi": -1000')
    plug_in(FakeLine(FakeRobot(one_sided)), monkeypatch)

    told = json.loads(softrig("orient", angle, "--grip", "8deg", "--json").out)

    assert told["swing_max_deg"] == most


@pytest.mark.parametrize("grip", ["0deg", "-8deg"])
def test_orient_refuses_a_grip_that_holds_nothing(softrig, peer, line, grip):
    told = softrig("orient", "5deg", "--grip", grip)

    assert told.status == 2
    assert f"--grip {grip}: both joints close inward, so write an angle above 0" in told.err
    assert peer.orders == []


def test_an_object_that_is_lost_from_sight_is_no_success(softrig, peer, line):
    line.at[3500] = lambda: peer.tell(messages.LOST, codes.CAMERA, 255, 105, line.now_ms)

    told = softrig("orient", "5deg", "--grip", "8deg")

    assert told.status == 1
    assert "the robot gave up turning the object: F27 The camera gave no new angle" in told.err
    assert [name for name, *_ in peer.taken("disarm")] == ["disarm"]


def test_orient_needs_to_know_how_far_to_close(softrig, peer, line):
    told = softrig("orient", "5deg")

    assert told.status == 2
    assert "--grip" in told.err
    assert peer.orders == []


def test_ctrl_c_in_a_move_stops_the_robot_and_names_the_joints(softrig, peer, line):
    line.at[2000] = interrupt

    told = softrig("move", "R", "L", "--to", "8deg", "--hold", "9s")

    assert told.status == 130
    assert "stop acknowledged, joints R L were driven and are limp now; the robot is tripped (F01)" in told.err
    assert peer.stops > 0


@pytest.mark.parametrize(
    ("arguments", "told_as"),
    [
        (("fire", "R", "--duty", "10%", "--hold", "1s"), "R is a joint, no coil: `softrig move R --to 1deg` moves it"),
        (("move", "Z", "--to", "8deg"), "no joint Z on fingers: it has R L, groups all"),
        (("arm", "--without", "R"), "R is a joint: only a coil can be left out"),
        (("calibrate",), "fingers has no coils"),
        (("settings", "resistance.R", "9.5"), "R is a joint, no coil"),
    ],
)
def test_what_joints_cannot_do_is_said_in_one_line(softrig, peer, line, arguments, told_as):
    told = softrig(*arguments)

    assert told.status == 2
    assert told_as in told.err
    assert not peer.taken("arm", "fire", "move", "set", "calibrate")


@pytest.mark.parametrize(
    ("arguments", "told_as"),
    [
        (("move", "A", "--to", "8deg"), "A is a coil, no joint: `softrig fire A` heats it"),
        (("fire", "all", "--duty", "10%", "--hold", "1s"), "R is a joint, no coil"),
    ],
)
def test_a_robot_of_both_kinds_knows_which_is_which(softrig, hand, arguments, told_as):
    told = softrig(*arguments)

    assert told.status == 2
    assert told_as in told.err


def test_a_robot_without_two_joints_or_any_cannot_turn_objects(softrig, monkeypatch):
    plug_in(FakeLine(FakeRobot()), monkeypatch)

    told = softrig("orient", "5deg", "--grip", "8deg")

    assert (told.status, told.err) == (2, "softrig: circular has no joints\n")


def test_info_tells_of_joints_what_they_may(softrig, line):
    told = softrig("info")

    assert told.status == 0
    assert "  coils       none\n  joints      R L\n" in told.out
    assert "  one move    -30 to 30 deg, at most 360 deg/s, then held for 60 s\n" in told.out
    assert "  stall       trips at 2400 mA for 300 ms\n" in told.out
    assert "  astray      trips 1.5 deg beside its order for 1500 ms\n" in told.out
    assert "  orient      turns what the joints hold: gain 5 /s, swing at most 20 deg\n" in told.out
    assert "heat" not in told.out


def test_info_as_json_has_no_limits_of_coils_that_there_are_not(softrig, line, monkeypatch):
    told = json.loads(softrig("info", "--json").out)

    assert (told["coils"], told["joints"]) == ([], ["R", "L"])
    assert told["limits"]["joint"]["stall_ma"] == 2400
    assert "trip_degc" not in told["limits"]


def test_status_tells_which_joints_are_driven(softrig, peer, line):
    peer.joints[1].move(800, 0, 10_000_000)

    assert softrig("status").out.startswith("idle, joints driven: L\n")
    assert "  no coils\n" in softrig("status", "--coils").out


def test_settings_of_a_robot_without_coils_have_no_resistances(softrig, line):
    told = softrig("settings")

    assert told.status == 0
    assert "resistance" not in told.out


def test_watch_tells_of_joints_by_label_and_leaves_coils_out(softrig, line):
    told = [json.loads(row) for row in softrig("watch", "--for", "300ms").out.splitlines()]

    assert told[-1]["joint_deg"] == {"R": 0.0, "L": 0.0}
    assert told[-1]["commanded_deg"] == {"R": None, "L": None}
    assert told[-1]["object_deg"] == 0.0
    assert "duty_permille" not in told[-1]


def test_watch_leaves_out_what_the_session_before_had_asked_for(softrig, line):
    told = softrig("watch", "joint_centi", "--for", "300ms")  # this robot goes on with the usual ones

    assert (told.out, told.err) == ("", "0 records, 0 missed\n")


def test_the_list_of_variables_says_what_each_is_told_of(softrig):
    told = softrig("watch", "--list").out

    assert "One value per joint." in told
    assert "Only where there is a camera." in told
