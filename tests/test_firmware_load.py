"""The load cell and the force cells: what they read, and what happens when a force or a reading is none that may be."""

import json

import pytest

from firmware.profile import Profile
from protocol import codes, messages, variables
from tests.firmware_bench import refusal
from tests.firmware_press import PRESS, P, PressRig

OVER_COUNTS = 819 + 20_500 // 8


@pytest.fixture
def rig():
    return PressRig()


@pytest.fixture
def armed(rig):
    rig.arm()
    return rig


def told(rig, *names: str) -> list:
    """Return the variables of these names as the next record has them."""
    numbers = [variables.number(name) for name in names]
    rig.say(messages.SUBSCRIBE, slot=1, period_ms=20, on_change=0, variables=bytes(numbers))
    record = [body for kind, body in rig.run(60) if kind == "telemetry" and body.slot == 1][-1]
    return variables.unpack(numbers, variables.veiled(record.values), variables.counts(0, 1, 0, 1, 6))


@pytest.mark.parametrize(("counts", "force_mn"), [(819, 0), (820, 8), (818, -8), (1819, 8000), (20, -6392)])
def test_the_force_is_told_in_millinewtons_from_its_zero(rig, counts, force_mn):
    rig.axis.load_counts = counts

    assert told(rig, "load_mn") == [(force_mn,)]


def test_the_force_cells_are_told_in_pascal_in_their_order(rig):
    rig.axis.cell_counts = [0, 1, 205, 2048, 4000, 4095]

    assert told(rig, "cell_pa") == [(0, 4, 1000, 10_000, 19_531, 19_995)]


def test_the_usual_variables_end_with_force_and_pressures(rig):
    rig.axis.load_counts, rig.axis.cell_counts = 1819, [2048] * 6
    rig.say(messages.SUBSCRIBE, slot=0, period_ms=20, on_change=0, variables=b"")
    record = [body for kind, body in rig.run(100) if kind == "telemetry"][-1]

    values = variables.unpack(variables.USUAL, variables.veiled(record.values), variables.counts(0, 1, 0, 1, 6))

    assert values[-2:] == [(8000,), (10_000,) * 6]


def test_a_force_beyond_its_limit_trips_within_three_readings_and_the_axis_is_let_go(armed):
    armed.move(P, 400, over_ms=1000)
    armed.run(300)
    armed.axis.load_counts = OVER_COUNTS
    armed.run(25)

    trip = armed.events("tripped")[-1]
    assert (trip.code, trip.channel, trip.value) == (codes.OVERLOAD, 0, 20_496)
    assert armed.board.servos[8].width_ns is None


def test_one_wild_reading_of_the_load_cell_is_not_believed(armed):
    armed.move(P, 400, over_ms=1000)
    armed.axis.load_counts = 4000
    armed.run(10)
    armed.axis.load_counts = 900
    armed.run(500)

    assert not armed.events("tripped")


def test_too_great_a_force_can_be_taken_off_by_moving_back(armed):
    armed.axis.mm = 3.0
    armed.axis.load_counts = OVER_COUNTS
    armed.run(200)
    limp = armed.events("tripped")
    armed.move(P, 0, over_ms=3000)
    armed.run(2900)
    back_mm = armed.axis.mm

    assert not limp
    assert not armed.events("tripped")
    assert back_mm < 0.2


def test_an_axis_that_hardly_moves_back_under_too_great_a_force_trips(armed):
    armed.move(P, 300, over_ms=3000)
    armed.run(3100)
    armed.move(P, 299, over_ms=60_000)
    armed.run(50)
    armed.axis.load_counts = OVER_COUNTS
    armed.run(200)

    assert armed.events("tripped")[-1].code == codes.OVERLOAD


def test_an_axis_that_stays_under_too_great_a_force_trips(armed):
    armed.axis.mm = 3.0
    armed.axis.load_counts = OVER_COUNTS
    armed.move(P, 200, over_ms=1000)
    armed.run(1100)

    assert armed.events("tripped")[-1].code == codes.OVERLOAD


@pytest.mark.parametrize("counts", [0, 8])
def test_a_load_cell_that_is_torn_off_is_refused_before_arming(rig, counts):
    rig.axis.load_counts = counts
    rig.run(100)

    refused = refusal(rig.arm())

    assert (refused.code, refused.value) == (codes.LOAD_CELL, counts)


@pytest.mark.parametrize("counts", [4087, 4095])
def test_a_force_beyond_what_the_load_cell_can_tell_is_no_reason_to_stay_under_it(rig, counts):
    """A hard block that keeps its force would hold the axis for ever: nobody could arm to lift it."""
    rig.axis.mm, rig.axis.load_counts = 3.0, counts
    rig.run(100)
    rig.arm()
    rig.move(P, 0, over_ms=3000)
    rig.run(2900)

    assert rig.axis.mm < 0.2
    assert not rig.events("tripped")


@pytest.mark.parametrize("counts", [4087, 4095])
def test_under_such_a_force_the_axis_is_not_pushed_on(rig, counts):
    rig.axis.mm, rig.axis.load_counts = 3.0, counts
    rig.run(100)
    rig.arm()
    rig.press(1000)
    rig.run(25)

    assert rig.events("tripped")[-1].code == codes.OVERLOAD
    assert rig.axis.mm == pytest.approx(3.0, abs=0.02)


def test_a_load_cell_that_is_torn_off_trips_an_armed_robot(armed):
    armed.move(P, 200, over_ms=1000)
    armed.axis.load_counts = 0
    armed.run(100)

    trip = armed.events("tripped")[-1]
    assert (trip.code, trip.value) == (codes.LOAD_CELL, 0)


def test_an_open_force_cell_reads_no_pressure_and_stops_nothing(armed):
    armed.move(P, 200, over_ms=1000)
    armed.run(1200)

    assert armed.core.state == messages.ARMED


BAD = [
    ("load", {"zero_counts": 4}),
    ("load", {"full_mn": 200_000}),
    ("load", {"trip_mn": 27_000}),
    ("load", {"most_mn": 20_001}),
    ("press", {"gain_um_per_s_per_n": 0}),
    ("press", {"reset_permille_per_s": -1}),
    ("press", {"smooth_ms": 10}),
    ("press", {"approach_um_per_s": 0}),
    ("press", {"touch_mn": -1}),  # it would approach as if it touched
    ("press", {"touch_mn": 18_000}),
    ("cell", {"full_pa": 40_000}),
    ("servo", {"unit": "inch"}),
    ("servo", {"unit": "deg"}),  # of a press
]


@pytest.mark.parametrize(
    ("load", "position", "cell"), [(16, 1, 7), (-1, 1, 7), (8, 16, 7), (8, 1, 99), (1, 1, 7), (7, 1, 7), (8, 7, 7)]
)
def test_a_profile_that_reads_no_input_or_two_things_at_one_is_refused(load, position, cell):
    data = json.loads(PRESS.read_bytes())
    data["load"]["input"], data["channels"][0]["position"], data["cells"][5]["input"] = load, position, cell

    with pytest.raises(ValueError, match="input"):
        Profile(json.dumps(data).encode())


@pytest.mark.parametrize(("section", "change"), BAD)
def test_a_profile_whose_forces_cannot_be_is_refused(section, change):
    data = json.loads(PRESS.read_bytes())
    data[section] |= change

    with pytest.raises(ValueError, match={"cell": "cells", "servo": "servo|in mm"}.get(section, section)):
        Profile(json.dumps(data).encode())
