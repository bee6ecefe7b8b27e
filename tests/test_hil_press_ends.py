"""Where a press on the bench ends: too much force, a servo that stalls, sensors that lie, and what no model covers."""

import pytest
from click.testing import CliRunner

from host.cli import main
from host.records import Telemetry
from protocol import codes
from tests.hil_rig import HilRig

COARSE = "set=block.columns_count:16&set=block.rows_count:8"
HARD = "set=material.youngs_modulus_kpa:400"


def pressed(options="", to_centi=400, over_ms=1000, seconds=1.5):
    """Return a robot that was told to press, and what it told meanwhile."""
    rig = HilRig(f"sim:press?{COARSE}{options and '&' + options}")
    rig.robot.subscribe(20)
    rig.robot.arm()
    rig.robot.move(["P"], to_centi, over_ms, 20_000)
    return rig, [record for record in rig.run(seconds) if isinstance(record, Telemetry)]


def test_too_much_force_switches_the_press_off_and_leaves_it_where_it_is():
    rig, _ = pressed(HARD)
    plant, status = rig.bench.plant, rig.robot.status()
    stood, force = plant.screw.at_mm, plant.load_n
    rig.run(2.0)

    assert (status.state, status.code) == ("tripped", codes.OVERLOAD)
    assert not rig.bench.any_joint_driven
    assert plant.screw.at_mm == stood < 4.0
    assert plant.load_n < force
    assert 20.0 < rig.bench.observe()["force_peak_n"] < 20.0 + 2.5  # 100 ms of the way down


def test_a_block_that_is_too_hard_for_the_load_cell_and_never_gives_way_can_be_left():
    elastic = "set=material.youngs_modulus_kpa:60000&set=material.parallel_modulus_kpa:60000"
    rig, _ = pressed(elastic)
    pinned_n = rig.bench.plant.load_n

    rig.robot.clear()
    rig.robot.arm()
    rig.robot.move(["P"], -200, 1000, 1000)
    rig.run(1.5)

    assert pinned_n > 26.2  # beyond what the load cell can tell
    assert not rig.bench.plant.touching
    assert rig.robot.status().state == "armed"


@pytest.mark.parametrize("over_ms", [0, 1000])
def test_the_most_that_may_be_ordered_trips_nothing_however_quickly_it_is_wanted(over_ms):
    rig = HilRig(f"sim:press?{COARSE}")
    rig.robot.arm()
    rig.robot.press(18_000, over_ms, 2500, 1000)
    rig.run(3.0)

    assert rig.robot.status().state == "armed"
    assert 17.5 < rig.bench.observe()["force_peak_n"] < 19.5


def test_a_block_that_answers_like_a_stiff_dashpot_is_pressed_without_swinging():
    rig = HilRig(f"sim:press?{COARSE}&indenter=flat&set=material.damping_kpa_s:150")
    rig.robot.subscribe(20)
    rig.robot.arm()
    rig.robot.press(5000, 1000, 9000, 1000)
    rig.run(5.0)

    felt_n = [record.load_n for record in rig.run(3.5) if isinstance(record, Telemetry)]

    assert 3.5 < min(felt_n) < max(felt_n) < 6.5
    assert rig.bench.observe()["force_peak_n"] < 10


def test_a_servo_that_cannot_press_any_harder_trips():
    rig, _ = pressed("set=axis.stall_force_n:4", seconds=3.0)

    assert rig.robot.status().code == codes.STALL
    assert 0.9 < rig.bench.joint("P").peak_a <= 1.5
    assert not rig.bench.any_joint_driven


@pytest.mark.parametrize("fault", ["joint-jam:P", "servo-dead:P", "pot-open:P"])
def test_an_axis_that_does_not_do_as_it_is_told_trips(fault):
    rig, _ = pressed(seconds=0.5)

    rig.happens(fault)
    rig.run(3.0)

    assert rig.robot.status().state == "tripped"
    assert not rig.bench.any_joint_driven


def test_pulled_out_of_power_the_press_stays_in_the_block():
    rig, _ = pressed()
    stood = rig.bench.plant.screw.at_mm

    rig.bench.board.set_estop(closed=False)
    rig.run(2.0)

    assert rig.bench.plant.screw.at_mm == pytest.approx(stood, abs=0.02)
    assert rig.bench.plant.touching
    assert rig.bench.plant.joint_current_a[0] == 0.01


def still(options):
    """Return the loads [N] and the pressures of C1 [kPa] that a press in the air tells."""
    rig = HilRig(f"sim:press?{COARSE}{options and '&' + options}")
    rig.robot.subscribe(20)
    told = [record for record in rig.run(4.0) if isinstance(record, Telemetry)]
    return [record.load_n for record in told], [record.cell_kpa[0] for record in told]


def deviation(values):
    mean = sum(values) / len(values)
    return (sum((value - mean) ** 2 for value in values) / len(values)) ** 0.5


def test_without_noise_a_press_at_rest_tells_no_force():
    loads, pressures = still("")

    assert set(loads) == {0.0}
    assert set(pressures) == {0.0}


def test_a_noisy_load_cell_and_noisy_force_cells_scatter_as_the_file_says():
    loads, pressures = still("set=load_cell.noise_n:0.1&set=cells.noise_pa:200")

    assert len(loads) > 150
    assert deviation(loads) == pytest.approx(0.1, rel=0.2)
    assert sum(loads) / len(loads) == pytest.approx(0.0, abs=0.03)
    assert 0.08 < deviation(pressures) < 0.15  # half of it is below 0, which no converter tells


def test_noise_is_a_matter_of_the_seed():
    noisy = "set=load_cell.noise_n:0.1"

    assert still(noisy) == still(noisy) != still(f"{noisy}&seed=2")


def test_a_load_cell_that_is_adjusted_otherwise_tells_another_force():
    loads, _ = still("set=load_cell.zero_mv:500")

    assert len(set(loads)) == 1
    assert loads[0] == pytest.approx(-0.160 / 3.3 * 32.768, abs=0.008)


def test_a_press_through_the_block_ends_the_run_with_one_line():
    flat = ["block.height_mm:6", "cells.side_mm:1", "material.youngs_modulus_kpa:5", "material.damping_kpa_s:1"]
    address = f"sim:press?{COARSE}&" + "&".join(f"set={row}" for row in flat)
    command = ["run", "gaits/press-hold-release.gait", "--robot", address, "-p", "depth=6mm"]

    result = CliRunner().invoke(main, [*command, "-p", "time=2s"])

    assert result.exit_code == 7
    assert "the press left what its model is valid for at" in result.stderr.splitlines()[-1]
    assert "the indenter meets what the block stands on at 0.006 m" in result.stderr.splitlines()[-1]


def test_both_worlds_hear_the_same_noise_and_the_same_play():
    options = "set=load_cell.noise_n:0.05&set=cells.noise_pa:50&set=axis.backlash_mm:0.2"

    traces = {pressed(f"{options}&world={world}")[0].bench.trace_sha256() for world in ("cpython", "micropython")}

    assert len(traces) == 1


def test_a_bench_shows_what_is_inside_a_block_and_nothing_of_other_bodies():
    rig, _ = pressed()
    fields = rig.bench.fields()

    assert fields["displacement_mm"][:, 1].min() == pytest.approx(-rig.bench.observe()["dent_mm"])
    assert fields["stress_kpa"].shape == (len(fields["triangles"]), 4)
    assert HilRig("sim:fingers").bench.fields() is None
