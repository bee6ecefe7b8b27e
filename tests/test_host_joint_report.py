"""The report of a run of joints, worked out by hand from a few records."""

import pytest

from host.drivenreport import driven, driven_lines
from host.keeper import Keeper
from host.observed import observed, observed_lines
from host.profile import read_profile
from host.recording import Recording
from host.records import Event, Telemetry
from tests.joint_samples import FINGERS, HAND

FINGER = read_profile(FINGERS)
SEEN = {
    "kind": "fingers",
    "object_deg": -2.588097,
    "object_mm": [0.31, 50.5],
    "along": "undetermined",
    "energy_mj": 213.51996,
    "gripped": True,
    "joint_torque_nm": {"R": 2.4775, "L": 2.4775},
    "displacement_mm": {"R": 6.189405, "L": 6.958104},
    "friction_used": {"R": None, "L": None},
    "stiffness_nmm_per_rad": 1759.96,
    "model": {"tip": "nail", "contact": "frictionless", "motion": "quasi-static"},
}


def record(now_ms, deg, commanded, ma) -> Telemetry:
    return Telemetry(
        now_ms, now_ms, "running", 1, 6000, 100, 25.0, (), (),
        joint_position=(deg, -deg), commanded_position=(commanded, None), joint_ma=(ma, 20),
    )  # fmt: skip


@pytest.fixture
def recording():
    seen = Recording((), joints=("R", "L"))
    seen.telemetry += [record(0, 0.1, None, 20), record(100, 4.0, 8.0, 300), record(400, 7.9, 8.0, 900)]
    seen.telemetry += [record(500, 7.8, None, 10)]
    return seen


class Watcher:
    """Sees the object in the grip when it is asked first; then nobody holds it any more."""

    def __init__(self):
        self.views = [{**SEEN, "torque_peak_nm": {"R": 2.4, "L": 2.4}}]

    def observe(self):
        free = {**SEEN, "object_deg": 0.0, "gripped": False, "torque_peak_nm": {"R": 2.5, "L": 2.5}}
        return self.views.pop() if self.views else free


def test_joints_are_told_by_time_driven_range_and_largest_current(recording):
    joints = driven(recording, FINGER)["joints"]

    assert joints["R"] == {"driven_s": 0.4, "least_deg": 0.1, "most_deg": 7.9, "peak_ma": 900}
    assert joints["L"] == {"driven_s": 0.0, "least_deg": -7.9, "most_deg": -0.1, "peak_ma": 20}


def test_a_robot_without_coils_has_no_table_of_coils(recording):
    fields = driven(recording, FINGER)

    assert list(fields) == ["joints"]
    assert list(driven_lines(fields)) == [
        "  joint    driven       least        most   peak current",
        "  R        0.40 s    0.10 deg    7.90 deg         0.90 A",
        "  L        0.00 s   -7.90 deg   -0.10 deg         0.02 A",
    ]


def test_joints_of_which_nothing_was_heard_are_told_without_figures():
    joints = driven(Recording((), joints=("R", "L")), FINGER)

    assert joints["joints"]["R"] == {"driven_s": 0.0, "least_deg": None, "most_deg": None, "peak_ma": None}
    assert list(driven_lines(joints))[1] == "  R        0.00 s"


def test_a_robot_of_both_kinds_has_both_tables():
    fields = driven(Recording(("A", "B"), joints=("R", "L")), read_profile(HAND))

    assert (list(fields["coils"]), list(fields["joints"])) == (["A", "B"], ["R", "L"])


def test_what_fingers_held_is_told_of_the_end_of_the_program(recording):
    watcher = Watcher()
    keeper = Keeper(observer=watcher, scenes=False)
    keeper.know(FINGER.parts)
    for name in ("started", "finished", "disarmed"):
        keeper.record(Event(400, 400, name, 0, 0, None, 0))

    seen = observed(watcher, keeper.recording)

    assert (seen["object_deg"], seen["gripped"]) == (-2.588097, True)
    assert seen["torque_peak_nm"] == {"R": 2.5, "L": 2.5}
    assert keeper.recording.scenes == []


def test_a_run_that_did_not_end_is_told_as_it_is_seen(recording):
    assert observed(Watcher(), recording)["object_deg"] == -2.588097


def test_the_lines_about_fingers_say_how_the_object_lies_and_what_is_not_known():
    assert list(observed_lines(SEEN)) == [
        "  object           -2.588 deg at x 0.31 mm, y 50.50 mm, along its faces undetermined",
        "  energy           213.52 mJ",
        "  stiffness        1760.0 N mm/rad",
        "  displacement     R 6.189 mm, L 6.958 mm",
        "  joint torque     R 2.478 N m, L 2.478 N m",
        "  model            nail, frictionless, quasi-static",
    ]
    assert next(observed_lines({**SEEN, "gripped": False})).endswith(", not gripped")


def test_a_nothing_has_no_sign():
    shown = next(observed_lines({**SEEN, "object_deg": -1e-9, "object_mm": [-1e-4, 51.0]}))

    assert shown == "  object           0.000 deg at x 0.00 mm, y 51.00 mm, along its faces undetermined"
