"""The host and a robot with a press: its profile, its telemetry, its orders."""

import json

import pytest

from host.errors import BadRequest, Mismatch
from host.profile import read_profile
from tests.joint_samples import FINGERS
from tests.press_profiles import MADE, PRESS, weighed, without

AXIS = read_profile(PRESS)


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
    with pytest.raises(BadRequest, match="`softrig move P --to 8mm` moves it"):
        AXIS.coil_mask(["P"])
