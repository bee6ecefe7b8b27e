"""The host and a robot with a press: its profile, its telemetry, its orders."""

import csv
import io
import json
import struct

import pytest

from host.errors import BadRequest, Interrupted, Mismatch, Refused, RobotFault
from host.log import LogWriter
from host.logbook import read_log
from host.profile import read_profile
from host.records import Sample, Telemetry, row_of
from host.robot import Robot
from host.run import run
from host.selections import Selection, Selections
from protocol import codes, messages, program, variables
from tests.fake_robot import FakeLine, FakeRobot, telemetry_of
from tests.joint_samples import FINGERS
from tests.press_profiles import MADE, PRESS, weighed, without

AXIS = read_profile(PRESS)
LIMP = variables.UNKNOWN_CENTI
CODE = program.press(5000, 200, 400) + program.delay(400) + program.halt()
TOLD = Telemetry(
    57, 50, "armed", 0, 6000, 350, 23.1, (), (),
    joint_position=(3.21,), commanded_position=(None,), joint_ma=(300,), load_n=4.984, cell_kpa=(1.2, 0, 0, 0, 0, 20),
)  # fmt: skip


@pytest.fixture
def peer():
    return FakeRobot(PRESS)


@pytest.fixture
def robot(peer):
    robot = Robot(FakeLine(peer))
    robot.connect()
    return robot


def test_a_press_counts_in_millimetres_and_names_what_it_feels_with():
    assert AXIS.parts.unit == AXIS.servo.unit == "mm"
    assert AXIS.parts.loads == 1
    assert AXIS.parts.cells == ("C1", "C2", "C3", "C4", "C5", "C6")
    assert (AXIS.load.most_mn, AXIS.press.touch_mn, AXIS.cell.full_pa) == (18000, 50, 20000)


def test_a_robot_without_load_cell_has_neither_load_nor_cells():
    finger = read_profile(FINGERS)

    assert (finger.load, finger.press, finger.cells, finger.cell) == (None, None, (), None)
    assert (finger.parts.unit, finger.parts.loads, finger.parts.cells) == ("deg", 0, ())


def test_a_robot_may_feel_a_load_without_pressing_and_press_without_cells():
    assert read_profile(weighed(FINGERS)).press is None
    assert read_profile(weighed(FINGERS)).load.most_mn == 18000
    assert read_profile(without("cells", "cell")).parts.cells == ()


@pytest.mark.parametrize("missing", ["load", "cell"])
def test_what_a_press_or_a_cell_cannot_be_without_must_stand_in_the_profile(missing):
    with pytest.raises(Mismatch, match=missing):
        read_profile(without(missing))


def test_joints_that_count_in_an_unknown_unit_are_a_mismatch():
    strange = json.dumps(MADE | {"servo": MADE["servo"] | {"unit": "furlong"}}).encode()

    with pytest.raises(Mismatch, match="joints that count in 'furlong'"):
        read_profile(strange)


def test_a_mask_of_force_cells_counts_the_cells_alone():
    assert AXIS.cell_mask(["C1", "C6"]) == 0b100001
    with pytest.raises(BadRequest, match="no force cell P on press: it has C1 C2 C3 C4 C5 C6"):
        AXIS.cell_mask(["P"])
    with pytest.raises(BadRequest, match="no force cell C1 on fingers: it has none"):
        read_profile(FINGERS).cell_mask(["C1"])


def test_a_joint_named_as_a_coil_is_told_how_to_move_it_in_its_own_unit():
    with pytest.raises(BadRequest, match="`softrig move P --to 1mm` moves it"):
        AXIS.coil_mask(["P"])


def test_telemetry_tells_of_the_axis_in_millimetres_and_of_what_is_felt_in_newtons_and_kilopascals():
    cells = (1200, 0, 0, 0, 0, 20_000)
    values = struct.pack("<BHHHhhhBhhHi6H", 2, 7, 6000, 350, 231, 0, 0, 255, 321, LIMP, 300, -8, *cells)

    told = Selections().take(telemetry_of(0, values), AXIS.parts, host_ms=80)

    assert (told.joint_position, told.commanded_position, told.joint_ma) == ((3.21,), (None,), (300,))
    assert (told.load_n, told.cell_kpa) == (-0.008, (1.2, 0, 0, 0, 0, 20))
    assert told.object_deg is None


def test_a_sample_has_force_cells_by_label_and_one_load():
    numbers = tuple(map(variables.number, ("load_mn", "cell_pa", "object_centideg")))
    selections = Selections()
    selections.ask(7, Selection(0, numbers, 10, False))

    told = selections.take(telemetry_of(8, struct.pack("<i6H", 5000, *range(6))), AXIS.parts, host_ms=80)

    cells = {"C1": 0, "C2": 1, "C3": 2, "C4": 3, "C5": 4, "C6": 5}
    assert told == Sample(80, 70, 0, {"load_mn": 5000, "cell_pa": cells, "object_centideg": None})


def test_a_sample_of_a_robot_without_load_cell_has_no_load():
    numbers = tuple(map(variables.number, ("load_mn", "cell_pa", "step")))
    selections = Selections()
    selections.ask(7, Selection(0, numbers, 10, False))

    told = selections.take(telemetry_of(8, struct.pack("<H", 3)), read_profile(FINGERS).parts, host_ms=80)

    assert told.values == {"load_mn": None, "cell_pa": {}, "step": 3}


def test_rows_name_the_unit_of_the_joints():
    row, turned = row_of(TOLD, AXIS.parts), row_of(TOLD, read_profile(FINGERS).parts)

    assert (row["joint_mm"], row["commanded_mm"], row["load_n"]) == ({"P": 3.21}, {"P": None}, 4.984)
    assert row["cell_kpa"]["C6"] == 20
    assert not {"joint_deg", "object_deg", "duty_permille"} & set(row)
    assert turned["joint_deg"] == {"R": 3.21}
    assert not {"joint_mm", "load_n", "cell_kpa"} & set(turned)


def test_a_log_gives_axis_load_and_cells_back_and_exports_them_by_label(tmp_path):
    with LogWriter(tmp_path / "a.mcap") as log:
        log.parts = AXIS.parts
        log.record(TOLD)

    kept, table = read_log(tmp_path / "a.mcap"), io.StringIO()
    kept.write_csv(table, "telemetry")
    recording = kept.recording()

    assert recording.telemetry == [TOLD]
    assert (recording.joints, recording.unit, recording.cells) == (("P",), "mm", AXIS.cell_labels)
    (row,) = csv.DictReader(io.StringIO(table.getvalue()))
    assert (row["joint_mm.P"], row["commanded_mm.P"], row["load_n"], row["cell_kpa.C1"]) == ("3.21", "", "4.984", "1.2")


def test_a_press_is_told_force_and_times(robot, peer):
    robot.press(5000, over_ms=1000, time_ms=100_000, hold_ms=600_000)

    assert peer.last_order == (5000, 1000, 100_000, 600_000)


def test_an_axis_is_held_for_minutes(robot, peer):
    robot.move(["P"], -500, over_ms=1000, hold_ms=600_000)

    assert peer.last_order == (1, -500, 1000, 600_000)


def test_forces_and_times_that_no_message_carries_are_refused(robot):
    with pytest.raises(Refused, match=r"press refused: R36 .* 70 N, at most 18\. "):
        robot.press(70_000, 1000, 1000, 1000)
    with pytest.raises(BadRequest, match="press with -5 N: a press cannot pull"):
        robot.press(-5000, 1000, 1000, 1000)
    with pytest.raises(BadRequest, match="over 70000 ms: at most 65535 ms"):
        robot.press(5000, 70_000, 100_000, 1000)
    with pytest.raises(BadRequest, match="for 4294967296 ms: at most 4294967295 ms"):
        robot.press(5000, 1000, 1 << 32, 1000)
    with pytest.raises(Refused, match=r"R05 .* 4294967296 ms, at most 600000"):
        robot.press(5000, 1000, 1000, 1 << 32)


def test_a_force_cannot_be_asked_of_a_robot_without_joints():
    robot = Robot(FakeLine(FakeRobot()))
    robot.connect()

    with pytest.raises(BadRequest, match="circular has no joints"):
        robot.press(5000, 1000, 1000, 1000)


def test_a_depth_that_no_message_carries_is_refused_in_millimetres(robot):
    with pytest.raises(Refused, match=r"R31 .* 400 mm, at most 10\. "):
        robot.move(["P"], 40_000, 1000, 1000)


@pytest.mark.parametrize(
    ("order", "refusal", "told"),
    [
        ("move", (codes.RANGE_LIMIT, 0, 1500, 1000), r"move \(joint P\) refused: R31 .* 15 mm, at most 10\. "),
        ("move", (codes.RANGE_LIMIT, 0, -600, -500), r"R31 .* -6 mm, at least -5\. "),
        ("move", (codes.SLEW_LIMIT, 0, 2000, 1000), r"R32 .* 20 mm/s, at most 10\. "),
        ("press", (codes.FORCE_LIMIT, 0, 19_500, 18_000), r"press \(joint P\) refused: R36 .* 19\.5 N, at most 18\. "),
        ("press", (codes.NO_LOAD_CELL, 255, 0, 0), r"press refused: R35 .*load cell"),
    ],
)
def test_refusals_are_told_in_millimetres_and_newtons(robot, peer, order, refusal, told):
    peer.refuse[order] = refusal
    ask = {"move": lambda: robot.move(["P"], 0, 10, 10), "press": lambda: robot.press(0, 10, 10, 10)}[order]

    with pytest.raises(Refused, match=told):
        ask()


@pytest.mark.parametrize(
    ("code", "value", "told"),
    [
        (codes.ASTRAY, 52, r"\(joint P\): F28 .* 0\.52 mm\. "),
        (codes.OVERLOAD, 20_480, r"F29 .* 20\.48 N\. "),
        (codes.LOAD_CELL, 4095, r"F30 .* 4095 counts\. "),
    ],
)
def test_a_run_that_a_fault_ends_tells_it_in_the_units_of_a_press(robot, peer, code, value, told):
    peer.ending = (messages.TRIP, code, 0, value)

    ending = run(robot, program.header(CODE, 0) + CODE, lambda stage, done: None)

    with pytest.raises(RobotFault, match=told):
        raise ending.error()


def test_ctrl_c_while_it_presses_stops_it(peer):
    robot = Robot(FakeLine(peer))
    robot.connect()
    robot.press(5000, 10, 5000, 1000)

    with pytest.raises(Interrupted, match="joints P were driven and are limp now where they stand"), robot:
        raise KeyboardInterrupt
