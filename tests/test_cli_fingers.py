"""The commands on the fingers of the bench: from the line that is typed to the joint that turns."""

import csv
import json

import pytest

from hil_sim.link import open_link
from host.errors import Refused
from host.robot import Robot

EXPERIMENT = "sim:fingers-experiment?contact=stick"
SERVO_DEG = 0.15  # what friction and dead band of a servo leave, and a count of its potentiometer
GAIT = """gait 1
robot fingers
move R to 4 deg over 300 ms
move L to -4 deg over 300 ms
wait 400 ms
"""


@pytest.fixture
def script(tmp_path):
    path = tmp_path / "pinch.gait"
    path.write_text(GAIT)
    return str(path)


def told_as_json(told) -> dict:
    assert told.status == 0, told.err
    return json.loads(told.out)


def test_a_joint_moves_where_it_is_told_and_is_limp_afterwards(softrig):
    told = told_as_json(softrig("move", "R", "--to", "-8deg", "--over", "0.5s", "--robot", "sim:fingers", "--json"))

    assert told["joints"]["R"]["reached_deg"] == pytest.approx(-8, abs=SERVO_DEG)


def test_the_status_tells_how_joints_stand_and_how_the_object_lies(softrig):
    fields = told_as_json(softrig("status", "--robot", EXPERIMENT, "--json"))
    lines = softrig("status", "--robot", EXPERIMENT).out.splitlines()

    assert fields["joints"]["L"] == {"deg": pytest.approx(0, abs=SERVO_DEG), "commanded_deg": None, "ma": 0}
    assert fields["object_deg"] == pytest.approx(0, abs=0.1)
    assert [line.split()[0] for line in lines[-3:]] == ["R", "L", "object"]


def test_an_object_is_turned_as_the_control_law_says(softrig):
    """The swing is that of row F10: -6.384 deg for 5 deg."""
    told = told_as_json(softrig("orient", "5deg", "--grip", "2.5deg", "--robot", EXPERIMENT, "--json"))

    assert told["reached_deg"] == pytest.approx(5, abs=0.1)  # noise of the camera, dead band of the servos
    assert told["swing_deg"] == pytest.approx(-6.384, abs=SERVO_DEG)


def test_an_object_that_only_one_joint_touches_cannot_be_turned():
    with Robot(open_link("sim:fingers")) as robot:
        robot.connect()
        robot.arm()
        robot.move(["R"], 200, 100, 1000)

        with pytest.raises(Refused, match=r"orient \(joint L\) refused: R34"):
            robot.orient(100, 1000, 1000)


def test_a_run_reports_joints_and_what_they_held_in_numbers_and_in_words(softrig, script):
    fields = told_as_json(softrig("run", script, "--robot", "sim:fingers", "--json"))

    assert "coils" not in fields
    assert fields["joints"]["R"]["most_deg"] == pytest.approx(4, abs=2 * SERVO_DEG)
    assert fields["joints"]["L"]["least_deg"] == pytest.approx(-4, abs=2 * SERVO_DEG)
    assert fields["joints"]["R"]["driven_s"] > 0.3
    assert fields["observed"]["gripped"]
    assert fields["observed"]["displacement_mm"]["R"] == pytest.approx(3.56, abs=0.2)  # 51 mm x sin 4 deg


def test_a_report_is_the_same_whether_or_not_a_log_is_kept(softrig, script, tmp_path):
    run = ("run", script, "--robot", "sim:fingers", "--json")

    told = [told_as_json(softrig(*run, *log)) for log in ((), ("--log", str(tmp_path / "a.mcap")))]

    assert [fields.pop("wall") for fields in told]
    assert told[0] == told[1]
    assert told[0]["observed"]["joint_torque_nm"]["R"] > 0.1  # they hold what they are told of


def test_a_run_prints_a_table_of_joints_and_none_of_coils(softrig, script):
    told = softrig("run", script, "--robot", "sim:fingers")

    assert told.status == 0
    assert "  joint    driven       least        most   peak current" in told.out
    assert "  displacement     R 3." in told.out
    assert "  coil " not in told.out


def test_a_log_of_fingers_is_exported_with_a_column_for_each_joint(softrig, script, tmp_path):
    softrig("run", script, "--robot", "sim:fingers", "--log", str(tmp_path / "a.mcap"))
    softrig("log", "export", str(tmp_path / "a.mcap"), "-o", str(tmp_path / "a.csv"))

    with (tmp_path / "a.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert {"joint_deg.R", "commanded_deg.L", "joint_ma.R", "object_deg"} <= set(rows[0])
    assert not {name for name in rows[0] if name.startswith("duty_permille")}
    assert max(float(row["joint_deg.R"]) for row in rows) == pytest.approx(4, abs=2 * SERVO_DEG)


@pytest.mark.parametrize(
    ("fault", "status", "told_as"),
    [
        ("camera-lost", 1, "gave up turning the object: F27"),
        ("joint-jam:R", 6, ": F25 A joint's servo took its stall current"),
        ("pot-open:L", 6, "the robot tripped (joint L): F26"),
    ],
)
def test_what_goes_wrong_while_an_object_is_turned_is_told_by_name(softrig, tmp_path, fault, status, told_as):
    path = tmp_path / "faults.toml"
    path.write_text(f'[[fault]]\nname = "{fault}"\nat_ms = 2500\n')

    told = softrig("orient", "5deg", "--grip", "2.5deg", "--hold", "2s", "--robot", f"{EXPERIMENT}&faults={path}")

    assert told.status == status
    assert told_as in told.err


def test_a_robot_whose_camera_sees_nothing_refuses_to_turn(softrig, tmp_path):
    path = tmp_path / "faults.toml"
    path.write_text('[[fault]]\nname = "object-hidden"\nat_ms = 0\n')

    told = softrig("orient", "5deg", "--grip", "2.5deg", "--robot", f"{EXPERIMENT}&faults={path}")

    assert (told.status, "orient refused: R33" in told.err) == (4, True)
