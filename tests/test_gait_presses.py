"""The gaits of the press: what each tells the robot, and that it is sound all over its ranges."""

import pytest

from host.gait.checker import check
from host.gait.compiler import compile_script
from host.gait.script import load
from protocol.program import ABOVE, ANY, BELOW, FORCE, POSITION, PRESSURE, disassemble
from tests.gait_scripts import ROOT, profile_of

ALL_CELLS = 0b111111


def made(name, *overrides):
    script = load(ROOT / "gaits" / f"press-{name}.gait")
    return compile_script(script, profile_of(script.robot_name()), overrides)


def rows(name, *overrides):
    """Return the ops of a gait without step marks."""
    return [row[1:] for row in disassemble(made(name, *overrides).code) if row[1] != "step"]


def asked(name, *overrides):
    """Return (source, value, mask) of each condition that the robot waits for."""
    waits = [row[1] for row in rows(name, *overrides) if row[0] == "wait"]
    return [(wait.source, wait.value, wait.mask) for wait in waits]


def test_the_press_goes_down_stands_is_lifted_at_8_mm_a_second_and_leaves_the_block_alone():
    assert rows("hold-release")[-7:] == [
        ("move", 1, 400, 2000), ("delay", 2000), ("delay", 3000),
        ("move", 1, -200, 750), ("delay", 750), ("delay", 5000), ("halt",),
    ]  # fmt: skip


def test_depth_and_times_come_from_the_command_line():
    moves = [row for row in rows("hold-release", "depth=2mm", "time=5s", "clear=1mm") if row[0] == "move"]

    assert moves[2:] == [("move", 1, 200, 5000), ("move", 1, -100, 375)]


def test_the_creep_is_a_force_after_the_block_was_felt_and_ends_early_where_it_is_too_deep():
    found = rows("creep", "force=2N", "creep=30s")

    assert asked("creep") == [(FORCE, 100, 0), (POSITION, 800, 1)]
    assert [row for row in found if row[0] == "press"] == [("press", 2000, 1000, 31_000)]


def test_the_cycle_asks_for_four_forces_and_looks_at_load_cell_and_force_cells():
    forces = [row[1] for row in rows("cycle", "force=1N") if row[0] == "press"]

    assert forces == [1000, 2000, 3000, 4000]
    assert asked("cycle", "force=1N")[:4] == [
        (FORCE, 100, 0), (FORCE, 800, 0), (PRESSURE, 7000, ALL_CELLS), (PRESSURE, 500, ALL_CELLS),
    ]  # fmt: skip
    assert rows("cycle")[0][1][:4] == (FORCE, ANY, ABOVE, 12_000)
    assert BELOW in [row[1].compare for row in rows("cycle") if row[0] == "wait"]


@pytest.mark.parametrize(
    ("name", "overrides"),
    [
        ("hold-release", ["depth=6mm", "time=1s", "hold=300s", "rest=300s", "clear=5mm"]),
        ("hold-release", ["depth=0.5mm", "time=60s", "hold=100ms", "rest=1s", "clear=0.5mm"]),
        ("creep", ["force=10N", "time=200ms", "creep=60s", "deep=9.5mm", "rest=300s", "clear=5mm", "felt=50mN"]),
        ("creep", ["force=0.5N", "time=10s", "creep=0.5s", "deep=1mm", "rest=1s", "clear=0.5mm", "felt=500mN"]),
        ("cycle", ["force=2N", "time=3s", "hold=3s", "most=18kPa", "near=0.4N", "rest=60s", "clear=5mm"]),
        ("cycle", ["force=0.5N", "time=300ms", "hold=100ms", "most=1kPa", "near=0.1N", "rest=100ms", "clear=0.5mm"]),
    ],
)
def test_the_gaits_of_the_press_are_sound_all_over_their_ranges(name, overrides):
    assert check(made(name, *overrides)).diagnostics == ()


@pytest.mark.parametrize(
    ("name", "override"),
    [("hold-release", "depth=7mm"), ("hold-release", "clear=0mm"), ("creep", "force=11N"), ("cycle", "most=19kPa")],
)
def test_the_gaits_of_the_press_refuse_what_is_outside_their_ranges(name, override):
    with pytest.raises(Exception, match="E182"):
        made(name, override)
