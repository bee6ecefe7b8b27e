"""Both spheres' files: points read from labels, numbers in SI units, and what of the paper they carry."""

from math import dist, radians, sqrt

import pytest

from hil_sim.bodies.directions import direction
from hil_sim.physics.bodies import Attitude
from hil_sim.robots.file import load

A, B = load("sphere-a"), load("sphere-b")
SQUARE = ("B10m1", "B01m1", "Bm10m1", "B0m1m1")


def test_a_label_names_its_direction_with_m_for_the_bar():
    found = [direction(label) for label in ("A100", "Am100", "A00m1", "B10m1", "A0m1m1")]

    assert found == [(1, 0, 0), (-1, 0, 0), (0, 0, -1), (1, 0, -1), (0, -1, -1)]


@pytest.mark.parametrize(
    "label", ["A", "A10", "A1000", "a100", "A102", "A1-10", "A1mm", "A000", "A111", "100", "AA100"]
)
def test_a_label_that_names_no_point_of_a_hoop_is_refused(label):
    with pytest.raises(ValueError, match=f"^{label}: "):
        direction(label)


def test_each_sphere_has_coils_to_the_six_axes_and_the_twelve_sums_of_two():
    directions = {direction(label) for label in A.labels}

    assert A.labels == B.labels[:18]
    assert len(directions) == 18
    assert sum(sum(map(abs, found)) == 1 for found in directions) == 6


def test_the_jump_coils_of_b_run_round_the_square_of_the_lower_diagonals():
    assert B.labels[18:] == SQUARE
    assert B.jumps == tuple(zip(SQUARE, (*SQUARE[1:], SQUARE[0]), strict=True))
    assert A.jumps == ()


def test_a_jump_coil_is_as_long_as_a_spoke():
    points = {label: [B.sphere.R * part / sqrt(2) for part in direction(label)] for label in SQUARE}

    lengths = [dist(points[start], points[end]) for start, end in B.jumps]

    assert lengths == pytest.approx([B.sphere.R - B.sphere.attach] * 4)


def test_sizes_are_in_si_units():
    sphere = A.sphere

    found = [sphere.R, sphere.m, sphere.m_core, sphere.width, sphere.EI, sphere.edgewise, A.battery.Q]
    assert found == pytest.approx([0.1, 0.05, 0.075, 0.01, 1.5e-3, 20, 1080])
    assert (A.kind, A.ring, B.battery, B.wiring.supply_v) == ("sphere", None, None, 5.0)


def test_the_paper_gives_size_and_weight():
    paper = {(robot.name, entry.name) for robot in (A, B) for entry in robot.entries if entry.standing == "paper"}

    assert paper == {("sphere-a", "shell.radius_mm"), ("sphere-a", "core.mass_g"), ("sphere-b", "shell.radius_mm")}


def test_the_start_attitude_comes_from_the_address():
    start = load("sphere-b", {"start.yaw_deg": "90", "start.pitch_deg": "-45", "start.settle_s": "1"}).start

    assert start == Attitude(radians(90), radians(-45), 0.0, 1.0)


def test_terrain_comes_from_the_address():
    ground = load("sphere-b", {"ground.step_mm": "4", "ground.step_at_mm": "80", "ground.roughness_mm": "1"}).ground

    assert (ground.step, ground.step_at, ground.rough, ground.rough_length) == (0.004, 0.08, 0.001, 0.012)
