"""The gaits of the soft fingers: what each tells both joints, and that it is sound all over its ranges."""

import pytest

from host.gait.checker import check
from host.gait.compiler import compile_script
from host.gait.script import load
from protocol.program import ORIENTATION, disassemble
from tests.gait_scripts import ROOT, profile_of

R, L = 0b01, 0b10


def made(name, *overrides):
    script = load(ROOT / "gaits" / f"fingers-{name}.gait")
    return compile_script(script, profile_of(script.robot_name()), overrides)


def rows(name, *overrides):
    """Return the ops of a gait without step marks."""
    return [row[1:] for row in disassemble(made(name, *overrides).code) if row[1] != "step"]


def poses(name, *overrides):
    """Return the angles [deg] of R and L after each pair of moves."""
    moves = [row for row in rows(name, *overrides) if row[0] == "move"]
    assert [row[1] for row in moves] == [R, L] * (len(moves) // 2)
    return [(right[2] / 100, left[2] / 100) for right, left in zip(moves[::2], moves[1::2], strict=True)]


def test_figure_13_grips_swings_to_both_sides_comes_back_and_opens():
    assert poses("figure13") == [(0, 0), (8, -8), (28, 12), (-12, -28), (8, -8), (-2, 2)]


def test_figure_13_takes_grip_and_swing_from_the_command_line():
    assert poses("figure13", "inward=4deg", "swing=10deg")[1:4] == [(4, -4), (14, 6), (-6, -14)]


def test_the_experiment_swings_several_times_and_rests_with_its_grip():
    assert poses("experiment", "times=2") == [(0, 0), (2.5, -2.5), (12.5, 7.5), (-7.5, -12.5), (2.5, -2.5)]
    assert [row for row in rows("experiment", "times=2") if row[0] == "repeat"] == [("repeat", 2)]
    assert rows("experiment")[-2:] == [("delay", 1000), ("halt",)]


def test_the_cube_is_turned_to_one_side_to_the_other_and_back():
    found = rows("orient")

    assert [row[1] for row in found if row[0] == "orient"] == [500, -500, 0]
    waits = [row[1] for row in found if row[0] == "wait"]
    assert [(wait.source, wait.value) for wait in waits] == [
        (ORIENTATION, 490), (ORIENTATION, -490), (ORIENTATION, -10),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("name", "overrides"),
    [
        ("figure13", ["inward=8deg", "swing=20deg", "time=500ms", "rest=100ms"]),
        ("figure13", ["inward=2deg", "swing=5deg", "time=10s", "rest=5s"]),
        ("experiment", ["inward=2.5deg", "swing=15deg", "time=500ms", "times=20"]),
        ("experiment", ["time=10s", "times=20"]),
        ("orient", ["inward=2.5deg", "angle=6deg", "near=0.05deg", "rest=2s"]),
        ("orient", ["angle=0.5deg", "near=1deg"]),
    ],
)
def test_the_gaits_of_the_fingers_are_sound_all_over_their_ranges(name, overrides):
    assert check(made(name, *overrides)).diagnostics == ()


@pytest.mark.parametrize(
    ("name", "override"),
    [("figure13", "inward=9deg"), ("figure13", "swing=-5deg"), ("experiment", "times=0"), ("orient", "angle=-5deg")],
)
def test_the_gaits_of_the_fingers_refuse_what_is_outside_their_ranges(name, override):
    with pytest.raises(Exception, match="E182"):
        made(name, override)
